# SPDX-License-Identifier: BSD-3-Clause
"""Coverage and NEES against the chi-square distribution."""
import math
import unittest

import numpy as np

from evaluation.calibration import LEVELS, by_visibility, calibration, chi_square_levels, coverage


class Calibration(unittest.TestCase):
    def test_levels_of_two_dimensions_are_exponential(self):
        np.testing.assert_allclose(chi_square_levels([0.0, 1.0, 5.0], [2, 2, 2]), 1 - np.exp([0.0, -0.5, -2.5]))

    def test_the_95_percent_quantiles(self):
        np.testing.assert_allclose(chi_square_levels([11.0705, 12.5916], [5, 6]), 0.95, atol=1e-5)

    def test_draws_from_the_distribution_are_calibrated(self):
        draws = np.random.default_rng(2).chisquare(6, 20000)
        np.testing.assert_allclose(coverage(draws, np.full(20000, 6)), LEVELS, atol=0.015)
        figures = calibration(draws, np.full(20000, 6))
        self.assertAlmostEqual(figures["nees_per_dof"], 1.0, delta=0.02)
        self.assertAlmostEqual(figures["inside95"], 0.95, delta=0.006)

    def test_too_small_a_covariance_shows(self):
        draws = 4 * np.random.default_rng(2).chisquare(6, 2000)  # standard deviations half of what they should be
        figures = calibration(draws, np.full(2000, 6))
        self.assertAlmostEqual(figures["nees_per_dof"], 4.0, delta=0.2)
        self.assertLess(figures["inside95"], 0.4)

    def test_frames_without_covariance_do_not_count(self):
        figures = calibration([6.0, math.nan], [6.0, math.nan])
        self.assertEqual((figures["frames"], figures["nees_per_dof"]), (1, 1.0))

    def test_bins_of_visibility(self):
        bins = by_visibility([1.0, 2.0, 3.0, 4.0, 5.0], [1.0] * 5, np.array([0.05, 0.1, 0.95, 1.0, math.nan]))
        self.assertEqual([figures["frames"] for figures in bins.values()], [1, 1, 0, 0, 3])
        self.assertEqual(bins["0.9-1"]["nees_per_dof"], 4.0)


if __name__ == "__main__":
    unittest.main()
