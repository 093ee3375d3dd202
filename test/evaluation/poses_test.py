# SPDX-License-Identifier: BSD-3-Clause
"""Rotations against closed forms."""
import math
import unittest

import numpy as np

from evaluation.poses import (difference, exp_so3, is_rotation, log_so3, nearest_rotation, pose, quaternion, roll_pitch_yaw,
                              rotation_about_point, rotation_from_quaternion)


class Poses(unittest.TestCase):
    def test_exp_of_a_quarter_turn_about_z(self):
        np.testing.assert_allclose(exp_so3([0, 0, math.pi / 2]) @ [1, 0, 0], [0, 1, 0], atol=1e-12)

    def test_log_undoes_exp_for_small_middle_and_nearly_half_turns(self):
        axis = np.array([0.48, -0.6, 0.64])
        for angle in (0.0, 1e-10, 1e-6, 0.3, 2.0, 3.0, math.pi - 1e-7):
            np.testing.assert_allclose(log_so3(exp_so3(angle * axis)), angle * axis, atol=1e-7)

    def test_log_of_half_turns_about_every_axis(self):
        for axis in np.eye(3):
            np.testing.assert_allclose(np.abs(log_so3(exp_so3(math.pi * axis))), math.pi * axis, atol=1e-7)

    def test_quaternion_and_back(self):
        random = np.random.default_rng(3)
        for _ in range(50):
            R = exp_so3(random.normal(size=3) * 2)
            np.testing.assert_allclose(rotation_from_quaternion(quaternion(R)), R, atol=1e-9)

    def test_quaternion_of_a_turn_about_z(self):
        np.testing.assert_allclose(quaternion(exp_so3([0, 0, 1.0])), [math.cos(0.5), 0, 0, math.sin(0.5)], atol=1e-12)

    def test_difference_turns_from_the_left(self):
        T = pose(exp_so3([0.3, -0.2, 0.9]), [1, 2, 3])
        moved = pose(exp_so3([0, 0, 0.1]) @ T[:3, :3], [1.5, 2, 3])
        np.testing.assert_allclose(difference(moved, T), [0.5, 0, 0, 0, 0, 0.1], atol=1e-9)

    def test_rotation_about_point_keeps_the_point(self):
        T = rotation_about_point(exp_so3([0.1, 0.7, 0]), np.array([1.0, 2, 3]))
        np.testing.assert_allclose(T @ [1, 2, 3, 1], [1, 2, 3, 1], atol=1e-12)

    def test_roll_pitch_yaw(self):
        R = exp_so3([0, 0, 0.7]) @ exp_so3([0, -0.3, 0]) @ exp_so3([0.2, 0, 0])
        np.testing.assert_allclose(roll_pitch_yaw(R), [0.2, -0.3, 0.7], atol=1e-12)

    def test_what_is_no_rotation(self):
        self.assertFalse(is_rotation(np.diag([1.0, 1.0, -1.0])))
        self.assertFalse(is_rotation(2 * np.eye(3)))
        self.assertFalse(is_rotation(np.full((3, 3), math.nan)))
        rounded = np.round(exp_so3([0.3, 0.2, 0.1]), 3)
        self.assertTrue(is_rotation(rounded))
        np.testing.assert_allclose(nearest_rotation(rounded) @ nearest_rotation(rounded).T, np.eye(3), atol=1e-12)


if __name__ == "__main__":
    unittest.main()
