# SPDX-License-Identifier: BSD-3-Clause
"""Symmetries that BOP's models_info.json declares: folding of equivalent poses, free directions."""
import dataclasses
import json

import numpy as np

from . import EvaluationError
from .poses import exp_so3, is_rotation, nearest_rotation, pose, quaternion, rotation_about_point

TIE_TOLERANCE = 1e-9  # on |cos| of the half angle: ties go to the pose as it is


@dataclasses.dataclass
class Symmetries:
    """Continuous: list of (unit axis, point on it [m]). Discrete: list of 4x4 T_object_object, without the identity."""
    continuous: list = dataclasses.field(default_factory=list)
    discrete: list = dataclasses.field(default_factory=list)

    def any(self):
        return bool(self.continuous or self.discrete)


def _numbers(value, count, where):
    array = np.asarray(value, dtype=float).ravel()
    if array.size != count or not np.all(np.isfinite(array)):
        raise EvaluationError(f"{where} is not a list of {count} numbers")
    return array


def _axis(entry, scale, where):
    axis = _numbers(entry["axis"], 3, where + ", axis")
    if np.linalg.norm(axis) < 1e-9:
        raise EvaluationError(f"{where}: the axis has no direction (length 0)")
    return axis / np.linalg.norm(axis), scale * _numbers(entry["offset"], 3, where + ", offset")


def _transform(entry, scale, where):
    T = _numbers(entry, 16, where).reshape(4, 4)
    if not is_rotation(T[:3, :3]):
        raise EvaluationError(f"{where} has no rotation matrix")
    return pose(nearest_rotation(T[:3, :3]), scale * T[:3, 3])


def load_symmetries(path, object_id, scale):
    """Of one object; none where the file or the entry is missing. scale: metres per unit of the mesh file."""
    if path is None or not path.is_file():
        return Symmetries()
    try:
        entry = json.loads(path.read_text(encoding="utf-8")).get(str(object_id))
        if entry is None:
            return Symmetries()
        where = f"{path}, object {object_id}"
        return Symmetries([_axis(e, scale, where) for e in entry.get("symmetries_continuous", [])],
                          [_transform(e, scale, where) for e in entry.get("symmetries_discrete", [])])
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise EvaluationError(f"{path} is not a models_info.json of BOP: {error!r}") from error


def _alignment(T_a, T_b):
    """|cos| of half the angle between two orientations: 1 when equal."""
    return abs(float(quaternion(T_a[:3, :3]) @ quaternion(T_b[:3, :3])))


def _common_point(a, b):
    """Where two axes meet; the middle of their shortest connection when they miss each other."""
    between = b[1] - a[1]
    cosine = a[0] @ b[0]
    along_a = (between @ a[0] - cosine * (between @ b[0])) / (1.0 - cosine**2)
    along_b = (cosine * (between @ a[0]) - between @ b[0]) / (1.0 - cosine**2)
    return 0.5 * (a[1] + along_a * a[0] + b[1] + along_b * b[0])


def _second_axis(axes):
    """First axis that is not parallel to axes[0], or None: two of them generate every rotation (a ball)."""
    return next((axis for axis in axes[1:] if np.linalg.norm(np.cross(axes[0][0], axis[0])) > 1e-6), None)


def _fold_continuous(T, T_reference, axes):
    if not axes:
        return T
    second = _second_axis(axes)
    R = T[:3, :3].T @ T_reference[:3, :3]
    if second is not None:
        return T @ rotation_about_point(R, _common_point(axes[0], second))
    # With q = R as a quaternion, turning by a about the axis is nearest to R at a/2 = atan2(v . axis, w).
    axis, offset = axes[0]
    q = quaternion(R)
    return T @ rotation_about_point(exp_so3(2.0 * np.arctan2(q[1:] @ axis, q[0]) * axis), offset)


def fold(T, T_reference, symmetries):
    """The pose equivalent to T whose orientation is nearest to that of T_reference."""
    best = _fold_continuous(T, T_reference, symmetries.continuous)
    best_alignment = _alignment(best, T_reference)
    for T_object_object in symmetries.discrete:
        candidate = _fold_continuous(T @ T_object_object, T_reference, symmetries.continuous)
        alignment = _alignment(candidate, T_reference)
        if alignment > best_alignment + TIE_TOLERANCE:
            best, best_alignment = candidate, alignment
    return best


def constrained_basis(T_camera_object, symmetries):
    """Orthonormal basis (6 x dof) of the error directions that the object's shape can tell: turning about a symmetry
    axis moves the mesh origin and the orientation along a direction that is left out."""
    free = []
    for axis, offset in symmetries.continuous:
        axis_camera = T_camera_object[:3, :3] @ axis
        free.append(np.concatenate([np.cross(axis_camera, T_camera_object[:3, :3] @ -offset), axis_camera]))
    if not free:
        return np.eye(6)
    U, singular, _ = np.linalg.svd(np.array(free).T)
    return U[:, int(np.sum(singular > 1e-6 * singular[0])):]
