# SPDX-License-Identifier: BSD-3-Clause
"""paper_experiments on a moment of video; its table; its kinematics."""
import contextlib
import csv
import io
import json
import os
import pathlib
import tempfile
import unittest

import numpy as np

from evaluation import EvaluationError
from experiments import command, methods, summary

SOURCE_FOLDER = pathlib.Path(__file__).resolve().parents[2] / "scripts"


def switched_on(name):
    return os.environ.get(name, "OFF").upper() in ("ON", "TRUE", "1")


class Command(unittest.TestCase):
    def run_command(self, *arguments):
        """(exit code, what was printed)."""
        printed, complained = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(complained):
            code = command.main(list(arguments), SOURCE_FOLDER)
        return code, printed.getvalue(), complained.getvalue()

    def test_a_moment_of_the_experiments(self):
        programs = pathlib.Path(os.environ["SIMULATE_SCENE"]).parent
        chosen = ["ours"] + (["kinematics"] if switched_on("WITH_ROBOT") else []) + (
            ["fiducials"] if switched_on("WITH_FIDUCIALS") else [])
        experiments = "ab" if switched_on("WITH_ROBOT") else "a"
        with tempfile.TemporaryDirectory() as name:
            output = pathlib.Path(name) / "results"
            code, printed, complained = self.run_command(
                "--output", str(output), "--seeds", "1", "--seconds", "0.6", "--fps", "10", "--experiments", experiments,
                "--methods", ",".join(chosen), "--programs", str(programs), "--jobs", "1")
            self.assertEqual(code, 0, complained)
            for picture in ["figure_4.png", "figure_5.png"] + (["figure_6.png"] if "b" in experiments else []):
                self.assertEqual((output / picture).read_bytes()[:4], b"\x89PNG", picture)
            rows = json.loads((output / "summary.json").read_text())["summary"]
            with open(output / "summary.csv", newline="", encoding="utf-8") as file:
                self.assertEqual(len(list(csv.DictReader(file))), len(rows))
            found = {(row["experiment"], row["method"]): row for row in rows}
            self.assertLess(found["a", "ours"]["add_mm_median"], 3.0)
            self.assertEqual(("a", "kinematics") in found, False)
            if "b" in experiments:
                self.assertGreater(found["b", "kinematics"]["add_mm_max"], 0.0)  # it drifts from the first image on
                self.assertLess(found["b", "kinematics"]["add_mm_max"], 50.0)
            self.assertIn("this tracker", printed)
            self.assertFalse(list((output / "scenes").rglob("*.png")), "pictures are removed")

    def test_what_cannot_be_is_said(self):
        with tempfile.TemporaryDirectory() as name:
            code, _, complained = self.run_command("--output", name, "--methods", "magic")
            self.assertEqual(code, 1)
            self.assertIn("magic", complained)
            code, _, complained = self.run_command("--output", name, "--programs", name)
            self.assertEqual(code, 1)
            self.assertIn(name, complained)
            for wrong in (["--seeds", "0"], ["--experiments", "x"], ["--seconds", "nan"]):
                with self.assertRaises(SystemExit) as caught, contextlib.redirect_stderr(io.StringIO()):
                    command.parse(["--output", name] + wrong)
                self.assertEqual(caught.exception.code, 2)


class Methods(unittest.TestCase):
    def test_those_without_program_are_left_out_unless_asked_for(self):
        def find(name):
            if name == "track_pcl":
                raise EvaluationError("no program track_pcl")
            return pathlib.Path("/bin") / name

        chosen, warnings = methods.choose_methods(None, SOURCE_FOLDER, find)
        self.assertEqual([method.name for method, _ in chosen], ["ours", "paper", "beam", "fiducials", "kinematics"])
        self.assertEqual(len(warnings), 1)
        with self.assertRaises(EvaluationError):
            methods.choose_methods(["pcl"], SOURCE_FOLDER, find)


class Table(unittest.TestCase):
    class Group:
        letter, title, object_name, name = "b", "a robot", "bracket", "ours"

    def result(self, add, problem=""):
        class Result:
            scenario, method, seed = self.Group, self.Group, 1
        Result.figures = None if problem else {"add_mm_median": add, "measured_share": add / 10.0}
        Result.problem = problem
        return Result

    def test_median_and_worst(self):
        row = summary.summarise([self.result(add) for add in (1.0, 3.0, 2.0)] + [self.result(0.0, "it broke")])[0]
        self.assertEqual((row["add_mm_median"], row["add_mm_median_worst"]), (2.0, 3.0))
        self.assertEqual((row["measured_share"], row["measured_share_worst"]), (0.2, 0.1))
        self.assertEqual((row["seeds"], row["failed"]), (4, 1))
        self.assertIn("2 (3)", summary.as_text([row]))

    def test_all_failed(self):
        row = summary.summarise([self.result(0.0, "it broke")])[0]
        self.assertIn("failed", summary.as_text([row]))

    def test_nothing_known(self):
        row = summary.summarise([self.result(np.nan)])[0]
        self.assertIsNone(row["add_mm_median"])


if __name__ == "__main__":
    unittest.main()
