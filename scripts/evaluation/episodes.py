# SPDX-License-Identifier: BSD-3-Clause
"""Losses of the object, and how long it takes to come back."""
import math

SEEN_SHARE = 0.1  # with less of the object in sight nobody can be asked where it is
LOSS_ERROR_M = 0.05
LOSS_FRAMES = 15  # more frames than this in a row are a loss
VISIBLE_BEFORE_LOSS = 10  # frames in sight before a large error counts: nobody can know where a hidden object went
RECOVERED_ERROR_M = 0.02
HIDDEN_FRAMES = 3  # at least so many in a row are a full occlusion


def visible_long_enough(seen):
    """Per frame: in sight for VISIBLE_BEFORE_LOSS frames. Before the first frame the object counts as in sight: the
    tracker is given its pose."""
    result, run = [], 0
    for k, in_sight in enumerate(seen):
        run = run + 1 if in_sight else 0
        result.append(run >= VISIBLE_BEFORE_LOSS or run > k)
    return result


def losses(errors_m, seen):
    """Index pairs (first, after last) of stretches with an error over LOSS_ERROR_M in more than LOSS_FRAMES frames; frames
    that do not count (hidden, or not yet visible long enough, or without truth: NaN) neither end nor lengthen one.
    Returns [(first, end, counted frames)]."""
    found, start, count = [], None, 0

    def close(end):
        if count > LOSS_FRAMES:
            found.append((start, end, count))

    counts = visible_long_enough(seen)
    for k, error in enumerate(errors_m):
        if math.isnan(error):
            continue
        if error <= LOSS_ERROR_M:
            close(k)
            start, count = None, 0
        elif seen[k] and counts[k]:
            start = k if start is None else start
            count += 1
    close(len(errors_m))
    return found


def full_occlusions(visible):
    """Index pairs (first hidden, first seen again) of at least HIDDEN_FRAMES frames with a visible share below SEEN_SHARE;
    the second is None when the object stays hidden. NaN shares count as seen."""
    found, start = [], None
    for k, share in enumerate(list(visible) + [1.0]):
        hidden = share < SEEN_SHARE
        if hidden and start is None:
            start = k
        elif not hidden and start is not None:
            if k - start >= HIDDEN_FRAMES:
                found.append((start, k if k < len(visible) else None))
            start = None
    return found


def frames_until_recovered(errors_m, begin, seen):
    """Seen frames from `begin` until the error is below RECOVERED_ERROR_M (0: at once); inf when that never happens."""
    count = 0
    for k in range(begin, len(errors_m)):
        if not seen[k]:
            continue
        if errors_m[k] < RECOVERED_ERROR_M:
            return count
        count += 1
    return math.inf
