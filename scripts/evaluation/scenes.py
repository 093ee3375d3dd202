# SPDX-License-Identifier: BSD-3-Clause
"""Scene folders in the format of the BOP benchmark, and their ground truth."""
import csv
import dataclasses
import json
import pathlib
import re

import numpy as np

from . import EvaluationError
from .poses import is_rotation, nearest_rotation, pose


@dataclasses.dataclass
class Scene:
    """One sequence and one object in it."""
    name: str  # unique in this evaluation
    folder: pathlib.Path
    object_id: int = 1
    scene_id: int = 0
    mesh: pathlib.Path = None
    mesh_scale: float = 1.0
    models_info: pathlib.Path = None
    init: pathlib.Path = None  # first pose; None: the first ground truth
    data_set: str = ""  # in BOP's sense
    split: str = "test"
    bag: pathlib.Path = None  # what the scene folder was made from, where it was
    object_file: pathlib.Path = None  # of a bag


@dataclasses.dataclass
class Truth:
    """Ground truth by frame number. T: 4x4; visible: share in [0, 1]; masks: path or (path, path) of pictures."""
    frames: list
    stamps: dict
    poses: dict
    visible: dict
    masks: dict


def read_json(path):
    try:
        return json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise EvaluationError(f"cannot read {path}: {error.strerror}") from error
    except ValueError as error:
        raise EvaluationError(f"{path} is not valid JSON: {error}") from error


def bop_pose(entry, where):
    """Pose of {"cam_R_m2c": 9 numbers row-major, "cam_t_m2c": 3 numbers in mm}."""
    try:
        R = np.array(entry["cam_R_m2c"], float).reshape(3, 3)
        t = np.array(entry["cam_t_m2c"], float).reshape(3)
    except (KeyError, TypeError, ValueError) as error:
        raise EvaluationError(f"{where} has no usable pose (cam_R_m2c, cam_t_m2c): {error!r}") from error
    if not is_rotation(R) or not np.all(np.isfinite(t)):
        raise EvaluationError(f"{where}: cam_R_m2c is not a rotation matrix or cam_t_m2c not finite")
    return pose(nearest_rotation(R), 1e-3 * t)


def _poses(scene):
    """({frame: pose}, {frame: place in the frame's list}) of the scene's object."""
    path = scene.folder / "scene_gt.json"
    if not path.is_file():
        return {}, {}
    poses, places = {}, {}
    for key, entries in read_json(path).items():
        for place, entry in enumerate(entries):
            if entry.get("obj_id") == scene.object_id and int(key) not in poses:
                poses[int(key)] = bop_pose(entry, f"{path}, frame {key}")
                places[int(key)] = place
    return poses, places


def _visible(scene, places):
    """Visible share by frame: our visibility.csv, else BOP's scene_gt_info.json, else empty."""
    ours, bops = scene.folder / "visibility.csv", scene.folder / "scene_gt_info.json"
    if ours.is_file():
        with open(ours, newline="", encoding="utf-8") as file:
            try:
                return {int(row["frame"]): float(row["fraction_visible"]) for row in csv.DictReader(file)}
            except (KeyError, TypeError, ValueError) as error:
                raise EvaluationError(f"{ours} needs the columns frame and fraction_visible: {error!r}") from error
    if bops.is_file():
        info = read_json(bops)
        return {frame: float(info[str(frame)][place]["visib_fract"]) for frame, place in places.items()
                if str(frame) in info and "visib_fract" in info[str(frame)][place]}
    return {}


def _masks(scene, places):
    """Ours: occlusion/%06d.png with 0, 128, 255. BOP's: mask/ (whole object) and mask_visib/ (its visible part)."""
    masks = {int(path.stem): path for path in (scene.folder / "occlusion").glob("*.png") if path.stem.isdigit()}
    if masks:
        return masks
    for frame, place in places.items():
        pair = tuple(scene.folder / kind / f"{frame:06d}_{place:06d}.png" for kind in ("mask", "mask_visib"))
        if all(path.is_file() for path in pair):
            masks[frame] = pair
    return masks


def load_truth(scene):
    cameras = read_json(scene.folder / "scene_camera.json")
    frames = sorted(int(key) for key in cameras)
    stamps = {int(key): entry.get("timestamp", int(key) / 30.0) for key, entry in cameras.items()}
    poses, places = _poses(scene)
    return Truth(frames, stamps, poses, _visible(scene, places), _masks(scene, places))


def scene_number(folder):
    return int(folder.name) if re.fullmatch(r"\d{1,8}", folder.name) else 0


def plain_scene(folder):
    """A scene that brings its own mesh.obj (metres), models_info.json and init.json."""
    models_info, init = folder / "models_info.json", folder / "init.json"
    return Scene(f"{folder.parent.name}/{folder.name}", folder, scene_id=scene_number(folder), mesh=folder / "mesh.obj",
                 models_info=models_info if models_info.is_file() else None, init=init if init.is_file() else None,
                 data_set=folder.parent.name)
