"""The launcher of a portable package starts the build for the largest instruction set of this processor."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

LAUNCHER = Path(sys.argv.pop(1)).resolve()
LEVELS = ["x86-64-v2", "x86-64-v3", "x86-64-v4"]
# Flags of /proc/cpuinfo, of which each level has all of its own and of those before.
FLAGS = [{"cx16", "lahf_lm", "popcnt", "pni", "sse4_1", "sse4_2", "ssse3"},
         {"avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "movbe", "xsave"},
         {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"}]


def supported_levels():
    line = next(line for line in Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("flags"))
    own, levels = set(line.split(":")[1].split()), []
    for name, flags in zip(LEVELS, FLAGS):
        if not flags <= own:
            break
        levels.append(name)
    return levels


class LauncherTest(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)
        (self.folder / "bin").mkdir()
        shutil.copy(LAUNCHER, self.folder / "bin" / "montelux")

    def install(self, *levels):
        for level in levels:
            program = self.folder / "libexec" / "montelux" / level / "bin" / "montelux"
            program.parent.mkdir(parents=True)
            program.write_text(f"#!/bin/sh\necho {level} \"$@\"\nexit 7\n")
            program.chmod(0o755)

    def run_it(self, *arguments, stated=None):
        environment = {name: value for name, value in os.environ.items() if name != "MONTELUX_INSTRUCTIONS"}
        if stated is not None:
            environment["MONTELUX_INSTRUCTIONS"] = stated
        done = subprocess.run([self.folder / "bin" / "montelux", *arguments], env=environment, text=True, capture_output=True)
        return done.returncode, done.stdout.strip(), done.stderr.strip()

    def test_the_largest_set_of_the_processor_is_chosen_and_receives_arguments_and_status(self):
        self.install(*LEVELS)
        self.assertEqual(self.run_it("render", "a b"), (7, f"{supported_levels()[-1]} render a b", ""))

    def test_builds_that_are_not_there_are_no_choice(self):
        self.install("x86-64-v2")
        self.assertEqual(self.run_it()[:2], (7, "x86-64-v2"))

    def test_through_a_link(self):
        self.install("x86-64-v2")
        link = self.folder / "link"
        link.symlink_to(self.folder / "bin" / "montelux")
        self.assertEqual(subprocess.run([link], text=True, capture_output=True).stdout.strip(), "x86-64-v2")

    def test_a_set_may_be_stated(self):
        self.install(*LEVELS)
        for level in LEVELS:
            status, said, error = self.run_it(stated=level)
            if level in supported_levels():
                self.assertEqual((status, said), (7, level))
            else:
                self.assertEqual((status, error), (2, f"montelux: error: MONTELUX_INSTRUCTIONS: this processor does not have {level}"))
        self.assertEqual(self.run_it(stated="sse"), (2, "", "montelux: error: MONTELUX_INSTRUCTIONS: \"sse\" is not one of "
                                                            "x86-64-v4, x86-64-v3, x86-64-v2"))

    def test_a_package_without_programs_says_so(self):
        status, _, error = self.run_it()
        self.assertEqual(status, 3)
        self.assertIn("no program in", error)


if __name__ == "__main__":
    unittest.main()
