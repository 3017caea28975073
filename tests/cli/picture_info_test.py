"""What info says of an image file."""
import json
import unittest

from program import ProgramTest


class PictureInfoTest(ProgramTest):
    def test_a_rendered_image_states_how_it_was_made(self):
        stated = json.loads(self.render("--spp", 16, "--seed", 7, "--integrator", "path:maxdepth=3", "--layers", "intervals",
                                      "-o", "a.exr", "--json", "--quiet").stdout)
        info = json.loads(self.run_program("info", "a.exr", "--json").stdout)
        self.assertTrue(info["rendered"])
        self.assertEqual((info["width"], info["height"]), (64, 48))
        names = {layer["name"]: layer["channels"] for layer in info["layers"]}
        self.assertEqual(sorted(names["low"]), ["B", "G", "R"])
        self.assertIn("samples", names[""])
        self.assertEqual(info["header"]["seed"], 7)
        self.assertEqual(info["interval_confidence"], 0.95)
        for key in ("mean", "standard_error", "relative_mse"):
            self.assertEqual(info[key], stated[key])
        for end in ("low", "high"):
            for mine, theirs in zip(info["interval_of_mean"][end], stated["interval_of_mean"][end]):
                self.assertAlmostEqual(mine, theirs, delta=1e-9)
        said = self.run_program("info", "a.exr").stdout
        for words in ("64 x 48 pixels", "16 per pixel (8 passes of 2)", "seed 7", "maxdepth=3", "by how much was not measured",
                      "95 %", "low (", "first-light"):
            self.assertIn(words, said)

    def test_an_image_with_more_samples_in_some_pixels_states_their_mean(self):
        stated = json.loads(self.render("--spp", 96, "--adaptive", "on", "-o", "a.exr", "--json", "--quiet").stdout)
        mean = stated["samples"] / (64 * 48)
        said = self.run_program("info", "a.exr").stdout
        self.assertRegex(said, r"samples   %.3g per pixel, from \d+ to \d+\n" % mean)

    def test_an_unbiased_image_says_so(self):
        self.render("--spp", 1, "--integrator", "path:maxdepth=none", "-o", "a.exr")
        said = self.run_program("info", "a.exr").stdout
        self.assertIn("unbiased", said)
        self.assertIn("unknown: it takes two independent passes", said)

    def test_other_images_have_size_and_layers(self):
        self.render("--spp", 1, "-o", "a.png", "-o", "a.pfm")
        for name in ("a.png", "a.pfm"):
            info = json.loads(self.run_program("info", name, "--json").stdout)
            self.assertFalse(info["rendered"])
            self.assertEqual((info["width"], info["height"]), (64, 48))
            self.assertIn("states neither samples nor error", self.run_program("info", name).stdout)

    def test_what_is_no_image_is_refused(self):
        self.assertIn("no such file", self.run_program("info", "none.exr", status=2).stderr.lower())
        (self.folder / "bad.exr").write_bytes(b"no image")
        self.assertIn("bad.exr", self.run_program("info", "bad.exr", status=2).stderr)


if __name__ == "__main__":
    unittest.main()
