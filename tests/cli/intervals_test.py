"""The intervals of pixels: which files have them, and what is said where they are unknown."""
import unittest

from program import ProgramTest


class IntervalsTest(ProgramTest):
    def test_pictures_have_them_on_request(self):
        self.render("--spp", 8, "--layers", "intervals", "-o", "a.exr", "--threads", 1)
        self.render("--spp", 8, "--layers", "intervals", "-o", "b.exr", "--threads", 3)
        self.assertEqual((self.folder / "a.exr").read_bytes(), (self.folder / "b.exr").read_bytes())
        for layer in ("low", "high"):
            self.run_program("tonemap", "a.exr", "--layer", layer, "-o", f"{layer}.png")
        self.assertIn(b"intervalConfidence", (self.folder / "a.exr").read_bytes())
        self.render("--spp", 8, "-o", "plain.exr")
        self.assertIn("low", self.run_program("tonemap", "plain.exr", "--layer", "low", "-o", "x.png", status=2).stderr)

    def test_parts_merge_to_the_same_picture(self):
        options = ["--spp", 16, "--layers", "intervals"]
        self.render(*options, "-o", "all.exr")
        for name, passes in (("a", "0:2"), ("b", "3:7")):
            self.render(*options, "--passes", passes, "--checkpoint", f"{name}.film", "-o", f"{name}.exr")
        self.run_program("merge", "b.film", "a.film", "-o", "merged.exr")
        self.run_program("tonemap", "all.exr", "--layer", "high", "-o", "x.png")
        self.run_program("tonemap", "merged.exr", "--layer", "high", "-o", "y.png")
        self.assertEqual((self.folder / "x.png").read_bytes(), (self.folder / "y.png").read_bytes())

    def test_one_pass_has_none_and_says_so(self):
        said = self.render("--spp", 1, "--layers", "intervals", "-o", "one.exr").stderr
        self.assertIn("two independent passes", said)
        self.assertNotIn(b"intervalConfidence", (self.folder / "one.exr").read_bytes())


if __name__ == "__main__":
    unittest.main()
