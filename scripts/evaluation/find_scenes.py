# SPDX-License-Identifier: BSD-3-Clause
"""Finds scenes of every known layout below folders."""
from . import EvaluationError
from .scenes import plain_scene


def find_scenes(folders, object_id=None):
    """Scenes in order of their folders, each once."""
    scenes = []
    for folder in folders:
        if not folder.is_dir():
            raise EvaluationError(f"there is no folder {folder}")
        for camera_file in sorted(folder.resolve().rglob("scene_camera.json")):
            scene = plain_scene(camera_file.parent)
            if object_id is not None:
                scene.object_id = object_id
            if scene.folder not in [known.folder for known in scenes]:
                scenes.append(scene)
    return scenes
