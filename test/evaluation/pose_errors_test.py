# SPDX-License-Identifier: BSD-3-Clause
"""ADD, ADD-S and NEES against closed forms."""
import math
import unittest

import numpy as np

from evaluation.pose_errors import PoseErrorMeter
from evaluation.poses import exp_so3, pose
from evaluation.symmetries import Symmetries

RADIUS = 0.05
ANGLES = np.linspace(0, 2 * math.pi, 720, endpoint=False)
RING = np.stack([RADIUS * np.cos(ANGLES), RADIUS * np.sin(ANGLES), 0 * ANGLES], axis=1)
Z = np.array([0.0, 0.0, 1.0])
ROUND = Symmetries([(Z, np.zeros(3))])
T_TRUTH = pose(exp_so3([0.4, 0.2, -0.7]), [0.05, -0.1, 0.8])


class Distances(unittest.TestCase):
    def setUp(self):
        self.meter = PoseErrorMeter(RING, Symmetries())

    def test_add_of_a_shift_is_its_length(self):
        shifted = T_TRUTH.copy()
        shifted[:3, 3] += [0.003, 0.0, 0.004]
        self.assertAlmostEqual(self.meter.add(shifted, T_TRUTH), 0.005, places=12)

    def test_add_of_a_turned_ring_is_the_chord(self):
        turned = T_TRUTH @ pose(exp_so3(0.6 * Z), [0, 0, 0])
        self.assertAlmostEqual(self.meter.add(turned, T_TRUTH), 2 * RADIUS * math.sin(0.3), places=12)

    def test_add_s_does_not_see_the_turn_but_a_shift_along_the_axis(self):
        turned = T_TRUTH @ pose(exp_so3(ANGLES[40] * Z), [0, 0, 0])
        self.assertAlmostEqual(self.meter.add_s(turned, T_TRUTH), 0.0, places=9)
        self.assertAlmostEqual(self.meter.add_s(turned @ pose(np.eye(3), [0, 0, 0.002]), T_TRUTH), 0.002, places=9)

    def test_error_vector_is_that_to_the_nearest_equivalent(self):
        meter = PoseErrorMeter(RING, ROUND)
        turned = T_TRUTH @ pose(exp_so3(2.0 * Z), [0, 0, 0.001])
        error = meter.error_vector(turned, T_TRUTH)
        np.testing.assert_allclose(error[:3], -0.001 * T_TRUTH[:3, 2], atol=1e-12)
        np.testing.assert_allclose(error[3:], 0.0, atol=1e-9)


class Nees(unittest.TestCase):
    def test_of_independent_errors_is_the_sum_of_squares_over_variances(self):
        meter = PoseErrorMeter(RING, Symmetries())
        estimate = pose(exp_so3([0, 0, -0.02]) @ T_TRUTH[:3, :3], T_TRUTH[:3, 3] - [0.001, 0, 0])
        covariance = np.diag([4e-6, 1e-6, 1e-6, 1e-4, 1e-4, 1e-4])
        nees, dof = meter.nees(estimate, covariance, T_TRUTH)
        self.assertEqual(dof, 6)
        self.assertAlmostEqual(nees, 1e-6 / 4e-6 + 4e-4 / 1e-4, places=6)

    def test_uses_correlations(self):
        meter = PoseErrorMeter(RING, Symmetries())
        covariance = 1e-6 * np.eye(6)
        covariance[0, 1] = covariance[1, 0] = 0.8e-6
        estimate = T_TRUTH.copy()
        estimate[:3, 3] -= [0.001, 0.001, 0.0]
        # e = (1, 1) mm, C = [[1, .8], [.8, 1]] mm^2: e^T C^-1 e = 2 / 1.8
        self.assertAlmostEqual(meter.nees(estimate, covariance, T_TRUTH)[0], 2 / 1.8, places=9)

    def test_the_spin_of_a_round_object_does_not_count(self):
        meter = PoseErrorMeter(RING, ROUND)
        axis = T_TRUTH[:3, 2]
        covariance = 1e-6 * np.eye(6)
        covariance[3:, 3:] += 1e4 * np.outer(axis, axis)
        spun = T_TRUTH @ pose(exp_so3(1.3 * Z), [0, 0, 0.002])
        nees, dof = meter.nees(spun, covariance, T_TRUTH)
        self.assertEqual(dof, 5)
        self.assertAlmostEqual(nees, 4.0, places=5)

    def test_is_nan_where_the_covariance_is_no_covariance(self):
        meter = PoseErrorMeter(RING, Symmetries())
        self.assertTrue(math.isnan(meter.nees(T_TRUTH, np.zeros((6, 6)), T_TRUTH)[0]))
        self.assertTrue(math.isnan(meter.nees(T_TRUTH, -np.eye(6), T_TRUTH)[0]))

    def test_standard_deviations_leave_the_free_axis_out(self):
        axis = T_TRUTH[:3, 2]
        covariance = 1e-6 * np.eye(6)
        covariance[3:, 3:] += 9.0 * np.outer(axis, axis)
        translation, rotation = PoseErrorMeter(RING, ROUND).standard_deviations(T_TRUTH, covariance)
        self.assertAlmostEqual(translation, math.sqrt(3e-6), places=9)
        self.assertAlmostEqual(rotation, math.sqrt(2e-6), places=9)

    def test_mean_over_draws_is_the_number_of_dimensions(self):
        meter = PoseErrorMeter(RING, Symmetries())
        random = np.random.default_rng(5)
        A = 1e-3 * random.normal(size=(6, 6))
        draws = random.multivariate_normal(np.zeros(6), A @ A.T, 2000)
        values = [meter.nees(pose(exp_so3(-e[3:]) @ T_TRUTH[:3, :3], T_TRUTH[:3, 3] - e[:3]), A @ A.T, T_TRUTH)[0] for e in draws]
        self.assertAlmostEqual(np.mean(values), 6.0, delta=5 * math.sqrt(12.0 / 2000))


if __name__ == "__main__":
    unittest.main()
