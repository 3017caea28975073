"""What 8-bit pictures show: layers that are no light, and light that is far too bright or too dark."""
import json
import struct
import unittest
import zlib

from program import ProgramTest

ROOM = """Film "rgb" "integer xresolution" [ 40 ] "integer yresolution" [ 30 ] {iso}
LookAt 0 2 -6   0 1 0   0 1 0
Camera "perspective" "float fov" [ 60 ]
WorldBegin
LightSource "point" "point3 from" [ 0 4 -2 ] "rgb I" [ {power} {power} {power} ] "string group" "key"
MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [ 0.8 0.2 0.2 ]
Texture "checks" "spectrum" "checkerboard"
Material "diffuse" "texture reflectance" "checks"
Shape "bilinearmesh" "point3 P" [ -4 0 -4   4 0 -4   -4 0 4   4 0 4 ]
Translate 0 1 0
NamedMaterial "red"
Shape "sphere" "float radius" [ 1 ]
"""


def read_png(path):
    """(width, height, rows of (r, g, b) or (y,)) of an 8-bit picture."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, _, color = struct.unpack(">IIBB", body[:10])
        if kind == b"IDAT":
            packed += body
        at += 12 + size
    n = {0: 1, 2: 3, 6: 4}[color]
    raw, rows, above = zlib.decompress(packed), [], bytes(width * n)
    for y in range(height):
        start = y * (width * n + 1)
        kind, line = raw[start], bytearray(raw[start + 1:start + 1 + width * n])
        for i in range(width * n):
            left, up, corner = (line[i - n] if i >= n else 0), above[i], (above[i - n] if i >= n else 0)
            guess = left + up - corner
            paeth = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))[2]
            line[i] = line[i] + [0, left, up, (left + up) // 2, paeth][kind] & 255
        rows.append([tuple(line[x:x + n]) for x in range(0, width * n, n)])
        above = bytes(line)
    return width, height, rows


class Display(ProgramTest):
    def scene(self, power=10, iso="", name="room.pbrt"):
        path = self.folder / name
        path.write_text(ROOM.format(power=power, iso=iso))
        return path

    def colors(self, name):
        return [pixel for row in read_png(self.folder / name)[2] for pixel in row]

    def test_layers_that_are_no_light_are_pictures_by_themselves(self):
        self.run_program("render", self.scene(), "--spp", "4", "-o", "out.exr")
        for layer in "Z", "id", "N", "P", "stderr", "albedo":
            result = self.run_program("tonemap", "out.exr", "-o", layer + ".png", "--layer", layer)
            colors = set(self.colors(layer + ".png"))
            self.assertGreater(len(colors), 2, layer)
            self.assertNotEqual(colors, {(255, 255, 255)}, layer)
            self.assertEqual("range" in result.stderr, layer in ("Z", "P", "stderr"), result.stderr)
        # Every pixel has as many samples; nothing is where the background is.
        self.run_program("tonemap", "out.exr", "-o", "samples.png", "--layer", "samples")
        self.assertEqual(set(self.colors("samples.png")), {(253, 231, 37)})
        self.assertIn((0, 0, 0), self.colors("Z.png"))
        self.assertEqual(self.run_program("tonemap", "out.exr", "-o", "Z.png", "--layer", "Z", "--quiet").stderr, "")

    def test_a_picture_of_distances_is_the_same_at_once_and_by_tonemap(self):
        for integrator in "depth", "normal", "albedo", "ao":
            scene = self.scene()
            self.run_program("render", scene, "--integrator", integrator, "--spp", "4", "-o", "out.exr", "-o", "direct.png")
            self.run_program("tonemap", "out.exr", "-o", "later.png")
            self.assertEqual(self.colors("direct.png"), self.colors("later.png"), integrator)
            self.assertGreater(len(set(self.colors("direct.png"))), 10, integrator)

    def test_light_that_is_far_too_bright_is_exposed_automatically_and_reported(self):
        bright = self.run_program("render", self.scene(power=54351), "--spp", "4", "-o", "out.exr", "-o", "out.png", "--json")
        written = json.loads(bright.stdout)["display"]
        self.assertTrue(written["automatic"])
        self.assertLess(written["exposure"], -8)
        self.assertIn(f"exposure {written['exposure']:.1f} EV, chosen automatically", bright.stderr)
        lit = [max(color) for color in self.colors("out.png") if max(color) > 0]
        self.assertGreater(sum(20 < value < 250 for value in lit), 0.8 * len(lit))
        # The same bits by that number, by tonemap, and in another run.
        self.run_program("tonemap", "out.exr", "-o", "later.png")
        self.run_program("tonemap", "out.exr", "-o", "stated.png", "--exposure", f"{written['exposure']:.1f}")
        self.assertEqual(self.colors("out.png"), self.colors("later.png"))
        self.assertEqual(self.colors("out.png"), self.colors("stated.png"))
        # An exposure that is stated, by the user or by the scene, stays.
        white = self.run_program("tonemap", "out.exr", "-o", "white.png", "--exposure", "0")
        self.assertNotIn("automatic", white.stderr)
        self.assertGreater(self.colors("white.png").count((255, 255, 255)), 0.4 * 40 * 30)
        own = self.scene(power=54351, iso='"float iso" [ 100 ]')
        result = self.run_program("render", own, "--spp", "4", "-o", "own.exr", "-o", "own.png", "--json")
        self.assertEqual(json.loads(result.stdout)["display"]["exposure"], 0)
        self.assertNotIn("automatic", self.run_program("tonemap", "own.exr", "-o", "own.png").stderr)

    def test_light_within_the_range_is_left_alone(self):
        result = self.run_program("render", self.scene(), "--spp", "4", "-o", "out.png", "--json")
        self.assertEqual(json.loads(result.stdout)["display"],
                         {"content": "light", "exposure": 0, "range": None, "colormap": None, "automatic": False})
        self.assertNotIn("automatic", result.stderr)
        result = self.run_program("render", self.scene(), "--spp", "4", "-o", "out.png", "--json", "--exposure", "auto")
        self.assertTrue(json.loads(result.stdout)["display"]["automatic"])

    def test_ranges_and_maps_are_options_of_tonemap(self):
        self.run_program("render", self.scene(), "--spp", "4", "-o", "out.exr")
        written = json.loads(self.run_program("tonemap", "out.exr", "-o", "a.png", "--layer", "Z", "--range", "1:20",
                                           "--colormap", "magma", "--json").stdout)
        self.assertEqual(written["display"], {"content": "distance", "exposure": None, "range": [1, 20],
                                           "colormap": "magma", "automatic": False})
        # Stated, auto is what data have by default; light is then shown by its range, and not by an exposure.
        for layer in "Z", "stderr", "P":
            shown = {}
            for options in (), ("--range", "auto"):
                result = self.run_program("tonemap", "out.exr", "-o", "auto.png", "--layer", layer, *options, "--json")
                shown[options] = (json.loads(result.stdout)["display"], self.colors("auto.png"), result.stderr)
            self.assertEqual(shown[()], shown["--range", "auto"], layer)
            self.assertTrue(shown[()][0]["automatic"])
        display = json.loads(self.run_program("tonemap", "out.exr", "-o", "auto.png", "--range", "auto", "--json").stdout)["display"]
        self.assertEqual((display["content"], display["exposure"], display["automatic"]), ("light", None, True))
        values = [max(color) for color in self.colors("auto.png")]
        self.assertEqual((min(values), max(values)), (0, 255))
        self.run_program("tonemap", "out.exr", "-o", "stated.png", "--range", "{}:{}".format(*display["range"]))
        self.assertEqual(self.colors("stated.png"), self.colors("auto.png"))
        for wrong, reason in (("--range", "5:1"), "LOW:HIGH"), (("--colormap", "viridi"), "viridis"), (
                ("--exposure", "bright"), "takes auto"):
            result = self.run_program("tonemap", "out.exr", "-o", "a.png", *wrong, status=2)
            self.assertIn(reason, result.stderr)

    def test_numbers_in_any_notation_percentages_and_single_frames(self):
        written = json.loads(self.run_program("render", self.scene(), "--spp", "1e1", "--json", "-o", "a.png").stdout)
        self.assertEqual(written["passes"] * written["samples_per_pass"], 10)
        for wrong in "1.5", "1e-1", "0", "1e9", "ten", "-1":
            self.run_program("render", self.scene(), f"--spp={wrong}", status=2)
        for percent, size in ("50%", (20, 15)), ("12.5%", (5, 4)), ("0.001%", (1, 1)):
            self.run_program("render", self.scene(), "--spp", "1", "--resolution", percent, "-o", "a.png")
            self.assertEqual(read_png(self.folder / "a.png")[:2], size)
        for wrong in "0%", "-5%", "%", "1e9%", "50":
            self.run_program("render", self.scene(), f"--resolution={wrong}", status=2)
        self.run_program("render", self.scene(), "--spp", "1", "--frames", "5", "-o", "f.####.png")
        self.assertEqual([p.name for p in self.folder.glob("f.*")], ["f.0005.png"])

    def test_info_names_materials_and_textures(self):
        scene = self.scene()
        self.assertIn("red (diffuse)", self.run_program("info", scene).stdout)
        written = json.loads(self.run_program("info", scene, "--json").stdout)
        self.assertIn({"name": "red", "kind": "diffuse"}, written["material_list"])
        self.assertEqual(written["texture_list"], [{"name": "checks", "kind": "checkerboard"}])
        self.assertEqual(written["cameras"], [])

    def test_info_names_cameras_and_animations_of_gltf(self):
        document = {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
            "nodes": [{"camera": 0}, {"camera": 1}],
            "cameras": [{"name": name, "type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}
                        for name in ("front", "side")],
            "buffers": [{"byteLength": 32, "uri": "data:application/octet-stream;base64," +
                         __import__("base64").b64encode(struct.pack("<8f", 0, 2.5, 0, 0, 0, 1, 0, 0)).decode()}],
            "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 24}],
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [2.5]},
                {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC3"}],
            "animations": [{"name": "slide", "samplers": [{"input": 0, "output": 1}],
                            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}]}
        scene = self.folder / "a.gltf"
        scene.write_text(json.dumps(document))
        written = json.loads(self.run_program("info", scene, "--json").stdout)
        self.assertEqual(written["cameras"], ["front", "side"])
        self.assertEqual(written["animations"], [{"name": "slide", "seconds": 2.5}])
        text = self.run_program("info", scene).stdout
        self.assertIn("front, side", text)
        self.assertIn("slide (2.5", text)


if __name__ == "__main__":
    unittest.main()
