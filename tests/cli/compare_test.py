"""The verb compare of the program: its results, its refusals, and a clean end on a signal."""
import array
import base64
import csv
import json
import os
import pty
import re
import signal
import threading
import unittest

import program
from light_test import GLASS, POINT, ROOM
from program import ROOT, SCENE, ProgramTest

SMALL = ["--resolution", "16x12", "--seed", "3"]
# Pictures of a millisecond: another process that takes the processor meanwhile must not decide a result.
STEADY = ["--clock", "processor"]


class Compare(ProgramTest):
    def compare(self, *arguments, status=0, samples=4, repeats=4):
        program.ENVIRONMENT["XDG_CACHE_HOME"] = str(self.folder)
        return self.run_program("compare", SCENE, *SMALL, "--repeats", repeats, "--spp", samples, *arguments,
                                status=status)

    def test_every_figure_has_an_interval(self):
        result = self.compare("-a", "path", "-b", "naive", *STEADY, "--json", "--quiet")
        found = json.loads(result.stdout)
        self.assertEqual([m["name"] for m in found["methods"]], ["path", "naive"])
        for method in found["methods"]:
            self.assertEqual(method["repeats"], 4)
            self.assertEqual(method["samples"]["mean"], 4)
            figures = {key: method[key] for key in ("mse", "relative_mse", "flip", "seconds", "coverage",
                                                    "slope_by_samples")}
            for measure in "relmse", "mse", "flip":
                figures["efficiency by " + measure] = method["efficiency"][measure]
            for key, figure in figures.items():
                low, high = figure["interval"]
                self.assertLess(low, high, key)
                self.assertTrue(low <= figure["mean"] <= high, key)
        self.assertEqual(len(found["verdicts"]), 1)
        self.assertEqual(found["measure"], "relmse")
        self.assertLess(found["reference"]["share_of_smallest_error"]["relmse"], 0.25)

    def test_the_reference_is_kept(self):
        self.compare("-a", "path", "-b", "naive", *STEADY)
        self.assertEqual(len(list(self.folder.glob("montelux/reference-*.exr"))), 1)
        self.assertIn("stored by an earlier comparison", self.compare("-a", "path", "-b", "naive", *STEADY).stderr)

    def test_csv_has_a_line_for_every_repeat(self):
        lines = self.compare("-a", "path", "-b", "path:mis=balance", "--csv", "--quiet").stdout.splitlines()
        self.assertEqual(len(lines), 1 + 2 * 4)
        names = lines[0].split(",")
        self.assertIn("share_bounce1", names)
        shares = [i for i, name in enumerate(names) if name.startswith("share_bounce")]
        for line in lines[1:]:
            values = next(csv.reader([line]))
            self.assertAlmostEqual(sum(float(values[i]) for i in shares), 1, delta=1e-6)

    def test_variance_is_attributed_where_there_are_layers(self):
        result = self.compare("-a", "path", "-b", "tracepath", "--json")
        first, second = json.loads(result.stdout)["methods"]
        self.assertEqual(list(first["attribution"]), ["bounces", "light groups", "techniques"])
        for family in first["attribution"].values():
            self.assertAlmostEqual(sum(share["mean"] for share in family.values()), 1, delta=1e-9)
        self.assertIsNone(second["attribution"])
        self.assertIn("the variance of tracepath is not attributed", result.stderr)
        without = json.loads(self.compare("-a", "path", "-b", "naive", "--no-attribution", "--json").stdout)
        self.assertTrue(all(method["attribution"] is None for method in without["methods"]))

    def test_the_time_of_warm_up_does_not_count_for_warm_frames(self):
        methods = ["-a", "path", "-b", "restir-di:frames=1,warm-up=6"]
        found = json.loads(self.compare(*methods, *STEADY, "--warm-frames", "--json").stdout)
        self.assertFalse(found["warm_up_counts"])
        path, frames = found["methods"]
        self.assertEqual(path["warm_up_seconds"]["mean"], 0)
        self.assertEqual(path["seconds"], path["seconds_with_warm_up"])
        self.assertGreater(frames["warm_up_seconds"]["mean"], frames["seconds"]["mean"])
        self.assertAlmostEqual(frames["seconds"]["mean"] + frames["warm_up_seconds"]["mean"],
                               frames["seconds_with_warm_up"]["mean"], delta=1e-9)
        self.assertGreater(frames["efficiency"]["relmse"]["mean"], frames["efficiency_with_warm_up"]["relmse"]["mean"])
        verdict = found["verdicts"][0]
        self.assertLess(verdict["efficiency_ratio"]["relmse"]["mean"],
                        verdict["efficiency_ratio_with_warm_up"]["relmse"]["mean"])
        # Omissions are stated in every form of the results.
        result = self.compare(*methods, "--warm-frames", "-o", "report.html")
        self.assertRegex(result.stdout, r"not counted: \S+ m?s of warm-up in each repeat; efficiency including it")
        self.assertRegex(result.stdout, r"the warm-up of restir-di:\S+ is not counted: \S+ \(\S+ to \S+\) times including it")
        page = (self.folder / "report.html").read_text()
        for word in "including the warm-up", "frames of a sequence", "--warm-frames":
            self.assertIn(word, page)
        self.assertIn("warm_up_seconds", self.compare(*methods, "--warm-frames", "--csv").stdout.splitlines()[0])
        # By default all time counts.
        found = json.loads(self.compare(*methods, "--json").stdout)
        self.assertTrue(found["warm_up_counts"])
        self.assertEqual(found["methods"][1]["seconds"], found["methods"][1]["seconds_with_warm_up"])
        self.assertNotIn("warm-up of", self.compare(*methods).stdout)

    def test_the_clock_and_slopes_may_be_chosen(self):
        found = json.loads(self.compare("-a", "path", "-b", "naive", "--clock", "processor", "--no-slopes", "--json",
                                        "--save", "run.json").stdout)
        self.assertEqual(found["clock"], "processor")
        self.assertEqual(found["methods"][0]["convergence"], [])
        self.assertIsNone(found["methods"][0]["slope_by_samples"]["mean"])
        more = json.loads(self.run_program("compare", "--resume", "run.json", "--repeats", 2, "--json").stdout)
        self.assertEqual(more["clock"], "processor")
        self.assertEqual(more["methods"][0]["repeats"], 6)

    def test_a_saved_comparison_continues(self):
        self.run_program("render", SCENE, "--resolution", "16x12", "--spp", 256, "-o", "truth.exr", "--quiet")
        common = ["-a", "path", "-b", "path:mis=balance", "--reference", "truth.exr", "--json", "--quiet"]
        whole = json.loads(self.compare(*common, repeats=6).stdout)
        self.compare(*common, "--save", "run.json")
        more = self.run_program("compare", "--resume", "run.json", "--repeats", 2, "--json", "--quiet", "--save",
                                "run.json", "-o", "report.html")
        continued = json.loads(more.stdout)
        for one, other in zip(whole["methods"], continued["methods"]):
            self.assertEqual(other["repeats"], 6)
            for key in "mse", "flip", "bias_squared", "attribution", "slope_by_samples":
                self.assertEqual(one[key], other[key], key)
        self.assertTrue((self.folder / "report.html").exists())
        timed = json.loads(self.run_program("compare", "--resume", "run.json", "--time", "20ms", "--json",
                                            "--quiet").stdout)
        self.assertGreater(timed["methods"][0]["repeats"], 6)

    def test_a_comparison_is_resumed_with_what_it_was_begun_with(self):
        self.compare("-a", "path", "-b", "naive", "--save", "run.json")
        for arguments, word in [
            ([SCENE, "--resume", "run.json"], "only the budget"),
            (["--resume", "run.json", "-a", "path"], "only the budget"),
            (["--resume", "run.json", "--seed", "4"], "only the budget"),
            (["--resume", "run.json", "--warm-frames"], "only the budget"),
            (["--resume", "run.json", "--camera", "1"], "only the budget"),
            (["--resume", "run.json", "--animation", "1"], "only the budget"),
            (["--resume", "run.json", "--shutter", "0:1"], "only the budget"),
            (["--resume", "run.json", "--no-cache"], "only the budget"),
            (["--resume", "run.json", "--set", "maxdepth=3"], "only the budget"),
            (["--resume", "nowhere.json"], "cannot be read"),
            (["--save", "run.json"], "a scene is missing"),
        ]:
            with self.subTest(arguments=arguments):
                self.assertIn(word, self.run_program("compare", *arguments, status=2).stderr)

    def test_a_file_of_the_format_before_is_read(self):
        self.compare("-a", "path", "-b", "naive", "--save", "run.json")
        saved = json.loads((self.folder / "run.json").read_text())
        self.assertEqual(saved["version"], 5)
        # Version 4 had neither settings of all nor a measure, and 13 figures of a repeat.
        saved["version"] = 4
        del saved["options"]["settings"], saved["options"]["measure"], saved["checksum"]
        for method in saved["methods"]:
            for repeat in method["repeats"]:
                repeat["figures"] = base64.b64encode(base64.b64decode(repeat["figures"])[:8 * 13]).decode()
        text, checksum = json.dumps(saved, separators=(",", ":"), ensure_ascii=False), 0xcbf29ce484222325
        for byte in text.encode():
            checksum = (checksum ^ byte) * 0x100000001b3 & 0xffffffffffffffff
        saved["checksum"] = str(checksum)
        (self.folder / "old.json").write_text(json.dumps(saved))
        more = json.loads(self.run_program("compare", "--resume", "old.json", "--repeats", 2, "--json", "--save",
                                           "new.json").stdout)
        self.assertEqual(more["methods"][0]["repeats"], 6)
        self.assertEqual(more["measure"], "mse")  # that its verdicts were by
        # Its repeats do not know their passes, so each is one.
        self.assertEqual(more["methods"][0]["agreement"]["degrees_of_freedom"], 5)
        self.assertEqual(json.loads((self.folder / "new.json").read_text())["version"], 5)

    def test_a_comparison_is_of_one_moment_and_camera(self):
        program.ENVIRONMENT["XDG_CACHE_HOME"] = str(self.folder)
        scene = self.folder / "scene/moves.gltf"  # what is written beside a scene changes it
        scene.parent.mkdir()
        scene.write_text((ROOT / "scenes/clockwork/clockwork.gltf").read_text())
        common = ["-a", "path", "-b", "path:mis=balance", *SMALL, "--spp", 4, "--json"]
        for time in "0:0", "0.7:0.7":
            result = self.run_program("compare", scene, "--shutter", time, *common, "--repeats", 2, "--save", f"{time[:3]}.json")
            self.assertNotIn("stored by an earlier comparison", result.stderr)
        again = self.run_program("compare", scene, "--shutter", "0:0", *common, "--repeats", 2)
        self.assertIn("stored by an earlier comparison", again.stderr)
        # A continued comparison keeps its initial settings: the result equals that of a single run.
        whole = self.run_program("compare", scene, "--shutter", "0.7:0.7", *common, "--repeats", 4)
        more = self.run_program("compare", "--resume", "0.7.json", "--repeats", 2, "--json")
        for one, other in zip(json.loads(whole.stdout)["methods"], json.loads(more.stdout)["methods"]):
            # Except for the reference, which was read from a file.
            self.assertAlmostEqual(one["mse"]["mean"] / other["mse"]["mean"], 1, delta=1e-3)
        scene.write_text(scene.read_text() + " ")
        self.assertIn("has changed since",
                      self.run_program("compare", "--resume", "0.7.json", "--repeats", 2, status=2).stderr)

    def test_a_bad_reference_is_refused(self):
        self.run_program("render", SCENE, "--resolution", "16x12", "--spp", 8, "-o", "noisy.exr", "--quiet")
        result = self.compare("-a", "path", "-b", "path:mis=balance", "--reference", "noisy.exr", status=1, samples=16)
        self.assertIn("no verdict by this reference", result.stdout)
        self.assertIn("would decide the comparison", result.stderr)

    def reference_of(self, name, change):
        """A reference of 16 x 12 pixels with a change of its values."""
        values = [0.5] * (3 * 16 * 12)
        change(values)
        path = self.folder / name
        path.write_bytes(b"PF\n16 12\n-1.0\n" + array.array("f", values).tobytes())
        return path

    def test_a_reference_with_holes_is_refused(self):
        def holes(values):
            values[3 * (16 * 11 + 5)] = float("nan")  # PFM begins with the lowest row
            values[3 * 7 + 1] = float("inf")
        file = self.reference_of("holes.pfm", holes)
        result = self.compare("-a", "path", "-b", "naive", "--reference", file, "--json", status=2)
        self.assertIn("holes.pfm: the reference is not finite in 2 of 192 pixels, the first at 5, 0", result.stderr)
        self.assertEqual(result.stdout, "")
        self.compare("-a", "path", "-b", "naive", "--reference", self.reference_of("whole.pfm", lambda values: None))

    def test_what_is_not_known_is_said_and_never_printed_as_a_number(self):
        for arguments in (["--spp", 1], ["--spp", 1, "--reference", self.reference_of("a.pfm", lambda v: None)]):
            result = self.run_program("compare", SCENE, *SMALL, "--no-cache", "--repeats", 2, "-a", "path", "-b", "naive",
                                      "-o", "report.html", *arguments)
            self.assertNotRegex(result.stdout, r"\b-?(nan|inf)\b")
            self.assertIn("no 95 % intervals of its own, which need two passes", result.stdout)
            self.assertIn("too few repeats to tell whether its mean agrees with the reference", result.stdout)
            self.assertNotRegex((self.folder / "report.html").read_text().split('id="report-data">')[1].split("</script>")[0],
                                r"\b-?(nan|inf)\b")
        lines = self.run_program("compare", SCENE, *SMALL, "--no-cache", "--repeats", 2, "--spp", 1, "-a", "path", "-b",
                                 "naive", "--csv", "--quiet").stdout
        self.assertNotRegex(lines, r"\b-?(nan|inf)\b")

    def test_figures_have_two_digits_of_their_error(self):
        text = self.compare("-a", "path", "-b", "naive").stdout
        self.assertNotRegex(text, r"± \d+e")
        figures = re.findall(r"(-?\d+(?:\.(\d+))?) ± (\d+(?:\.(\d+))?)", text)
        self.assertGreater(len(figures), 10)
        for value, places, error, error_places in figures:
            self.assertEqual(len(places), len(error_places), f"{value} ± {error}")
            digits = error.replace(".", "").lstrip("0")
            self.assertTrue(len(digits) == 2 or not error_places, f"{value} ± {error}")

    def test_verdicts_go_by_the_measure(self):
        methods = ["-a", "fast=path", "-b", "path:mis=balance"]
        self.compare(*methods, "--save", "run.json", "--quiet")
        for measure, title in ("relmse", "relMSE"), ("mse", "MSE"), ("flip", "FLIP"):
            found = json.loads(self.compare(*methods, "--measure", measure, "--json", repeats=2).stdout)
            self.assertEqual(found["measure"], measure)
            verdict = found["verdicts"][0]
            self.assertEqual((verdict["first"], verdict["second"]), ("fast", "path:mis=balance"))
            self.assertIn(f"by {title}", verdict["sentence"].split(";")[0])
            low, high = verdict["efficiency_ratio"][measure]["interval"]
            self.assertEqual(verdict["decided"], low > 1 or high < 1)
            # A saved comparison may be judged by another measure.
            again = json.loads(self.run_program("compare", "--resume", "run.json", "--repeats", 1, "--measure", measure,
                                                "--json").stdout)
            self.assertEqual(again["measure"], measure)
            self.assertEqual(again["methods"][0]["name"], "fast")

    def test_methods_that_are_the_same_are_said_to_be(self):
        text = self.compare("-a", "path", "-b", "path", "-c", "path:mis=power").stdout
        self.assertIn("path (a) and path (b) are the same method with the same settings", text)
        # The default, typed.
        self.assertIn("path (a) and path:mis=power gave the same images bit for bit", text)

    def test_what_pictures_lack_is_named_for_each_method(self):
        ball = GLASS + '\nShape "sphere" "float radius" [ 0.5 ] "float nonsense" [ 1 ]'
        scene = self.folder / "room.pbrt"
        scene.write_text(ROOM.format(head='Integrator "sppm"\nSampler "zsobol"', world=POINT, ball=ball))
        common = ["compare", scene, *SMALL, "--lenient", "--no-cache", "--spp", 4, "--repeats", 2, "-a", "path", "-b",
                  "path:mis=balance,sampler=sobol"]
        light = "light of point lights through smooth surfaces (dielectric)"
        replaced = {"family": "sampler", "name": "zsobol", "by": "blue-noise"}
        result = self.run_program(*common, "--json", "--save", "run.json")
        resumed = self.run_program("compare", "--resume", "run.json", "--repeats", 1, "--json")
        for written in json.loads(result.stdout)["methods"], json.loads(resumed.stdout)["methods"]:
            self.assertEqual([m["missing_light"] for m in written], [[light], [light]])
            # What a method chooses itself is not replaced.
            self.assertEqual([m["replaced"] for m in written], [[replaced], []])
            for method in written:
                self.assertEqual(len(method["left_out"]), 1)
                self.assertIn("nonsense", method["left_out"][0])
        self.assertIn(f"path and path:mis=balance,sampler=sobol cannot find {light}", result.stderr)
        result = self.run_program(*common, "--quiet", "-o", "report.html")
        self.assertRegex(result.stdout, r"(?m)^left out: .*nonsense")
        first, second = re.split(r"(?m)^path:mis=balance,sampler=sobol$", result.stdout)
        self.assertIn(f"\n   missing  {light}\n   replaced sampler zsobol by blue-noise\n", first)
        self.assertIn(f"\n   missing  {light}\n", second)
        self.assertNotIn("   replaced", second)
        page = (self.folder / "report.html").read_text()
        for words in (f"path: missing: {light}; replaced: sampler zsobol by blue-noise.",
                      f"path:mis=balance,sampler=sobol: missing: {light}.", '"left out"'):
            self.assertIn(words, page)

    def test_methods_that_find_all_light_lack_nothing(self):
        result = self.compare("-a", "path:sampler=sobol", "-b", "naive:sampler=sobol", "--json")
        for method in json.loads(result.stdout)["methods"]:
            for key in "missing_light", "replaced", "left_out":
                self.assertEqual(method[key], [])
        self.assertNotIn("cannot find", result.stderr)

    def test_settings_of_all_methods(self):
        found = json.loads(self.compare("-a", "path", "-b", "naive", "-c", "path:maxdepth=1", "--set", "maxdepth=2",
                                        "--reference", self.reference_of("a.pfm", lambda v: None), "--json").stdout)
        self.assertEqual([m["biases"] for m in found["methods"]], [["maxdepth=2"], ["maxdepth=2"], ["maxdepth=1"]])
        self.assertEqual([m["name"] for m in found["methods"]], ["path", "naive", "path:maxdepth=1"])
        self.assertEqual(found["settings"], {"maxdepth": "2"})
        # Biases that all share do not keep them from making the reference.
        result = self.compare("-a", "path", "-b", "naive", "-c", "path:mis=balance", "--set", "maxdepth=2")
        self.assertIn("path, naive and path:mis=balance are biased: maxdepth=2", result.stderr)

    def test_how_long_it_takes_is_said_before(self):
        common = ["compare", SCENE, *SMALL, "--no-cache", "-a", "path", "-b", "naive", "--time", "0.4s", "--repeats", 4]
        # So short a time may leave no verdict.
        either = {"status": (0, 1)}
        result = self.run_program(*common, "--json", **either)
        self.assertRegex(result.stderr, r"(?m)^about \S+ m?s: pilots \S+ m?s, reference \S+ m?s, 4 repeats of 2 methods "
                                        r"with slopes and attribution \S+ m?s$")
        found = json.loads(result.stdout)
        self.assertGreater(found["predicted_seconds"], 0.8)  # two methods, all of their repeats
        self.assertGreater(found["seconds"], 0.8)
        self.assertEqual(self.run_program(*common, "--quiet", **either).stderr, "")
        self.assertIn("0.4 s for each method, 0.1 s in each of its repeats", self.run_program(*common, **either).stdout)

    def test_a_bar_runs_through_all_phases(self):
        main, terminal = pty.openpty()
        process = self.start("compare", SCENE, "--resolution", "64x48", "--no-cache", "-a", "path", "-b", "naive", "--spp", 32,
                             "--repeats", 3, stderr=terminal)
        os.close(terminal)
        shown = b""
        reading = threading.Thread(target=process.communicate)
        reading.start()
        try:
            while chunk := os.read(main, 65536):
                shown += chunk
        except OSError:
            pass  # the other end is closed
        reading.join()
        os.close(main)
        self.assertEqual(process.returncode, 0)
        text = shown.decode()
        for phase in "pilot of path", "reference by ", "repeat 1 of 3, ", "repeat 3 of 3, ":
            self.assertRegex(text, rf"\d+ % \[[= ]*\] \S+ m?s  left \S+ .*{phase}|\d+ % .*left .*{phase}")
        self.assertNotIn("left", self.run_program("compare", SCENE, *SMALL, "--no-cache", "-a", "path", "-b", "naive",
                                                  "--no-progress", "--spp", 2).stderr)

    def test_an_interrupt_before_the_reference_is_its_status(self):
        process = self.start("compare", SCENE, "--resolution", "320x240", "--no-cache", "-a", "path", "-b", "naive", "--spp",
                             8192)
        lines = [process.stderr.readline()]
        while " left " not in lines[-1]:  # the first line of progress
            lines.append(process.stderr.readline())
        self.assertRegex(lines[-1], "(timing|pilot) of (path|naive)")  # whichever a slow program has begun
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 130)
        self.assertEqual(out, "")
        self.assertIn("interrupted before there was a reference", err)

    def test_mistakes_are_named(self):
        for arguments, word in [
            (["-a", "path"], "at least two methods"),
            (["-a", "path", "-b", "pth"], 'did you mean "path"'),
            (["-a", "path", "-b", "path:sampler=sobl"], 'did you mean "sobol"'),
            (["-a", "path", "-b", "path:mis=best"], "balance, power, off"),
            (["-a", "direct", "-b", "ao"], "none of them can render a fair reference"),
            (["-a", "path,mis=balance", "-b", "naive"], "settings follow a colon"),
            (["-a", "x=path", "-b", "x=naive"], 'two methods are called "x"'),
            (["-a", "path", "-b", "naive", "--measure", "psnr"], "relmse, mse, flip"),
            (["-a", "path", "-b", "ao", "--set", "mis=balance"], 'ao: unknown setting'),
            (["-a", "path", "-b", "naive", "--set", "maxdepht=3"], 'did you mean "maxdepth"'),
            (["-a", "path", "-b", "restir-di", "--warm-frames"], "no method has warm-up frames"),
            (["-a", "path", "-b", "naive", "--clock", "sand"], "wall, processor"),
            (["-a", "path", "-b", "naive", "--reference", "nowhere.exr"], "nowhere.exr"),
        ]:
            with self.subTest(arguments=arguments):
                result = self.compare(*arguments, status=2)
                self.assertIn(word, result.stderr)
                self.assertEqual(result.stdout, "")


if __name__ == "__main__":
    unittest.main()
