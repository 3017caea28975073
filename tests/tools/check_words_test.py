"""tools/check_words finds each kind of planted word, where it is, and nothing in a tree without fault."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TOOL = ROOT / "tools" / "check_words"
LIST = """
[text]
asks, asks for -> queries
goes on -> continues
MUST -> must
[identifiers]
most_ -> max_
hither -> near
[allowed]
src/b/*.h: asks # the name of a person
"""


class Tree(unittest.TestCase):
    """A small source tree in a temporary folder; each test plants one fault."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = Path(self.folder.name)
        self.write("tools/words.txt", LIST)
        self.write("src/a/fine.h", "// The mask of the almost_done lanes.\nint max_depth = 3;\n")
        self.write("src/b/names.h", "// As Asks writes.\n")
        self.write("tests/fine_test.py", '"""Tests continue."""\n# must\nword = "queries"\n')
        self.write("docs/fine.md", "# Title\n\nIt continues.\n")

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def run_tool(self, *arguments):
        result = subprocess.run([sys.executable, str(TOOL), "--root", str(self.root), *arguments],
                                capture_output=True, text=True, check=False)
        return result.returncode, result.stdout + result.stderr

    def assert_found(self, place, *arguments):
        status, output = self.run_tool(*arguments)
        self.assertEqual(status, 1, output)
        self.assertIn(place, output)

    def assert_clean(self):
        status, output = self.run_tool()
        self.assertEqual(status, 0, output)

    def test_a_tree_without_fault_passes(self):
        self.assert_clean()

    def test_scripts_scenes_and_pages_are_read(self):
        self.write("quickstart", "#!/bin/sh\n# It goes on.\necho \"$#\"\n")
        self.assert_found('quickstart:2:6: "goes on"; write: continues')
        (self.root / "quickstart").unlink()
        self.write("scenes/a/a.pbrt", "# A path that asks\nShape \"asks\"\n")
        self.assert_found('scenes/a/a.pbrt:1:15: "asks"; write: queries')
        (self.root / "scenes/a/a.pbrt").unlink()
        self.write("web/src/a.ts", "const text = `it goes on`;\n")
        self.assert_found('web/src/a.ts:1:18: "goes on"; write: continues')
        (self.root / "web/src/a.ts").unlink()
        self.write("src/a/CMakeLists.txt", "# goes on\n")
        self.assert_found('src/a/CMakeLists.txt:1:3: "goes on"')
        (self.root / "src/a/CMakeLists.txt").unlink()
        self.assert_clean()

    def test_a_phrase_in_a_comment_is_found_with_its_replacement(self):
        self.write("src/a/bad.h", "int a;  // one\n  // The path Goes on here.\n")
        self.assert_found('src/a/bad.h:2:15: "Goes on"; write: continues')

    def test_a_phrase_in_the_name_of_a_test_is_found(self):
        self.write("tests/bad_test.cpp", "TEST(Path, ends)\nTEST_F(Path, that_goes_on_ends)\n")
        self.assert_found('tests/bad_test.cpp:2:19: "goes on"; write: continues')

    def test_a_phrase_across_lines_is_found(self):
        self.write("src/a/bad.h", "// The path goes\n  // on here.\n")
        self.assert_found('src/a/bad.h:1:13: "goes on"')
        self.write("src/a/bad.h", 'const char* text = "it goes"\n                   " on";\n')
        self.assert_found("src/a/bad.h:1:24: ")

    def test_a_phrase_does_not_reach_across_code(self):
        self.write("src/a/fine.h", "// where it goes\nint on;\n// on time\n")
        self.assert_clean()

    def test_literals_and_raw_strings_are_text(self):
        self.write("src/a/bad.h", 'const char* text = R"(one\nasks)";\n')
        self.assert_found('src/a/bad.h:2:1: "asks"')

    def test_includes_and_code_are_not_text(self):
        self.write("src/a/fine.h", '#include "asks/goes.h"\nint asks;\n')
        self.assert_clean()

    def test_a_longer_word_is_not_the_word(self):
        self.write("src/a/fine.h", "// tasks, masks, asks_more, must\n")
        self.assert_clean()

    def test_a_phrase_with_capitals_is_found_as_it_is_written(self):
        self.write("src/a/bad.h", "// It MUST be.\n")
        self.assert_found('src/a/bad.h:1:7: "MUST"; write: must')

    def test_identifiers_are_read_by_their_parts(self):
        self.write("src/a/bad.h", "int a; float hitherPlane;\n")
        self.assert_found('src/a/bad.h:1:14: "hitherPlane"; write: near')
        self.write("src/a/bad.h", "// as far as most_events\n")
        self.assert_found('src/a/bad.h:1:14: "most_events"; write: max_')
        self.write("src/a/bad.h", "int almost_done, at_most_once, most;  // most of them\n")
        self.assert_clean()

    def test_python_and_prose_are_read(self):
        self.write("tests/bad.py", "a = 1  # asks\n")
        self.assert_found('tests/bad.py:1:10: "asks"')
        self.write("tests/bad.py", "")
        self.write("docs/bad.md", "Text\nthat asks.\n")
        self.assert_found('docs/bad.md:2:6: "asks"')

    def test_code_in_prose_is_not_text(self):
        self.write("docs/fine.md", "Run `asks` and [this](asks.md):\n\n    asks\n\n```\nasks\n```\n")
        self.assert_clean()

    def test_an_exception_that_nothing_needs_is_found(self):
        self.write("src/b/names.h", "// no name\n")
        self.assert_found('no text needs the exception "src/b/*.h: asks"')

    def test_an_exception_holds_in_its_files_alone(self):
        self.write("src/c/names.h", "// As Asks writes.\n")
        self.assert_found("src/c/names.h:1:7:")

    def test_files_can_be_named(self):
        self.write("src/a/bad.h", "// asks\n")
        self.assert_found("src/a/bad.h:1:4:", str(self.root / "src/a/bad.h"))
        self.assertEqual(self.run_tool(str(self.root / "src/a/fine.h"))[0], 0)

    def test_a_list_without_a_reason_or_a_replacement_is_refused(self):
        self.write("tools/words.txt", LIST.replace(" # the name of a person", ""))
        self.assertEqual(self.run_tool()[0], 2)
        self.write("tools/words.txt", LIST.replace("goes on -> continues", "goes on"))
        self.assertEqual(self.run_tool()[0], 2)

    def test_the_list_of_the_project_finds_a_planted_word(self):
        self.write("src/b/names.h", "// The result hangs on the seed.\n")
        self.assert_found('src/b/names.h:1:15: "hangs on"; write: depend on', "--list", str(ROOT / "tools/words.txt"))


if __name__ == "__main__":
    unittest.main()
