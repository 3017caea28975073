"""Noise is removed by Open Image Denoise where it is installed, and what is left is measured all the same.

A library with its interface stands for it here: what is tested is how it is found, called and judged.
"""
import json
import os
import unittest

from program import ProgramTest, read_pfm, relative_error


class OidnTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.oidn = "oidn:library=" + os.environ["FAKE_OIDN"]

    def test_the_error_that_is_left_is_measured(self):
        self.render("--spp", 1024, "--seed", 9, "-o", "true.pfm")
        true = read_pfm(self.folder / "true.pfm")
        ratios = []
        for seed in range(1, 5):
            said = json.loads(self.render("--spp", 16, "--seed", seed, "--denoiser", self.oidn,
                                          "--json", "--quiet", "-o", "a.exr", "-o", "a.pfm").stdout)["denoised"]
            self.assertEqual(said["denoiser"], "oidn 2.8.9")
            error = relative_error(read_pfm(self.folder / "a.pfm"), true)
            self.assertLess(error, said["noisy_relative_mse"])
            ratios.append(said["relative_mse"] / error)
        self.assertGreater(sum(ratios) / len(ratios), 0.7)
        self.assertLess(sum(ratios) / len(ratios), 1.4)
        self.assertIn("by oidn 2.8.9: ", self.run_program("info", "a.exr").stdout)

    def test_one_step_and_two_give_the_same(self):
        one = json.loads(self.render("--spp", 16, "--layers", "light-groups", "--denoiser", self.oidn, "--json", "--quiet",
                                     "-o", "a.exr", "-o", "a.pfm").stdout)["denoised"]
        self.render("--spp", 16, "--layers", "halves,light-groups", "-o", "b.exr")
        # By the names of version 1.
        old = "oidn:library=" + os.environ["FAKE_OIDN_1"]
        two = json.loads(self.run_program("denoise", "b.exr", "--denoiser", old, "-o", "c.exr", "-o", "c.pfm",
                                          "--threads", 1, "--json").stdout)["denoised"]
        self.assertEqual(two["denoiser"], "oidn 1.4.3")
        self.assertAlmostEqual(one["relative_mse"] / two["relative_mse"], 1, delta=1e-3)
        a, c = read_pfm(self.folder / "a.pfm"), read_pfm(self.folder / "c.pfm")
        for row, other in zip(a[2], c[2]):
            for x, y in zip(row, other):
                self.assertAlmostEqual(x, y, delta=1e-4 * (1 + abs(x)))
        layers = (self.folder / "c.exr").read_bytes()
        for name in b"denoised_error.R", b"denoised_Combined_default.R":
            self.assertIn(name, layers)

    def test_a_render_ends_at_the_error_that_it_leaves(self):
        said = json.loads(self.render("--target-error", "denoised:12%", "--denoiser", self.oidn,
                                      "--spp", 4096, "--json", "--quiet", "-o", "a.exr").stdout)
        self.assertTrue(said["target"]["reached"])
        self.assertEqual(said["denoised"]["denoiser"], "oidn 2.8.9")
        self.assertLess(said["denoised"]["relative_mse"], 0.12 ** 2)

    def test_frames_are_filtered_alone(self):
        self.render("--frames", "0:1", "--spp", 16, "--denoiser", self.oidn, "-o", "f.#.exr")
        self.render("--frames", "0:1", "--spp", 16, "--layers", "halves", "-o", "g.#.exr")
        self.run_program("denoise", "f.1.exr", "--denoiser", self.oidn, "-o", "f.pfm")
        self.run_program("denoise", "g.1.exr", "--denoiser", self.oidn, "-o", "g.pfm")
        self.assertEqual((self.folder / "f.pfm").read_bytes(), (self.folder / "g.pfm").read_bytes())
        said = self.run_program("denoise", "g.1.exr", "--before", "g.0.exr", "--denoiser", self.oidn, "-o", "x.exr",
                                status=2).stderr
        self.assertIn("takes no earlier images", said)

    def test_what_is_missing_or_fails_says_so(self):
        self.render("--spp", 4, "--layers", "halves", "-o", "a.exr")
        for value, found in [("oidm", "did you mean \"oidn\"?"), ("oidn:libary=x", "did you mean \"library\"?"),
                             ("montelux:library=x", "has no settings"), ("oidn:library=none.so", "none.so"),
                             ("oidn:library=" + os.environ["MONTELUX_DISK_WATCH"], "has no function oidnNewDevice")]:
            said = self.run_program("denoise", "a.exr", "--denoiser", value, "-o", "x.exr", status=2).stderr
            self.assertIn(found, said)
            self.assertIn(found, self.render("--denoiser", value, "-o", "x.exr", status=2).stderr)
            self.assertFalse((self.folder / "x.exr").exists())
        said = self.run_program("denoise", "a.exr", "--denoiser", "oidn", "-o", "x.exr", status=(0, 2)).stderr
        if said:
            self.assertIn("there is no libOpenImageDenoise.so.2, ", said)
        failing = {"FAKE_OIDN_ERROR": "out of memory"}
        said = self.run_program("denoise", "a.exr", "--denoiser", self.oidn, "-o", "x.exr", status=2, **failing).stderr
        self.assertIn("Open Image Denoise: out of memory", said)
        # A render is not lost.
        said = self.render("--spp", 4, "--denoiser", self.oidn, "-o", "x.exr", **failing).stderr
        self.assertIn("Open Image Denoise: out of memory", said)
        self.assertTrue((self.folder / "x.exr").exists())


if __name__ == "__main__":
    unittest.main()
