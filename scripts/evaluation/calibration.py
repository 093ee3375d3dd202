# SPDX-License-Identifier: BSD-3-Clause
"""Does the covariance say how large the error is? NEES, coverage, ranks."""
import numpy as np
from scipy.special import gammainc

from .statistics import mean, rank_correlation, share

VISIBILITY_BINS = [(0.0, 0.1), (0.1, 0.3), (0.3, 0.6), (0.6, 0.9), (0.9, 1.0)]
LEVELS = np.array([0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99])


def chi_square_levels(nees, dof):
    """Smallest confidence region that holds the truth, per frame: uniform in [0, 1] when calibrated."""
    # The chi-square distribution function; scipy.stats, which has it by name, takes a second to import.
    return gammainc(0.5 * np.asarray(dof, float), 0.5 * np.asarray(nees, float))


def coverage(nees, dof, levels=LEVELS):
    """Observed share of frames inside the region of each level."""
    found = chi_square_levels(nees, dof)
    found = found[np.isfinite(found)]
    return np.array([share(found <= level) for level in levels])


def calibration(nees, dof):
    """Figures over the frames with a finite NEES."""
    nees, dof = np.asarray(nees, float), np.asarray(dof, float)
    good = np.isfinite(nees)
    return {"frames": int(good.sum()), "nees_per_dof": mean(nees[good] / dof[good]),
            "nees_per_dof_median": float(np.median(nees[good] / dof[good])) if good.any() else float("nan"),
            "inside95": float(coverage(nees[good], dof[good], [0.95])[0])}


def by_visibility(nees, dof, visible):
    """{"0.1-0.3": calibration(...), ...}; frames of unknown visibility count as fully visible."""
    nees, dof = np.asarray(nees, float), np.asarray(dof, float)
    visible = np.where(np.isnan(visible), 1.0, visible)
    result = {}
    for low, high in VISIBILITY_BINS:
        inside = (visible >= low) & ((visible < high) | (high == 1.0))
        result[f"{low:g}-{high:g}"] = calibration(nees[inside], dof[inside])
    return result


def ranks(stddev, error):
    """Rank correlation of the predicted standard deviation with the error that occurred."""
    return rank_correlation(stddev, error)
