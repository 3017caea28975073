"""The fuzzer finds the faults that are planted in it, keeps their inputs, and finds them again in these."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

FUZZ = os.path.abspath(sys.argv.pop(1))


class Fuzz(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)

    def run_fuzz(self, *arguments):
        return subprocess.run([FUZZ, "--keep", self.folder, *map(str, arguments)], text=True, capture_output=True,
                              check=False)

    def test_planted_faults_are_found_and_kept(self):
        for fault, status, word in (("crash", 5, "CRASH"), ("exception", 1, "FOUND"), ("hang", 4, "HANG")):
            result = self.run_fuzz("--kind", "pbrt", "--runs", 5, "--plant", fault, "--run-seconds", 1)
            self.assertEqual(result.returncode, status, result.stdout + result.stderr)
            self.assertIn(word, result.stderr)
            kept = Path(result.stderr.splitlines()[0].split(" is kept as ")[1])
            self.assertIn("Shape", kept.read_text(errors="replace"))
            again = self.run_fuzz("--replay", kept, "--plant", fault, "--run-seconds", 1)
            self.assertEqual(again.returncode, status, again.stderr)
            self.assertEqual(self.run_fuzz("--replay", kept).returncode, 0)
            kept.unlink()

    def test_a_seed_gives_the_same_runs(self):
        runs = [self.run_fuzz("--kind", "formula", "--runs", 40, "--seed", 5, "--seconds", 60) for _ in range(2)]
        self.assertEqual([r.returncode for r in runs], [0, 0], runs[0].stderr)
        self.assertIn("40 runs", runs[0].stdout)

    def test_wrong_options_say_what_is_valid(self):
        result = self.run_fuzz("--kind", "pbtr")
        self.assertEqual(result.returncode, 2)
        self.assertIn("pbrt, gltf", result.stderr)


if __name__ == "__main__":
    unittest.main()
