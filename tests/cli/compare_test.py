"""The verb compare of the program: its results, its refusals, and a clean end on a signal."""
import json
import unittest

import program
from program import SCENE, ProgramTest

SMALL = ["--resolution", "16x12", "--repeats", "4", "--seed", "3"]


class Compare(ProgramTest):
    def compare(self, *arguments, status=0, samples=4):
        program.ENVIRONMENT["XDG_CACHE_HOME"] = str(self.folder)
        return self.run_program("compare", SCENE, *SMALL, "--spp", samples, *arguments, status=status)

    def test_every_figure_has_an_interval(self):
        result = self.compare("-a", "path", "-b", "naive", "--json", "--quiet")
        found = json.loads(result.stdout)
        self.assertEqual([m["label"] for m in found["methods"]], ["a", "b"])
        for method in found["methods"]:
            self.assertEqual(method["repeats"], 4)
            self.assertEqual(method["samples"]["mean"], 4)
            for key in ("mse", "relative_mse", "flip", "seconds", "efficiency", "coverage", "slope_by_samples"):
                low, high = method[key]["interval"]
                self.assertLess(low, high, key)
                self.assertTrue(low <= method[key]["mean"] <= high, key)
        self.assertEqual(len(found["verdicts"]), 1)
        self.assertLess(found["reference"]["share_of_smallest_mse"], 0.25)

    def test_the_reference_is_kept(self):
        self.compare("-a", "path", "-b", "naive")
        self.assertEqual(len(list(self.folder.glob("montelux/reference-*.exr"))), 1)
        self.assertIn("kept from an earlier comparison", self.compare("-a", "path", "-b", "naive").stderr)

    def test_csv_has_a_line_for_every_repeat(self):
        lines = self.compare("-a", "path", "-b", "path:mis=balance", "--csv", "--quiet").stdout.splitlines()
        self.assertEqual(len(lines), 1 + 2 * 4)

    def test_a_bad_reference_is_refused(self):
        self.run_program("render", SCENE, "--resolution", "16x12", "--spp", 8, "-o", "noisy.exr", "--quiet")
        result = self.compare("-a", "path", "-b", "path:mis=balance", "--reference", "noisy.exr", status=1, samples=16)
        self.assertIn("no verdict by this reference", result.stdout)
        self.assertIn("would decide the comparison", result.stderr)

    def test_mistakes_are_named(self):
        for arguments, word in [
            (["-a", "path"], "at least two methods"),
            (["-a", "path", "-b", "pth"], 'did you mean "path"'),
            (["-a", "path", "-b", "path:sampler=sobl"], 'did you mean "sobol"'),
            (["-a", "path", "-b", "path:mis=best"], "balance, power, off"),
            (["-a", "direct", "-b", "ao"], "none of them can make the reference"),
            (["-a", "path", "-b", "naive", "--reference", "nowhere.exr"], "nowhere.exr"),
        ]:
            with self.subTest(arguments=arguments):
                result = self.compare(*arguments, status=2)
                self.assertIn(word, result.stderr)
                self.assertEqual(result.stdout, "")


if __name__ == "__main__":
    unittest.main()
