"""montelux trace: one sample of a pixel, traced again."""
import array
import json
import math
import unittest

from program import SCENE, ProgramTest

FOG = """Film "rgb" "integer xresolution" 4 "integer yresolution" 4
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ .1 .2 .3 ] "rgb sigma_s" [ 1 2 3 ]
MediumInterface "" "fog"
LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" 30
WorldBegin
LightSource "point" "rgb I" [ 1 2 3 ] "point3 from" [ 1 0 0 ]
"""

# The camera looks at a mirror, in which it sees a matt wall behind itself.
MIRROR = """Film "rgb" "integer xresolution" 4 "integer yresolution" 4
LookAt 0 0 2  0 0 0  0 1 0
Camera "perspective" "float fov" 30
WorldBegin
LightSource "point" "rgb I" [ 1 2 3 ] "point3 from" [ 0 3 1 ]
Material "conductor" "float roughness" 0
Shape "bilinearmesh" "point3 P" [ -9 -9 0  9 -9 0  -9 9 0  9 9 0 ]
Material "diffuse"
Shape "bilinearmesh" "point3 P" [ -9 -9 5  9 -9 5  -9 9 5  9 9 5 ]
"""


class Trace(ProgramTest):
    def fog(self):
        path = self.folder / "fog.pbrt"
        path.write_text(FOG)
        return path

    def traced(self, scene, *options):
        return json.loads(self.run_program("trace", scene, *options, "--json").stdout)

    def pixel(self, scene, x, y, width, height, *options):
        """A pixel as render has it by its own samples, from a .pfm, whose rows begin at the bottom."""
        self.run_program("render", scene, "-o", "out.pfm", "--resolution", f"{width}x{height}", "--filter-samples", "own", *options)
        data = (self.folder / "out.pfm").read_bytes()
        values = array.array("f", data[-12 * width * height:])
        return values[3 * ((height - 1 - y) * width + x):][:3]

    def test_the_samples_of_a_pixel_are_those_of_the_render(self):
        for scene, options in ((SCENE, ["--spp", "32"]), (self.fog(), ["--spp", "16", "--sampler", "independent"])):
            shown = self.pixel(scene, 3, 2, 4, 4, *options, "--seed", "5")
            options += ["--filter-samples", "own"]
            found = self.traced(scene, "--resolution", "4x4", "--pixel", "3,2", *options, "--seed", "5")
            for a, b in zip(shown, found["pixel_mean"]):
                self.assertAlmostEqual(a, b, delta=2e-6 * abs(b))
            other = self.traced(scene, "--resolution", "4x4", "--pixel", "3,2", *options, "--seed", "6")
            self.assertNotAlmostEqual(shown[0], other["pixel_mean"][0], delta=1e-4 * shown[0])

    def test_samples_that_count_for_several_pixels_are_those_of_the_render(self):
        self.run_program("render", SCENE, "--resolution", "4x4", "--spp", "8", "--checkpoint", "a.film", "-o", "a.pfm")
        by_film = self.traced("--film", "a.film", "--pixel", "3,2")
        by_scene = self.traced(SCENE, "--resolution", "4x4", "--pixel", "3,2", "--spp", "8")
        own = self.traced(SCENE, "--resolution", "4x4", "--pixel", "3,2", "--spp", "8", "--filter-samples", "own")
        self.assertEqual(by_film, by_scene)
        self.assertNotEqual(by_film["pixel_mean"], own["pixel_mean"])

    def test_the_passes_may_be_those_of_any_render_or_of_a_film(self):
        small = ["--resolution", "4x4", "--seed", "5", "--filter-samples", "own"]
        for plan in (["--spp", "16", "--samples-per-pass", "4"], ["--spp", "32", "--passes", "2:5"],
                     ["--time", "20ms"], ["--target-error", "30%", "--spp", "4096"],
                     ["--spp", "256", "--adaptive", "on"]):
            with self.subTest(plan=plan):
                film = ["--checkpoint", "a.film"]
                for x, y in (3, 2), (0, 0):
                    shown = self.pixel(SCENE, x, y, 4, 4, *plan, *film, "--seed", "5")
                    traces = [self.traced("--film", "a.film", "--pixel", f"{x},{y}")]
                    if plan[0] == "--spp" and "--adaptive" not in plan:
                        traces.append(self.traced(SCENE, *small, "--pixel", f"{x},{y}", *plan))
                        self.assertEqual(traces[0], traces[1])
                    for a, b in zip(shown, traces[0]["pixel_mean"]):
                        self.assertAlmostEqual(a, b, delta=2e-6 * abs(b))
        for wrong, saying in ((["--film", "a.film", "--spp", "4"], "excludes"), ([], "SCENE is required, or --film"),
                              (["--film", SCENE], "cannot be read"), (["--film", "none.film"], "none.film")):
            self.assertIn(saying, self.run_program("trace", *wrong, "--pixel", "1,1", status=2).stderr)
        other = self.folder / "other.pbrt"
        other.write_bytes(SCENE.read_bytes() + b"\nLightSource \"infinite\"\n")
        self.assertIn("is not the scene", self.run_program("trace", other, "--film", "a.film", "--pixel", "1,1",
                                                           status=2).stderr)

    def test_a_sample_is_the_sum_of_its_contributions(self):
        for scene in SCENE, self.fog():
            for k in 0, 3, 7:
                t = self.traced(scene, "--resolution", "4x4", "--pixel", "1,2", "--spp", "8", "--sample", str(k))
                self.assertEqual(t["sample"], k)
                for c in range(3):
                    total = sum(contribution["light"][c] for contribution in t["contributions"])
                    self.assertAlmostEqual(total, t["radiance"][c], delta=1e-5 * abs(total) + 1e-12)
                self.assertTrue(all(c["vertex"] <= len(t["vertices"]) for c in t["contributions"]))
                for before, after in zip(t["vertices"], t["vertices"][1:]):
                    self.assertTrue(before["continues"])
                    way = [after["position"][i] - before["position"][i] for i in range(3)]
                    self.assertAlmostEqual(sum(w * w for w in way) ** 0.5, after["distance"], delta=1e-3)

    def test_the_brightest_is_found(self):
        common = SCENE, "--resolution", "8x6", "--pixel", "4,3", "--spp", "16"
        brightness = lambda t: sum(w * c for w, c in zip((0.212639, 0.715169, 0.072192), t["radiance"]))
        all_samples = [brightness(self.traced(*common, "--sample", str(k))) for k in range(16)]
        self.assertEqual(self.traced(*common)["sample"], all_samples.index(max(all_samples)))

    def test_vertices_are_of_media_and_surfaces(self):
        kinds = {v["kind"] for v in self.traced(self.fog(), "--pixel", "1,1", "--spp", "4")["vertices"]}
        self.assertEqual(kinds, {"medium"})
        surfaces = self.traced(SCENE, "--resolution", "8x6", "--pixel", "4,3", "--spp", "4")["vertices"]
        self.assertEqual({v["kind"] for v in surfaces}, {"surface"})
        self.assertTrue(all(v["model"] for v in surfaces))
        text = self.run_program("trace", SCENE, "--resolution", "8x6", "--pixel", "4,3", "--spp", "4").stdout
        for word in "radiance", "camera", "throughput", "ends here":
            self.assertIn(word, text)

    def test_a_direction_has_a_density_except_that_of_a_mirror(self):
        scene = self.folder / "mirror.pbrt"
        scene.write_text(MIRROR)
        command = scene, "--pixel", "1,2", "--spp", "4", "--integrator", "path:roulette=off,maxdepth=3"
        mirror, wall = self.traced(*command)["vertices"][:2]
        self.assertEqual((mirror["model"], mirror["density"]), ("conductor", None))
        self.assertEqual(wall["model"], "diffuse")
        cosine = abs(sum(n * w for n, w in zip(wall["normal"], wall["direction"])))
        self.assertAlmostEqual(wall["density"], cosine / math.pi, delta=1e-4)
        text = self.run_program("trace", *command).stdout
        self.assertEqual(text.count("straight or mirrored"), text.count("conductor"))

    def test_mistakes_are_named(self):
        for options, words in ((["--pixel", "900,0"], "outside"), (["--pixel", "1"], "two whole numbers"),
                               (["--pixel", "1,1", "--sample", "9", "--spp", "8"], "samples 0 to 7"),
                               (["--pixel", "1,1", "--sample", "x"], "brightest"),
                               (["--pixel", "1,1", "--integrator", "direct"], "no paths to show"), ([], "--pixel")):
            self.assertIn(words, self.run_program("trace", SCENE, *options, status=2).stderr)


if __name__ == "__main__":
    unittest.main()
