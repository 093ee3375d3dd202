# SPDX-License-Identifier: BSD-3-Clause
"""The command from arguments to files."""
import argparse
import concurrent.futures
import os
import pathlib
import sys

from evaluation import EvaluationError, programs, provenance
from evaluation.progress import Progress

from . import figures, summary
from .experiment import run_scene
from .methods import choose_methods
from .scenarios import scenarios

DESCRIPTION = """Repeats the experiments of Wuethrich et al. (IROS 2013) in simulation: (a) a human moves the object, (b) a robot holds
it, (c) a robot holds it and a human disturbs it in the hand. Runs the tracker, its ablations and the other methods over the
same scenes, prints a table and draws the paper's figures 4 to 7."""


def parse(arguments):
    parser = argparse.ArgumentParser(prog="paper_experiments", description=DESCRIPTION)
    parser.add_argument("--output", required=True, type=pathlib.Path, help="folder for table, figures and estimates")
    parser.add_argument("--seeds", type=int, default=5, help="scenes per experiment (default 5)")
    parser.add_argument("--seconds", type=float, default=10.0, help="length of a scene (default 10)")
    parser.add_argument("--fps", type=float, default=30.0, help="images a second (default 30)")
    parser.add_argument("--experiments", default="abc", help="some of a, b and c (default abc)")
    parser.add_argument("--methods", help="comma-separated: ours, paper, beam, fiducials, kinematics, pcl (default: all there are)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="scenes at a time (default: the number of cores)")
    parser.add_argument("--keep-scenes", action="store_true", help="keep the pictures (about 1 MB an image); later runs with the same settings use them again")
    parser.add_argument("--programs", type=pathlib.Path, help="folder of the programs (default: where they are built or installed)")
    parser.add_argument("--timeout", type=float, default=1800.0, help="longest time of one program [s] (default 1800)")
    options = parser.parse_args(arguments)
    for name, bad in (("--seeds", options.seeds < 1), ("--seconds", not 0.1 <= options.seconds <= 600.0),
                      ("--fps", not 1.0 <= options.fps <= 120.0), ("--jobs", options.jobs < 1),
                      ("--experiments", not options.experiments or set(options.experiments) - set("abc"))):
        if bad:
            parser.error(f"{name} is out of range")
    return options


def _config_folder(source_folder):
    """In the source tree, in a catkin install space and in one without ROS."""
    for folder in (source_folder.parent / "config", source_folder.parent.parent / "share/depth_object_tracker/config",
                   source_folder.parent / "share/depth_object_tracker/config"):
        if (folder / "paper.yaml").is_file():
            return folder
    raise EvaluationError("the folder config/ of depth_object_tracker is missing: is the installation complete?")


def _run_all(chosen, methods, simulator, options, config_folder):
    results, progress = [], Progress()
    tasks = [(scenario, seed) for scenario in chosen for seed in range(1, options.seeds + 1)]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        pending = [pool.submit(run_scene, scenario, seed, methods, simulator, options, config_folder)
                   for scenario, seed in tasks]
        try:
            for done, future in enumerate(pending, start=1):
                results += future.result()
                progress.update(done, len(tasks))
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    progress.clear()
    return results


def _draw(chosen, results, curves, output):
    drawn = [figures.plot_likelihood(output / "figure_4.png", curves)]
    for scenario in chosen:
        tables = {result.method.name: result.table for result in results
                  if result.scenario is scenario and result.seed == 1 and result.table is not None}
        if tables:
            title = f"({scenario.letter}) {scenario.title} ({scenario.object_name})"
            drawn.append(figures.plot_poses(output / f"{scenario.figure}.png", title, tables))
    return drawn


def run(options, source_folder):
    config_folder = _config_folder(source_folder)
    chosen = [scenario for scenario in scenarios(config_folder) if scenario.letter in options.experiments]
    names = [name.strip() for name in options.methods.split(",")] if options.methods else None
    def find(name):
        return programs.check_program(options.programs / name) if options.programs else programs.find_program(name, source_folder)

    methods, warnings = choose_methods(names, config_folder, find)
    simulator, curves = find("simulate_scene"), find("pixel_model_curves")
    options.output.mkdir(parents=True, exist_ok=True)
    results = _run_all(chosen, methods, simulator, options, config_folder)
    for result in results:
        if result.problem:
            warnings.append(f"experiment {result.scenario.letter}, seed {result.seed}, {result.method.name}: {result.problem}")
    rows = summary.summarise(results)
    made = provenance.describe(source_folder, simulator.parent, None, options.jobs)
    summary.write(rows, results, made, options.output)
    print(summary.as_text(rows))
    for path in _draw(chosen, results, curves, options.output):
        print(path)
    for warning in warnings:
        print(f"warning: {warning}", file=sys.stderr)
    return 1 if any(result.problem for result in results) else 0


def main(arguments, source_folder):
    """Exit code: 0 done, 1 something failed, 2 usage."""
    options = parse(arguments)
    try:
        return run(options, source_folder)
    except EvaluationError as error:
        print(f"error: {error}", file=sys.stderr)
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
    return 1
