# SPDX-License-Identifier: BSD-3-Clause
"""Occlusion beliefs per pixel against ground-truth masks."""
import math

import numpy as np

from . import EvaluationError

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


class ReactionTimer:
    """Frames from a pixel's change (an occluder comes over the object, or goes) until the belief is on the right side of
    1/2. Only where masks of successive frames are there. Pixels still wrong after MAX_WAIT frames count as never right;
    those that change again before are left out."""

    MAX_WAIT = 10

    def __init__(self):
        self._last = None  # (frame, mask)
        self._waiting = {}  # value of the mask -> frames since the change, -1 where nothing is waited for
        self._found = {OCCLUDED: [], VISIBLE: []}

    def add(self, frame, mask, picture):
        if self._last is None or frame != self._last[0] + 1:
            self._waiting = {value: np.full(mask.shape, -1) for value in self._found}
        else:
            for value, other in ((OCCLUDED, VISIBLE), (VISIBLE, OCCLUDED)):
                self._advance(value, (mask == value) & (self._last[1] == other), mask, picture)
        self._last = (frame, mask)

    def _advance(self, value, changed, mask, picture):
        waiting = self._waiting[value]
        waiting[waiting >= 0] += 1
        waiting[mask != value] = -1
        waiting[changed] = 0
        if picture is None:
            return
        belief = twice_belief(picture)
        right = (waiting >= 0) & (belief > 254 if value == OCCLUDED else belief < 254)
        self._found[value].extend(waiting[right].tolist())
        waiting[right] = -1
        never = waiting >= self.MAX_WAIT
        self._found[value].extend([math.inf] * int(never.sum()))
        waiting[never] = -1

    def frames(self, value, percent=90):
        """Frames within which so many percent of the pixels reacted; NaN without any pixel."""
        found = sorted(self._found[value])
        return float(found[max(math.ceil(percent / 100 * len(found)), 1) - 1]) if found else math.nan


def read_belief(folder, frame, mask):
    """Estimated picture of a frame, None where there is none."""
    path = folder / f"{frame:06d}.png"
    if not path.is_file():
        return None
    picture = read_grey(path)
    if picture.shape != mask.shape:
        raise EvaluationError(f"{path} has {picture.shape[1]}x{picture.shape[0]} pixels, the mask of frame {frame} "
                              f"{mask.shape[1]}x{mask.shape[0]}")
    return picture


def score_pictures(masks, folder):
    """(RocCounter, ReactionTimer) over the frames with a mask. masks: {frame: source}; folder: of the estimates."""
    counter, timer = RocCounter(), ReactionTimer()
    for frame, source in sorted(masks.items()):
        mask = read_mask(source)
        picture = read_belief(folder, frame, mask)
        counter.add(mask, picture)
        timer.add(frame, mask, picture)
    return counter, timer


def share_lag(true_share, estimated_share):
    """Frames by which the estimated visible share runs behind the true one: the shift with the smallest deviation, any
    constant offset apart. NaN when the true share hardly changes (standard deviation under 0.1) or is too short."""
    truth, estimate = np.asarray(true_share, float), np.asarray(estimated_share, float)
    length = len(truth) - MAX_LAG
    if length < 2 * MAX_LAG or not np.all(np.isfinite(truth)) or np.std(truth) < 0.1 or not np.all(np.isfinite(estimate)):
        return math.nan
    return float(np.argmin([np.std(estimate[lag:lag + length] - truth[:length]) for lag in range(MAX_LAG + 1)]))
