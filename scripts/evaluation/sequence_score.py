# SPDX-License-Identifier: BSD-3-Clause
"""All figures of one run over one scene."""
import dataclasses
import math

import numpy as np

from . import calibration, episodes, motion_quality, occlusion_score, state_confusion
from .statistics import area_under_accuracy, mean, percentile, share

PUBLISHED = ("TRACKING", "OCCLUDED", "INITIALIZING")  # states in which a pose (with its covariance) goes out


@dataclasses.dataclass
class FrameTable:
    """Per-frame figures; every field is a list or array over the run's frames, NaN where there is no truth."""
    frames: list
    stamps: np.ndarray
    true_poses: list  # None where there is no truth
    poses: list
    scores: np.ndarray
    states: list
    visible: np.ndarray  # true share, NaN where unknown
    estimated_visible: np.ndarray
    times_s: np.ndarray
    add: np.ndarray
    add_s: np.ndarray
    translation: np.ndarray
    rotation: np.ndarray
    error_vectors: np.ndarray
    nees: np.ndarray  # NaN also where no pose was published
    dof: np.ndarray
    stddev_translation: np.ndarray
    stddev_rotation: np.ndarray
    symmetric: bool

    @property
    def error(self):
        """The error that counts: ADD-S where symmetries are declared, ADD otherwise."""
        return self.add_s if self.symmetric else self.add

    @property
    def seen(self):
        return ~(self.visible < episodes.SEEN_SHARE)

    @property
    def judged(self):
        return self.seen & np.isfinite(self.error)


def make_table(truth, run, meter):
    """Compares every estimated frame with the truth."""
    n = len(run.frames)
    columns = {name: np.full(n, math.nan) for name in
               ("add", "add_s", "nees", "dof", "stddev_translation", "stddev_rotation")}
    vectors = np.full((n, 6), math.nan)
    true_poses = [truth.poses.get(frame) for frame in run.frames]
    for k, T_truth in enumerate(true_poses):
        if run.covariances is not None and np.all(np.isfinite(run.covariances[k])):
            columns["stddev_translation"][k], columns["stddev_rotation"][k] = meter.standard_deviations(
                run.poses[k], run.covariances[k])
        if T_truth is None:
            continue
        columns["add"][k] = meter.add(run.poses[k], T_truth)
        columns["add_s"][k] = meter.add_s(run.poses[k], T_truth)
        vectors[k] = meter.error_vector(run.poses[k], T_truth)
        if run.covariances is not None and run.states[k] in PUBLISHED and np.all(np.isfinite(run.covariances[k])):
            columns["nees"][k], columns["dof"][k] = meter.nees(run.poses[k], run.covariances[k], T_truth)
    return FrameTable(
        frames=run.frames, stamps=np.array([truth.stamps.get(f, math.nan) for f in run.frames], float),
        true_poses=true_poses, poses=run.poses, scores=run.scores, states=run.states,
        visible=np.array([truth.visible.get(f, math.nan) for f in run.frames], float),
        estimated_visible=run.visible if run.visible is not None else np.full(n, math.nan), times_s=run.times_s,
        translation=np.linalg.norm(vectors[:, :3], axis=1), rotation=np.linalg.norm(vectors[:, 3:], axis=1),
        error_vectors=vectors, symmetric=meter.symmetric, **columns)


def _accuracy(table, chosen, prefix):
    """Error percentiles over the chosen frames, in mm and degrees."""
    result = {}
    for name, values, scale in (("add_mm", table.add, 1e3), ("add_s_mm", table.add_s, 1e3), ("error_mm", table.error, 1e3),
                                ("translation_mm", table.translation, 1e3),
                                ("rotation_deg", table.rotation, math.degrees(1.0))):
        for label, percent in (("median", 50), ("p95", 95), ("max", 100)):
            result[f"{prefix}{name}_{label}"] = scale * percentile(values[chosen], percent)
    for name, values in (("add", table.add), ("add_s", table.add_s), ("error", table.error)):
        result[f"{prefix}auc_{name}"] = area_under_accuracy(values[chosen])
    result[f"{prefix}within_5cm_5deg"] = share((table.translation[chosen] < 0.05) &
                                               (table.rotation[chosen] < math.radians(5.0)))
    return result


def _losses(table):
    found = episodes.losses(table.error, table.seen)
    after_loss = [episodes.frames_until_recovered(table.error, first, table.seen) for first, _, _ in found]
    after_hidden = [episodes.frames_until_recovered(table.error, seen_again, table.seen)
                    for _, seen_again in episodes.full_occlusions(table.visible)
                    if seen_again is not None and np.isfinite(table.error[seen_again])]
    return {"loss_episodes": len(found), "lost_frames": sum(count for _, _, count in found),
            "recovery_after_loss_frames": max(after_loss, default=math.nan),
            "full_occlusions": len(after_hidden),
            "recovery_after_occlusion_frames": max(after_hidden, default=math.nan)}


def _calibration(table):
    chosen = table.judged
    result = calibration.calibration(table.nees[chosen], table.dof[chosen])
    figures = {"nees_frames": result["frames"], "nees_per_dof": result["nees_per_dof"],
               "nees_per_dof_median": result["nees_per_dof_median"], "inside95": result["inside95"]}
    published = chosen & np.isfinite(table.nees)
    figures["rank_translation"] = calibration.ranks(table.stddev_translation[published], table.translation[published])
    figures["rank_rotation"] = calibration.ranks(table.stddev_rotation[published], table.rotation[published])
    return figures


def _states(table):
    said = (table.error, table.visible, table.states)
    figures = {f"said_{state.lower()}": table.states.count(state) for state in state_confusion.STATES}
    figures["wrong_as_tracking_longest"] = state_confusion.longest_run(*said, "LOST", "TRACKING")
    figures["false_lost_frames"] = state_confusion.confusion(*said)["TRACKING"]["LOST"]
    return figures


def _motion(table):
    stretches = motion_quality.rests(table.true_poses, table.error, table.seen)
    translation, rotation = motion_quality.jitter(table.error_vectors, stretches)
    delay = motion_quality.delay_frames(table.true_poses, table.error_vectors, table.error, table.seen)
    return {"jitter_mm": 1e3 * translation, "jitter_deg": math.degrees(rotation), "delay_frames": delay}


def _occlusion(table, roc, timer):
    nothing = roc is None
    return {"occlusion_roc": math.nan if nothing else roc.area(),
            "occlusion_lag_frames": occlusion_score.share_lag(table.visible, table.estimated_visible),
            "reaction_comes_frames": math.nan if nothing else timer.frames(occlusion_score.OCCLUDED),
            "reaction_goes_frames": math.nan if nothing else timer.frames(occlusion_score.VISIBLE)}


def score_run(table, roc=None, timer=None):
    """Flat dictionary of figures; roc, timer: what occlusion_score.score_pictures gives, None without pictures."""
    figures = {"frames": len(table.frames), "judged_frames": int(table.judged.sum()),
               "error_kind": "ADD-S" if table.symmetric else "ADD"}
    figures.update(_accuracy(table, table.judged, ""))
    figures.update(_accuracy(table, np.isfinite(table.error), "all_"))
    figures.update(_losses(table))
    figures.update(_calibration(table))
    figures.update(_occlusion(table, roc, timer))
    figures.update(_states(table))
    figures.update(_motion(table))
    figures["time_ms_median"] = 1e3 * percentile(table.times_s, 50)
    figures["time_ms_p99"] = 1e3 * percentile(table.times_s, 99)
    figures["time_ms_mean"] = 1e3 * mean(table.times_s)
    return figures
