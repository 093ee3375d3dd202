# SPDX-License-Identifier: BSD-3-Clause
"""YCBInEOAT's layout (Wen et al., se(3)-TrackNet, IROS 2020): videos of a robot that handles YCB objects.

    VIDEO/cam_K.txt                 3x3 intrinsics
    VIDEO/depth/NAME.png            16-bit, mm, 0 = no reading; NAME is a time in ns
    VIDEO/annotated_poses/*.txt     4x4 pose of the object in the optical frame [m], in the order of the pictures

Meshes are those of the YCB-Video data set: MODELS/021_bleach_cleanser/textured_simple.obj and so on, metres. The tracker
reads scene folders in BOP's format, so a video becomes such a folder with links to the pictures.
"""
import json
import pathlib

import numpy as np

from . import EvaluationError
from .poses import is_rotation
from .scenes import Scene

OBJECTS = {"bleach": "021_bleach_cleanser", "cracker": "003_cracker_box", "mustard": "006_mustard_bottle",
           "sugar": "004_sugar_box", "tomato": "005_tomato_soup_can"}
MESH_FILES = ["textured_simple.obj", "textured.obj", "nontextured.ply"]
NANOSECOND_DIGITS = 16  # names with at least so many digits are times


def is_video(folder):
    return (folder / "cam_K.txt").is_file() and (folder / "annotated_poses").is_dir() and (folder / "depth").is_dir()


def find_mesh(video, models):
    """models: folder given by the user, or None: models/ or CADmodels/ beside or above the videos."""
    name = next((full for word, full in OBJECTS.items() if word in video.name), None)
    if name is None:
        raise EvaluationError(f"{video}: the name tells no object ({', '.join(OBJECTS)})")
    places = [models] if models else [base / folder for base in (video, video.parent, video.parent.parent)
                                      for folder in ("models", "CADmodels")]
    for place in places:
        for file in MESH_FILES:
            if (place / name / file).is_file():
                return place / name / file
    raise EvaluationError(f"{video}: there is no {name}/{MESH_FILES[0]} in {' or '.join(map(str, places))}; get the models of "
                          "the YCB-Video data set and name their folder with --models")


def _matrix(path, size):
    try:
        numbers = np.loadtxt(path)
    except (OSError, ValueError) as error:
        raise EvaluationError(f"{path} is no table of numbers: {error}") from error
    if numbers.size != size * size or not np.all(np.isfinite(numbers)):
        raise EvaluationError(f"{path} has not {size}x{size} numbers")
    return numbers.reshape(size, size)


def _stamps(pictures):
    """Seconds since the first picture, None where the names are no times."""
    if not all(path.stem.isdigit() and len(path.stem) >= NANOSECOND_DIGITS for path in pictures):
        return [None] * len(pictures)
    return [1e-9 * (int(path.stem) - int(pictures[0].stem)) for path in pictures]


def _truth(path):
    T = _matrix(path, 4)
    if not is_rotation(T[:3, :3]):
        raise EvaluationError(f"{path} has no rotation matrix")
    return {"obj_id": 1, "cam_R_m2c": T[:3, :3].ravel().tolist(), "cam_t_m2c": (1e3 * T[:3, 3]).tolist()}


def _link(target, link):
    link.unlink(missing_ok=True)
    link.symlink_to(target.resolve())


def convert(video, folder, mesh):
    """Writes the scene folder: JSON files, and links to pictures and mesh."""
    pictures = sorted((video / "depth").glob("*.png"))
    annotations = sorted((video / "annotated_poses").glob("*.txt"))
    if not pictures:
        raise EvaluationError(f"{video}/depth has no .png")
    if len(annotations) > len(pictures):
        raise EvaluationError(f"{video} has {len(annotations)} annotated poses for {len(pictures)} depth pictures")
    intrinsics = _matrix(video / "cam_K.txt", 3).ravel().tolist()
    (folder / "depth").mkdir(parents=True, exist_ok=True)
    cameras = {}
    for k, (picture, stamp) in enumerate(zip(pictures, _stamps(pictures))):
        cameras[str(k)] = {"cam_K": intrinsics, "depth_scale": 1.0, **({} if stamp is None else {"timestamp": stamp})}
        _link(picture, folder / "depth" / f"{k:06d}.png")
    truths = {str(k): [_truth(path)] for k, path in enumerate(annotations)}
    (folder / "scene_camera.json").write_text(json.dumps(cameras), encoding="utf-8")
    (folder / "scene_gt.json").write_text(json.dumps(truths), encoding="utf-8")
    _link(mesh, folder / ("mesh" + mesh.suffix))


def scene_of(video, models, work_folder):
    folder = work_folder / "ycbineoat" / video.name
    mesh = find_mesh(video, models)
    convert(video, folder, mesh)
    return Scene(pathlib.PurePath(video.parent.name, video.name).as_posix(), folder, mesh=folder / ("mesh" + mesh.suffix),
                 data_set=video.parent.name)
