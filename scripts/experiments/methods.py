# SPDX-License-Identifier: BSD-3-Clause
"""The methods that are compared: which program runs, with which arguments."""
import dataclasses

from evaluation import EvaluationError
from evaluation.runs import Job, tracker_command
from evaluation.scene_plots import read_forward_kinematics


@dataclasses.dataclass
class Method:
    name: str
    title: str
    program: str = ""  # "" = no program: written here
    arguments: tuple = ()
    needs_robot: bool = False


def known_methods(config_folder):
    return [Method("ours", "this tracker", "track_sequence"),
            Method("paper", "the paper's filter (config/paper.yaml)", "track_sequence",
                   ("--config", str(config_folder / "paper.yaml"))),
            Method("beam", "this tracker, classical beam model", "track_sequence",
                   ("--config", str(config_folder / "beam.yaml"))),
            Method("fiducials", "AprilTags, stereo", "track_fiducials"),
            Method("kinematics", "forward kinematics, fixed grasp", needs_robot=True),
            Method("pcl", "PCL's particle filter", "track_pcl")]


def choose_methods(names, config_folder, find_program):
    """([(method, path of its program or None)], warnings). Without names: all whose program there is.

    find_program(name) gives the path or raises EvaluationError."""
    known = {method.name: method for method in known_methods(config_folder)}
    unknown = [name for name in names or [] if name not in known]
    if unknown:
        raise EvaluationError(f"--methods: {unknown[0]} is not known; known are {', '.join(known)}")
    chosen, warnings = [], []
    for name in names or known:
        try:
            program = known[name].program
            chosen.append((known[name], find_program(program) if program else None))
        except EvaluationError as error:
            if names or name == "ours":
                raise
            warnings.append(f"without {name}: {error}")
    return chosen, warnings


def write_kinematics(scene, csv):
    """fk.csv as estimates: where the robot's model has the object, with the true grasp offset of the first image."""
    poses = read_forward_kinematics(scene)
    if not poses:
        raise EvaluationError(f"{scene.folder} has no fk.csv")
    csv.parent.mkdir(parents=True, exist_ok=True)
    with open(csv, "w", encoding="utf-8") as file:
        file.write("scene_id,im_id,obj_id,score,R,t,time\n")
        for frame, T in sorted(poses.items()):
            rotation = " ".join(f"{x:.10g}" for x in T[:3, :3].ravel())
            translation = " ".join(f"{1e3 * x:.10g}" for x in T[:3, 3])
            file.write(f"{scene.scene_id},{frame},{scene.object_id},1,{rotation},{translation},0\n")


def make_job(method, program, scene, seed, csv, timeout_s):
    """What evaluation.runs.SceneScorer executes."""
    if not program:
        write_kinematics(scene, csv)
        return Job(scene, method.name, csv)
    if method.program == "track_fiducials":
        command = [str(program), str(scene.folder), "--output", str(csv), "--init", str(scene.init)]
    else:
        is_peer = method.program != "track_sequence"
        command = tracker_command(program, scene, seed, csv, list(method.arguments), False, is_peer)
    return Job(scene, method.name, csv, command, timeout_s)
