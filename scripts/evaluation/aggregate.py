# SPDX-License-Identifier: BSD-3-Clause
"""Figures over seeds and over sequences."""
import math

import numpy as np

from . import calibration, state_confusion
from .episodes import SEEN_SHARE
from .occlusion_score import RocCounter
from .statistics import accuracy_curve, finite

TEXT = ("error_kind",)
HIGHER_IS_BETTER = ("auc", "all_auc", "within", "all_within", "inside95", "rank", "occlusion_roc", "judged_frames")
THRESHOLDS_M = np.geomspace(1e-4, 0.1, 121)


def _median(values):
    """With infinite values ("never") in their place; NaN only where there is no number at all."""
    values = [v for v in values if not math.isnan(v)]
    if not values:
        return math.nan
    ordered = sorted(values)
    middle = len(ordered) // 2
    return ordered[middle] if len(ordered) % 2 else 0.5 * (ordered[middle - 1] + ordered[middle])


def _worst(key, values):
    values = [v for v in values if not math.isnan(v)]
    if not values:
        return math.nan
    return min(values) if key.startswith(HIGHER_IS_BETTER) else max(values)


def _pooled(tables):
    """NEES, degrees of freedom and true visible share of all judged frames."""
    chosen = [table.judged for table in tables]
    return [np.concatenate([getattr(t, name)[c] for t, c in zip(tables, chosen)]) if tables else np.array([])
            for name in ("nees", "dof", "visible")]


def _groups(outcomes):
    """What is counted over frames rather than averaged over runs."""
    tables = [o.table for o in outcomes]
    nees, dof, visible = _pooled(tables)
    hidden = [np.concatenate([getattr(t, name)[t.visible < SEEN_SHARE] for t in tables]) if tables else np.array([])
              for name in ("nees", "dof", "visible")]
    bins = calibration.by_visibility(np.concatenate([nees, hidden[0]]), np.concatenate([dof, hidden[1]]),
                                     np.concatenate([visible, hidden[2]]))
    errors = np.concatenate([t.error[t.judged] for t in tables]) if tables else np.array([])
    return {"confusion": state_confusion.add_tables(
                state_confusion.confusion(t.error, t.visible, t.states) for t in tables),
            "nees_by_visibility": bins,
            "reliability": {"expected": calibration.LEVELS.tolist(), "observed": calibration.coverage(nees, dof).tolist()},
            "accuracy_curve": {"threshold_m": THRESHOLDS_M.tolist(),
                               "share": accuracy_curve(errors, THRESHOLDS_M).tolist()}}


def summarise_scene(scene, outcomes):
    """Median and worst over the runs that did not fail."""
    good = [o for o in outcomes if o.figures]
    summary = {"scene": scene.name, "object_id": scene.object_id, "runs": len(outcomes),
               "failed_runs": len(outcomes) - len(good), "failures": [{"run": o.job.label, "problem": o.problem}
                                                                     for o in outcomes if not o.figures]}
    if not good:
        return summary
    summary["error_kind"] = good[0].figures["error_kind"]
    keys = [key for key in good[0].figures if key not in TEXT]
    summary["median"] = {key: _median([o.figures[key] for o in good]) for key in keys}
    summary["worst"] = {key: _worst(key, [o.figures[key] for o in good]) for key in keys}
    summary["lost_runs"] = sum(o.figures["loss_episodes"] > 0 for o in good)
    summary["per_run"] = [{"run": o.job.label, **o.figures} for o in good]
    summary.update(_groups(good))
    return summary


def summarise_all(summaries, outcomes):
    """Over the sequences: mean of the AUCs, median of the medians, worst of the worst; NEES and occlusion over all frames
    and pixels together."""
    good = [s for s in summaries if "median" in s]
    runs = [o for entries in outcomes.values() for o in entries if o.figures]
    total = {"scenes": len(summaries), "runs": sum(s["runs"] for s in summaries),
             "failed_runs": sum(s["failed_runs"] for s in summaries),
             "scenes_lost": sum(s["lost_runs"] > 0 for s in good), "lost_runs": sum(s["lost_runs"] for s in good)}
    if not good:
        return total
    keys = list(good[0]["median"])
    total["median"] = {key: _median([s["median"][key] for s in good]) for key in keys}
    total["worst"] = {key: _worst(key, [s["worst"][key] for s in good]) for key in keys}
    for key in keys:
        if "auc" in key or "within" in key:
            values = finite(s["median"][key] for s in good)
            total["median"][key] = float(values.mean()) if values.size else math.nan
    total.update(_groups(runs))
    nees, dof, _ = _pooled([o.table for o in runs])
    pooled = calibration.calibration(nees, dof)
    for key in ("nees_per_dof", "inside95", "nees_per_dof_median"):
        total["median"][key] = pooled[key]
    roc = RocCounter()
    for outcome in runs:
        if outcome.roc:
            roc.merge(outcome.roc)
    total["median"]["occlusion_roc"] = roc.area()
    return total
