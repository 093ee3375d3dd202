# SPDX-License-Identifier: BSD-3-Clause
"""Simulates one scene and runs every method over it."""
import dataclasses
import shutil

import numpy as np

from evaluation.estimates import load_run
from evaluation.runs import SceneScorer
from evaluation.scenes import plain_scene
from evaluation.statistics import percentile, share

from .methods import make_job
from .scenarios import simulate


@dataclasses.dataclass
class Result:
    """One method on one scene; figures and table are None when it failed: problem says why."""
    scenario: object
    seed: int
    method: object
    figures: dict = None
    table: object = None
    problem: str = ""


def _figures(outcome, run):
    figures = {name: outcome.figures[name] for name in
               ("add_mm_median", "add_mm_p95", "add_mm_max", "translation_mm_median", "rotation_deg_median", "lost_frames",
                "frames", "time_ms_median")}
    # Fiducials say by their score what others say by a state: 1 = tags seen, less = predicted, 0 = lost.
    measured = run.scores >= 1.0
    figures["measured_share"] = share(measured) if outcome.job.label == "fiducials" else float("nan")
    figures["measured_add_mm_median"] = (1e3 * percentile(np.asarray(outcome.table.add)[measured], 50)
                                         if outcome.job.label == "fiducials" else float("nan"))
    return figures


def run_scene(scenario, seed, methods, simulator, options, config_folder):
    """[Result], one per method that applies. The pictures are removed afterwards unless options.keep_scenes."""
    folder = options.output / "scenes" / f"{scenario.letter}_{seed}"
    with_stereo = any(method.name == "fiducials" for method, _ in methods)
    simulate(simulator, scenario, seed, folder, options, config_folder, with_stereo)
    scene = plain_scene(folder)
    scorer = SceneScorer(scene)
    results = []
    for method, program in methods:
        if method.needs_robot and not scenario.has_robot:
            continue
        csv = options.output / "estimates" / folder.name / f"{method.name}.csv"
        outcome = scorer.execute(make_job(method, program, scene, seed, csv, options.timeout))
        result = Result(scenario, seed, method, problem=outcome.problem)
        if not outcome.problem:
            result.table = outcome.table
            result.figures = _figures(outcome, load_run(csv, scene))
        results.append(result)
    if not options.keep_scenes:
        for part in ("depth", "stereo", "occlusion"):
            shutil.rmtree(folder / part, ignore_errors=True)
    return results
