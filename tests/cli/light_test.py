"""Light that a picture lacks: named on stderr, in results, in the header and by info, and only where it is so."""
import json
import math
import re
import unittest

from program import ROOT, SCENE, ProgramTest, write_pfm

CLASSES = ROOT / "scenes" / "path-classes"
ROOM = """Film "rgb" "integer xresolution" [ 32 ] "integer yresolution" [ 24 ]
{head}
LookAt 0 2 -6   0 1 0   0 1 0
Camera "perspective" "float fov" [ 40 ]
WorldBegin
{world}
Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
Shape "bilinearmesh" "point3 P" [ -4 0 -4   4 0 -4   -4 0 4   4 0 4 ]
Translate 0 1 0
{ball}
Shape "sphere" "float radius" [ 1 ]
"""
POINT = 'LightSource "point" "point3 from" [ 0 4 0 ] "rgb I" [ 20 20 20 ]'
GLASS = 'Material "dielectric" "float eta" [ 1.5 ]'
MATT = 'Material "diffuse"'


def header(path):
    """The attributes of text of an .exr, by name."""
    data = path.read_bytes()
    found = re.findall(rb"(montelux:\w+)\0string\0(.{4})", data[:20000], re.DOTALL)
    texts = {}
    for name, size in found:
        start = data.index(name + b"\0string\0") + len(name) + 8 + 4
        texts[name.decode()] = data[start:start + int.from_bytes(size, "little")].decode()
    return texts


class Light(ProgramTest):
    def scene(self, name="room.pbrt", head="", world=POINT, ball=GLASS):
        path = self.folder / name
        path.write_text(ROOM.format(head=head, world=world, ball=ball))
        return path

    def rendered(self, scene, *options):
        result = self.run_program("render", scene, *([] if "--spp" in options else ["--spp", "2"]), "--json", "-o", "out.exr",
                                  *options)
        return json.loads(result.stdout), header(self.folder / "out.exr"), result.stderr

    def test_a_glass_ball_under_a_point_light_is_named_everywhere(self):
        scene = self.scene()
        for integrator in "path", "naive", "restir-di":
            stated, attributes, messages = self.rendered(scene, "--integrator", integrator)
            self.assertEqual(stated["missing_light"], ["light of point lights through smooth surfaces (dielectric)"])
            self.assertEqual(attributes["montelux:missingLight"], stated["missing_light"][0])
            lines = [line for line in messages.splitlines() if "may be missing" in line]
            self.assertEqual(len(lines), 1, messages)
        text = self.run_program("render", scene, "--spp", "2", "--quiet", "-o", "out.exr").stdout
        self.assertIn("missing  light of point lights", text)
        self.assertIn("light of point lights", self.run_program("info", scene).stdout)
        self.assertEqual(len(json.loads(self.run_program("info", scene, "--json").stdout)["missing_light"]), 1)

    def test_light_that_is_met_by_chance(self):
        """What one sample of the brightest such lamp adds, times three: the rule of three, in every place that states it."""
        missing = -math.log(0.05)  # samples
        for scene, radiance, integrators in (("lde", 0, ("path", "bdpt", "sppm")), ("lsde", 5, ("path", "restir-pt", "metropolis")),
                                             ("lsde", 0, ("bdpt", "vcm")), ("lsdse", None, ("path", "bdpt")),
                                             ("lsdse", 0, ("vcm",))):
            for integrator in integrators:
                with self.subTest(scene=scene, integrator=integrator):
                    stated, _, _ = self.rendered(CLASSES / f"{scene}.pbrt", "--integrator", integrator, "--spp", "16")
                    if radiance is None:
                        self.assertGreater(stated["missing_by_chance"], 0)
                        continue
                    expected = missing * radiance / stated["samples"] * 3 / sum(stated["mean"]) if radiance > 0 else 0
                    self.assertAlmostEqual(stated["missing_by_chance"], expected, delta=1e-4 * expected)
        stated, _, _ = self.rendered(CLASSES / "lde.pbrt", "--integrator", "naive", "--spp", "16")
        self.assertGreater(stated["missing_by_chance"], 0)  # it finds all lamps by chance

        # A lamp so bright and small that few samples meet it.
        lamp = ('AttributeBegin\nAreaLightSource "diffuse" "rgb L" [ 9e4 3e4 1e4 ]\nTranslate 0 4 0\n'
                'Shape "sphere" "float radius" [ 0.01 ]\nAttributeEnd')
        scene = self.scene(world=lamp)
        result = self.run_program("render", scene, "--spp", "16", "--quiet", "--integrator", "path", "-o", "out.exr", "--checkpoint",
                                  "out.film")
        self.assertIn("may be missing: light that paths meet by chance", result.stdout)
        self.assertIn("may be missing: light that paths meet by chance", self.run_program("info", "out.exr").stdout)
        again = self.run_program("merge", "out.film", "-o", "again.exr", "--json")
        rendered, _, _ = self.rendered(scene, "--spp", "16", "--integrator", "path", "--target-error", "mean:50%")
        self.assertFalse(rendered["target"]["reached"])
        rendered, _, _ = self.rendered(scene, "--spp", "16", "--integrator", "path")
        for facts in json.loads(again.stdout), json.loads(self.run_program("info", "out.exr", "--json").stdout):
            self.assertEqual(facts["interval_of_mean"]["low"], rendered["interval_of_mean"]["low"])
            for high, expected, mean in zip(facts["interval_of_mean"]["high"], rendered["interval_of_mean"]["high"],
                                            rendered["mean"]):
                self.assertAlmostEqual(high, expected, delta=1e-5 * expected)
                self.assertGreater(high, 2 * mean)
        # A channel without light has no room, and leaves that of the others.
        red = self.scene(name="red.pbrt", world=lamp.replace("3e4 1e4", "0 0"))
        stated, _, _ = self.rendered(red, "--spp", "16", "--integrator", "path")
        facts = json.loads(self.run_program("info", "out.exr", "--json").stdout)
        for channel, high in enumerate(facts["interval_of_mean"]["high"]):
            self.assertAlmostEqual(high, stated["interval_of_mean"]["high"][channel], delta=1e-5 * high)
        self.assertGreater(facts["interval_of_mean"]["high"][0], 2 * stated["mean"][0])
        self.assertLess(facts["interval_of_mean"]["high"][1], 1e-9)
        clamped, _, _ = self.rendered(scene, "--spp", "16", "--integrator", "path:maxcomponent=2")
        self.assertAlmostEqual(clamped["missing_by_chance"],
                               missing * 2 / clamped["samples"] * 3 / sum(clamped["mean"]), delta=1e-4)

    def test_kinds_of_lights_and_of_surfaces(self):
        lights = {
            "spot": 'LightSource "spot" "point3 from" [ 0 4 0 ] "point3 to" [ 0 1 0 ]',
            "distant": 'LightSource "distant" "point3 from" [ 0 4 0 ] "point3 to" [ 0 0 0 ]',
            "goniometric": 'AttributeBegin\nTranslate 0 4 0\nLightSource "goniometric"\nAttributeEnd',
            # Slides are thrown along +z: here down.
            "projection": 'AttributeBegin\nTranslate 0 4 0\nRotate 90 1 0 0\n'
                          'LightSource "projection" "string filename" "slide.pfm"\nAttributeEnd',
        }
        write_pfm(self.folder / "slide.pfm", 4, 4, (1, 1, 1))
        for kind, light in lights.items():
            with self.subTest(light=kind):
                stated, _, _ = self.rendered(self.scene(world=light))
                self.assertEqual(stated["missing_light"], [f"light of {kind} lights through smooth surfaces (dielectric)"])
        surfaces = {
            "thindielectric": 'Material "thindielectric"',
            "tinteddielectric": 'Material "tinteddielectric" "rgb tint" [ 0.9 0.5 0.1 ] "rgb absorption" [ 0.1 0.5 1 ]',
            "conductor": 'Material "conductor" "float roughness" [ 0 ]',
            "coateddiffuse": 'Material "coateddiffuse" "float roughness" [ 0 ]',
            "dielectric": 'MakeNamedMaterial "a" "string type" "diffuse"\nMakeNamedMaterial "b" "string type" "dielectric"\n'
                          'Material "mix" "string materials" [ "a" "b" ] "float amount" [ 0.5 ]',
        }
        for kind, ball in surfaces.items():
            with self.subTest(surface=kind):
                stated, _, _ = self.rendered(self.scene(ball=ball))
                self.assertEqual(stated["missing_light"], [f"light of point lights through smooth surfaces ({kind})"])

    def test_no_alarm_where_everything_is_found(self):
        area = ('AttributeBegin\nTranslate 0 4 0\nAreaLightSource "diffuse"\nShape "sphere" "float radius" [ 0.1 ]\n'
                "AttributeEnd")
        inside = 'LightSource "spot" "point3 from" [ 0 4 0 ] "point3 to" [ 0 9 0 ]'
        for name, scene in {
                "area light": dict(world=area), "sky": dict(world='LightSource "infinite"'), "matt": dict(ball=MATT),
                "rough": dict(ball='Material "dielectric" "float roughness" [ 0.3 ]'),
                "rough metal": dict(ball='Material "conductor" "float roughness" [ 0.1 ]'),
                "looks away": dict(world=inside)
        }.items():
            with self.subTest(name):
                stated, attributes, messages = self.rendered(self.scene(**scene))
                self.assertEqual(stated["missing_light"], [])
                self.assertEqual(attributes["montelux:missingLight"], "none")
                self.assertNotIn("missing", messages)
        # A picture that does not show light lacks none.
        self.assertEqual(self.rendered(self.scene(), "--integrator", "normal")[0]["missing_light"], [])

    def test_first_light_lacks_nothing_and_replaces_nothing(self):
        stated, attributes, _ = self.rendered(SCENE, "--resolution", "32x24", "--integrator", "path")
        for key, name in ("missing_light", "missingLight"), ("left_out", "leftOut"):
            self.assertEqual(stated[key], [])
            self.assertEqual(attributes["montelux:" + name], "none")

    def test_directions_without_the_bsdf_lack_reflections_in_smooth_coats(self):
        lamp = ('AttributeBegin\nTranslate 0 4 0\nAreaLightSource "diffuse"\nMaterial "diffuse" "rgb reflectance" [ 0 0 0 ]\n'
                'Shape "bilinearmesh" "point3 P" [ -1 0 -1   -1 0 1   1 0 -1   1 0 1 ]\nAttributeEnd')
        scene = self.scene(world=lamp, ball='Material "coateddiffuse" "float roughness" [ 0 ]')
        for way in "direct:strategy=light-area", "direct:strategy=cosine", "tracepath":
            self.assertIn("reflections in smooth coats", self.rendered(scene, "--integrator", way)[0]["missing_light"])
        for way in "path", "direct:strategy=mis", "direct:strategy=bsdf":
            self.assertNotIn("reflections in smooth coats",
                             self.rendered(scene, "--integrator", way)[0]["missing_light"])

    def test_stand_ins_are_named(self):
        for requested, by in ("mlt", "metropolis"), ("lightpath", "light"), ("randomwalk", "path"):
            scene = self.scene(head=f'Integrator "{requested}"\nSampler "zsobol"', ball=MATT)
            stated, attributes, _ = self.rendered(scene)
            self.assertIn({"family": "integrator", "name": requested, "by": by}, stated["replaced"])
            self.assertEqual(attributes["montelux:replaced"],
                             f"integrator {requested} by {by}; sampler zsobol by blue-noise")
            # What the user chooses stands in for nothing.
            stated, attributes, _ = self.rendered(scene, "--integrator", "path", "--sampler", "sobol")
            self.assertEqual(stated["replaced"], [])
            self.assertEqual(attributes["montelux:replaced"], "none")
        stated, attributes, _ = self.rendered(self.scene(ball=MATT))
        self.assertEqual(attributes["montelux:replaced"], "none")
        self.assertIn("integrator lightpath by light",
                      self.run_program("info", self.scene(head='Integrator "lightpath"')).stdout)

    def test_bidirectional_path_tracing_is_what_a_file_states_in_media_too(self):
        scene = self.scene(head='Integrator "bdpt" "integer maxdepth" 4', ball=MATT)
        stated, attributes, _ = self.rendered(scene)
        self.assertEqual((stated["replaced"], attributes["montelux:replaced"]), ([], "none"))
        fog = self.scene(head='Integrator "bdpt"\nMakeNamedMedium "fog" "string type" "homogeneous"\n'
                              'MediumInterface "" "fog"', ball=MATT)
        stated, attributes, _ = self.rendered(fog)
        self.assertEqual((stated["replaced"], attributes["montelux:replaced"]), ([], "none"))
        self.assertTrue(attributes["montelux:integrator"].startswith("bdpt"), attributes["montelux:integrator"])

    def test_photons_stand_in_for_nothing_and_find_light_through_glass(self):
        scene = self.scene(head='Integrator "sppm" "integer photonsperiteration" 3000 "float radius" 0.25',
                           world=POINT, ball=GLASS)
        stated, attributes, messages = self.rendered(scene)
        self.assertEqual((stated["replaced"], stated["missing_light"]), ([], []))
        self.assertEqual(attributes["montelux:missingLight"], "none")
        self.assertEqual(attributes["montelux:biasedOptions"], "radius=0.25")
        self.assertIn("photons are gathered within 0.25", messages)
        # Neither does the description of the scene name any.
        self.assertNotIn("missing", self.run_program("info", scene).stdout)
        self.assertIn("missing", self.run_program("info", self.scene(world=POINT, ball=GLASS)).stdout)

    def test_what_a_lenient_reading_leaves_out_is_named(self):
        smoke = POINT + '\nMakeNamedMedium "smoke" "string type" "uniformgrid"'
        ball = MATT + '\nMediumInterface "smoke" ""\nShape "sphere" "float radius" [ 0.5 ] "float nonsense" [ 1 ]'
        scene = self.scene(world=smoke, ball=ball)
        self.run_program("render", scene, "--spp", "1", status=2)
        stated, attributes, messages = self.rendered(scene, "--lenient")
        self.assertTrue(any("uniformgrid" in line for line in stated["left_out"]), stated)
        self.assertTrue(any("nonsense" in line and "room.pbrt:" in line for line in stated["left_out"]), stated)
        self.assertEqual(attributes["montelux:leftOut"], "; ".join(stated["left_out"]))
        text = self.run_program("render", scene, "--spp", "1", "--lenient", "--quiet").stdout
        self.assertIn("left out", text)
        self.assertIn("left out", self.run_program("info", scene, "--lenient").stdout)

    def test_equal_omissions_are_counted(self):
        shapes = "\n".join(['Shape "sphere" "float radius" [ 0.5 ] "float nonsense" [ 1 ]'] * 70)
        stated, _, _ = self.rendered(self.scene(ball=MATT + "\n" + shapes), "--lenient")
        self.assertEqual(len(stated["left_out"]), 1, stated["left_out"])
        self.assertIn("70 times, first at room.pbrt:11:", stated["left_out"][0])

    def test_a_scene_without_light_warns(self):
        scene = self.scene(world="", ball=MATT)
        stated, _, messages = self.rendered(scene)
        self.assertIn("the scene has no light: the image is black", messages)
        self.assertEqual(stated["mean"], [0, 0, 0])
        for integrator in "ao", "normal", "albedo", "depth":
            self.assertNotIn("no light", self.rendered(scene, "--integrator", integrator)[2])

    ERRORS = ("mse", "relative_mse", "relative_mse_range", "interval_of_mean", "tail_index")

    def header_names(self):
        return set(re.findall(rb"montelux:\w+", (self.folder / "out.exr").read_bytes()[:20000]))

    def test_where_no_sample_found_light_no_error_is_known(self):
        # A scene without light, and one whose lamp is behind a wall.
        hidden = self.scene("hidden.pbrt", world='LightSource "point" "point3 from" [ 0 -4 0 ]', ball=MATT)
        for scene in self.scene(world="", ball=MATT), hidden:
            for options in [], ["--integrator", "restir-di"]:
                stated, attributes, _ = self.rendered(scene, "--spp", "8", *options)
                self.assertEqual(stated["mean"], [0, 0, 0])
                self.assertGreaterEqual(stated["passes"], 2)
                self.assertEqual([stated[key] for key in self.ERRORS], [None] * len(self.ERRORS))
                self.assertEqual(stated["standard_error"], [None] * 3)
                self.assertFalse(stated["error_bar"])
                self.assertEqual(attributes["montelux:errorBar"], "none: no sample found light")
                self.assertFalse([name for name in self.header_names() if b"estimated" in name or b"StandardError" in name])
            text = self.run_program("render", scene, "--spp", "8", "-o", "out.exr").stdout
            self.assertIn("error    unknown: no sample found light\n", text)
            self.assertNotIn("±", text)
            self.assertNotIn("95 %", text)

    def test_an_error_of_zero_is_known_where_there_is_light_or_no_light_is_requested(self):
        # Nothing but the sky, of one radiance: no noise at all.
        sky = self.folder / "sky.pbrt"
        sky.write_text('Film "rgb" "integer xresolution" 8 "integer yresolution" 8\nPixelFilter "box"\nWorldBegin LightSource "infinite"\n')
        dark = self.folder / "dark.pbrt"
        dark.write_text('Film "rgb" "integer xresolution" 8 "integer yresolution" 8\nWorldBegin\n')
        for scene, integrator in ((sky, "path"), (dark, "depth"), (dark, "normal"), (dark, "albedo"), (dark, "ao")):
            with self.subTest(integrator):
                stated, attributes, _ = self.rendered(scene, "--spp", "8", "--integrator", integrator)
                self.assertEqual((stated["mse"], stated["relative_mse"], stated["standard_error"]), (0, 0, [0, 0, 0]))
                self.assertIsNotNone(stated["interval_of_mean"])
                self.assertEqual(attributes["montelux:errorBar"], f"over {stated['passes']} independent passes")
                self.assertIn(b"montelux:estimatedRelativeMSE", self.header_names())
                self.assertIn(b"montelux:meanStandardErrorR", self.header_names())
        # A single lit pixel is light.
        lamp = self.scene(world='AttributeBegin\nTranslate 0 1 -5\nAreaLightSource "diffuse"\nScale 0.02 0.02 0.02\n'
                          'Shape "sphere"\nAttributeEnd', ball=MATT)
        self.assertIsNotNone(self.rendered(lamp, "--spp", "8")[0]["relative_mse"])


if __name__ == "__main__":
    unittest.main()
