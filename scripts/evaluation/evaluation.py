# SPDX-License-Identifier: BSD-3-Clause
"""The command from arguments to files."""
import re
import sys

from . import EvaluationError, aggregate, bop_results, command_line, programs, provenance, runs, terminal_table
from .estimates import find_estimates
from .find_scenes import find_scenes
from .progress import Progress


def choose_scenes(options):
    try:
        pattern = re.compile(options.only or "")
    except re.error as error:
        raise EvaluationError(f"--only {options.only} is not a regular expression: {error}") from error
    scenes = find_scenes(options.folders, options.output / "scenes", options.object_id, options.models, pattern.search,
                         options.object)
    if not scenes:
        raise EvaluationError("no scene found: a scene is a folder with scene_camera.json (BOP format), or a video of YCBInEOAT"
                              + (f"; --only {options.only} may leave none" if options.only else ""))
    return scenes


def choose_program(options, source_folder):
    if options.estimates:
        return None
    if options.program:
        return programs.check_program(options.program)
    return programs.find_program(programs.PEERS.get(options.peer, "track_sequence"), source_folder)


def bag_program(options, scene, source_folder):
    """track_bag for a bag, unless the user wants another program: that one gets the scene folder made from it."""
    return programs.find_program("track_bag", source_folder) if scene.bag and not options.program and not options.peer else None


def job_maker(options, program, num_scenes, source_folder):
    """Function (scene, truth) -> jobs."""
    extra = (["--config", str(options.config)] if options.config else []) + options.passed

    def existing(scene, _):
        files = find_estimates(options.estimates, scene, num_scenes)
        return [runs.Job(scene, path.stem, path) for path in files]

    def fresh(scene, truth):
        jobs = []
        for_bag = bag_program(options, scene, source_folder)
        for seed in range(1, options.seeds + 1):
            csv = options.output / "estimates" / scene.name / f"seed{seed}.csv"
            command = (runs.bag_command(for_bag, scene, seed, csv, extra) if for_bag else
                       runs.tracker_command(program, scene, seed, csv, extra, bool(truth.masks), bool(options.peer)))
            jobs.append(runs.Job(scene, f"seed{seed}", csv, command, options.timeout))
        return jobs

    return existing if options.estimates else fresh


def run_and_print(options, scenes, scorers, program, source_folder):
    """(outcomes by scene name, summaries in order); prints a line for each scene when it is done."""
    width = terminal_table.name_width(scenes)
    progress = Progress()
    summaries = []

    def on_done(scene, outcomes, done, total):
        if scene is not None:
            summaries.append(aggregate.summarise_scene(scene, outcomes))
            progress.clear()
            print(terminal_table.scene_line(summaries[-1], width), flush=True)
        if done < total:
            progress.update(done, total)

    print(terminal_table.header(width), flush=True)
    outcomes = runs.execute_all(scenes, scorers, job_maker(options, program, len(scenes), source_folder), options.jobs, on_done)
    return outcomes, summaries


def evaluate(options, source_folder):
    """Returns the number of runs that failed."""
    scenes = choose_scenes(options)
    program = choose_program(options, source_folder)
    if options.config and not options.config.is_file():
        raise EvaluationError(f"there is no configuration {options.config}")
    options.output.mkdir(parents=True, exist_ok=True)
    scorers = {scene.name: runs.SceneScorer(scene) for scene in scenes}
    outcomes, summaries = run_and_print(options, scenes, scorers, program, source_folder)
    total = aggregate.summarise_all(summaries, outcomes)
    print(terminal_table.overall_line(total, terminal_table.name_width(scenes)), flush=True)

    from . import results  # here: matplotlib takes its time, and mistakes in the arguments shall show at once

    made_with = provenance.describe(source_folder, program, options.config, options.jobs)
    results.write(results.Results(options.output, made_with, scenes, scorers, outcomes, summaries, total))
    bop_results.write(options.output / "bop", program.name if program else "estimates", scenes, outcomes)
    print(f"report: {options.output / 'report.html'}")
    return report_failures(summaries)


def report_failures(summaries):
    failures = 0
    for summary in summaries:
        for failure in summary["failures"]:
            print(f"failed: {summary['scene']}, {failure['run']}: {failure['problem']}", file=sys.stderr)
            failures += 1
        if not summary["runs"]:
            print(f"failed: {summary['scene']}: no estimates found", file=sys.stderr)
            failures += 1
    return failures


def main(arguments, source_folder):
    """Exit code: 0 done, 1 a run failed or input cannot be used, 2 usage."""
    options = command_line.parse(arguments)
    try:
        failures = evaluate(options, source_folder)
    except (EvaluationError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("error: interrupted", file=sys.stderr)
        return 1
    if failures:
        print(f"error: {failures} run(s) failed", file=sys.stderr)
    return 1 if failures else 0
