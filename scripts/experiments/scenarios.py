# SPDX-License-Identifier: BSD-3-Clause
"""The paper's three experiments as simulated scenes."""
import dataclasses
import json
import shutil
import subprocess

from evaluation import EvaluationError


@dataclasses.dataclass
class Scenario:
    """letter: as in the paper's section V; figure: where the paper draws it."""
    letter: str
    title: str
    figure: str
    object_name: str
    arguments: list  # of simulate_scene
    has_robot: bool


def scenarios(config_folder):
    robot = ["--robot", str(config_folder / "robots/arm.urdf")]
    return [Scenario("a", "a human moves the object", "figure_5", "drill", ["--scenario", "human"], False),
            Scenario("b", "a robot holds it, secure grasp", "figure_6", "bracket", ["--scenario", "robot"] + robot, True),
            Scenario("c", "a robot holds it, a human disturbs it in the hand", "figure_7", "mug",
                     ["--scenario", "slip"] + robot, True)]


def _command(program, scenario, seed, folder, options, config_folder, with_stereo):
    command = [str(program), str(folder), "--object", str(config_folder / "objects" / f"{scenario.object_name}.yaml"),
               "--frames", str(round(options.seconds * options.fps)), "--fps", repr(options.fps), "--seed", str(seed),
               "--occlusion-every", "1000000"] + scenario.arguments
    if with_stereo:
        command += ["--fiducials", str(config_folder / "fiducials" / f"{scenario.object_name}.yaml")]
    return command


def _is_there(made_by, command):
    """Whether the scene was made by the same command and its pictures were kept."""
    try:
        return json.loads(made_by.read_text(encoding="utf-8")) == command and (made_by.parent / "depth").is_dir()
    except (OSError, ValueError):
        return False


def simulate(program, scenario, seed, folder, options, config_folder, with_stereo):
    """Writes the scene, with grey stereo pictures if asked for; keeps one that is there (--keep-scenes) if made the same way.

    Raises EvaluationError with the program's message."""
    command = _command(program, scenario, seed, folder, options, config_folder, with_stereo)
    made_by = folder / "made_by.json"
    if _is_there(made_by, command):
        return
    shutil.rmtree(folder, ignore_errors=True)
    try:
        finished = subprocess.run(command, capture_output=True, text=True, check=False, timeout=options.timeout)
    except subprocess.TimeoutExpired:
        raise EvaluationError(f"{folder}: simulate_scene was stopped after {options.timeout:g} s (--timeout)") from None
    if finished.returncode != 0:
        raise EvaluationError(f"{folder}: simulate_scene failed: {(finished.stderr.strip().splitlines() or ['no message'])[-1]}")
    made_by.write_text(json.dumps(command) + "\n", encoding="utf-8")
