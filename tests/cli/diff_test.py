"""montelux diff and tonemap: equal, equal except for noise, or different; each with its exit status."""
import json
import unittest

from program import SCENE, ProgramTest, write_pfm


class Diff(ProgramTest):
    def difference(self, *arguments, status):
        return json.loads(self.run_program("diff", *arguments, "--json", status=status).stdout)

    def test_two_plain_pictures_have_the_errors_that_arithmetic_gives(self):
        write_pfm(self.folder / "a.pfm", 8, 6, (0.5, 0.5, 0.5))
        write_pfm(self.folder / "b.pfm", 8, 6, (0.6, 0.6, 0.6))
        stated = self.difference("a.pfm", "b.pfm", status=1)
        self.assertAlmostEqual(stated["mse"], 0.01, places=7)
        self.assertAlmostEqual(stated["relative_mse"], 0.01 / (0.36 + 0.01), places=7)
        self.assertAlmostEqual(stated["psnr"], 20, places=4)
        self.assertAlmostEqual(stated["mean_difference"], -0.1, places=6)
        self.assertIsNone(stated["welch"])
        self.assertFalse(stated["equal"])

    def test_error_bars_of_other_files_decide(self):
        write_pfm(self.folder / "a.pfm", 8, 8, (0.5, 0.5, 0.5))
        write_pfm(self.folder / "b.pfm", 8, 8, (0.6, 0.6, 0.6))
        write_pfm(self.folder / "wide.pfm", 8, 8, (1, 1, 1))
        write_pfm(self.folder / "narrow.pfm", 8, 8, (0.01, 0.01, 0.01))
        bars = ["--stderr-a", "wide.pfm", "--stderr-b", "wide.pfm"]
        self.assertFalse(self.difference("a.pfm", "b.pfm", *bars, status=0)["differs"])
        narrow = [bar.replace("wide", "narrow") for bar in bars]
        stated = self.difference("a.pfm", "b.pfm", *narrow, status=1)
        # 0.1 over sqrt(2) 0.01 in a pixel, and 8 times that in the mean of 64.
        self.assertAlmostEqual(stated["welch"]["pixels"]["t"], -7.0711, places=3)
        self.assertAlmostEqual(stated["welch"]["image"]["t"], -56.569, places=2)
        # With one degree of freedom each, seven standard errors prove nothing in a pixel; the mean still tells.
        stated = self.difference("a.pfm", "b.pfm", *narrow, "--dof", "1", status=1)
        self.assertFalse(stated["welch"]["pixels"]["differs"])

    def test_trouble_is_status_2(self):
        write_pfm(self.folder / "a.pfm", 8, 6, (1, 1, 1))
        write_pfm(self.folder / "b.pfm", 6, 8, (1, 1, 1))
        self.assertIn("8 x 6 and 6 x 8", self.run_program("diff", "a.pfm", "b.pfm", status=2).stderr)
        self.assertIn("none.exr", self.run_program("diff", "a.pfm", "none.exr", status=2).stderr)
        (self.folder / "broken.exr").write_bytes(b"\x76\x2f\x31\x01 and nothing more")
        self.assertIn("broken.exr", self.run_program("diff", "a.pfm", "broken.exr", status=2).stderr)

    def test_noise_differs_from_a_difference(self):
        darkened = self.folder / "dark.pbrt"
        darkened.write_text(SCENE.read_text().replace("[ 17 15 12 ]", "[ 16 14 11 ]"))
        self.render("--spp", "32", "--seed", "1", "-o", "a.exr")
        self.render("--spp", "32", "--seed", "2", "-o", "b.exr")
        self.render("--spp", "32", "--seed", "3", "-o", "dark.exr", scene=darkened)
        self.assertTrue(self.difference("a.exr", "a.exr", status=0)["equal"])
        alike = self.difference("a.exr", "b.exr", status=0)
        self.assertFalse(alike["equal"] or alike["differs"])
        self.assertTrue(self.difference("a.exr", "dark.exr", status=1)["welch"]["image"]["differs"])
        self.assertIn("indistinguishable", self.run_program("diff", "a.exr", "b.exr").stdout)

    def test_maps_of_the_difference_are_written(self):
        write_pfm(self.folder / "a.pfm", 8, 6, (0.5, 0.5, 0.5))
        write_pfm(self.folder / "b.pfm", 8, 6, (0.6, 0.5, 0.5))
        for metric in "relative", "squared", "absolute", "flip":
            self.run_program("diff", "a.pfm", "b.pfm", "--metric", metric, "-o", f"{metric}.png", status=1)
            self.assertTrue((self.folder / f"{metric}.png").read_bytes().startswith(b"\x89PNG"))
        self.run_program("diff", "a.pfm", "b.pfm", "-o", "map.exr", status=1)
        self.assertIn("tif", self.run_program("diff", "a.pfm", "b.pfm", "-o", "map.tif", status=2).stderr)


class Tonemap(ProgramTest):
    def test_a_stop_of_exposure_doubles_the_light(self):
        write_pfm(self.folder / "a.pfm", 4, 4, (0.2, 0.1, 0.05))
        write_pfm(self.folder / "twice.pfm", 4, 4, (0.4, 0.2, 0.1))
        self.run_program("tonemap", "a.pfm", "-o", "a.png", "--exposure", "1")
        self.run_program("tonemap", "twice.pfm", "-o", "twice.png")
        self.run_program("diff", "a.png", "twice.png")

    def test_layers_are_shown_by_name(self):
        self.render("--spp", "2", "-o", "a.exr")
        for layer in "albedo", "stderr", "N", "Z":
            self.run_program("tonemap", "a.exr", "-o", f"{layer}.png", "--layer", layer)
        refused = self.run_program("tonemap", "a.exr", "-o", "x.png", "--layer", "albdo", status=2)
        self.assertIn('did you mean "albedo"', refused.stderr)
        self.run_program("tonemap", "a.exr", "-o", "x.exr", status=2)


if __name__ == "__main__":
    unittest.main()
