# SPDX-License-Identifier: BSD-3-Clause
"""Reads what track_sequence writes: estimates (BOP CSV), trace (JSON lines)."""
import csv
import dataclasses
import json
import pathlib
import re

import numpy as np

from . import EvaluationError
from .poses import is_rotation, nearest_rotation, pose

COLUMNS = ["scene_id", "im_id", "obj_id", "score", "R", "t", "time"]


@dataclasses.dataclass
class Run:
    """One seed's estimates of a scene; arrays over the frames in order. Without a trace covariance is None and the
    state follows from the score (0 = LOST)."""
    frames: list
    poses: list
    scores: np.ndarray
    times_s: np.ndarray
    states: list
    covariances: list = None
    visible: np.ndarray = None
    machine: dict = dataclasses.field(default_factory=dict)


def _row_pose(row, where):
    R = np.array(row["R"].split(), float)
    t = np.array(row["t"].split(), float)
    if R.size != 9 or t.size != 3 or not is_rotation(R.reshape(3, 3)) or not np.all(np.isfinite(t)):
        raise EvaluationError(f"{where}: R (9 numbers) and t (3 numbers, mm) are not a pose")
    return pose(nearest_rotation(R.reshape(3, 3)), 1e-3 * t)


def read_csv(path, scene_id=None, object_id=None):
    """[(frame, pose, score, time_s)] in order of frames. A file of several scenes or objects is narrowed to those given;
    in a file of only one scene the ids do not matter."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        if rows and any(column not in rows[0] for column in COLUMNS):
            raise EvaluationError(f"{path} is not a BOP result file: its first line is not {','.join(COLUMNS)}")
        for column, wanted in (("scene_id", scene_id), ("obj_id", object_id)):
            if wanted is not None and len({row[column] for row in rows}) > 1:
                rows = [row for row in rows if int(row[column]) == wanted]
        found = {}
        for number, row in enumerate(rows, start=2):
            best = found.get(int(row["im_id"]))
            if best is None or float(row["score"]) > best[2]:  # a detector may give several poses for an object
                found[int(row["im_id"])] = (int(row["im_id"]), _row_pose(row, f"{path}, row {number}"),
                                            float(row["score"]), float(row["time"]))
    except OSError as error:
        raise EvaluationError(f"cannot read {path}: {error.strerror}") from error
    except (ValueError, TypeError, AttributeError) as error:
        raise EvaluationError(f"{path} is not a BOP result file: {error!r}") from error
    return [found[frame] for frame in sorted(found)]


def read_trace(path):
    """{frame: object} of a JSON-lines file."""
    trace = {}
    with open(path, encoding="utf-8") as file:
        for number, line in enumerate(file, start=1):
            try:
                entry = json.loads(line)
                trace[int(entry["frame"])] = entry
            except (ValueError, KeyError, TypeError) as error:
                raise EvaluationError(f"{path}, line {number} is not a trace of track_sequence: {error!r}") from error
    return trace


def _covariance(entry):
    values = np.array([np.nan if x is None else x for x in entry.get("covariance", [])], float)
    return values.reshape(6, 6) if values.size == 36 and np.all(np.isfinite(values)) else np.full((6, 6), np.nan)


def load_run(csv_path, scene):
    rows = read_csv(csv_path, scene.scene_id, scene.object_id)
    if not rows:
        raise EvaluationError(f"{csv_path} has no estimate of scene {scene.scene_id}, object {scene.object_id}")
    frames, poses, scores, times = zip(*rows)
    run = Run(list(frames), list(poses), np.array(scores), np.array(times),
              ["LOST" if score == 0.0 else "TRACKING" for score in scores])
    trace_path = csv_path.with_suffix(".jsonl")
    if not trace_path.is_file():
        return run
    trace = read_trace(trace_path)
    missing = [frame for frame in frames if frame not in trace]
    if missing:
        raise EvaluationError(f"{trace_path} lacks frame {missing[0]} (and {len(missing) - 1} more) of {csv_path.name}")
    entries = [trace[frame] for frame in frames]
    run.states = [str(entry.get("status", "UNINITIALIZED")) for entry in entries]
    run.covariances = [_covariance(entry) for entry in entries]
    run.visible = np.array([entry.get("visible_fraction") for entry in entries], dtype=float)
    run.machine = {key: entries[0][key] for key in ("simd_target", "num_particles") if key in entries[0]}
    return run


def occlusion_folder(csv_path):
    """Where the run's occlusion pictures are, or None."""
    candidates = [csv_path.with_name(csv_path.stem + suffix) for suffix in ("_occlusion", "")]
    if len(list(csv_path.parent.glob("*.csv"))) == 1:
        candidates.append(csv_path.parent / "occlusion")
    return next((folder for folder in candidates if folder.is_dir()), None)


def find_estimates(folder, scene, num_scenes):
    """CSV files below the folder that belong to a scene: in a folder named as the scene is here (what evaluate writes), in
    one named as the scene's folder, named SCENE.csv, SCENE_1.csv, SCENE_seed1.csv or PARENT_SCENE....csv; where there is
    only one scene, every CSV; else BOP result files (METHOD_DATASET-SPLIT....csv)."""
    folder = pathlib.Path(folder)
    if not folder.is_dir():
        raise EvaluationError(f"there is no folder {folder} (--estimates)")
    files = [path for path in sorted(folder.rglob("*.csv")) if _is_result(path)]
    last, parent = re.escape(scene.folder.name), re.escape(scene.folder.parent.name)
    name = re.compile(rf"(?:{parent}[_-])?{last}(?:[_.-](?:seed)?_?\d+)?")
    for belongs in (lambda path: ("/" + path.parent.relative_to(folder).as_posix()).endswith("/" + scene.name),
                    lambda path: path.parent != folder and path.parent.name == scene.folder.name,
                    lambda path: name.fullmatch(path.stem),
                    lambda path: num_scenes == 1,
                    lambda path: re.match(r"[^_]+_[^_]+-(test|train|val)", path.stem)):
        found = [path for path in files if belongs(path)]
        if found:
            return found
    return []


def _is_result(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        return file.readline().strip().replace(" ", "") == ",".join(COLUMNS)
