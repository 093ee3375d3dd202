# SPDX-License-Identifier: BSD-3-Clause
"""Losses and recoveries on sequences made by hand."""
import math
import unittest

from evaluation.episodes import frames_until_recovered, full_occlusions, losses, visible_long_enough

NEAR, FAR = 0.001, 0.2


class Losses(unittest.TestCase):
    def test_more_than_15_frames_over_5_cm(self):
        self.assertEqual(losses([NEAR] * 20 + [FAR] * 15 + [NEAR], [True] * 36), [])
        self.assertEqual(losses([NEAR] * 20 + [FAR] * 16 + [NEAR], [True] * 37), [(20, 36, 16)])

    def test_until_the_end(self):
        self.assertEqual(losses([NEAR] * 5 + [FAR] * 40, [True] * 45), [(5, 45, 40)])

    def test_hidden_frames_and_the_ten_after_them_do_not_count(self):
        seen = [True] * 10 + [False] * 30 + [True] * 25
        self.assertEqual(losses([FAR] * 65, seen), [(0, 65, 10 + 16)])  # the tenth frame in sight counts again
        errors = [NEAR] * 10 + [FAR] * 30 + [FAR] * 24 + [NEAR]
        self.assertEqual(losses(errors, seen), [])  # 15 counted frames only

    def test_frames_without_truth_neither_end_nor_count(self):
        self.assertEqual(losses([FAR] * 10 + [math.nan] * 5 + [FAR] * 6, [True] * 21), [(0, 21, 16)])

    def test_before_the_first_frame_the_object_counts_as_seen(self):
        self.assertTrue(all(visible_long_enough([True] * 3)))
        self.assertEqual(visible_long_enough([False] + [True] * 10), [False] * 10 + [True])


class Recovery(unittest.TestCase):
    def test_full_occlusions_of_three_frames_or_more(self):
        visible = [1.0, 0.05, 0.05, 1.0, 0.09, 0.0, 0.0, 0.1, 1.0, 0.0, 0.0, 0.0]
        self.assertEqual(full_occlusions(visible), [(4, 7), (9, None)])

    def test_unknown_visibility_is_no_occlusion(self):
        self.assertEqual(full_occlusions([math.nan] * 5), [])

    def test_seen_frames_until_under_2_cm(self):
        errors, seen = [FAR, FAR, FAR, 0.019], [True, False, True, True]
        self.assertEqual(frames_until_recovered(errors, 0, seen), 2)
        self.assertEqual(frames_until_recovered(errors, 3, seen), 0)
        self.assertEqual(frames_until_recovered([FAR] * 3, 0, [True] * 3), math.inf)


if __name__ == "__main__":
    unittest.main()
