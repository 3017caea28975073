"""Integrals from the command line: their values, their files, and what is said of mistakes."""
import csv
import io
import json
import math
import re
import signal
import time
import unittest
from pathlib import Path

from program import SANITIZED, ProgramTest


class IntegrateTest(ProgramTest):
    def integrate(self, *arguments, **options):
        return self.run_program("integrate", *arguments, **options)

    def result(self, *arguments, **options):
        return json.loads(self.integrate(*arguments, "--json", **options).stdout)

    def assert_refused(self, arguments, *words):
        result = self.integrate(*arguments, status=2)
        self.assertEqual(result.stdout, "")
        for word in words:
            self.assertIn(word, result.stderr)
        return result.stderr


class Values(IntegrateTest):
    def test_the_first_line_is_the_value_with_its_error(self):
        first = self.integrate("4*x^3", "--over", "x=0:1", "--method", "uniform").stdout.splitlines()[0]
        self.assertRegex(first, r"^(0\.\d+|1\.\d+)\(\d\d\)$")
        digits = len(first.split(".")[1].split("(")[0])
        value, error = float(first.split("(")[0]), int(first[-3:-1]) * 10 ** -digits
        self.assertLess(abs(value - 1), 5 * error)
        self.assertEqual(self.integrate("4*x^3", "--over", "x=0:1", "--method", "uniform", "--quiet").stdout, first + "\n")

    def test_integrals_have_their_closed_forms(self):
        cases = [("exp(-x*y)", ["x=0:1,y=0:2"], 1.3193), ("1", ["disk:radius=2"], 4 * math.pi),
                 ("cos(theta)^2", ["sphere"], 4 * math.pi / 3), ("z", ["hemisphere"], math.pi),
                 ("1 + 0*x", ["hemisphere:measure=projected"], math.pi), ("x1", ["simplex:dimension=5"], 1 / 720),
                 ("x*y", ["triangle:a=(0,0),b=(1,0),c=(1,1)"], 1 / 8), ("exp(-x^2)", ["x=-inf:inf"], math.sqrt(math.pi)),
                 ("y", ["x=0:1,y=0:x"], 1 / 6), ("t*r^2", ["disk", "t=0:2"], math.pi),
                 ("x < 0.5 ? 1 : 0", ["x=0:pi/2"], 0.5), ("x1*x64", ["cube:dimension=64"], 0.25)]
        cases[0] = (*cases[0][:2], sum((-1) ** k * 2 ** (k + 1) / ((k + 1) * math.factorial(k + 1)) for k in range(40)))
        for text, over, truth in cases:
            with self.subTest(text=text, over=over):
                domain = [word for part in over for word in ("--over", part)]
                r = self.result(text, *domain, "--method", "uniform", "--samples", "200000")
                # Twelve decisions at 1e-3 in all: 4.1 standard errors of 31 degrees of freedom.
                self.assertLessEqual(abs(r["mean"] - truth), 4.6 * r["standard_error"] + 1e-12 * truth)
                self.assertLessEqual(r["interval"][0], r["mean"])

    def test_a_wrong_truth_would_be_found(self):
        r = self.result("z", "--over", "hemisphere", "--method", "uniform", "--samples", "200000")
        self.assertGreater(abs(r["mean"] - 1.01 * math.pi), 4.6 * r["standard_error"])

    def test_every_field_is_there(self):
        r = self.result("4*x^3", "--over", "x=0:1", "--method", "uniform", "--samples", "1e4", "--seed", "7")
        for key in ("mean standard_error interval confidence evaluations variance_of_one_sample seconds efficiency "
                    "chi2_per_dof q passes non_finite method reason stopped_because warnings seed version").split():
            self.assertIn(key, r)
        self.assertEqual((r["confidence"], r["seed"], r["method"], r["non_finite"]), (0.95, 7, "uniform", 0))
        self.assertAlmostEqual(r["variance_of_one_sample"], 9 / 7, delta=0.15)
        self.assertEqual(r["stopped_because"], "samples")

    def test_several_methods_make_a_table(self):
        arguments = ("4*x^3", "--over", "x=0:1", "--method", "uniform", "--method", "uniform:passes=64", "--samples", "1e4")
        lines = self.integrate(*arguments).stdout.splitlines()
        self.assertTrue(lines[0].startswith("method"))
        self.assertTrue(lines[1].startswith("uniform ") and lines[2].startswith("uniform:passes=64 "))
        self.assertEqual(len(self.result(*arguments)["results"]), 2)
        rows = list(csv.DictReader(io.StringIO(self.integrate(*arguments, "--csv").stdout)))
        self.assertEqual([row["method"] for row in rows], ["uniform", "uniform:passes=64"])
        self.assertLess(abs(float(rows[0]["mean"]) - 1), 0.1)

    def test_the_target_error_is_reached_or_missed_with_a_word(self):
        common = ("4*x^3", "--over", "x=0:1", "--method", "uniform", "--confidence", "90%")
        r = self.result(*common, "--target-error", "1%")
        self.assertEqual((r["stopped_because"], r["target_reached"], r["confidence"]), ("target-error", True, 0.9))
        self.assertLessEqual(r["interval"][1] - r["interval"][0], 2 * 0.01 * r["mean"])
        short = self.integrate(*common, "--target-error", "1e-7", "--samples", "1e5")
        self.assertIn("before the target", short.stderr)


class Files(IntegrateTest):
    BITS = ("mean", "standard_error", "interval", "variance_of_one_sample", "evaluations", "passes")

    def bits(self, result):
        return [result[key] for key in self.BITS]

    def test_the_bits_are_the_same_for_any_number_of_threads(self):
        one, two = (self.result("exp(-x*y)", "--over", "x=0:1,y=0:2", "--method", "uniform", "--threads", threads)
                    for threads in (1, 2))
        self.assertEqual(self.bits(one), self.bits(two))
        other = self.result("exp(-x*y)", "--over", "x=0:1,y=0:2", "--method", "uniform", "--seed", "1")
        self.assertNotEqual(self.bits(one), self.bits(other))

    def test_a_resumed_run_is_one_long_run_bit_for_bit(self):
        integral = ("exp(-x*y)", "--over", "x=0:1,y=0:2")
        long = self.result(*integral, "--method", "uniform:passes=64", "--samples", "64000")
        self.integrate(*integral, "--method", "uniform:passes=32", "--samples", "32000", "--save", "half.json")
        resumed = self.result("--resume", "half.json", "--samples", "32000", "--save", "half.json")
        self.assertEqual(self.bits(long), self.bits(resumed))
        self.assertEqual(self.bits(json.loads(self.run_program("merge", "half.json", "--json").stdout)), self.bits(long))

    def test_a_spent_budget_and_a_changed_integral_are_refused(self):
        self.integrate("x", "--over", "x=0:1", "--method", "uniform", "--save", "a.json")
        self.assert_refused(["--resume", "a.json"], "has used up its budget")
        self.assert_refused(["x^2", "--resume", "a.json", "--samples", "100"], "only the budget")
        self.assert_refused(["x", "--over", "x=0:1", "--save", "none/a.json"], "none/a.json", "no such folder")
        self.assert_refused(["--resume", "none.json"], "none.json", "cannot be read")
        (self.folder / "b.json").write_text("{}")
        self.assert_refused(["--resume", "b.json"], "b.json")
        damaged = (self.folder / "a.json").read_text().replace('"seed": 0', '"seed": 1', 1)
        (self.folder / "b.json").write_text(damaged)
        self.assert_refused(["--resume", "b.json"], "b.json", "it is damaged")

    def wait_for_handler(self, process):
        """Until the program is ready for SIGINT, as far as the system tells."""
        status = Path(f"/proc/{process.pid}/status")
        while process.poll() is None and status.exists():
            caught = re.search(r"SigCgt:\s*([0-9a-f]+)", status.read_text())
            if not caught or int(caught.group(1), 16) & 1 << (signal.SIGINT - 1):
                return
            time.sleep(0.005)

    def test_a_resumed_run_spends_its_time(self):
        self.integrate("x", "--over", "x=0:1", "--method", "uniform", "--time", "300ms", "--save", "a.json")
        before = json.loads(self.run_program("merge", "a.json", "--json").stdout)
        after = self.result("--resume", "a.json", "--time", "200ms")
        self.assertGreater(after["evaluations"], 1.05 * before["evaluations"])
        self.assertLess(after["seconds"] - before["seconds"], 2)

    def test_an_interrupted_run_states_what_it_has_and_continues_to_the_same_bits(self):
        integral = ("exp(-x*y)", "--over", "x=0:1,y=0:2", "--method", "uniform:passes=4096", "--samples", "33554432")
        for delay in 0.1, 0.4, 1.6:  # until there is a result, on a slow machine
            process = self.start("integrate", *integral, "--save", "part.json", "--json")
            self.wait_for_handler(process)
            time.sleep(delay)
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=60)
            if "interrupted before" not in err:
                break
        if process.returncode == 0:
            self.skipTest("the machine was too fast for the signal")
        self.assertEqual(process.returncode, 130, err)
        part = json.loads(out)
        self.assertEqual(part["stopped_because"], "stopped")
        self.assertLess(part["passes"], 4096)
        resumed = self.result("--resume", "part.json")
        self.assertEqual(self.bits(resumed), self.bits(self.result(*integral)))

    def test_runs_of_different_seeds_merge(self):
        integral = ("4*x^3", "--over", "x=0:1", "--method", "uniform", "--samples", "32000")
        parts = [self.result(*integral, "--seed", seed, "--save", f"{seed}.json") for seed in (1, 2)]
        merged = json.loads(self.run_program("merge", "1.json", "2.json", "-o", "both.json", "--json").stdout)
        self.assertAlmostEqual(merged["mean"], (parts[0]["mean"] + parts[1]["mean"]) / 2, delta=1e-15)
        self.assertEqual(merged["evaluations"], sum(part["evaluations"] for part in parts))
        self.assertLess(merged["standard_error"], parts[0]["standard_error"])
        again = json.loads(self.run_program("merge", "both.json", "--json").stdout)
        self.assertEqual(self.bits(again), self.bits(merged))
        self.assertIn("seed", self.run_program("merge", "1.json", "1.json", status=2).stderr)
        self.integrate("x", *integral[1:], "--save", "other.json")
        self.assertIn("integrand", self.run_program("merge", "1.json", "other.json", status=2).stderr)


class Densities(IntegrateTest):
    def assert_right(self, r, truth=1):
        self.assertLessEqual(abs(r["mean"] - truth), 5 * r["standard_error"] + 1e-12)

    def test_a_density_makes_importance_sampling_by_each_way_of_drawing(self):
        plain = self.result("4*x^3", "--over", "x=0:1", "--method", "uniform", "--samples", "1e5")
        for pdf in "2*x, inverse=sqrt(u)", "2*x", "2*x, sampling=table", "2*x, sampling=rejection, bound=2":
            with self.subTest(pdf=pdf):
                r = self.result("4*x^3", "--over", "x=0:1", "--pdf", pdf, "--samples", "1e5")
                self.assertEqual(r["method"], "importance")
                self.assert_right(r)
                # The variance of 2x^2 under 2x is 1/3, that of 4x^3 is 9/7.
                self.assertAlmostEqual(r["variance_of_one_sample"], 1 / 3, delta=0.03)
                self.assertLess(r["standard_error"], plain["standard_error"])
        self.assertAlmostEqual(r["acceptance"], 0.5, delta=0.01)

    def test_several_densities_make_mis(self):
        for heuristic in "balance", "power", "max", "cutoff":
            r = self.result("sqrt(x)+x^8", "--over", "x=0:1", "--pdf", "1.5*sqrt(x)", "--pdf", "9*x^8",
                            "--method", f"mis:heuristic={heuristic}", "--samples", "1e5")
            self.assert_right(r, 2 / 3 + 1 / 9)

    def test_a_density_that_is_wrong_is_refused_with_all_that_is_wrong(self):
        self.assert_refused(["x", "--over", "x=0:1", "--pdf", "3*x"], "integrates to 1.", "--normalize-pdf")
        self.assert_refused(["x", "--over", "x=0:1", "--pdf", "3*x-0.5"], "negative at x = ")
        self.assert_refused(["x", "--over", "x=0:1", "--pdf", "x<0.5 ? 2 : 0"], "misses 0.37", "--allow-missed")
        self.assert_right(self.result("4*x^3", "--over", "x=0:1", "--pdf", "3*x", "--normalize-pdf"))
        biased = self.integrate("x", "--over", "x=0:1", "--pdf", "x<0.5 ? 2 : 0", "--allow-missed", "--json")
        self.assertIn("misses", biased.stderr)
        self.assertAlmostEqual(json.loads(biased.stdout)["mean"], 1 / 8, delta=1e-3)

    def test_a_control_variate_takes_variance_away(self):
        common = ("exp(x)", "--over", "x=0:1", "--samples", "1e5")
        plain = self.result(*common, "--method", "uniform")
        r = self.result(*common, "--control", "1+x", "--control-integral", "3/2")
        self.assertEqual(r["method"], "control")
        self.assert_right(r, math.e - 1)
        self.assertLess(r["standard_error"], plain["standard_error"] / 4)

    def test_every_method_finds_the_integral_the_same_with_any_number_of_threads(self):
        methods = ["uniform", "stratified", "stratified:strata=latin", "antithetic", "qmc", "qmc:points=halton",
                   "qmc:points=lattice", "qmc:points=pmj02", "vegas", "miser", "ris", "metropolis", "auto"]
        arguments = ["exp(-x*y)", "--over", "x=0:1,y=0:2", "--target", "1+0*x", "--samples", "1e5"]
        for method in methods:
            arguments += ["--method", method]
        one, two = (self.result(*arguments, "--threads", threads)["results"] for threads in (1, 2))
        truth = sum((-1) ** k * 2 ** (k + 1) / ((k + 1) * math.factorial(k + 1)) for k in range(40))
        for method, a, b in zip(methods, one, two):
            with self.subTest(method=method):
                self.assert_right(a, truth)
                if method != "auto":  # it measures time
                    self.assertEqual([a[key] for key in Files.BITS], [b[key] for key in Files.BITS])

    def test_adaptive_runs_go_on_to_the_same_bits(self):
        for method in "vegas", "qmc", "stratified", "metropolis":
            with self.subTest(method=method):
                self.integrate("exp(-x*y)", "--over", "x=0:1,y=0:2", "--method", method, "--samples", "1e5", "--save", "a.json")
                first = self.result("--resume", "a.json", "--samples", "1e5", "--threads", "1")
                again = self.result("--resume", "a.json", "--samples", "1e5", "--threads", "2")
                self.assertEqual([first[key] for key in Files.BITS], [again[key] for key in Files.BITS])
                self.assertGreater(first["evaluations"], 150000)


class Mistakes(IntegrateTest):
    def test_a_mistake_is_shown_with_a_caret(self):
        text = self.assert_refused(["4*sinn(x)", "--over", "x=0:1"], 'did you mean "sin"')
        self.assertIn("\n    4*sinn(x)\n      ^~~~\n", text)

    def test_all_mistakes_are_reported_together(self):
        text = self.assert_refused(["x + width", "--over", "x=0:1,y=3:2", "--method", "vegs", "--method", "qmc:pints=sobol"],
                                   'did you mean "vegas"', 'did you mean "points"', "not below")
        self.assertGreaterEqual(len(re.findall("error:", text)), 3)

    def test_what_is_missing_is_named(self):
        self.assert_refused([], "an expression is missing")
        self.assert_refused(["x"], "--over")
        self.assert_refused(["x", "--over", "x=0:1", "--method", "control"], "--control-integral")
        self.assert_refused(["x", "--over", "x=0:1", "--control", "x"], "--control-integral")
        self.assert_refused(["x", "--over", "x=0:1", "--method", "importance"], "--pdf")
        self.assert_refused(["-x^2", "--over", "x=0:1"], "after --")

    def test_a_value_out_of_range_is_refused(self):
        for option, value in [("--samples", "1"), ("--samples", "many"), ("--time", "long"), ("--confidence", "1"),
                              ("--confidence", "200%"), ("--target-error", "0"), ("--seed", "-1"), ("--threads", "0")]:
            with self.subTest(option=option, value=value):
                self.assert_refused(["x", "--over", "x=0:1", f"{option}={value}"], f"{option}: takes", f'found "{value}"')

    def test_values_that_are_not_finite_are_counted_and_reported(self):
        run = self.integrate("x < 0.25 ? 1/0 : 1", "--over", "x=0:1", "--method", "uniform", "--samples", "1e5", "--json")
        r = json.loads(run.stdout)
        self.assertLess(abs(r["non_finite"] / r["evaluations"] - 0.25), 0.01)
        self.assertIn("not finite", run.stderr)
        self.assertEqual(r["warnings"][0]["kind"], "non-finite")

    def test_a_heavy_tail_is_found(self):
        r = self.result("1/sqrt(x)^1.9", "--over", "x=0:1", "--method", "uniform")
        self.assertTrue(r["heavy_tail"])
        self.assertIn("heavy-tail", [warning["kind"] for warning in r["warnings"]])
        self.assertFalse(self.result("exp(x)", "--over", "x=0:1", "--method", "uniform")["heavy_tail"])


class Doubts(IntegrateTest):
    def test_warnings_are_the_exit_status_where_strict_is_given(self):
        zero = ("0*x", "--over", "x=0:1", "--method", "uniform", "--samples", "1e4")
        r = self.result(*zero)
        self.assertEqual((r["mean"], r["standard_error"], r["interval"]), (0, None, None))
        self.assertEqual(r["warnings"][0]["kind"], "nothing-found")
        run = self.integrate(*zero, "--strict", "--save", "zero.json", status=1)
        self.assertEqual(run.stdout.splitlines()[0], "0(?)")
        self.run_program("merge", "zero.json", "--strict", status=1)
        self.integrate("x", "--over", "x=0:1", "--strict")
        divergent = self.integrate("1/x", "--over", "x=0:1", "--strict", "--method", "uniform", status=1)
        self.assertIn("may not exist", divergent.stderr)

    def test_methods_that_contradict_each_other_are_named(self):
        # A density that misses half of the domain makes one of the two wrong.
        arguments = ("x", "--over", "x=0:1", "--pdf", "x<0.5 ? 2 : 0", "--allow-missed", "--method", "importance",
                     "--method", "qmc", "--samples", "1e5")
        run = self.integrate(*arguments, "--json", "--strict", status=1)
        found = json.loads(run.stdout)["disagreements"]
        self.assertEqual([(d["first"], d["second"]) for d in found], [("importance", "qmc")])
        self.assertIn("importance and qmc disagree", run.stderr)
        agree = self.result("x", "--over", "x=0:1", "--method", "uniform", "--method", "qmc", "--samples", "1e5")
        self.assertEqual(agree["disagreements"], [])

    def test_a_control_integral_that_samples_rule_out_is_refused(self):
        common = ["exp(x)", "--over", "x=0:1", "--control", "1+x", "--control-integral"]
        self.assert_refused([*common, "1.51"], "--control-integral 1.51", "give 1.5000", "level 1e-06")
        self.integrate(*common, "3/2", "--samples", "1e4")

    def test_a_constant_is_printed_with_the_digits_that_a_double_has(self):
        run = self.integrate("3", "--over", "x=0:1", "--samples", "1e5")
        self.assertEqual(run.stdout.splitlines()[0], "3.000000000000000(3)")
        self.assertEqual(run.stderr, "")

    def test_text_and_json_state_the_same_error_of_a_constant(self):
        for method in "uniform", "stratified", "vegas", "qmc", "auto":
            with self.subTest(method):
                options = ["3", "--over", "x=0:1", "--samples", "1e5", "--method", method]
                value, error = re.fullmatch(r"([\d.]+)\((\d+)\)", self.integrate(*options, "--quiet").stdout.strip()).groups()
                unit = 10.0 ** -len(value.split(".")[1])
                stated = self.result(*options)
                self.assertEqual(float(value), stated["mean"])
                # Both are that of rounding: not below it, and to the digits that are shown the same.
                self.assertGreater(stated["standard_error"], 0)
                self.assertEqual(round(stated["standard_error"] / unit), int(error))
                table = self.integrate(*options, "--csv").stdout
                self.assertEqual(float(next(csv.DictReader(io.StringIO(table)))["standard_error"]), stated["standard_error"])

    def test_a_negative_value_before_the_two_dashes_is_what_is_complained_of(self):
        text = self.assert_refused(["--over", "x=0:1", "--samples", "-1", "--", "x"], "--samples: takes")
        self.assertNotIn('"--"', text)

    def test_a_domain_with_thousands_of_intervals_is_refused_at_once(self):
        over = ",".join(f"x{i}=0:1" for i in range(8000))
        text = self.assert_refused(["x0", "--over", over], "more than 64 dimensions")
        self.assertLess(len(text), 1000)

    def test_any_number_of_samples_takes_bounded_memory_and_ends_by_one_signal(self):
        for method in "stratified", "uniform", "auto":
            with self.subTest(method=method):
                process = self.start("integrate", "x", "--over", "x=0:1", "--method", method, "--samples", "1e13", "--threads", "1")
                Files.wait_for_handler(self, process)
                time.sleep(0.5)
                status = Path(f"/proc/{process.pid}/status").read_text()
                process.send_signal(signal.SIGINT)
                _, err = process.communicate(timeout=60)
                self.assertEqual(process.returncode, 130, err)
                if not SANITIZED:  # sanitizers keep more than that for themselves
                    self.assertLess(int(re.search(r"VmHWM:\s*(\d+)", status)[1]), 200_000)


if __name__ == "__main__":
    unittest.main()
