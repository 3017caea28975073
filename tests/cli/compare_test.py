"""The verb compare of the program: its results, its refusals, and a clean end on a signal."""
import json
import unittest

import program
from program import ROOT, SCENE, ProgramTest

SMALL = ["--resolution", "16x12", "--seed", "3"]


class Compare(ProgramTest):
    def compare(self, *arguments, status=0, samples=4, repeats=4):
        program.ENVIRONMENT["XDG_CACHE_HOME"] = str(self.folder)
        return self.run_program("compare", SCENE, *SMALL, "--repeats", repeats, "--spp", samples, *arguments,
                                status=status)

    def test_every_figure_has_an_interval(self):
        result = self.compare("-a", "path", "-b", "naive", "--json", "--quiet")
        found = json.loads(result.stdout)
        self.assertEqual([m["label"] for m in found["methods"]], ["a", "b"])
        for method in found["methods"]:
            self.assertEqual(method["repeats"], 4)
            self.assertEqual(method["samples"]["mean"], 4)
            for key in ("mse", "relative_mse", "flip", "seconds", "efficiency", "coverage", "slope_by_samples"):
                low, high = method[key]["interval"]
                self.assertLess(low, high, key)
                self.assertTrue(low <= method[key]["mean"] <= high, key)
        self.assertEqual(len(found["verdicts"]), 1)
        self.assertLess(found["reference"]["share_of_smallest_mse"], 0.25)

    def test_the_reference_is_kept(self):
        self.compare("-a", "path", "-b", "naive")
        self.assertEqual(len(list(self.folder.glob("montelux/reference-*.exr"))), 1)
        self.assertIn("kept from an earlier comparison", self.compare("-a", "path", "-b", "naive").stderr)

    def test_csv_has_a_line_for_every_repeat(self):
        lines = self.compare("-a", "path", "-b", "path:mis=balance", "--csv", "--quiet").stdout.splitlines()
        self.assertEqual(len(lines), 1 + 2 * 4)
        names = lines[0].split(",")
        self.assertIn("share_bounce1", names)
        shares = [i for i, name in enumerate(names) if name.startswith("share_bounce")]
        for line in lines[1:]:
            values = line.replace('"', "").split(",")
            self.assertAlmostEqual(sum(float(values[i]) for i in shares), 1, delta=1e-6)

    def test_variance_is_attributed_where_there_are_layers(self):
        result = self.compare("-a", "path", "-b", "tracepath", "--json")
        first, second = json.loads(result.stdout)["methods"]
        self.assertEqual(list(first["attribution"]), ["bounces", "light groups", "techniques"])
        for family in first["attribution"].values():
            self.assertAlmostEqual(sum(share["mean"] for share in family.values()), 1, delta=1e-9)
        self.assertIsNone(second["attribution"])
        self.assertIn("tracepath) does not part its light into layers", result.stderr)
        without = json.loads(self.compare("-a", "path", "-b", "naive", "--no-attribution", "--json").stdout)
        self.assertTrue(all(method["attribution"] is None for method in without["methods"]))

    def test_the_time_of_warm_up_does_not_count_for_warm_frames(self):
        methods = ["-a", "path", "-b", "restir-di:chain=1,warm-up=6"]
        found = json.loads(self.compare(*methods, "--warm-frames", "--json").stdout)
        self.assertFalse(found["warm_up_counts"])
        path, frames = found["methods"]
        self.assertEqual(path["warm_up_seconds"]["mean"], 0)
        self.assertEqual(path["seconds"], path["seconds_with_warm_up"])
        self.assertGreater(frames["warm_up_seconds"]["mean"], frames["seconds"]["mean"])
        self.assertAlmostEqual(frames["seconds"]["mean"] + frames["warm_up_seconds"]["mean"],
                               frames["seconds_with_warm_up"]["mean"], delta=1e-9)
        self.assertGreater(frames["efficiency"]["mean"], frames["efficiency_with_warm_up"]["mean"])
        verdict = found["verdicts"][0]
        self.assertLess(verdict["efficiency_ratio"]["mean"], verdict["efficiency_ratio_with_warm_up"]["mean"])
        # What is left out is said, in every form of the results.
        result = self.compare(*methods, "--warm-frames", "-o", "report.html")
        self.assertRegex(result.stdout, r"not counted: \S+ s of warm-up in each repeat; with it efficiency")
        self.assertRegex(result.stdout, r"the warm-up of b is not counted: with it \S+ times \(between")
        page = (self.folder / "report.html").read_text()
        for word in "ratio with the time of warm-up", "frames of a sequence", "--warm-frames":
            self.assertIn(word, page)
        self.assertIn("warm_up_seconds", self.compare(*methods, "--warm-frames", "--csv").stdout.splitlines()[0])
        # By default all time counts.
        found = json.loads(self.compare(*methods, "--json").stdout)
        self.assertTrue(found["warm_up_counts"])
        self.assertEqual(found["methods"][1]["seconds"], found["methods"][1]["seconds_with_warm_up"])
        self.assertNotIn("warm-up of b", self.compare(*methods).stdout)

    def test_the_clock_and_slopes_may_be_chosen(self):
        found = json.loads(self.compare("-a", "path", "-b", "naive", "--clock", "processor", "--no-slopes", "--json",
                                        "--save", "run.json").stdout)
        self.assertEqual(found["clock"], "processor")
        self.assertEqual(found["methods"][0]["convergence"], [])
        self.assertIsNone(found["methods"][0]["slope_by_samples"]["mean"])
        more = json.loads(self.run_program("compare", "--resume", "run.json", "--repeats", 2, "--json").stdout)
        self.assertEqual(more["clock"], "processor")
        self.assertEqual(more["methods"][0]["repeats"], 6)

    def test_a_saved_comparison_goes_on(self):
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
            (["--resume", "nowhere.json"], "cannot be read"),
            (["--save", "run.json"], "a scene is missing"),
        ]:
            with self.subTest(arguments=arguments):
                self.assertIn(word, self.run_program("compare", *arguments, status=2).stderr)

    def test_a_comparison_is_of_one_moment_and_camera(self):
        program.ENVIRONMENT["XDG_CACHE_HOME"] = str(self.folder)
        scene = self.folder / "scene/moves.gltf"  # what is written beside a scene changes it
        scene.parent.mkdir()
        scene.write_text((ROOT / "scenes/clockwork/clockwork.gltf").read_text())
        common = ["-a", "path", "-b", "path:mis=balance", *SMALL, "--spp", 4, "--json"]
        for time in "0:0", "0.7:0.7":
            result = self.run_program("compare", scene, "--shutter", time, *common, "--repeats", 2, "--save", f"{time[:3]}.json")
            self.assertNotIn("kept from an earlier comparison", result.stderr)
        again = self.run_program("compare", scene, "--shutter", "0:0", *common, "--repeats", 2)
        self.assertIn("kept from an earlier comparison", again.stderr)
        # What goes on is of the moment that it was begun with: the same as all at once.
        whole = self.run_program("compare", scene, "--shutter", "0.7:0.7", *common, "--repeats", 4)
        more = self.run_program("compare", "--resume", "0.7.json", "--repeats", 2, "--json")
        for one, other in zip(json.loads(whole.stdout)["methods"], json.loads(more.stdout)["methods"]):
            # But for the reference, which was read from a file.
            self.assertAlmostEqual(one["mse"]["mean"] / other["mse"]["mean"], 1, delta=1e-3)
        scene.write_text(scene.read_text() + " ")
        self.assertIn("has changed since",
                      self.run_program("compare", "--resume", "0.7.json", "--repeats", 2, status=2).stderr)

    def test_a_bad_reference_is_refused(self):
        self.run_program("render", SCENE, "--resolution", "16x12", "--spp", 8, "-o", "noisy.exr", "--quiet")
        result = self.compare("-a", "path", "-b", "path:mis=balance", "--reference", "noisy.exr", status=1, samples=16)
        self.assertIn("no verdict by this reference", result.stdout)
        self.assertIn("would decide the comparison", result.stderr)

    def test_mistakes_are_named(self):
        for arguments, word in [
            (["-a", "path"], "at least two methods"),
            (["-a", "path", "-b", "pth"], 'did you mean "path"'),
            (["-a", "path", "-b", "path:sampler=sobl"], 'did you mean "sobol"'),
            (["-a", "path", "-b", "path:mis=best"], "balance, power, off"),
            (["-a", "direct", "-b", "ao"], "none of them can make the reference"),
            (["-a", "path", "-b", "restir-di", "--warm-frames"], "no method has frames of warm-up"),
            (["-a", "path", "-b", "naive", "--clock", "sand"], "wall, processor"),
            (["-a", "path", "-b", "naive", "--reference", "nowhere.exr"], "nowhere.exr"),
        ]:
            with self.subTest(arguments=arguments):
                result = self.compare(*arguments, status=2)
                self.assertIn(word, result.stderr)
                self.assertEqual(result.stdout, "")


if __name__ == "__main__":
    unittest.main()
