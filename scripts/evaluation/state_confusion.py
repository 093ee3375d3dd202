# SPDX-License-Identifier: BSD-3-Clause
"""What the tracker says of itself against what is true."""
import math

from .episodes import LOSS_ERROR_M, SEEN_SHARE

TRUE_STATES = ["TRACKING", "OCCLUDED", "LOST"]
STATES = ["TRACKING", "OCCLUDED", "LOST", "INITIALIZING", "UNINITIALIZED"]


def true_state(error_m, visible):
    """OCCLUDED when hardly any of the object is in sight, LOST when the error is large all the same, else TRACKING.
    None without ground truth."""
    if math.isnan(error_m):
        return None
    if visible < SEEN_SHARE:  # false for NaN: unknown counts as visible
        return "OCCLUDED"
    return "LOST" if error_m > LOSS_ERROR_M else "TRACKING"


def confusion(errors_m, visible, states):
    """{true state: {state said: frames}}."""
    table = {truth: {state: 0 for state in STATES} for truth in TRUE_STATES}
    for error, share, state in zip(errors_m, visible, states):
        truth = true_state(error, share)
        if truth is not None:
            table[truth][state if state in STATES else "UNINITIALIZED"] += 1
    return table


def add_tables(tables):
    total = confusion([], [], [])
    for table in tables:
        for truth in TRUE_STATES:
            for state in STATES:
                total[truth][state] += table[truth][state]
    return total


def right_share(table, truth):
    """Share of the frames of a true state for which the tracker says just this; NaN without any."""
    frames = sum(table[truth].values())
    return table[truth][truth] / frames if frames else math.nan


def longest_run(errors_m, visible, states, truth, said):
    """Most frames in a row in which `truth` was true and `said` was said."""
    longest = run = 0
    for error, share, state in zip(errors_m, visible, states):
        run = run + 1 if true_state(error, share) == truth and state == said else 0
        longest = max(longest, run)
    return longest
