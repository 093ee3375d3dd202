# SPDX-License-Identifier: BSD-3-Clause
"""ROC areas and reaction times of small pictures."""
import math
import pathlib
import tempfile
import unittest

import numpy as np
from PIL import Image

from evaluation import EvaluationError
from evaluation.occlusion_score import OCCLUDED, VISIBLE, ReactionTimer, RocCounter, read_mask, score_pictures, share_lag


def picture(*beliefs):
    """One row of 1 + round(254 p), 0 where p is None."""
    return np.array([[0 if p is None else 1 + round(254 * p) for p in beliefs]], np.uint8)


def mask(*values):
    return np.array([values], np.uint8)


def area(true_mask, estimate):
    counter = RocCounter()
    counter.add(true_mask, estimate)
    return counter.area()


class Roc(unittest.TestCase):
    def test_perfect_wrong_and_undecided(self):
        truth = mask(OCCLUDED, OCCLUDED, VISIBLE, VISIBLE)
        self.assertEqual(area(truth, picture(0.9, 0.8, 0.1, 0.3)), 1.0)
        self.assertEqual(area(truth, picture(0.1, 0.2, 0.9, 0.3)), 0.0)
        self.assertEqual(area(truth, picture(0.4, 0.4, 0.4, 0.4)), 0.5)

    def test_area_is_the_share_of_pairs_in_order(self):
        truth = mask(OCCLUDED, OCCLUDED, VISIBLE, VISIBLE)
        self.assertEqual(area(truth, picture(0.9, 0.2, 0.1, 0.3)), 0.75)

    def test_pixels_left_out_count_as_one_half(self):
        truth = mask(OCCLUDED, VISIBLE)
        self.assertEqual(area(truth, picture(None, 0.4)), 1.0)
        self.assertEqual(area(truth, picture(None, 0.6)), 0.0)
        self.assertEqual(area(truth, picture(None, 0.5)), 0.5)
        self.assertEqual(area(truth, None), 0.5)

    def test_pixels_off_the_object_do_not_count(self):
        self.assertEqual(area(mask(0, OCCLUDED, VISIBLE), picture(0.0, 0.7, 0.6)), 1.0)

    def test_one_kind_of_pixels_has_no_area(self):
        self.assertTrue(math.isnan(area(mask(VISIBLE, VISIBLE), picture(0.1, 0.2))))

    def test_the_curve_holds_the_area(self):
        random = np.random.default_rng(4)
        truth = np.where(random.random((50, 50)) < 0.3, OCCLUDED, VISIBLE)
        belief = np.clip(0.5 + 0.2 * (truth == OCCLUDED) + 0.2 * random.normal(size=truth.shape), 0, 1)
        counter = RocCounter()
        counter.add(truth, (1 + np.round(254 * belief)).astype(np.uint8))
        self.assertAlmostEqual(counter.area(), np.trapz(*reversed(counter.curve())), places=9)


class Pictures(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def save(self, name, array):
        Image.fromarray(array).save(self.path / name)
        return self.path / name

    def test_bops_pair_of_masks(self):
        pair = (self.save("mask.png", mask(0, 255, 255)), self.save("visib.png", mask(0, 0, 255)))
        np.testing.assert_array_equal(read_mask(pair), mask(0, OCCLUDED, VISIBLE))

    def test_missing_estimates_count_as_undecided(self):
        masks = {0: self.save("true0.png", mask(OCCLUDED, VISIBLE)), 1: self.save("true1.png", mask(OCCLUDED, VISIBLE))}
        self.save("000000.png", picture(1.0, 0.0))
        roc, _ = score_pictures(masks, self.path)
        self.assertEqual(roc.area(), 0.75 + 0.5 * 0.25)  # right: all but the pair of undecided ones

    def test_another_size_is_named(self):
        masks = {0: self.save("true0.png", mask(OCCLUDED, VISIBLE))}
        self.save("000000.png", picture(1.0))
        with self.assertRaisesRegex(EvaluationError, "1x1 pixels.*2x1"):
            score_pictures(masks, self.path)


class Reaction(unittest.TestCase):
    def test_counts_frames_until_the_belief_changes_side(self):
        timer = ReactionTimer()
        for frame, (value, belief) in enumerate([(VISIBLE, 0.1), (OCCLUDED, 0.2), (OCCLUDED, 0.4), (OCCLUDED, 0.8),
                                                 (VISIBLE, 0.3)]):
            timer.add(frame, mask(value), picture(belief))
        self.assertEqual(timer.frames(OCCLUDED), 2)
        self.assertEqual(timer.frames(VISIBLE), 0)

    def test_pixels_that_stay_wrong_count_as_never(self):
        timer = ReactionTimer()
        timer.add(0, mask(VISIBLE, VISIBLE), picture(0.1, 0.1))
        for frame in range(1, 15):
            timer.add(frame, mask(OCCLUDED, OCCLUDED), picture(0.9, 0.1))
        self.assertEqual(timer.frames(OCCLUDED, percent=50), 0)
        self.assertEqual(timer.frames(OCCLUDED), math.inf)

    def test_needs_successive_frames(self):
        timer = ReactionTimer()
        timer.add(0, mask(VISIBLE), picture(0.1))
        timer.add(10, mask(OCCLUDED), picture(0.9))
        self.assertTrue(math.isnan(timer.frames(OCCLUDED)))

    def test_lag_of_the_visible_share(self):
        truth = np.array([1.0] * 30 + [0.2] * 30 + [1.0] * 30)
        self.assertEqual(share_lag(truth, np.roll(truth, 3) - 0.1), 3.0)
        self.assertEqual(share_lag(truth, truth), 0.0)
        self.assertTrue(math.isnan(share_lag(np.ones(90), np.ones(90))))
        self.assertTrue(math.isnan(share_lag(truth, np.full(90, math.nan))))


if __name__ == "__main__":
    unittest.main()
