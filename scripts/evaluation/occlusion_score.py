# SPDX-License-Identifier: BSD-3-Clause
"""Occlusion beliefs per pixel against ground-truth masks."""
import math

import numpy as np

OFF, OCCLUDED, VISIBLE = 0, 128, 255  # values of the true mask
MAX_LAG = 15
BINS = 509  # beliefs are multiples of 1/254, or 1/2 where there is none: twice the value is a whole number


def read_grey(path):
    """Picture as an array (rows x columns) of numbers."""
    from PIL import Image

    with Image.open(path) as picture:
        return np.array(picture.convert("L") if picture.mode in ("RGB", "RGBA", "P") else picture)


def read_mask(source):
    """True mask with OFF, OCCLUDED, VISIBLE; source is a path (ours) or BOP's pair (whole object, visible part)."""
    if not isinstance(source, tuple):
        return read_grey(source)
    whole, visible = (read_grey(path) > 0 for path in source)
    return np.where(visible, VISIBLE, np.where(whole, OCCLUDED, OFF)).astype(np.uint8)


def twice_belief(picture):
    """Whole numbers 2 * 254 * p; pixels that the estimate leaves out (0) count as p = 0.5."""
    picture = picture.astype(int)
    return np.where(picture == 0, 254, 2 * (picture - 1))


class RocCounter:
    """Area under the ROC curve of "occluded" over all true object pixels of the pictures added."""

    def __init__(self):
        self.occluded = np.zeros(BINS)
        self.visible = np.zeros(BINS)

    def add(self, mask, picture):
        """picture: None where there is no estimate at all."""
        belief = np.full(mask.shape, 254) if picture is None else twice_belief(picture)
        self.occluded += np.bincount(belief[mask == OCCLUDED], minlength=BINS)
        self.visible += np.bincount(belief[mask == VISIBLE], minlength=BINS)

    def area(self):
        """P(belief at an occluded pixel > at a visible one) + P(equal) / 2; NaN when one kind is missing."""
        if not self.occluded.sum() or not self.visible.sum():
            return math.nan
        below = np.cumsum(self.visible) - self.visible
        return float((self.occluded @ (below + 0.5 * self.visible)) / (self.occluded.sum() * self.visible.sum()))

    def curve(self):
        """(false alarm rates, hit rates), both from 0 to 1."""
        rates = [np.concatenate([[0.0], np.cumsum(c[::-1])]) / max(c.sum(), 1.0) for c in (self.visible, self.occluded)]
        return rates[0], rates[1]

    def merge(self, other):
        self.occluded += other.occluded
        self.visible += other.visible


def score_pictures(masks, folder):
    """RocCounter over the frames with a mask. masks: {frame: source}; folder: of the estimated pictures."""
    counter = RocCounter()
    for frame, source in sorted(masks.items()):
        path = folder / f"{frame:06d}.png"
        mask = read_mask(source)
        picture = read_grey(path) if path.is_file() else None
        if picture is not None and picture.shape != mask.shape:
            raise ValueError(f"{path} has {picture.shape[1]}x{picture.shape[0]} pixels, the mask of frame {frame} "
                             f"{mask.shape[1]}x{mask.shape[0]}")
        counter.add(mask, picture)
    return counter


def share_lag(true_share, estimated_share):
    """Frames by which the estimated visible share runs behind the true one: the shift with the smallest deviation, any
    constant offset apart. NaN when the true share hardly changes (standard deviation under 0.1) or is too short."""
    truth, estimate = np.asarray(true_share, float), np.asarray(estimated_share, float)
    length = len(truth) - MAX_LAG
    if length < 2 * MAX_LAG or not np.all(np.isfinite(truth)) or np.std(truth) < 0.1:
        return math.nan
    deviations = []
    for lag in range(MAX_LAG + 1):
        difference = estimate[lag:lag + length] - truth[:length]
        deviations.append(np.nanstd(difference))
    return float(np.argmin(deviations))
