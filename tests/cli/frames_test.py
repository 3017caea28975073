"""montelux render --frames: a picture for each frame of a scene that moves."""
import json
import math
import signal
import time
import unittest

from program import ROOT, ProgramTest, read_pfm

# A black square comes in from the left over a sky of radiance 1: at time t of 0 to 2 it hides t / 2 of the picture.
SCENE = """
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
Sampler "stratified" "integer xsamples" 8 "integer ysamples" 8
Integrator "path"
PixelFilter "box"
TransformTimes 0 2
LookAt 0 0 -5  0 0 0  0 1 0
Camera "orthographic" "float shutteropen" SHUTTER_OPEN "float shutterclose" SHUTTER_CLOSE
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Material "diffuse" "rgb reflectance" [ 0 0 0 ]
ActiveTransform StartTime
Translate -2 0 0
ActiveTransform All
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ]
    "point3 P" [ -1 -1 0   1 -1 0   1 1 0   -1 1 0 ]
"""

# A lamp over a floor, past which a camera pans.
LIT_SCENE = """
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
PixelFilter "box"
Integrator "path" "integer maxdepth" 3
ActiveTransform StartTime
LookAt 0 1 -4  -0.2 0.5 0  0 1 0
ActiveTransform EndTime
LookAt 0 1 -4  0.2 0.5 0  0 1 0
ActiveTransform All
Camera "perspective" "float fov" 60
WorldBegin
AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 9 8 7 ]
Translate 0 1.5 0
Shape "sphere" "float radius" 0.2
AttributeEnd
Shape "bilinearmesh" "point3 P" [ -9 0 -9  9 0 -9  -9 0 9  9 0 9 ]
"""


class Frames(ProgramTest):
    def write_scene(self, shutter_open=0, shutter_close=2, name="slide.pbrt"):
        text = SCENE.replace("SHUTTER_OPEN", str(shutter_open)).replace("SHUTTER_CLOSE", str(shutter_close))
        (self.folder / name).write_text(text)

    def stated(self, *arguments):
        result = self.run_program("render", "slide.pbrt", "--json", "--no-progress", *arguments)
        return [json.loads(line) for line in result.stdout.splitlines()]

    def expect_hidden(self, stated, hidden, exposure):
        """The share of the picture that is hidden, of each frame, to five standard errors."""
        for frame, share in zip(stated, hidden, strict=True):
            self.assertGreater(frame["standard_error"][0], 0)
            self.assertAlmostEqual(frame["mean"][0], exposure * (1 - share), delta=5 * frame["standard_error"][0])

    def test_the_whole_time_falls_into_equal_frames(self):
        self.write_scene()
        stated = self.stated("--frames", "10:13", "-o", "a.####.pfm")
        self.assertEqual([t["frame"] for t in stated], [10, 11, 12, 13])
        self.assertEqual([t["shutter"] for t in stated], [[0, 0.5], [0.5, 1], [1, 1.5], [1.5, 2]])
        self.assertEqual([t["files"] for t in stated], [[f"a.00{n}.pfm"] for n in (10, 11, 12, 13)])
        self.expect_hidden(stated, [1 / 8, 3 / 8, 5 / 8, 7 / 8], 2)
        # The picture is that of the moment: the square comes from the left.
        _, _, rows = read_pfm(self.folder / "a.0011.pfm")
        self.assertLess(rows[8][0], 0.01)
        self.assertGreater(rows[8][3 * 15], 1.99)

    def test_a_part_of_the_frames_is_the_same_as_in_the_whole(self):
        self.write_scene(0, 1)
        whole = self.stated("--frames", "0:7", "-o", "whole.%03d.pfm")
        part = self.stated("--frames", "5:6/8", "-o", "part.#.pfm")
        self.assertEqual([t["shutter"] for t in part], [[1.25, 1.375], [1.5, 1.625]])
        self.assertEqual([t["seed"] for t in part], [t["seed"] for t in whole[5:7]])
        self.assertEqual(len({t["seed"] for t in whole}), 8)
        for number in 5, 6:
            self.assertEqual((self.folder / f"whole.00{number}.pfm").read_bytes(),
                             (self.folder / f"part.{number}.pfm").read_bytes())
        self.expect_hidden(part, [(1.25 + 1.375) / 4, (1.5 + 1.625) / 4], 1)

    def test_frames_a_unit_of_time_shift_the_shutter_of_the_scene(self):
        self.write_scene(0, 0.25)
        stated = self.stated("--frames", "0:3", "--fps", "2", "-o", "a.pfm")
        self.assertEqual([t["shutter"] for t in stated], [[0, 0.25], [0.5, 0.75], [1, 1.25], [1.5, 1.75]])
        self.expect_hidden(stated, [1 / 16, 5 / 16, 9 / 16, 13 / 16], 0.25)
        self.assertTrue((self.folder / "a.0002.pfm").is_file())

    def test_a_fault_in_the_shutter_would_show(self):
        # The same frame with a shutter that stays at its opening lies far outside of what is allowed above.
        self.write_scene()
        self.write_scene(0.5, 1, "open.pbrt")
        frame = self.stated("--frames", "0:3", "-o", "a.pfm")[1]
        wrong = 2 * (1 - 0.5 / 2)
        self.assertGreater(abs(frame["mean"][0] - wrong), 5 * frame["standard_error"][0])
        self.assertTrue(math.isfinite(frame["mean"][0]))

    def test_what_makes_no_frames_is_refused(self):
        self.write_scene()
        for arguments, word in [(["--frames", "x"], "A:B"), (["--frames", "5:3"], "end before"),
                                (["--frames", "-1:3"], "A:B"), (["--frames", "0:8/8"], "no frame 8"),
                                (["--frames", "0:x"], "A:B"), (["--frames", "0:1/0"], "no frame 1"),
                                (["--frames", "0:1/2", "--fps", "24"], "exclude"),
                                (["--frames", "0:1", "--fps", "0"], "from"), (["--fps", "24"], "--frames"),
                                (["--frames", "0:1", "-o", "a.##.b.%d.exr"], "more than one"),
                                (["--frames", "0:1", "-o", "missing/a.#.exr"], "missing")]:
            with self.subTest(arguments=arguments):
                result = self.run_program("render", "slide.pbrt", *arguments, status=2)
                self.assertIn(word, result.stderr)
                self.assertEqual(list(self.folder.glob("*.exr")), [])

    def test_an_interrupt_keeps_the_frames_that_are_finished(self):
        self.write_scene()
        program = self.start("render", "slide.pbrt", "--frames", "0:99999", "--spp", "16384", "--no-progress", "-o", "a.#.pfm")
        deadline = time.monotonic() + 60
        while not (self.folder / "a.1.pfm").exists() and time.monotonic() < deadline:
            time.sleep(0.01)
        program.send_signal(signal.SIGINT)
        _, error = program.communicate(timeout=60)
        self.assertEqual(program.returncode, 130)
        # In a frame, or between two.
        self.assertRegex(error, "not written|interrupted after frame")
        frames = sorted(int(path.name.split(".")[1]) for path in self.folder.glob("a.*.pfm"))
        self.assertEqual(frames, list(range(len(frames))))
        self.assertGreaterEqual(len(frames), 2)
        for number in frames:
            self.assertEqual(read_pfm(self.folder / f"a.{number}.pfm")[:2], (16, 16))

    def test_an_interrupt_ends_a_sequence_of_frames_that_are_cut_to_a_time(self):
        (self.folder / "slide.pbrt").write_text(LIT_SCENE)
        # Frames over which a signal is seen while they are rendered, and shorter ones.
        for budget in "300ms", "2ms":
            program = self.start("render", "slide.pbrt", "--frames", "0:99999", "--interactive-budget", budget,
                                 "--integrator", "restir-di", "--quiet", "-o", "b.#.pfm")
            deadline = time.monotonic() + 60
            while not (self.folder / "b.1.pfm").exists() and time.monotonic() < deadline:
                time.sleep(0.01)
            program.send_signal(signal.SIGINT)
            _, error = program.communicate(timeout=60)
            self.assertEqual(program.returncode, 130)
            self.assertEqual(error, "")
            for picture in self.folder.glob("b.*.pfm"):
                picture.unlink()

    def test_the_shutter_does_not_change_the_brightness(self):
        self.write_scene()
        whole = self.stated("--frames", "0:0/1", "--spp", "256", "-o", "a.pfm")[0]
        half = json.loads(self.run_program("render", "slide.pbrt", "--json", "--quiet", "--spp", "256", "--shutter",
                                           "0.5:1.5", "-o", "a.pfm").stdout)
        # The panel slides evenly, so that the middle of its way is as bright as the whole.
        error = math.hypot(whole["standard_error"][0], half["standard_error"][0])
        self.assertLess(abs(whole["mean"][0] - half["mean"][0]), 4 * error)
        self.assertGreater(whole["mean"][0], 20 * error)

    def test_series_go_on_from_frame_to_frame(self):
        (self.folder / "slide.pbrt").write_text(LIT_SCENE)
        way = ["--integrator", "restir-di:frames=2,candidates=2", "--spp", "8"]
        stated = self.stated("--frames", "0:2", *way, "-o", "on.#.pfm")
        again = self.stated("--frames", "0:2", *way, "--threads", "1", "-o", "again.#.pfm")
        self.assertEqual([t["mean"] for t in stated], [t["mean"] for t in again])
        off = self.stated("--frames", "0:2", *way, "--set", "carry=off", "-o", "off.#.pfm")
        late = self.stated("--frames", "2:2/3", *way, "-o", "late.#.pfm")
        # Nothing follows the last one. With four components of the spectrum, a pixel has 16 bytes more.
        sizes = [[16 * 16 * 4 * bytes_] * 2 + [0] for bytes_ in (328, 344)]
        self.assertIn([t["history_bytes"] for t in stated], sizes)
        self.assertEqual([t["history_bytes"] for t in off], [0] * 3)
        # The first frame has no history; what begins later has none either.
        same = [(self.folder / f"on.{n}.pfm").read_bytes() == (self.folder / f"off.{n}.pfm").read_bytes()
                for n in range(3)]
        self.assertEqual(same, [True, False, False])
        self.assertEqual(late[0]["mean"], off[2]["mean"])
        for on, other in zip(stated, off, strict=True):
            error = math.hypot(on["standard_error"][1], other["standard_error"][1])
            self.assertAlmostEqual(on["mean"][1], other["mean"][1], delta=5 * error)

    def test_motion_is_a_layer_of_frames(self):
        self.write_scene()
        self.run_program("render", "slide.pbrt", "--frames", "0:1", "--spp", "1", "--layers", "motion", "-o", "a.#.exr")
        for name in b"motion.X", b"motion.Y":
            self.assertIn(name, (self.folder / "a.1.exr").read_bytes())
        alone = self.run_program("render", "slide.pbrt", "--layers", "motion", status=2)
        self.assertIn("--frames", alone.stderr)
        both = self.stated("--frames", "0:0", "--spp", "1", "--layers", "motion,bounces:1", "-o", "b.#.exr")
        self.assertIn("bounce0", both[0]["layers"])
        self.assertIn(b"motion.X", (self.folder / "b.0.exr").read_bytes())
        self.run_program("render", "slide.pbrt", "--frames", "0:0", "--layers", "motion,errors", status=2)

    def test_a_budget_ends_every_picture(self):
        (self.folder / "slide.pbrt").write_text(LIT_SCENE)
        series = self.stated("--frames", "0:2", "--integrator", "restir-di", "--interactive-budget", "200ms")
        self.assertEqual([frame["history_bytes"] > 0 for frame in series], [True, True, False])
        for frame in series:
            self.assertGreaterEqual(frame["samples_per_pass"], 1)
            self.assertEqual((frame["passes"], frame["error_bar"], frame["budget"]), (1, False, 0.2))
            self.assertEqual(frame["standard_error"], [None] * 3)
            self.assertEqual(frame["over_budget"], frame["seconds"] > 0.2)
        for picture in self.folder.glob("*.exr"):
            self.assertIn(b"montelux:errorBar", picture.read_bytes())
            self.assertIn(b"none: it takes two independent passes", picture.read_bytes())
        still = json.loads(self.run_program("render", "slide.pbrt", "--json", "--interactive-budget", "300ms",
                                            "-o", "still.exr").stdout)
        self.assertEqual(still["error_bar"], still["passes"] > 1)
        self.assertEqual(len(list(self.folder.glob("*.exr"))), 4)
        # A picture that cannot be in time has one pass all the same, and says that it is late.
        result = self.run_program("render", "slide.pbrt", "--frames", "0:1", "--interactive-budget", "0.001ms",
                                  "--no-progress", "-o", "a.#.pfm")
        self.assertIn("over the budget", result.stdout)
        self.assertIn("error    unknown", result.stdout)
        self.assertIn("2 of 2 images took longer", result.stderr)
        for arguments in (["--spp", "2"], ["--time", "1s"], ["--layers", "bounces"]):
            self.run_program("render", "slide.pbrt", "--interactive-budget", "1s", *arguments, status=2)

    def test_a_scene_that_stands_still_says_so(self):
        (self.folder / "still.pbrt").write_text("WorldBegin\nLightSource \"infinite\"\n")
        result = self.run_program("render", "still.pbrt", "--resolution", "8x8", "--spp", "1", "--frames", "0:1")
        self.assertIn("nothing moves", result.stderr)
        self.assertTrue((self.folder / "still.0001.exr").is_file())

    def test_a_gltf_animation_is_rendered_at_its_own_rate_or_in_parts(self):
        clockwork = ROOT / "scenes" / "clockwork" / "clockwork.gltf"

        def stated(*arguments):
            result = self.run_program("render", clockwork, "--resolution", "32x18", "--json", "--no-progress", *arguments)
            return [json.loads(line) for line in result.stdout.splitlines()], result.stderr

        def still(time, seed):
            return json.loads(self.run_program(
                "render", clockwork, "--resolution", "32x18", "--json", "--no-progress", "--quiet", "--spp", "4",
                "--shutter", f"{time}:{time}", "--seed", seed, "-o", "still.pfm").stdout)

        frames, _ = stated("--frames", "11:13", "--spp", "4", "-o", "a.#.pfm")
        self.assertEqual([f["shutter"] for f in frames], [[n / 24, n / 24] for n in (11, 12, 13)])
        parts, _ = stated("--frames", "1:2/4", "--spp", "4", "-o", "b.#.pfm")
        self.assertEqual([f["shutter"] for f in parts], [[0.5, 0.5], [1, 1]])
        # A frame is the still picture of its moment, however the scene came to it.
        for frame in frames + parts:
            alone = still(frame["shutter"][0], frame["seed"])
            for a, b in zip(frame["mean"], alone["mean"], strict=True):
                self.assertAlmostEqual(a, b, delta=2e-3 * b)
        other = still(0.9, frames[0]["seed"])
        self.assertGreater(abs(other["mean"][1] - frames[0]["mean"][1]), 2e-3 * other["mean"][1])
        # More frames than a scene has moments for are loaded part by part.
        many, notes = stated("--frames", "0:129", "--fps", "65", "--spp", "1", "-o", "c.#.pfm")
        self.assertEqual(len(many), 130)
        self.assertIn("frames from 127 on", notes)
        # Exposures are shares of a frame, however many frames there are.
        open_shutter, notes = stated("--frames", "0:129/300", "--shutter", "0:1", "--spp", "1", "-o", "e.#.pfm")
        self.assertEqual(len(open_shutter), 130)
        self.assertIn("frames from 127 on", notes)
        late, _ = stated("--frames", "128:129", "--fps", "65", "--spp", "1", "-o", "d.#.pfm")
        for a, b in zip(many[128]["mean"], late[0]["mean"], strict=True):
            self.assertAlmostEqual(a, b, delta=2e-3 * b)

    def test_a_gltf_animation_carries_histories_and_blurs(self):
        clockwork = ROOT / "scenes" / "clockwork" / "clockwork.gltf"

        def stated(*arguments):
            result = self.run_program("render", clockwork, "--resolution", "32x18", "--json", "--no-progress", "--frames",
                                      "6:8", *arguments)
            return [json.loads(line) for line in result.stdout.splitlines()]

        for shutter in [], ["--shutter", "0:0.03"]:
            reused = stated(*shutter, "--integrator", "restir-di:frames=2,candidates=2", "--spp", "32", "-o", "a.#.pfm")
            paths = stated(*shutter, "--integrator", "path", "--spp", "128", "-o", "b.#.pfm")
            self.assertEqual([one["history_bytes"] > 0 for one in reused], [True, True, False])
            for one, other in zip(reused, paths, strict=True):
                self.assertAlmostEqual(one["shutter"][1] - one["shutter"][0], 0.03 if shutter else 0)
                error = math.hypot(one["standard_error"][1], other["standard_error"][1])
                self.assertAlmostEqual(one["mean"][1], other["mean"][1], delta=5 * error)

    def test_what_a_gltf_scene_does_not_have_is_named(self):
        clockwork = ROOT / "scenes" / "clockwork" / "clockwork.gltf"
        for arguments, word in [(["--animation", "tock"], "did you mean 'tick'"), (["--camera", "4"], "no camera '4'"),
                                (["--shutter", "2:1"], "OPEN:CLOSE"),
                                (["--frames", "0:1", "--shutter", "0:2", "--fps", "0.1"], "too fast")]:
            with self.subTest(arguments=arguments):
                result = self.run_program("render", clockwork, *arguments, "-o", "a.#.exr", status=2)
                self.assertIn(word, result.stderr)


if __name__ == "__main__":
    unittest.main()
