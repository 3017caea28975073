"""montelux render --integrator auto: chooses an integrator, says which and why, and continues with it."""
import json
import unittest

from program import ROOT, ProgramTest

INDIRECT = ROOT / "scenes" / "glossy-indirect" / "glossy-indirect.pbrt"


class Auto(ProgramTest):
    def render_image(self, *arguments, scene=INDIRECT, resolution="64x48"):
        return self.run_program("render", scene, "--resolution", resolution, *arguments)

    def stated(self, *arguments, **options):
        return json.loads(self.render_image("--integrator", "auto", *arguments, "--json", "--quiet", **options).stdout)

    def test_the_better_integrator_is_chosen_with_the_same_bytes_for_any_number_of_threads_and_after_a_stop(self):
        # Where pixels share samples, path needs fewer of them.
        options, size = ["--target-error", "20%", "--spp", 20000, "--filter-samples", "own", "--set", "among=restir-pt"], "160x120"
        stated = self.stated(*options, "--threads", 1, "--checkpoint", "1.film", "-o", "1.exr", resolution=size)
        choice = stated["choice"]
        self.assertEqual(choice["integrator"], "restir-pt")
        self.assertTrue(stated["target"]["reached"])
        self.assertTrue(0 < choice["pilots"] <= 0.05)
        low, high = choice["candidates"][0]["interval"]
        self.assertTrue(1 < low < choice["candidates"][0]["efficiency"] < high)
        again = self.stated(*options, "--threads", 2, "-o", "2.exr", resolution=size)
        self.assertEqual(again["choice"], choice)
        one, two = ((self.folder / f"{n}.exr").read_bytes() for n in (1, 2))
        self.assertTrue(one == two)
        self.assertIn(b"chosenBy", one)
        # The image is that of the chosen integrator, without any sample of the pilots.
        self.render_image(*options[:4], "--integrator", "restir-pt", "--quiet", "-o", "a.pfm", resolution=size)
        self.run_program("render", "--resume", "1.film", "--quiet", "-o", "b.pfm")
        self.assertTrue((self.folder / "a.pfm").read_bytes() == (self.folder / "b.pfm").read_bytes())
        # A film that is continued keeps the integrator and what was said of it, with and without the option.
        for option in [], ["--integrator", "auto"]:
            more = json.loads(self.run_program("render", "--resume", "1.film", *option, "--spp", 100, "--target-error", "15%", "--json",
                                               "--quiet", "-o", "c.pfm").stdout)
            self.assertEqual(more["choice"], choice)
            self.assertGreater(more["passes"], stated["passes"])

    def test_a_short_render_is_by_path_and_says_so(self):
        stated = self.stated("--spp", 16, "-o", "a.pfm")
        self.assertEqual((stated["choice"]["integrator"], stated["choice"]["pilots"]), ("path", 0))
        self.render_image("--spp", 16, "--integrator", "path", "--quiet", "-o", "b.pfm")
        self.assertTrue((self.folder / "a.pfm").read_bytes() == (self.folder / "b.pfm").read_bytes())
        result = self.render_image("--integrator", "auto", "--spp", 16, "-o", "a.pfm")
        self.assertIn("too short", result.stderr)
        self.assertIn("chosen   path: the render is too short for pilots\n", result.stdout)

    def test_limits_are_those_of_all_candidates(self):
        for setting in "maxcomponent=0.5", "maxdepth=2":
            stated = self.stated("--set", setting, "--spp", 64, "--set", "share=0.01", "-o", "a.pfm")
            self.assertIn(setting, stated["biased_options"])
            self.assertIn("choice", stated)

    def test_candidates_can_do_what_options_require(self):
        for options in ["--layers", "bounces:1"], ["--adaptive", "on"]:
            with self.subTest(options=options):
                stated = self.stated("--spp", 64, "--set", "among=restir-pt", *options, "-o", "a.exr")
                self.assertEqual(stated["choice"]["reason"], "no other integrator renders this image")
        stated = self.stated("--spp", 16, "--set", "among=restir-pt", "-o", "a.exr", scene=ROOT / "scenes" / "media" / "glass.pbrt")
        self.assertEqual(stated["choice"]["reason"], "no other integrator renders this image")
        stated = self.stated("--time", "1s", "--denoise", "-o", "a.exr")
        self.assertIn("choice", stated)
        frames = self.render_image("--integrator", "auto", "--frames", "0:1", "--spp", 8, "--json", "--quiet", "-o", "a.####.pfm").stdout
        self.assertEqual([json.loads(line)["choice"]["integrator"] for line in frames.splitlines()], ["path", "path"])

    def test_a_comparison_has_what_a_repeat_would_choose(self):
        stated = self.run_program("compare", INDIRECT, "--resolution", "32x24", "-a", "naive", "-b", "auto:sampler=halton", "--spp", 8, "--no-cache",
                                "--save", "a.json")
        self.assertIn("auto b is path: the render is too short for pilots, which its time does not include", stated.stdout + stated.stderr)
        self.assertIn("auto b=path:sampler=halton", (self.folder / "a.json").read_text())
        self.run_program("compare", "--resume", "a.json", "--repeats", 1)

    def test_what_cannot_be_combined_with_a_choice_is_refused(self):
        for options, message in (
                (["--passes", "0:1", "--checkpoint", "a.film"], "range of its passes"),
                (["--interactive-budget", "1s"], "time budget"),
                (["--measure-bias"], "state one to measure it"),
                (["--sampler", "uniform-grid"], "cannot choose"),
                (["--set", "among=pth"], "did you mean"),
                (["--set", "among=path:nee=on+sky-lerning=on"], "did you mean \"sky-learning\""),
                (["--set", "among=auto"], "its own candidates"),
                (["--set", "share=0.5"], "0.05")):
            with self.subTest(options=options):
                result = self.render("--integrator", "auto", *options, "-o", "a.exr", status=2)
                self.assertIn(message, result.stderr)
                self.assertEqual(result.stderr.count("error:"), 1)


if __name__ == "__main__":
    unittest.main()
