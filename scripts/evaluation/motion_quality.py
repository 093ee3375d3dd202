# SPDX-License-Identifier: BSD-3-Clause
"""Jitter while the object is at rest, and delay while it moves."""
import math

import numpy as np

from .poses import log_so3

REST_M, REST_RAD = 1e-5, 1e-4  # largest true motion between frames that is rest
MIN_REST_FRAMES = 30
SETTLING_FRAMES = 10  # at the start of each rest, not judged


def rests(poses, errors_m, seen):
    """Index pairs (first, end) of stretches in which the truth does not move while the object is seen and tracked."""
    found, start = [], None
    for k in range(len(poses) + 1):
        resting = k < len(poses) and poses[k] is not None and seen[k] and errors_m[k] < 0.02
        if resting and start is not None:
            delta = np.linalg.inv(poses[start]) @ poses[k]
            resting = np.linalg.norm(delta[:3, 3]) < REST_M and np.linalg.norm(log_so3(delta[:3, :3])) < REST_RAD
            if resting:
                continue
        if start is not None and k - start >= MIN_REST_FRAMES:
            found.append((start + SETTLING_FRAMES, k))
        usable = k < len(poses) and poses[k] is not None and seen[k] and errors_m[k] < 0.02
        start = k if usable else None
    return found


def jitter(error_vectors, stretches):
    """Root mean square deviation of the error from its mean at rest: (translation [m], rotation [rad]); NaN without rest.
    error_vectors: n x 6, as PoseErrorMeter.error_vector."""
    squares = []
    for first, end in stretches:
        deviation = error_vectors[first:end] - np.mean(error_vectors[first:end], axis=0)
        squares.append(np.stack([np.sum(deviation[:, :3]**2, axis=1), np.sum(deviation[:, 3:]**2, axis=1)], axis=1))
    if not squares:
        return math.nan, math.nan
    return tuple(float(x) for x in np.sqrt(np.mean(np.concatenate(squares), axis=0)))


def delay_frames(poses, error_vectors, errors_m, seen):
    """Frames by which the estimate runs behind the truth: the factor d in (error of the position) = d * (motion per frame),
    by least squares over frames that are seen, tracked and move at least 1 mm. NaN with less than 30 of them."""
    numerator = denominator = 0.0
    count = 0
    for k in range(1, len(poses)):
        if poses[k] is None or poses[k - 1] is None or not seen[k] or not errors_m[k] < 0.02:
            continue
        motion = poses[k][:3, 3] - poses[k - 1][:3, 3]
        if np.linalg.norm(motion) < 1e-3:
            continue
        numerator += float(error_vectors[k][:3] @ motion)
        denominator += float(motion @ motion)
        count += 1
    return numerator / denominator if count >= 30 else math.nan
