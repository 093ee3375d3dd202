# SPDX-License-Identifier: BSD-3-Clause
"""Runs a tracker program over scenes, and scores what it or somebody else wrote."""
import concurrent.futures
import dataclasses
import pathlib
import subprocess

from . import EvaluationError
from .estimates import load_run, occlusion_folder
from .mesh_points import load_points
from .occlusion_score import score_pictures
from .pose_errors import PoseErrorMeter
from .scenes import load_truth
from .sequence_score import make_table, score_run
from .symmetries import load_symmetries


@dataclasses.dataclass
class Job:
    """One seed of one scene. command: None when the estimates are there already."""
    scene: object
    label: str  # the seed, or the file's name
    csv: pathlib.Path
    command: list = None
    timeout_s: float = 600.0


@dataclasses.dataclass
class Outcome:
    """figures and table are None when the run failed; problem says why."""
    job: Job
    figures: dict = None
    table: object = None
    roc: object = None
    problem: str = ""
    warnings: list = dataclasses.field(default_factory=list)
    machine: dict = dataclasses.field(default_factory=dict)


def tracker_command(program, scene, seed, csv, options, has_masks, is_peer):
    """Command line of track_sequence (or a peer, which has no trace and no occlusion pictures)."""
    command = [str(program), str(scene.folder), "--seed", str(seed), "--output", str(csv),
               "--object-id", str(scene.object_id), "--mesh", str(scene.mesh), "--mesh-scale", repr(scene.mesh_scale)]
    if scene.models_info:
        command += ["--models-info", str(scene.models_info)]
    if scene.init and "--init" not in options:
        command += ["--init", str(scene.init)]
    if not is_peer:
        command += ["--trace", str(csv.with_suffix(".jsonl"))]
        if has_masks:
            command += ["--occlusion-dir", str(csv.with_name(csv.stem + "_occlusion"))]
    return command + list(options)


def bag_command(program, scene, seed, csv, options):
    """Command line of track_bag."""
    return [str(program), str(scene.bag), "--object", str(scene.object_file), "--seed", str(seed), "--num-threads", "1",
            "--output", str(csv), "--trace", str(csv.with_suffix(".jsonl")), *options]


def _run_program(job):
    """Warnings of the program. Raises EvaluationError with the reason when it fails."""
    job.csv.parent.mkdir(parents=True, exist_ok=True)
    for stale in (job.csv, job.csv.with_suffix(".jsonl")):
        stale.unlink(missing_ok=True)
    try:
        finished = subprocess.run(job.command, capture_output=True, text=True, errors="replace", check=False,
                                  timeout=job.timeout_s)
    except subprocess.TimeoutExpired:
        raise EvaluationError(f"stopped after {job.timeout_s:g} s (--timeout)") from None
    except OSError as error:
        raise EvaluationError(f"cannot run {job.command[0]}: {error.strerror}") from error
    job.csv.with_suffix(".log").write_text(finished.stdout + finished.stderr, encoding="utf-8")
    lines = [line for line in finished.stderr.splitlines() if line.strip()]
    if finished.returncode != 0:
        how = f"signal {-finished.returncode}" if finished.returncode < 0 else f"exit code {finished.returncode}"
        raise EvaluationError(f"{how}: {lines[-1] if lines else 'no message'}")
    return lines


def _score(job, truth, meter):
    run = load_run(job.csv, job.scene)
    if not any(frame in truth.poses for frame in run.frames):
        raise EvaluationError(f"{job.csv} has no frame in common with the ground truth of {job.scene.folder}")
    table = make_table(truth, run, meter)
    folder = occlusion_folder(job.csv)
    masks = {frame: mask for frame, mask in truth.masks.items() if frame in set(run.frames)}
    roc, timer = score_pictures(masks, folder) if masks and folder else (None, None)
    figures = score_run(table, roc, timer)
    figures["scene_frames"] = len(truth.frames)
    return Outcome(job, figures, table, roc, machine=run.machine)


class SceneScorer:
    """Ground truth and model of a scene, read once for all its runs."""

    def __init__(self, scene):
        self.truth = load_truth(scene)
        self.symmetries = load_symmetries(scene.models_info, scene.object_id, scene.mesh_scale)
        self._meter = PoseErrorMeter(load_points(scene.mesh, scene.mesh_scale), self.symmetries)

    def execute(self, job):
        """Never raises for what a run may do wrong: the Outcome says it."""
        try:
            warnings = _run_program(job) if job.command else []
            outcome = _score(job, self.truth, self._meter)
            outcome.warnings = warnings
            return outcome
        except (EvaluationError, OSError, ValueError) as error:
            return Outcome(job, problem=str(error))


def execute_all(scenes, scorers, make_jobs, num_jobs, on_done):
    """Runs make_jobs(scene, truth) of every scene, num_jobs at a time. Calls on_done(scene, outcomes, done, total) in the
    order of the scenes, and on_done(None, None, done, total) after each run. scorers, result: {scene name: ...}."""
    jobs = {scene.name: make_jobs(scene, scorers[scene.name].truth) for scene in scenes}
    total = sum(len(entries) for entries in jobs.values())
    results, done = {}, 0
    with concurrent.futures.ThreadPoolExecutor(num_jobs) as pool:
        pending = {name: [pool.submit(scorers[name].execute, job) for job in entries] for name, entries in jobs.items()}
        try:
            for scene in scenes:
                outcomes = []
                for future in pending[scene.name]:
                    outcomes.append(future.result())
                    done += 1
                    on_done(None, None, done, total)
                results[scene.name] = outcomes
                on_done(scene, outcomes, done, total)
        except KeyboardInterrupt:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return results
