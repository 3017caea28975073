"""montelux render --target-error: ends at the requested error, says whether it is reached, and continues where it stopped."""
import json
import unittest

from program import SLOWNESS, ProgramTest, read_pfm


class Target(ProgramTest):
    def stated(self, *arguments, **options):
        return json.loads(self.render("--json", "--quiet", *arguments, **options).stdout)

    def test_the_render_ends_at_the_error_with_the_same_bytes_for_any_number_of_threads(self):
        for target in "12%", "pixels:25%@90%", "mean:0.5%", "denoised:12%":
            with self.subTest(target=target):
                stated = [self.stated("--target-error", target, "--spp", 4096, "--threads", n, "-o", f"{n}.exr")
                        for n in (1, 2)]
                result = stated[0]["target"]
                self.assertTrue(result["reached"])
                self.assertEqual((result["request"], result["confidence"], result["unbiased"]), (target, 0.95, False))
                self.assertLess(stated[0]["passes"] * stated[0]["samples_per_pass"], 4096)
                self.assertLess(result["error"], result["bound"])
                one, two = ((self.folder / f"{n}.exr").read_bytes() for n in (1, 2))
                self.assertEqual(one, two)
                self.assertIn(b"targetReached", one)

    def test_an_error_that_is_not_reached_says_how_much_more_it_takes(self):
        result = self.render("--target-error", "4%", "--spp", 64, "-o", "a.pfm").stdout
        self.assertRegex(result, r"target   4% not reached: with 95 % confidence the error is at most [\d.]+ %")
        self.assertRegex(result, r"it takes about [\d.]+ k? ?\([^)]*\) samples per pixel more, ")
        target = self.stated("--target-error", "4%", "--spp", 64, "-o", "a.pfm")["target"]
        self.assertFalse(target["reached"])
        self.assertGreater(target["bound"], 0.04)
        low, high = target["samples_needed_range"]
        self.assertTrue(0 < low < target["samples_needed"] < high)
        # As many do.
        more = self.stated("--target-error", "4%", "--spp", 65536, "-o", "a.pfm")
        samples = more["passes"] * more["samples_per_pass"] - 64
        self.assertTrue(more["target"]["reached"])
        self.assertTrue(low / 1.6 < samples < high * 1.6, f"{samples} {low} {high}")

    def test_a_time_may_be_the_most(self):
        stated = self.stated("--target-error", "0.1%", "--time", f"{0.7 * SLOWNESS}s", "-o", "a.pfm")
        self.assertFalse(stated["target"]["reached"])
        self.assertGreater(stated["target"]["seconds_needed"], 0)
        self.assertLess(stated["seconds"], 5 * SLOWNESS)

    def test_a_film_is_continued_to_its_error(self):
        whole = ["--target-error", "12%", "--spp", 4096]
        stated = self.stated(*whole, "--checkpoint", "whole.film", "-o", "whole.pfm")
        k = stated["samples_per_pass"]
        # The most samples end it at first.
        self.stated("--target-error", "12%", "--spp", 5 * k, "--samples-per-pass", k, "--checkpoint", "a.film", "-o", "a.pfm")
        result = json.loads(self.run_program("render", "--resume", "a.film", "--json", "--quiet", "-o", "b.pfm").stdout)
        self.assertTrue(result["target"]["reached"])
        self.assertEqual(result["passes"], stated["passes"])
        self.assertEqual(read_pfm(self.folder / "whole.pfm"), read_pfm(self.folder / "b.pfm"))

    def test_the_error_that_is_left_without_noise_takes_fewer_samples_and_continues(self):
        noisy = self.stated("--target-error", "8%", "--spp", 4096, "--filter-samples", "own", "-o", "noisy.pfm")
        whole = self.stated("--target-error", "denoised:8%", "--spp", 4096, "-o", "whole.exr", "-o", "whole.pfm")
        self.assertTrue(whole["target"]["reached"])
        self.assertAlmostEqual(whole["target"]["error"] ** 2 / whole["denoised"]["relative_mse"], 1, 12)
        self.assertLess(whole["samples"], 0.7 * noisy["samples"])
        self.assertIn(b"denoised.R", (self.folder / "whole.exr").read_bytes())
        k = whole["samples_per_pass"]
        self.stated("--target-error", "denoised:8%", "--spp", 5 * k, "--samples-per-pass", k, "--checkpoint", "a.film", "-o", "a.pfm")
        again = json.loads(self.run_program("render", "--resume", "a.film", "--json", "--quiet", "-o", "b.pfm").stdout)
        self.assertTrue(again["target"]["reached"])
        self.assertEqual(read_pfm(self.folder / "whole.pfm"), read_pfm(self.folder / "b.pfm"))
        self.stated("--target-error", "12%", "--spp", 4096, "--checkpoint", "other.film", "-o", "a.pfm")
        result = self.run_program("render", "--resume", "other.film", "--target-error", "denoised:8%", "-o", "b.pfm", status=2)
        self.assertIn("halves", result.stderr)

    def test_an_unbiased_render_has_other_samples_than_those_that_decide(self):
        stated = self.stated("--target-error", "12%", "--unbiased", "--spp", 4096, "--checkpoint", "a.film", "-o", "a.pfm")
        self.assertTrue(stated["target"]["unbiased"])
        # The image is that of as many samples without any target.
        self.stated("--spp", stated["passes"] * stated["samples_per_pass"], "--samples-per-pass", stated["samples_per_pass"], "-o", "b.pfm")
        self.assertEqual(read_pfm(self.folder / "a.pfm"), read_pfm(self.folder / "b.pfm"))
        again = json.loads(self.run_program("render", "--resume", "a.film", "--json", "--quiet", "-o", "c.pfm").stdout)
        self.assertEqual((again["passes"], again["target"]), (stated["passes"], {**stated["target"], **{
            key: again["target"][key] for key in ("seconds_needed", "seconds_needed_range")}}))
        self.assertEqual(read_pfm(self.folder / "a.pfm"), read_pfm(self.folder / "c.pfm"))

    def test_each_frame_of_a_sequence_has_its_error(self):
        lines = self.render("--frames", "0:1", "--target-error", "15%", "--spp", 4096, "--json", "--quiet", "-o", "a.####.pfm").stdout
        frames = [json.loads(line) for line in lines.splitlines()]
        self.assertEqual(len(frames), 2)
        for frame in frames:
            self.assertTrue(frame["target"]["reached"])

    def test_series_end_at_the_error(self):
        stated = self.stated("--target-error", "15%", "--integrator", "restir-di:frames=4", "--spp", 4096, "-o", "a.pfm")
        self.assertTrue(stated["target"]["reached"])
        self.assertLess(stated["passes"] * stated["samples_per_pass"], 4096)

    def test_adaptive_tiles_have_different_samples_and_the_same_bytes_for_any_number_of_threads(self):
        for options in (["--spp", 128], ["--target-error", "12%"], ["--target-error", "15%", "--unbiased"]):
            with self.subTest(options=options):
                # Of small tiles: where pixels share samples, the image has two large ones.
                stated = [self.stated(*options, "--adaptive", "on", "--filter-samples", "own", "--threads", n, "-o", f"{n}.exr")
                          for n in (1, 2)]
                one, two = ((self.folder / f"{n}.exr").read_bytes() for n in (1, 2))
                self.assertEqual(one, two)
                # More than those of the tile with the fewest passes.
                self.assertGreater(stated[0]["samples"], 64 * 48 * stated[0]["passes"] * stated[0]["samples_per_pass"])
        self.run_program("tonemap", "1.exr", "-o", "samples.png", "--layer", "samples")

    def test_renders_that_cannot_be_adaptive_are_refused(self):
        for options, message in (
                (["--adaptive", "maybe"], "on"),
                (["--adaptive", "on", "--integrator", "restir-di"], "share samples"),
                (["--adaptive", "on", "--sampler", "uniform-grid"], "one pass"),
                (["--adaptive", "on", "--passes", "0:3"], "range of passes")):
            with self.subTest(options=options):
                self.assertIn(message, self.render("--spp", 64, *options, "-o", "a.pfm", status=2).stderr)

    def test_requests_that_make_no_sense_are_refused(self):
        for options, message in (
                (["--target-error", "2"], "takes an error in percent"),
                (["--target-error", "two%"], "takes an error in percent"),
                (["--target-error", "0%"], "the error is from"),
                (["--target-error", "-1%"], "the error is from"),
                (["--target-error", "nan%"], "takes an error in percent"),
                (["--target-error", "pixels:5%"], "takes an error in percent"),
                (["--target-error", "pixels:5%@100%"], "the share of the pixels"),
                (["--target-error", "mean:5%@95%"], "takes an error in percent"),
                (["--target-error", "denoised:5%@95%"], "takes an error in percent"),
                (["--target-error", "denoized:5%"], "takes an error in percent"),
                (["--target-error", "2%", "--confidence", "1.5"], "--confidence"),
                (["--confidence", "0.9"], "--target-error"),
                (["--unbiased"], "--target-error"),
                (["--target-error", "2%", "--interactive-budget", "1s"], "--interactive-budget"),
                (["--target-error", "2%", "--passes", "0:3"], "--passes"),
                (["--target-error", "2%", "--preset", "none"], "--preset"),
                (["--target-error", "2%", "--sampler", "uniform-grid"], "same points in every pass")):
            with self.subTest(options=options):
                result = self.render(*options, "-o", "a.pfm", status=2)
                self.assertIn(message, result.stderr)
                self.assertFalse((self.folder / "a.pfm").exists())


if __name__ == "__main__":
    unittest.main()
