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
# A cube of the same, seen toward a corner: kernels of photons lose light at its edges.
CUBE = FURNACE[:FURNACE.index("Camera")] + """LookAt 0 0 0  1 0.9 0.8  0 1 0
""" + FURNACE[FURNACE.index("Camera"):FURNACE.index("Shape")] + """Shape "bilinearmesh" "integer indices" [ 0 1 2 3  4 5 6 7  0 1 4 5  2 3 6 7  0 2 4 6  1 3 5 7 ]
  "point3 P" [ -1 -1 -1   1 -1 -1   -1 1 -1   1 1 -1   -1 -1 1   1 -1 1   -1 1 1   1 1 1 ]
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

    def test_integrators_whose_pixels_share_samples_are_compared_with_path(self):
        (self.folder / "furnace.pbrt").write_text(CUBE)
        for way in ("sppm:radius=0.8,alpha=1,photons=8192", "photonmap:radius=0.8,photons=16384,gather-rays=0",
                    "vcm:radius=0.4,connect=off", "irradiance-cache:maxdepth=2", "restir-gi:maxdepth=2"):
            with self.subTest(way):
                written = self.written(way, "--measure-bias")
                bias = written["measured_bias"]
                for mean, stated, one, other in zip(written["mean"], bias["mean"], bias["standard_error"],
                                                    written["standard_error"]):
                    self.assertGreater(abs(mean - 2), 5 * one)  # there is a bias to find
                    self.assertLess(abs(mean - stated - 2), 4 * one + 4 * other)

    def test_it_is_stated_and_has_the_same_bits_for_any_threads(self):
        options = ["path:maxdepth=1", "--measure-bias", "--threads"]
        self.assertEqual(self.written(*options, 1)["measured_bias"], self.written(*options, 3)["measured_bias"])
        shared = ["sppm", *options[1:]]
        self.assertEqual(self.written(*shared, 1)["measured_bias"], self.written(*shared, 3)["measured_bias"])
        self.written(*options, 1)
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
        (self.folder / "furnace.pbrt").write_text(FURNACE + """LightSource "point" "point3 from" [ 0 0.5 0 ]
Material "dielectric"
Shape "sphere" "float radius" 0.2
""")
        self.assertIn("path, which has none, misses", refused("--integrator", "sppm"))
        self.assertIn("maxcomponent", refused("--integrator", "direct:pattern=uniform-grid"))
        self.assertIn("saved", refused("--integrator", "path:maxdepth=3", "--checkpoint", "b.film"))
        self.assertFalse((self.folder / "b.exr").exists())
        said = self.run_program("render", "furnace.pbrt", "--spp", 4, "-o", "b.exr", "--measure-bias", "--integrator",
                                "path:maxdepth=none").stderr
        self.assertIn("no bias", said)


if __name__ == "__main__":
    unittest.main()
