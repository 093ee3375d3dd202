# SPDX-License-Identifier: BSD-3-Clause
"""Arguments of evaluate."""
import argparse
import pathlib

from .terminal_table import LEGEND

DESCRIPTION = """Runs track_sequence over every scene folder (BOP format) and track_bag over every rosbag below the given folders, with
several seeds, and scores the estimates against the ground truth. Writes summary.csv, summary.json, report.html and plots."""
EPILOG = "Everything after -- goes to the tracker program, e.g. `-- --stride 3`.\n\n" + LEGEND


def _positive(text):
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"must be at least 1, is {value}")
    return value


def parse(arguments):
    own, passed = list(arguments), []
    if "--" in own:
        passed = own[own.index("--") + 1:]
        own = own[:own.index("--")]
    parser = argparse.ArgumentParser(prog="evaluate", description=DESCRIPTION, epilog=EPILOG,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", metavar="DIR", nargs="+", type=pathlib.Path,
                        help="a scene folder, a rosbag with /ground_truth/pose, or a folder that holds such at any depth")
    parser.add_argument("--output", metavar="DIR", type=pathlib.Path, required=True, help="folder for all results")
    parser.add_argument("--estimates", metavar="DIR", type=pathlib.Path,
                        help="score the estimates that are there (EST.csv, beside it EST.jsonl and EST_occlusion/) instead "
                             "of running a tracker")
    parser.add_argument("--peer", choices=["pcl", "icp"],
                        help="run another tracker: pcl = PCL's particle filter (track_pcl), icp = point-to-plane ICP (track_icp)")
    parser.add_argument("--seeds", metavar="N", type=_positive, default=1, help="run seeds 1..N (default 1)")
    parser.add_argument("--jobs", metavar="N", type=_positive, default=1,
                        help="runs at the same time (default 1: times are then fair)")
    parser.add_argument("--program", metavar="FILE", type=pathlib.Path, help="tracker program to run (default: track_sequence)")
    parser.add_argument("--config", metavar="FILE", type=pathlib.Path, help="tracker parameters (YAML), passed on")
    parser.add_argument("--only", metavar="REGEX", help="only scenes whose folder matches")
    parser.add_argument("--object-id", metavar="N", type=_positive,
                        help="object to track in scenes with several (default: 1 in a scene with its own mesh, else all)")
    parser.add_argument("--models", metavar="DIR", type=pathlib.Path,
                        help="folder of the meshes (BOP: obj_000001.ply; YCBInEOAT: 021_bleach_cleanser/textured_simple.obj; "
                             "default: where the data set keeps them)")
    parser.add_argument("--object", metavar="FILE", type=pathlib.Path,
                        help="object YAML, or a mesh in metres, for bags (default: NAME.yaml beside NAME.bag)")
    parser.add_argument("--timeout", metavar="S", type=float, default=900.0, help="longest time of one run [s] (default 900)")
    options = parser.parse_args(own)
    options.passed = passed
    if options.estimates and options.peer:
        parser.error("--estimates and --peer exclude each other")
    return options
