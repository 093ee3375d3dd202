# SPDX-License-Identifier: BSD-3-Clause
"""Figures over a list of numbers; NaN where there is none."""
import numpy as np

AUC_LIMIT_M = 0.1


def finite(values):
    array = np.asarray(list(values), dtype=float)
    return array[np.isfinite(array)]


def percentile(values, percent):
    """Linear interpolation between order statistics."""
    values = finite(values)
    return float(np.percentile(values, percent)) if values.size else float("nan")


def mean(values):
    values = finite(values)
    return float(values.mean()) if values.size else float("nan")


def share(condition):
    condition = np.asarray(condition, dtype=bool)
    return float(condition.mean()) if condition.size else float("nan")


def area_under_accuracy(errors_m, limit_m=AUC_LIMIT_M):
    """Area under (share of frames with an error below x) for x in [0, limit], over the limit: in [0, 1]."""
    errors = finite(errors_m)
    return float(np.clip(1.0 - errors / limit_m, 0.0, None).mean()) if errors.size else float("nan")


def accuracy_curve(errors_m, thresholds_m):
    """Share of frames with an error of at most each threshold."""
    errors = np.sort(finite(errors_m))
    if not errors.size:
        return np.full(len(thresholds_m), np.nan)
    return np.searchsorted(errors, thresholds_m, side="right") / errors.size


def _ranks(values):
    """1 for the smallest; equal values share the mean of their ranks."""
    _, place, counts = np.unique(values, return_inverse=True, return_counts=True)
    return (np.cumsum(counts) - 0.5 * (counts - 1))[place]


def rank_correlation(a, b):
    """Spearman's: 1 where the larger goes with the larger; NaN with less than 3 pairs or without variation."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    both = np.isfinite(a) & np.isfinite(b)
    if both.sum() < 3:
        return float("nan")
    ranks = _ranks(a[both]), _ranks(b[both])
    if min(np.std(r) for r in ranks) == 0.0:
        return float("nan")
    return float(np.corrcoef(*ranks)[0, 1])
