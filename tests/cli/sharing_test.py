"""Pixels that share samples: montelux render --filter-samples."""
import json
import unittest

from program import SCENE, ProgramTest, read_pfm, relative_error

SIZE = ["--resolution", "64x48"]


class SharedSamples(ProgramTest):
    def picture(self, *arguments, name="picture.pfm"):
        self.run_program("render", SCENE, *SIZE, *arguments, "-o", name)
        return read_pfm(self.folder / name)

    def stated(self, *arguments):
        """The mean squared relative error that --json states."""
        result = self.run_program("render", SCENE, *SIZE, *arguments, "--json", "-o", "stated.pfm")
        return json.loads(result.stdout)["relative_mse"]

    def test_lowers_the_true_and_the_stated_error(self):
        truth = self.picture("--spp", "4096", "--filter-samples", "own", "--seed", "9")
        errors = {way: relative_error(self.picture("--spp", "64", "--filter-samples", way), truth) for way in ("shared", "own")}
        # The filter is pbrt's Gaussian, which leaves 0.34 of the noise.
        self.assertLess(errors["shared"], 0.5 * errors["own"])
        self.assertLess(self.stated("--spp", "64"), 0.5 * self.stated("--spp", "64", "--filter-samples", "own"))

    def test_is_the_default_where_it_can_be(self):
        for options, way in ((["--spp", "4"], "shared"), (["--spp", "4", "--integrator", "direct"], "shared"),
                             (["--spp", "4", "--crop", "0,0,20,48"], "shared"), (["--spp", "4", "--layers", "halves"], "own"),
                             (["--spp", "4", "--layers", "bounces"], "own"),
                             (["--spp", "4", "--integrator", "restir-di"], "own")):
            files = []
            for number, more in enumerate(([], ["--filter-samples", way])):
                file = self.folder / f"{number}.exr"
                self.run_program("render", SCENE, *SIZE, *options, *more, "-o", file)
                files.append(file.read_bytes())
            self.assertEqual(*files, options)
        self.assertNotEqual(self.picture("--spp", "4"), self.picture("--spp", "4", "--filter-samples", "own"))

    def test_shows_the_same_pixels_in_a_crop(self):
        whole, part = self.picture("--spp", "4"), self.picture("--spp", "4", "--crop", "10,8,50,40")
        self.assertEqual([row[3 * 10:3 * 50] for row in whole[2][8:40]], part[2])

    def test_is_the_same_for_any_number_of_threads_and_when_it_is_resumed(self):
        whole = self.picture("--spp", "16", "--threads", "1")
        self.assertEqual(whole, self.picture("--spp", "16", "--threads", "2"))
        self.run_program("render", SCENE, *SIZE, "--spp", "16", "--passes", "0:3", "--checkpoint", "a.film", "-o", "a.pfm")
        self.run_program("render", SCENE, *SIZE, "--spp", "16", "--passes", "4:7", "--checkpoint", "b.film", "-o", "b.pfm")
        self.run_program("merge", "a.film", "b.film", "-o", "merged.pfm")
        self.assertEqual(whole, read_pfm(self.folder / "merged.pfm"))
        self.run_program("render", "--resume", "a.film", "--passes", "0:7", "-o", "resumed.pfm")
        self.assertEqual(whole, read_pfm(self.folder / "resumed.pfm"))

    def test_is_kept_by_a_saved_film(self):
        for name, way in (("shared.film", "shared"), ("own.film", "own")):
            first = "0:3" if way == "shared" else "4:7"
            self.run_program("render", SCENE, *SIZE, "--spp", "16", "--passes", first, "--filter-samples", way,
                             "--checkpoint", name, "-o", "x.pfm")
        result = self.run_program("merge", "shared.film", "own.film", "-o", "y.pfm", status=2)
        self.assertIn("filter_samples is \"shared\" and \"own\"", result.stderr)
        result = self.run_program("render", "--resume", "own.film", "--filter-samples", "shared", "-o", "y.pfm", status=2)
        self.assertIn("filter_samples is \"own\" and \"shared\"", result.stderr)

    def test_is_refused_where_it_cannot_be(self):
        for options, saying in ((["--denoise"], "noise is removed"), (["--layers", "halves"], "noise is removed"),
                                (["--layers", "bounces"], "layers of light"),
                                (["--integrator", "restir-pt"], "restir-pt traces all pixels together"),
                                (["--interactive-budget", "100ms"], "--interactive-budget")):
            result = self.render("--filter-samples", "shared", *options, "-o", "x.exr", status=2)
            self.assertEqual(result.stderr.count("error:"), 1, result.stderr)
            self.assertIn(saying, result.stderr)
            self.assertFalse((self.folder / "x.exr").exists())
        result = self.render("--filter-samples", "on", status=2)
        self.assertRegex(result.stderr, "shared.*own")


if __name__ == "__main__":
    unittest.main()
