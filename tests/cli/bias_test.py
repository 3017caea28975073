"""The bias of options is measured by paired samples: held to a closed form, and stated in results and files."""
import json
import unittest

from program import ProgramTest

# A sphere that emits 1 and reflects a half of what it receives, seen from within: 1 + 1/2 + 1/4 + ... = 2.
FURNACE = """Film "rgb" "integer xresolution" 48 "integer yresolution" 32
Camera "perspective" "float fov" 60
WorldBegin
Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] "bool twosided" true
Shape "sphere" "float radius" 1
"""


class BiasTest(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "furnace.pbrt").write_text(FURNACE)

    def written(self, *options):
        return json.loads(self.run_program("render", "furnace.pbrt", "--spp", 64, "--quiet", "--json", "-o", "a.exr",
                                           "--integrator", *options).stdout)

    def test_light_beyond_the_depth_limit_is_that_of_the_series(self):
        for depth in 0, 2, 4:
            written = self.written(f"path:maxdepth={depth}", "--measure-bias")
            bias, beyond = written["measured_bias"], 0.5 ** depth
            for mean, error in zip(bias["mean"], bias["standard_error"]):
                self.assertLess(error, 0.05 * beyond)
                self.assertAlmostEqual(mean, -beyond, delta=4 * error + 1e-5)
            self.assertAlmostEqual(written["mean"][0] + beyond, 2, delta=0.01)

    def test_light_that_a_clamp_cuts(self):
        written = self.written("path:maxcomponent=1.5", "--measure-bias", "--set", "maxdepth=none")
        for mean, bias, error in zip(written["mean"], written["measured_bias"]["mean"], written["measured_bias"]["standard_error"]):
            self.assertLess(bias, -0.1)
            self.assertAlmostEqual(mean - bias, 2, delta=4 * error + 4 * written["standard_error"][0])

    def test_it_is_stated_and_has_the_same_bits_for_any_threads(self):
        options = ["path:maxdepth=1", "--measure-bias", "--threads"]
        self.assertEqual(self.written(*options, 1)["measured_bias"], self.written(*options, 3)["measured_bias"])
        said = self.run_program("info", "a.exr").stdout
        self.assertIn("maxdepth=1", said)
        self.assertIn("as measured", said)
        compared = self.written("path:maxdepth=1", "--measure-bias", "-o", "a.pfm")
        plain = self.written("path:maxdepth=1", "-o", "b.pfm")
        self.assertEqual((self.folder / "a.pfm").read_bytes(), (self.folder / "b.pfm").read_bytes())
        self.assertEqual(compared["mean"], plain["mean"])
        self.assertNotIn("measured_bias", plain)
        self.assertIn("not measured", self.run_program("info", "a.exr").stdout)

    def test_what_cannot_be_measured_says_why(self):
        def refused(*options):
            return self.run_program("render", "furnace.pbrt", "--spp", 4, "-o", "b.exr", "--measure-bias", *options,
                                    status=2).stderr
        self.assertIn("maxdepth", refused("--integrator", "restir-gi:maxdepth=3"))
        self.assertIn("saved", refused("--integrator", "path:maxdepth=3", "--checkpoint", "b.film"))
        self.assertFalse((self.folder / "b.exr").exists())
        said = self.run_program("render", "furnace.pbrt", "--spp", 4, "-o", "b.exr", "--measure-bias", "--integrator",
                                "path:maxdepth=none").stderr
        self.assertIn("no bias", said)


if __name__ == "__main__":
    unittest.main()
