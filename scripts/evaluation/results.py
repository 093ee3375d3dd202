# SPDX-License-Identifier: BSD-3-Clause
"""Everything that evaluate leaves in its output folder."""
import dataclasses
import pathlib

from . import overall_plots, report, result_files, scene_plots
from .estimates import occlusion_folder
from .occlusion_score import RocCounter


@dataclasses.dataclass
class Results:
    output: pathlib.Path
    made_with: dict
    scenes: list
    scorers: dict  # by scene name
    outcomes: dict  # by scene name
    summaries: list
    total: dict


def shown_run(outcomes):
    """The run that is drawn: the one with the largest median error of those that did not fail."""
    good = [outcome for outcome in outcomes if outcome.figures]
    return max(good, key=lambda outcome: outcome.figures["error_mm_median"], default=None)


def draw_scene(results, scene):
    """Paths of the scene's plots."""
    outcome = shown_run(results.outcomes[scene.name])
    if outcome is None:
        return []
    folder = results.output / "plots" / scene.name
    scorer = results.scorers[scene.name]
    paths = [scene_plots.plot_trajectory(folder / "trajectory.png", scene, outcome.table, scorer.symmetries),
             scene_plots.plot_errors(folder / "errors.png", outcome.table)]
    pictures = occlusion_folder(outcome.job.csv)
    if pictures:
        paths.append(scene_plots.plot_occlusion(folder / "occlusion.png", scene, scorer.truth, pictures))
    return [path for path in paths if path]


def roc_counters(results):
    """{"all pixels": RocCounter, scene: RocCounter, ...} of the scenes with masks and pictures."""
    total, counters = RocCounter(), {}
    for scene in results.scenes:
        counter = RocCounter()
        for outcome in results.outcomes[scene.name]:
            if outcome.roc:
                counter.merge(outcome.roc)
                total.merge(outcome.roc)
        if counter.occluded.sum() and counter.visible.sum():
            counters[scene.name] = counter
    return {"all pixels": total, **counters} if counters else {}


def draw_overall(results):
    good = [summary for summary in results.summaries if "median" in summary]
    if not good:
        return []
    folder = results.output / "plots"
    paths = [overall_plots.plot_accuracy(folder / "accuracy.png", good, results.total)]
    if any(summary["median"]["nees_frames"] > 0 for summary in good):
        paths.append(overall_plots.plot_reliability(folder / "reliability.png", good, results.total))
    counters = roc_counters(results)
    if counters:
        paths.append(overall_plots.plot_roc(folder / "occlusion_roc.png", counters))
    return paths


def write_frame_tables(results):
    for scene in results.scenes:
        folder = results.output / "frames" / scene.name
        for outcome in results.outcomes[scene.name]:
            if outcome.table:
                folder.mkdir(parents=True, exist_ok=True)
                result_files.write_frames(folder / f"{outcome.job.label}.csv", outcome.table)


def write(results):
    result_files.write_csv(results.output / "summary.csv", results.summaries, results.total)
    result_files.write_json(results.output / "summary.json", results.made_with, results.summaries, results.total)
    write_frame_tables(results)
    overall_pictures = draw_overall(results)
    scene_pictures = {scene.name: draw_scene(results, scene) for scene in results.scenes}
    report.write_report(results.output / "report.html", results.made_with, results.summaries, results.total, overall_pictures,
                        scene_pictures)
