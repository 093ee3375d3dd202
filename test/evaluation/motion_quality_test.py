# SPDX-License-Identifier: BSD-3-Clause
"""Jitter and delay of made-up tracks."""
import math
import unittest

import numpy as np

from evaluation.motion_quality import delay_frames, jitter, rests
from evaluation.poses import pose

STILL = pose(np.eye(3), [0, 0, 1.0])


def moving(count, step):
    return [pose(np.eye(3), [step * k, 0, 1.0]) for k in range(count)]


class Jitter(unittest.TestCase):
    def test_of_known_noise_whatever_the_offset(self):
        errors = np.zeros((110, 6))
        errors[:, 0] = 0.005 + np.where(np.arange(110) % 2, 1e-4, -1e-4)
        errors[:, 5] = np.where(np.arange(110) % 2, 2e-3, -2e-3)
        stretches = rests([STILL] * 110, np.zeros(110), np.ones(110, bool))
        self.assertEqual(stretches, [(10, 110)])
        np.testing.assert_allclose(jitter(errors, stretches), [1e-4, 2e-3])

    def test_motion_ends_a_rest(self):
        poses = [STILL] * 40 + moving(40, 0.01) + [STILL] * 20
        self.assertEqual(rests(poses, np.zeros(100), np.ones(100, bool)), [(10, 41)])  # 20 frames are too few

    def test_nothing_at_rest(self):
        self.assertTrue(math.isnan(jitter(np.zeros((50, 6)), rests(moving(50, 0.01), np.zeros(50), np.ones(50, bool)))[0]))


class Delay(unittest.TestCase):
    def test_of_an_estimate_half_a_frame_behind(self):
        poses = moving(60, 0.01)
        errors = np.zeros((60, 6))
        errors[:, 0] = 0.005  # truth minus estimate
        self.assertAlmostEqual(delay_frames(poses, errors, np.full(60, 0.005), np.ones(60, bool)), 0.5)

    def test_needs_motion(self):
        self.assertTrue(math.isnan(delay_frames([STILL] * 60, np.zeros((60, 6)), np.zeros(60), np.ones(60, bool))))


if __name__ == "__main__":
    unittest.main()
