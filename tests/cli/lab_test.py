#!/usr/bin/env python3
"""montelux lab: what it lists, writes and returns."""
import json
import unittest

from program import ProgramTest


class LabTest(ProgramTest):
    def test_list_names_experiments_of_every_document(self):
        text = self.run_program("lab", "list").stdout
        for name in ("running-estimate", "square-light", "neighbour-bias", "roulette", "metropolis"):
            self.assertIn(name, text)
        entries = json.loads(self.run_program("lab", "list", "--json").stdout)
        self.assertEqual(len({entry["group"] for entry in entries}), 6)
        self.assertIn("Settings", self.run_program("lab", "list", "circle").stdout)

    def test_run_writes_a_report_with_data_and_figures(self):
        result = self.run_program("lab", "run", "circle", "-o", "out", "--json", "--set", "samples=20000")
        summary = json.loads(result.stdout)
        self.assertTrue(summary["passed"])
        self.assertEqual([one["name"] for one in summary["experiments"]], ["circle"])
        for name in ("report.json", "circle/radius.svg", "circle/radius.csv"):
            self.assertTrue((self.folder / "out" / name).is_file(), name)
        report = json.loads((self.folder / "out" / "report.json").read_text())
        self.assertEqual(report["reports"][0]["name"], "circle")
        if summary["page"]:
            self.assertIn("<!doctype html>", (self.folder / "out" / "report.html").read_text()[:100])

    def test_a_planted_fault_makes_the_exit_status_1(self):
        result = self.run_program("lab", "run", "roulette", "-o", "out", "--fault", status=1)
        self.assertIn("FAILS", result.stdout)

    def test_bad_input_is_explained_and_makes_the_exit_status_2(self):
        for arguments, words in ((("run", "circel", "-o", "out"), "did you mean \"circle\""),
                                 (("run", "circle"), "-o DIR"),
                                 (("run",), "an experiment is missing"),
                                 (("jog", "circle"), "list"),
                                 (("run", "circle", "-o", "out", "--set", "sample=3"), "samples"),
                                 (("run", "all", "-o", "out", "--set", "samples=3"), "single experiment"),
                                 (("list", "circel"), "circle")):
            self.assertIn(words, self.run_program("lab", *arguments, status=2).stderr)


if __name__ == "__main__":
    unittest.main()
