# SPDX-License-Identifier: BSD-3-Clause
"""paper_experiments on a moment of video; its scenes and table."""
import contextlib
import csv
import io
import json
import os
import pathlib
import shutil
import tempfile
import types
import unittest
from unittest import mock

import numpy as np

from evaluation import EvaluationError
from experiments import command, experiment, methods, scenarios, summary

SOURCE_FOLDER = pathlib.Path(__file__).resolve().parents[2] / "scripts"
CONFIG_FOLDER = SOURCE_FOLDER.parent / "config"


def switched_on(name):
    return os.environ.get(name, "OFF").upper() in ("ON", "TRUE", "1")


class Command(unittest.TestCase):
    def run_command(self, *arguments):
        """(exit code, what was printed)."""
        printed, complained = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(complained):
            code = command.main(list(arguments), SOURCE_FOLDER)
        return code, printed.getvalue(), complained.getvalue()

    def test_a_moment_of_an_experiment(self):
        """Three images of the experiment that has all methods, through every program to table and figures."""
        programs = pathlib.Path(os.environ["SIMULATE_SCENE"]).parent
        with_robot = switched_on("WITH_ROBOT")
        letter, figure = ("b", "figure_6.png") if with_robot else ("a", "figure_5.png")
        chosen = ["ours"] + (["kinematics"] if with_robot else []) + (["fiducials"] if switched_on("WITH_FIDUCIALS") else [])
        with tempfile.TemporaryDirectory() as name:
            output = pathlib.Path(name) / "results"
            code, printed, complained = self.run_command(
                "--output", str(output), "--seeds", "1", "--seconds", "0.6", "--fps", "5", "--experiments", letter,
                "--methods", ",".join(chosen), "--programs", str(programs), "--jobs", "1")
            self.assertEqual(code, 0, complained)
            for picture in ["figure_4.png", figure]:
                self.assertEqual((output / picture).read_bytes()[:4], b"\x89PNG", picture)
            rows = json.loads((output / "summary.json").read_text())["summary"]
            with open(output / "summary.csv", newline="", encoding="utf-8") as file:
                self.assertEqual(len(list(csv.DictReader(file))), len(rows))
            found = {row["method"]: row for row in rows if row["experiment"] == letter}
            self.assertEqual(sorted(found), sorted(chosen))
            self.assertLess(found["ours"]["add_mm_median"], 3.0)
            if with_robot:
                self.assertGreater(found["kinematics"]["add_mm_max"], 0.0)  # it drifts from the first image on
                self.assertLess(found["kinematics"]["add_mm_max"], 50.0)
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


class Scenes(unittest.TestCase):
    def simulate(self, folder, seed=1, seconds=1.0):
        """How often the program ran; it only says that it has."""
        program = folder / "simulate_scene"
        program.write_text('#!/bin/sh\nmkdir -p "$1/depth" && echo "$@" >> "$1.calls"\n', encoding="utf-8")
        program.chmod(0o755)
        options = types.SimpleNamespace(seconds=seconds, fps=10.0, timeout=20.0)
        for scenario in scenarios.scenarios(CONFIG_FOLDER):
            scene = folder / f"{scenario.letter}_scene"
            scenarios.simulate(program, scenario, seed, scene, options, CONFIG_FOLDER, True)
            self.assertTrue((scene / "depth").is_dir())
        return [len((folder / f"{letter}_scene.calls").read_text().splitlines()) for letter in "abc"]

    def test_a_scene_that_was_kept_is_used_again_unless_the_settings_differ(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            self.assertEqual(self.simulate(folder), [1, 1, 1])
            self.assertEqual(self.simulate(folder), [1, 1, 1])
            self.assertEqual(self.simulate(folder, seconds=2.0), [2, 2, 2])
            shutil.rmtree(folder / "b_scene/depth")
            self.assertEqual(self.simulate(folder, seconds=2.0), [2, 3, 2])

    def test_what_the_experiments_need_is_there(self):
        for scenario in scenarios.scenarios(CONFIG_FOLDER):
            for kind in ("objects", "fiducials"):
                self.assertTrue((CONFIG_FOLDER / kind / f"{scenario.object_name}.yaml").is_file(), scenario.title)
            if "--robot" in scenario.arguments:
                self.assertTrue(pathlib.Path(scenario.arguments[scenario.arguments.index("--robot") + 1]).is_file())
            self.assertEqual(scenario.has_robot, "--robot" in scenario.arguments)


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


    def test_a_human_has_no_kinematics(self):
        chosen = [(method, None) for method in methods.known_methods(CONFIG_FOLDER) if method.name in ("ours", "kinematics")]
        options = types.SimpleNamespace(output=pathlib.Path("/nowhere"), keep_scenes=True, timeout=1.0)
        part = "experiments.experiment."
        with mock.patch(part + "simulate"), mock.patch(part + "plain_scene"), mock.patch(part + "make_job"), \
                mock.patch(part + "SceneScorer") as scorer:
            scorer.return_value.execute.return_value.problem = "not run"
            ran = {scenario.letter: [result.method.name for result in
                                     experiment.run_scene(scenario, 1, chosen, None, options, CONFIG_FOLDER)]
                   for scenario in scenarios.scenarios(CONFIG_FOLDER)}
        self.assertEqual(ran, {"a": ["ours"], "b": ["ours", "kinematics"], "c": ["ours", "kinematics"]})


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
