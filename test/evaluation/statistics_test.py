# SPDX-License-Identifier: BSD-3-Clause
"""Percentiles, areas and ranks against closed forms."""
import math
import unittest

import numpy as np

from evaluation.statistics import accuracy_curve, area_under_accuracy, mean, percentile, rank_correlation, share


class Statistics(unittest.TestCase):
    def test_percentiles_interpolate_and_leave_nan_out(self):
        self.assertEqual(percentile([4.0, 1.0, math.nan, 2.0, 3.0], 50), 2.5)
        self.assertEqual(percentile([4.0, 1.0], 100), 4.0)
        self.assertTrue(math.isnan(percentile([], 50)))

    def test_area_of_a_constant_error(self):
        self.assertAlmostEqual(area_under_accuracy([0.02] * 5), 0.8)
        self.assertEqual(area_under_accuracy([0.3, 0.5]), 0.0)
        self.assertEqual(area_under_accuracy([0.0]), 1.0)
        self.assertTrue(math.isnan(area_under_accuracy([])))

    def test_area_is_that_under_the_curve(self):
        errors = np.random.default_rng(1).exponential(0.03, 500)
        thresholds = np.linspace(0, 0.1, 20001)
        curve = accuracy_curve(errors, thresholds)
        self.assertAlmostEqual(area_under_accuracy(errors), np.trapz(curve, thresholds) / 0.1, places=4)

    def test_curve_counts_errors_at_the_threshold(self):
        np.testing.assert_allclose(accuracy_curve([0.01, 0.02, 0.03, 0.04], [0.0, 0.02, 0.1]), [0.0, 0.5, 1.0])

    def test_ranks(self):
        self.assertAlmostEqual(rank_correlation([1, 2, 3, 4], [1, 8, 27, 64]), 1.0)
        self.assertAlmostEqual(rank_correlation([1, 2, 3, 4], [4, 3, 2, 1]), -1.0)
        self.assertAlmostEqual(rank_correlation([1, 2, 3, 4, 5], [2, 1, 4, 3, 5]), 0.8)  # 1 - 6 * 4 / (5 * 24)
        # Ties share ranks: 1.5, 1.5, 3 against 1, 2, 3.
        self.assertAlmostEqual(rank_correlation([5, 5, 7], [1, 2, 3]), 1.5 / math.sqrt(1.5 * 2.0))
        self.assertTrue(math.isnan(rank_correlation([1, 1, 1], [1, 2, 3])))
        self.assertTrue(math.isnan(rank_correlation([1, 2], [1, 2])))

    def test_means_and_shares_of_nothing(self):
        self.assertTrue(math.isnan(mean([math.nan])))
        self.assertTrue(math.isnan(share([])))
        self.assertEqual(share([True, False]), 0.5)


if __name__ == "__main__":
    unittest.main()
