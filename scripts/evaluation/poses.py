# SPDX-License-Identifier: BSD-3-Clause
"""Rotations and rigid transforms as arrays."""
import numpy as np


def skew(v):
    """Cross-product matrix (3x3) of a 3-vector."""
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def exp_so3(rotation_vector):
    """Rotation (3x3) by a rotation vector (3) in rad."""
    v = np.asarray(rotation_vector, float)
    angle = np.linalg.norm(v)
    K = skew(v)
    if angle < 1e-8:
        return np.eye(3) + K
    return np.eye(3) + np.sin(angle) / angle * K + (1.0 - np.cos(angle)) / angle**2 * K @ K


def quaternion(R):
    """Unit quaternion (w, x, y, z) with w >= 0 of a rotation; well-conditioned for every angle."""
    trace = np.trace(R)
    squares = np.array([trace, R[0, 0], R[1, 1], R[2, 2]])  # the largest component is computed first
    k = int(np.argmax(squares))
    q = np.empty(4)
    if k == 0:
        q[:] = [1.0 + trace, R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]
    else:
        i, j, l = k - 1, k % 3, (k + 1) % 3
        q[0] = R[l, j] - R[j, l]
        q[1 + i] = 1.0 + R[i, i] - R[j, j] - R[l, l]
        q[1 + j] = R[j, i] + R[i, j]
        q[1 + l] = R[l, i] + R[i, l]
    q /= np.linalg.norm(q)
    return -q if q[0] < 0.0 else q


def rotation_from_quaternion(q):
    """Rotation (3x3) of a quaternion (w, x, y, z) of any length but 0."""
    w, x, y, z = np.asarray(q, float) / np.linalg.norm(q)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def log_so3(R):
    """Rotation vector (3), angle in [0, pi]; inverse of exp_so3."""
    q = quaternion(R)
    sine = np.linalg.norm(q[1:])
    if sine < 1e-12:
        return 2.0 * q[1:]
    return 2.0 * np.arctan2(sine, q[0]) * q[1:] / sine


def pose(R, t):
    """4x4 transform."""
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = t
    return T


def rotation_about_point(R, point):
    """Transform that turns by R about a point that stays where it is."""
    return pose(R, point - R @ point)


def difference(T_to, T_from):
    """The 6-vector [t_to - t_from; Log(R_to R_from^T)], axes of the camera."""
    return np.concatenate([T_to[:3, 3] - T_from[:3, 3], log_so3(T_to[:3, :3] @ T_from[:3, :3].T)])


def is_rotation(R, tolerance=1e-2):
    return bool(np.all(np.isfinite(R)) and np.abs(R @ R.T - np.eye(3)).max() < tolerance and np.linalg.det(R) > 0.0)


def nearest_rotation(R):
    """The rotation next to a matrix that is one up to rounding."""
    U, _, Vt = np.linalg.svd(R)
    return U @ Vt


def roll_pitch_yaw(R):
    """Angles (3) about the fixed x, y and z axes in this order: R = Rz(yaw) Ry(pitch) Rx(roll)."""
    pitch = np.arcsin(np.clip(-R[2, 0], -1.0, 1.0))
    return np.array([np.arctan2(R[2, 1], R[2, 2]), pitch, np.arctan2(R[1, 0], R[0, 0])])
