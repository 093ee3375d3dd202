# SPDX-License-Identifier: BSD-3-Clause
"""Data sets laid out as the BOP benchmark does (YCB-V, T-LESS, LM-O, HB, ...):

    DATASET/models/obj_000001.ply, models_info.json     in mm
    DATASET/test/000001/scene_camera.json, scene_gt.json, depth/000000.png, ...
    DATASET/test_targets_bop19.json                     optional: which objects in which pictures count
"""
import functools
import pathlib

from . import EvaluationError
from .scenes import Scene, read_json, scene_number

MODEL_FOLDERS = ["models", "models_cad", "models_reconst", "models_eval"]
METRES_PER_UNIT = 1e-3
TARGET_FILES = ["test_targets_bop19.json", "test_targets_bop24.json"]


def models_folder(scene_folder):
    """Folder with obj_*.ply of the data set that a scene belongs to, or None."""
    for base in (scene_folder.parent.parent, scene_folder.parent):
        for name in MODEL_FOLDERS:
            if any((base / name).glob("obj_*.ply")):
                return base / name
    return None


@functools.lru_cache(maxsize=8)
def read_targets(root):
    """{scene id: {object id: {image ids}}} of the data set's list of targets, None where there is none."""
    path = next((root / name for name in TARGET_FILES if (root / name).is_file()), None)
    if path is None:
        return None
    targets = {}
    try:
        for entry in read_json(path):
            objects = targets.setdefault(int(entry["scene_id"]), {})
            objects.setdefault(int(entry["obj_id"]), set()).add(int(entry["im_id"]))
    except (KeyError, TypeError, ValueError) as error:
        raise EvaluationError(f"{path} is not a list of BOP targets: {error!r}") from error
    return targets


def object_ids(scene_folder):
    """Objects to track: the targets of a test scene where they are listed, else all with ground truth."""
    targets = read_targets(scene_folder.parent.parent) if scene_folder.parent.name.startswith("test") else None
    number = scene_number(scene_folder)
    if targets and number in targets:
        return sorted(targets[number])
    truth = scene_folder / "scene_gt.json"
    if not truth.is_file():
        return []
    return sorted({int(entry["obj_id"]) for entries in read_json(truth).values() for entry in entries})


def scenes_of(scene_folder, models, object_id=None):
    """One Scene per object; the first pose is the first ground truth. Of several alike in a picture the first counts."""
    models_info = next((path for path in (models / "models_info.json", models.parent / "models_eval/models_info.json")
                        if path.is_file()), None)
    root = models.parent
    found = []
    for number in object_ids(scene_folder) if object_id is None else [object_id]:
        mesh = models / f"obj_{number:06d}.ply"
        if not mesh.is_file():
            raise EvaluationError(f"{scene_folder} shows object {number}, but there is no {mesh}")
        name = pathlib.PurePath(root.name, *scene_folder.relative_to(root).parts, f"obj_{number:06d}").as_posix()
        found.append(Scene(name, scene_folder, number, scene_number(scene_folder), mesh, METRES_PER_UNIT, models_info,
                           data_set=root.name, split=scene_folder.parent.name))
    return found
