# SPDX-License-Identifier: BSD-3-Clause
"""Scores pose tracks against ground truth; the command is scripts/evaluate.

Units: m, rad, s. Poses are 4x4 arrays T_camera_object in the camera's optical frame.
"""


class EvaluationError(Exception):
    """Input that cannot be used; the message says what, where and what to do."""
