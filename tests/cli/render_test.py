"""montelux render: the same bits in every run, a clean end on signals, and no broken files."""
import gzip
import json
import math
import os
import pty
import re
import signal
import time
import unittest

from program import ROOT, SCENE, SLOWNESS, ProgramTest, read_pfm


class Render(ProgramTest):
    def test_the_same_seed_gives_the_same_bytes_for_any_number_of_threads(self):
        for threads in 1, 2:
            self.render("--spp", "8", "--threads", threads, "-o", f"{threads}.exr")
        one, two = ((self.folder / f"{threads}.exr").read_bytes() for threads in (1, 2))
        self.assertEqual(one, two)
        self.render("--spp", "8", "--seed", "1", "-o", "other.exr")
        self.assertNotEqual(one, (self.folder / "other.exr").read_bytes())

    def test_a_crop_holds_the_same_pixels_as_the_whole_picture(self):
        for sampler in "independent", "sobol", "blue-noise":
            with self.subTest(sampler=sampler):
                options = ["--spp", "8", "--sampler", sampler]
                self.render(*options, "-o", "whole.pfm")
                self.render(*options, "--crop", "5,7,44,30", "-o", "crop.pfm")
                whole, crop = read_pfm(self.folder / "whole.pfm")[2], read_pfm(self.folder / "crop.pfm")[2]
                self.assertEqual(crop, [row[3 * 5:3 * 44] for row in whole[7:30]])

    def test_one_render_writes_many_files_and_one_json_object(self):
        result = self.render("--spp", "16", "--json", *(f"-oroom.{kind}" for kind in ("exr", "pfm", "png", "jpg", "hdr")))
        written = json.loads(result.stdout)
        for name in written["files"]:
            self.assertGreater((self.folder / name).stat().st_size, 0)
        self.assertEqual(len(written["files"]), 5)
        self.assertEqual(written["samples"], 64 * 48 * written["passes"] * written["samples_per_pass"])
        self.assertEqual(written["passes"] * written["samples_per_pass"], 16)
        self.assertEqual(written["non_finite"], 0)
        self.assertGreater(written["rays"], written["samples"])
        # The stated mean is that of the picture.
        _, _, rows = read_pfm(self.folder / "room.pfm")
        for channel in range(3):
            mean = math.fsum(math.fsum(row[channel::3]) for row in rows) / (64 * 48)
            self.assertAlmostEqual(written["mean"][channel], mean, delta=1e-5 * mean)
            self.assertGreater(written["standard_error"][channel], 0)

    def test_the_default_file_has_the_name_of_the_scene(self):
        result = self.render("--spp", "1", "--quiet")
        self.assertTrue((self.folder / "first-light.exr").is_file())
        self.assertIn("first-light.exr", result.stdout)
        self.assertEqual(result.stderr, "")

        packed = self.folder / "room.pbrt.gz"
        nameless = SCENE.read_bytes().replace(b'"string filename" [ "first-light.exr" ]', b"")
        packed.write_bytes(gzip.compress(nameless))
        self.render("--spp", "1", "--quiet", scene=packed)
        self.assertTrue((self.folder / "room.exr").is_file())

    def write_scene(self, before):
        scene = self.folder / "room.pbrt"
        scene.write_text(before + '\nWorldBegin LightSource "infinite" Shape "sphere"\n')
        return scene

    def test_the_film_names_the_picture_where_nobody_else_does(self):
        # Relative to the working directory, not to the scene.
        (self.folder / "scenes").mkdir()
        scene = self.write_scene('Film "rgb" "string filename" "shown.pfm"').rename(self.folder / "scenes" / "room.pbrt")
        self.render("--spp", "1", scene=scene)
        self.assertEqual([p.name for p in self.folder.iterdir() if p.is_file()], ["shown.pfm"])
        self.render("--spp", "1", "-o", "mine.pfm", scene=scene)
        self.assertTrue((self.folder / "mine.pfm").is_file())
        self.assertFalse((self.folder / "scenes" / "shown.pfm").exists())

    def test_a_picture_of_the_film_that_cannot_be_written_is_refused_before_the_render(self):
        for name, word in ("shown.tga", "extension must be one of .exr"), ("none/shown.exr", "no such folder"):
            scene = self.write_scene(f'Film "rgb" "string filename" "{name}"')
            result = self.render("--time", "1h", scene=scene, status=2)
            for part in word, name, "the scene's film names this file, -o":
                self.assertIn(part, result.stderr)
            self.render("--spp", "1", "-o", "mine.pfm", scene=scene)

    def test_the_seed_of_the_scene_is_that_of_the_picture(self):
        scene = self.write_scene('Option "integer seed" 7')
        self.assertEqual(json.loads(self.render("--spp", "1", "--json", scene=scene).stdout)["seed"], 7)
        self.assertEqual(json.loads(self.render("--spp", "1", "--json", "--seed", "9", scene=scene).stdout)["seed"], 9)

    # A lamp whose edge goes through a column of 8: between the centre and the border of its pixels.
    EDGE = """Film "rgb" "integer xresolution" [ 8 ] "integer yresolution" [ 8 ]
        {head}
        {motion}
        Camera "orthographic" "float shutterclose" 1 {camera}
        WorldBegin
        Translate 0 0 4
        AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] "bool twosided" true
        Shape "bilinearmesh" "point3 P" [ -9 -9 0   {edge} -9 0   -9 9 0   {edge} 9 0 ]
        """

    def test_without_jitter_a_pixel_is_what_its_centre_sees(self):
        moving = "ActiveTransform EndTime Translate 0.4 0 0 ActiveTransform All"
        cases = {
            # name: (camera, its motion, x of the edge, whether the centres at x = -0.125 are lit)
            "lit": ("", "", -0.1, True),
            "dark": ("", "", -0.15, False),
            "out of focus": ('"float lensradius" 0.5 "float focaldistance" 1', "", -0.1, True),
            # In the middle of the time the edge is at x = -0.1.
            "moving": ("", moving, -0.3, True),
        }
        for name, (camera, motion, edge, lit) in cases.items():
            for jitter in True, False:
                with self.subTest(name, jitter=jitter):
                    head = "" if jitter else 'Option "bool disablepixeljitter" true'
                    scene = self.folder / "edge.pbrt"
                    scene.write_text(self.EDGE.format(head=head, camera=camera, motion=motion, edge=edge))
                    result = self.run_program("render", scene, "--spp", "64", "--sampler", "independent", "--json", "-o",
                                              "edge.pfm")
                    written = json.loads(result.stdout)
                    row = list(read_pfm(self.folder / "edge.pfm")[2][4][::3])
                    if jitter:
                        self.assertGreater(written["standard_error"][0], 0)
                        self.assertTrue(0 < row[3] < 1, row)
                        self.assertEqual(written["biased_options"], "none")
                        self.assertNotIn("disablepixeljitter", result.stderr)
                    else:
                        self.assertEqual(written["standard_error"], [0, 0, 0])
                        self.assertEqual(row, [1, 1, 1, float(lit), 0, 0, 0, 0])
                        self.assertEqual(written["biased_options"], "disablepixeljitter")
                        self.assertIn("disablepixeljitter of the scene): the picture is biased", result.stderr)

    def test_a_file_that_cannot_be_written_is_refused_before_the_render(self):
        (self.folder / "good.png").write_text("old")
        (self.folder / "file").touch()
        (self.folder / "folder.exr").mkdir()
        for bad in "missing/room.exr", "file/room.exr", "folder.exr", "room.tif", "room":
            with self.subTest(file=bad):
                result = self.render("--time", "1h", "-o", "good.png", "-o", bad, status=2)
                self.assertIn(bad, result.stderr)
        self.assertEqual((self.folder / "good.png").read_text(), "old")
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["file", "folder.exr", "good.png"])

    def test_time_ends_a_render(self):
        # The time includes the writing of the picture, the seconds of the render do not.
        start = time.monotonic()
        written = json.loads(self.render("--time", "500ms", "--json").stdout)
        self.assertGreaterEqual(time.monotonic() - start, 0.4)
        self.assertLess(written["seconds"], 2 * SLOWNESS)  # units that are under way are completed, on a busy machine late
        self.assertGreater(written["seconds"], 0)
        self.assertFalse(written["interrupted"])

    def test_time_that_writing_takes_is_named_before_the_render(self):
        result = self.run_program("render", SCENE, "--resolution", "2000x2000", "--time", "1ms", "-o", "a.exr")
        self.assertRegex(result.stderr, r"takes about [\d.]+ s in addition to the time")

    def test_time_that_is_too_short_for_a_sample_of_each_pixel_gives_a_sparse_picture_that_says_so(self):
        result = self.run_program("render", SCENE, "--resolution", "1600x1200", "--time", "200ms", "--threads", 1, "--json",
                                  "-o", "room.pfm")
        written = json.loads(result.stdout)
        self.assertIn("more than the time", result.stderr)
        self.assertLess(written["sampled_pixels"], 0.6)
        self.assertGreater(written["sampled_pixels"], 0)
        self.assertLess(written["seconds"], 2 * SLOWNESS)  # 4 s for one sample of every pixel, on a quick machine
        self.assertIsNone(written["relative_mse"])
        self.assertEqual(self.run_program("render", SCENE, "--resolution", "1600x1200", "--time", "200ms", "--threads", 1,
                                          "--quiet", "-o", "quiet.pfm").stderr, "")
        # The picture has no holes: unsampled pixels repeat those that are sampled.
        _, _, rows = read_pfm(self.folder / "room.pfm")
        black = sum(1 for row in rows[::7] for value in row[::3] if value == 0)
        self.assertLess(black, 0.3 * len(rows[::7]) * 1600)

    def test_time_that_is_too_short_for_a_frame_of_a_chain_gives_a_sparse_picture_that_says_so(self):
        for integrator in ("restir-di", "light"):
            result = self.run_program("render", SCENE, "--integrator", integrator, "--resolution", "1600x1200", "--time", "100ms",
                                      "--threads", 1, "--json", "-o", "room.pfm")
            written = json.loads(result.stdout)
            self.assertRegex(result.stderr, r"more than the time: one pixel of each \d+ x \d+ is sampled")
            self.assertLess(written["sampled_pixels"], 0.3)
            self.assertGreater(written["sampled_pixels"], 0)
            self.assertGreater(written["passes"], 0)

    def test_the_interval_of_the_mean_is_students(self):
        written = json.loads(self.render("--spp", "16", "--json").stdout)
        self.assertEqual(written["passes"], 8)
        interval = written["interval_of_mean"]
        self.assertEqual(interval["confidence"], 0.95)
        missing = []
        for channel in range(3):
            width = 2.364624 * written["standard_error"][channel]  # t(0.975) of 7 degrees of freedom
            self.assertAlmostEqual(interval["low"][channel], written["mean"][channel] - width, delta=1e-5 * width)
            high = interval["high"][channel] - written["mean"][channel]
            self.assertGreaterEqual(high, (1 - 1e-5) * width)
            missing.append(math.sqrt(max(high ** 2 - width ** 2, 0)))
        # Above it has room for light that paths meet by chance: by the mirrors and the glass of this scene.
        expected = written["missing_by_chance"] * sum(written["mean"]) / 3
        self.assertGreater(expected, 0)
        self.assertAlmostEqual(sum(missing) / 3, expected, delta=1e-3 * expected)
        matt = json.loads(self.run_program("render", ROOT / "scenes" / "path-classes" / "lde.pbrt", "--spp", "16", "--json", "--quiet",
                                           "-o", "matt.pfm").stdout)
        self.assertEqual(matt["missing_by_chance"], 0)
        for channel in range(3):
            width = 2.364624 * matt["standard_error"][channel]
            self.assertAlmostEqual(matt["interval_of_mean"]["high"][channel], matt["mean"][channel] + width, delta=1e-5 * width)
        self.assertIsNone(json.loads(self.render("--spp", "1", "--json").stdout)["interval_of_mean"])
        self.assertIn("95 %", self.render("--spp", "16").stdout)

    def test_an_error_that_few_bright_samples_decide_has_a_range(self):
        result = self.render("--spp", "16")
        self.assertIn("few bright samples determine it", result.stdout)
        written = json.loads(self.render("--spp", "16", "--json").stdout)
        self.assertTrue(written["unsure_error"])
        low, high = written["relative_mse_range"]
        self.assertLess(low, written["relative_mse"])
        self.assertGreater(high, written["relative_mse"])
        # Converged pictures of this size have 0.117 in the mean of seeds at these samples.
        self.assertGreater(written["relative_mse"], 0.03)

    def test_half_is_for_what_is_seen_and_not_for_errors_and_places(self):
        def types(name):
            header, found = (self.folder / name).read_bytes(), {}
            at = header.index(b"channels\0chlist\0") + 20
            while header[at]:
                end = header.index(b"\0", at)
                found[header[at:end].decode()] = header[end + 1]
                at = end + 17
            return found
        for options in [], ["--half"]:
            self.render("--spp", "4", "--layers", "bounces:1,errors", *options, "-o", f"a{len(options)}.exr")
        self.assertEqual(set(types("a0.exr").values()), {2})  # 32-bit floats
        half = {name for name, kind in types("a1.exr").items() if kind == 1}
        colors = {f"{layer}.{c}" for layer in ("albedo", "bounce0", "bounce1", "bounce_rest") for c in "RGB"}
        self.assertEqual(half, {*"RGBA", *colors, "N.X", "N.Y", "N.Z"})
        written = json.loads(self.run_program("diff", "a1.exr", "a0.exr", "--json").stdout)
        self.assertFalse(written["welch"]["differs"])
        self.assertLess(written["relative_mse"], 1e-6)

    def test_layers_sum_to_the_picture(self):
        written = json.loads(self.render("--spp", "8", "--layers", "bounces:2,light-groups,errors", "--json", "-o",
                                      "room.exr").stdout)
        names = ["bounce0", "bounce1", "bounce2", "bounce_rest", "Combined_default"]
        self.assertEqual(list(written["layers"]), names)
        for family in "bounce", "Combined":
            for channel in range(3):
                total = sum(mean[channel] for name, mean in written["layers"].items() if name.startswith(family))
                self.assertAlmostEqual(total, written["mean"][channel], delta=1e-12)
        header = (self.folder / "room.exr").read_bytes()[:4096]
        for name in names:
            self.assertIn(f"{name}.R\0".encode(), header)
            self.assertIn(f"{name}_stderr.B\0".encode(), header)

    def test_layers_of_strategies_sum_to_the_picture_and_are_kept_in_films(self):
        options = ["--layers", "strategies:1,alone,bounces:1", "--integrator", "vcm", "--samples-per-pass", "1"]
        written = json.loads(self.render("--spp", "4", *options, "--json", "-o", "whole.exr").stdout)
        connections = ["s0_t2", "s1_t1", "s0_t3", "s1_t2", "s2_t1"]
        self.assertEqual(list(written["layers"]), [
            "bounce0", "bounce1", "bounce_rest", *(f"strategy_{name}" for name in connections), "merging_s2_t2",
            "strategy_rest", *(f"alone_{name}" for name in connections), "alone_merging_s2_t2"])
        for channel in range(3):
            total = sum(mean[channel] for name, mean in written["layers"].items() if name.startswith(("strategy", "merging")))
            self.assertAlmostEqual(total, written["mean"][channel], delta=1e-12)
            self.assertEqual(written["layers"]["strategy_s0_t2"], written["layers"]["bounce0"])
        self.render("--spp", "2", *options, "--checkpoint", "part.film", "-o", "part.exr")
        self.run_program("render", "--resume", "part.film", "--spp", "4", "-o", "resumed.exr")
        for name in "whole.exr", "resumed.exr":
            self.run_program("tonemap", name, "--layer", "alone_s1_t2", "-o", name.replace(".exr", ".png"))
        self.assertEqual((self.folder / "whole.png").read_bytes(), (self.folder / "resumed.png").read_bytes())

    def test_layers_that_cannot_be_had_are_refused(self):
        for options, reason in (
            (["--layers", "bounce"], 'no layers "bounce"; valid: bounces'),
            (["--layers", "bounces:x"], "whole number from 0 to 64"),
            (["--layers", "errors"], "light-groups or strategies as well"),
            (["--layers", "alone"], "alone needs strategies"),
            (["--layers", "strategies:17", "--integrator", "bdpt"], "whole number from 0 to 16"),
            (["--layers", "strategies", "--integrator", "path"], "path has no layers of strategies; light, bdpt and vcm"),
            (["--layers", "strategies", "--integrator", "metropolis"],
             "metropolis has no layers of strategies; light, bdpt and vcm have them, and metropolis with strategies=bdpt"),
            (["--layers", "bounces", "--integrator", "restir-di"], "the integrator restir-di has no layers"),
            (["--layers", "bounces", "--integrator", "vcm:maxcomponent=2"], "maxcomponent=none"),
            (["--layers", "bounces", "-o", "room.png"], "need an .exr file"),
            (["--layers", "bounces", "--integrator", "tracepath"], "the integrator tracepath has no layers"),
            (["--layers", "bounces", "--set", "maxcomponent=2"], "maxcomponent=none"),
        ):
            with self.subTest(options=options):
                result = self.render(*options, status=2)
                self.assertIn(reason, result.stderr)


class Signals(ProgramTest):
    def interrupted_by(self, number):
        """Renders for long, is interrupted once it has begun, and returns what was said."""
        process = self.start("render", SCENE, "--resolution", "64x48", "--time", "60s", "--sampler", "independent", "-o",
                             "room.exr", "-o", "room.pfm")
        self.addCleanup(process.kill)
        self.assertIn("samples/s", process.stderr.readline())
        process.send_signal(number)
        output, errors = process.communicate(timeout=60)
        self.assertIn("interrupted", errors)
        self.assertEqual(read_pfm(self.folder / "room.pfm")[:2], (64, 48))
        self.run_program("diff", "room.exr", "room.exr")
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["room.exr", "room.pfm"])
        self.assertIn("mean", output)
        return process.returncode

    def test_sigint_writes_what_is_done_and_returns_130(self):
        self.assertEqual(self.interrupted_by(signal.SIGINT), 130)

    def interrupted_after(self, share, *options):
        """Renders two passes, is interrupted when that share of them is done, and returns what was said."""
        terminal, inside = pty.openpty()
        process = self.start("render", SCENE, "--resolution", "1800x1400", "--spp", "2", "--sampler", "independent",
                             "--threads", "1", "-o", "early.exr", *options, stderr=inside)
        self.addCleanup(process.kill)
        os.close(inside)
        said = b""
        try:
            while part := os.read(terminal, 4096):
                said += part
                done = re.findall(rb"(\d+) %", said)
                if done and int(done[-1]) >= 100 * share:
                    process.send_signal(signal.SIGINT)
                    share = 2
        except OSError:  # how a terminal ends whose other side is closed
            pass
        os.close(terminal)
        output, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, said)
        return output

    def header_has(self, name):
        return b"montelux:" + name in (self.folder / "early.exr").read_bytes()[:20000]

    def test_the_error_is_not_known_before_every_pixel_has_two_passes(self):
        written = json.loads(self.interrupted_after(0.6, "--json"))
        # The second pass is cut: some pixels have two samples, others one.
        self.assertTrue(1800 * 1400 < written["samples"] < 2 * 1800 * 1400, written["samples"])
        self.assertEqual(written["passes"], 1)
        for key in "mse", "relative_mse", "relative_mse_range", "tail_index", "interval_of_mean":
            self.assertIsNone(written[key], key)
        self.assertEqual(written["standard_error"], [None, None, None])
        self.assertEqual((written["unsure_error"], written["error_bar"]), (False, False))
        for name in b"estimatedMSE", b"estimatedRelativeMSE", b"unsureError", b"meanStandardError":
            self.assertFalse(self.header_has(name), name)
        self.assertTrue(self.header_has(b"errorBar"))
        text = self.interrupted_after(0.6)
        self.assertIn("error    unknown: it takes two independent passes of every pixel\n", text)
        self.assertNotIn("±", text)
        self.assertFalse(self.header_has(b"estimatedRelativeMSE"))

    def test_a_signal_does_not_wait_for_a_costly_material(self):
        scene = self.folder / "slow.pbrt"
        scene.write_text('''
            LookAt 0 0 -4  0 0 0  0 1 0
            Camera "perspective"
            Film "rgb" "integer xresolution" [ 64 ] "integer yresolution" [ 64 ]
            WorldBegin
            LightSource "infinite" "rgb L" [ 1 1 1 ]
            Material "coateddiffuse" "integer nsamples" [ 100000 ] "float thickness" [ 0.1 ] "rgb albedo" [ 0.5 0.5 0.5 ]
            Shape "sphere" "float radius" [ 1 ]
            ''')
        process = self.start("render", scene, "--spp", "64", "-o", "slow.pfm")
        self.addCleanup(process.kill)
        time.sleep(1.5)
        process.send_signal(signal.SIGINT)
        began = time.monotonic()
        process.communicate(timeout=120)
        self.assertLess(time.monotonic() - began, 10)
        self.assertEqual(process.returncode, 130)

    def test_sigterm_writes_what_is_done_and_returns_143(self):
        self.assertEqual(self.interrupted_by(signal.SIGTERM), 143)


class ProgressLine(ProgramTest):
    def said_on_a_terminal(self, *arguments):
        terminal, inside = pty.openpty()
        process = self.start("render", SCENE, "--resolution", "64x48", "--time", f"{0.5 * SLOWNESS}s", *arguments,
                             stderr=inside)
        os.close(inside)
        said = b""
        try:
            while part := os.read(terminal, 4096):
                said += part
        except OSError:  # how a terminal ends whose other side is closed
            pass
        os.close(terminal)
        process.communicate()
        self.assertEqual(process.returncode, 0)
        return said.decode()

    def test_a_terminal_sees_one_line_that_is_redrawn_and_goes(self):
        said = self.said_on_a_terminal()
        self.assertGreater(said.count("\r"), 2)
        self.assertNotIn("\n", said)
        self.assertIn("samples/s", said)
        self.assertTrue(said.endswith("\r\x1b[K"))

    def test_quiet_says_nothing(self):
        self.assertEqual(self.said_on_a_terminal("--quiet"), "")
        self.assertEqual(self.said_on_a_terminal("--no-progress"), "")


if __name__ == "__main__":
    unittest.main()
