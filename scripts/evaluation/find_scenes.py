# SPDX-License-Identifier: BSD-3-Clause
"""Finds scenes of every known layout below folders."""
import os
import pathlib

from . import EvaluationError, bags, bop_data_set, ycbineoat
from .scenes import plain_scene


def _folders_with(root, is_wanted):
    """Folders at any depth, in order; what is inside of a wanted one is not searched."""
    for folder, subfolders, _ in os.walk(root, followlinks=True):
        subfolders.sort()
        if is_wanted(pathlib.Path(folder)):
            subfolders.clear()
            yield pathlib.Path(folder)


def _is_scene(folder):
    return (folder / "scene_camera.json").is_file() or ycbineoat.is_video(folder)


def _scenes_in(folder, object_id, models, work_folder):
    """A folder with its own mesh.obj, else a scene of a BOP data set or a video of YCBInEOAT."""
    if ycbineoat.is_video(folder):
        return [ycbineoat.scene_of(folder, models, work_folder)]
    if not (folder / "mesh.obj").is_file():
        models = models or bop_data_set.models_folder(folder)
        if models is None:
            raise EvaluationError(f"{folder} has neither mesh.obj nor, as BOP data sets do, ../../models/obj_000001.ply; name the "
                                  "folder of the models with --models")
        return bop_data_set.scenes_of(folder, models, object_id)
    scene = plain_scene(folder)
    scene.object_id = scene.object_id if object_id is None else object_id
    return [scene]


def _bags_in(root):
    """The bag itself, or those at any depth below a folder."""
    return [root] if bags.is_bag(root) else sorted(path for path in root.rglob("*.bag") if path.is_file())


def find_scenes(folders, work_folder, object_id=None, models=None, wanted=lambda folder: True, object_file=None):
    """Scenes in order of their folders, each once, with names of their own; bags come after the folders beside them.

    work_folder: for scene folders that are made from other layouts; object_id: None = 1 in a scene with its own mesh, all
    in a BOP data set; models: folder of the meshes, None = where the data set keeps them; wanted: tells from the path; object_file:
    YAML or mesh for bags, None = NAME.yaml beside NAME.bag."""
    scenes, known = [], set()
    for root in folders:
        if not root.is_dir() and not bags.is_bag(root):
            raise EvaluationError(f"there is no folder or bag {root}")
        for folder in _folders_with(root.resolve(), _is_scene):
            if folder not in known and wanted(str(folder)):
                known.add(folder)
                scenes += _scenes_in(folder, object_id, models, work_folder)
        for path in _bags_in(root.resolve()):
            if path not in known and wanted(str(path)):
                known.add(path)
                scenes.append(bags.scene_of(path, object_file, work_folder))
    _make_names_unique(scenes)
    return scenes


def _make_names_unique(scenes):
    taken = set()
    for scene in scenes:
        name, count = scene.name, 1
        while scene.name in taken:
            count += 1
            scene.name = f"{name}.{count}"
        taken.add(scene.name)
