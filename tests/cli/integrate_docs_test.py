"""Every example of docs/integrate.md runs, and prints what the page shows, except for times and figures derived from them."""
import re
import shlex
import unittest

from program import ROOT, ProgramTest

PAGE = ROOT / "docs" / "integrate.md"
MEASURED = ("time", "efficiency", "of first")  # columns and lines that depend on the machine


def examples(text):
    """(command, lines shown after it), in the order of the page: indented lines that begin with the program's name."""
    found = []
    for line in text.splitlines():
        if line.startswith("    montelux "):
            if not line.startswith("    montelux: "):
                found.append((line.strip(), []))
                continue
        if line.startswith("    ") and found and line.strip():
            found[-1][1].append(line[4:].rstrip())
        elif line.strip() and found and found[-1][1] is not None:
            found.append((None, []))  # what follows prose is shown by no command
    return [(command, shown) for command, shown in found if command]


def comparable(lines):
    """The lines without what is measured by the clock."""
    result, dropped = [], []
    for line in lines:
        cells = re.split(r"  +", line.strip())
        if cells[0] == "method" and "efficiency" in cells:
            dropped = [k for k, cell in enumerate(cells) if cell in MEASURED]
        if cells[0] in MEASURED:
            result.append(cells[0])
        elif dropped and len(cells) > max(dropped):
            result.append([cell for k, cell in enumerate(cells) if k not in dropped])
        else:
            result.append(cells)
    return result


class Page(ProgramTest):
    def test_the_examples_print_what_the_page_shows(self):
        found = examples(PAGE.read_text())
        self.assertGreater(len(found), 12)
        self.assertGreaterEqual(sum(1 for _, shown in found if shown), 3)
        self.check(found)

    def test_a_wrong_figure_would_be_found(self):
        text = PAGE.read_text()
        command, shown = next((c, s) for c, s in examples(text) if s and "uniform" in c)
        self.check([(command, shown)])
        wrong = re.sub(r"\d\(", lambda m: str((int(m[0][0]) + 1) % 10) + "(", shown[0], count=1)
        self.assertNotEqual(wrong, shown[0])
        with self.assertRaises(AssertionError):
            self.check([(command, [wrong, *shown[1:]])])

    def check(self, found):
        for command, shown in found:
            words = shlex.split(re.sub(r"--time \w+", "--time 50ms", command))[1:]
            if words[0] == "integrate":
                words.insert(1, "--no-progress")
            refused = any(line.startswith("montelux: error") for line in shown)
            result = self.run_program(*words, status=2 if refused else 0)
            said = (result.stdout + result.stderr).splitlines()
            if shown:
                self.assertEqual(comparable(said), comparable(shown), command)


if __name__ == "__main__":
    unittest.main()
