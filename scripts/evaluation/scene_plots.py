# SPDX-License-Identifier: BSD-3-Clause
"""Plots of one run: pose over time, errors over time, occlusion."""
import csv
import math

import numpy as np

from .episodes import LOSS_ERROR_M, SEEN_SHARE
from .occlusion_score import OCCLUDED, VISIBLE, read_grey, read_mask
from .plot_style import ESTIMATE, FORWARD_KINEMATICS, STATE_COLOURS, TRUTH, log_axis, new_figure, save, shade_hidden
from .poses import pose, roll_pitch_yaw, rotation_from_quaternion
from .symmetries import fold

LABELS = ["x [m]", "y [m]", "z [m]", "roll [deg]", "pitch [deg]", "yaw [deg]"]


def six_numbers(poses):
    """n x 6 [m, deg] with angles that do not jump; NaN rows where there is no pose."""
    result = np.full((len(poses), 6), math.nan)
    for k, T in enumerate(poses):
        if T is not None:
            result[k] = np.concatenate([T[:3, 3], roll_pitch_yaw(T[:3, :3])])
    known = np.isfinite(result[:, 3])
    if known.any():
        result[known, 3:] = np.degrees(np.unwrap(result[known, 3:], axis=0))
    return result


def _aligned(angles, reference):
    """Whole turns added so that angles [deg] run beside the reference."""
    return angles - 360.0 * np.round((angles - reference) / 360.0)


def read_forward_kinematics(scene):
    """{frame: pose} of fk.csv (frame,t,px,py,pz,qw,qx,qy,qz: where the robot's model has the object), {} without it."""
    path = scene.folder / "fk.csv"
    if not path.is_file():
        return {}
    with open(path, newline="", encoding="utf-8") as file:
        return {int(row["frame"]): pose(rotation_from_quaternion([float(row[q]) for q in ("qw", "qx", "qy", "qz")]),
                                        [float(row[p]) for p in ("px", "py", "pz")]) for row in csv.DictReader(file)}


def plot_trajectory(path, scene, table, symmetries):
    """x y z roll pitch yaw of truth and estimate over time (Figures 5 to 7 of Wuethrich et al.)."""
    times = table.stamps - table.stamps[0]
    estimates = [T if T_truth is None else fold(T, T_truth, symmetries) for T, T_truth in zip(table.poses, table.true_poses)]
    truth, estimate = six_numbers(table.true_poses), six_numbers(estimates)
    kinematics = read_forward_kinematics(scene)
    by_kinematics = six_numbers([kinematics.get(frame) for frame in table.frames])
    figure, axes = new_figure(2, 3, 11, 5, sharex=True)
    for k, one in enumerate(axes.ravel()):
        shade_hidden(one, times, ~table.seen)
        if k >= 3:
            estimate[:, k] = _aligned(estimate[:, k], truth[:, k])
            by_kinematics[:, k] = _aligned(by_kinematics[:, k], truth[:, k])
        if kinematics:
            one.plot(times, by_kinematics[:, k], color=FORWARD_KINEMATICS, linewidth=1.0, label="forward kinematics")
        one.plot(times, truth[:, k], color=TRUTH, linewidth=1.6, label="truth")
        one.plot(times, estimate[:, k], color=ESTIMATE, linewidth=1.0, label="estimate")
        one.set_ylabel(LABELS[k])
        one.ticklabel_format(axis="y", useOffset=False)
    for one in axes[1]:
        one.set_xlabel("time [s]")
    axes[0, 0].legend(frameon=False, fontsize=8)
    figure.tight_layout()
    return save(figure, path)


def plot_errors(path, table):
    """The error that counts over time, coloured by the state said, above the visible share."""
    times = table.stamps - table.stamps[0]
    figure, (upper, lower) = new_figure(2, 1, 11, 4, sharex=True, gridspec_kw={"height_ratios": [2.4, 1]})
    for one in (upper, lower):
        shade_hidden(one, times, ~table.seen)
    error_mm = np.maximum(1e3 * table.error, 1e-2)
    upper.plot(times, error_mm, color="#bbbbbb", linewidth=0.8, zorder=1)
    for state, colour in STATE_COLOURS.items():
        chosen = np.array([said == state for said in table.states])
        if chosen.any():
            upper.scatter(times[chosen], error_mm[chosen], s=9, color=colour, label=state, zorder=2)
    upper.axhline(1e3 * LOSS_ERROR_M, color="#999999", linewidth=0.8, linestyle="--", label="loss")
    log_axis(upper.yaxis)
    upper.set_ylabel(("ADD-S" if table.symmetric else "ADD") + " [mm]")
    above = {"frameon": False, "fontsize": 8, "loc": "lower right", "bbox_to_anchor": (1.0, 0.97)}
    upper.legend(ncol=6, **above)
    if np.isfinite(table.visible).any():
        lower.plot(times, table.visible, color=TRUTH, linewidth=1.2, label="truth")
    lower.plot(times, table.estimated_visible, color=ESTIMATE, linewidth=1.0, label="estimate")
    lower.axhline(SEEN_SHARE, color="#999999", linewidth=0.8, linestyle="--")
    lower.set_ylim(-0.03, 1.03)
    lower.set_ylabel("visible share")
    lower.set_xlabel("time [s]")
    lower.legend(ncol=2, **above)
    figure.tight_layout()
    return save(figure, path)


def _most_occluded(masks):
    """(frame, mask) with the most even mix of occluded and visible pixels."""
    best = None
    for frame, source in masks.items():
        mask = read_mask(source)
        mix = min(int((mask == OCCLUDED).sum()), int((mask == VISIBLE).sum()))
        if best is None or mix > best[0]:
            best = (mix, frame, mask)
    return best[1:] if best and best[0] else None


def plot_occlusion(path, scene, truth, folder):
    """Depth picture, true mask and belief of the frame with the most to tell; None when there is none."""
    chosen = _most_occluded(truth.masks)
    if not chosen:
        return None
    frame, mask = chosen
    depth_path, belief_path = scene.folder / "depth" / f"{frame:06d}.png", folder / f"{frame:06d}.png"
    if not depth_path.is_file() or not belief_path.is_file():
        return None
    rows, cols = np.nonzero(mask)
    margin = 15
    window = np.s_[max(rows.min() - margin, 0):rows.max() + margin, max(cols.min() - margin, 0):cols.max() + margin]
    depth = read_grey(depth_path).astype(float)
    depth[depth == 0] = math.nan
    belief = read_grey(belief_path).astype(float)
    belief[belief == 0] = math.nan
    figure, axes = new_figure(1, 3, 9, 3)
    axes[0].imshow(depth[window], cmap="gray")
    axes[1].imshow(np.select([mask[window] == OCCLUDED, mask[window] == VISIBLE], [1.0, 0.0], math.nan), cmap="coolwarm",
                   vmin=0, vmax=1)
    axes[2].imshow((belief[window] - 1.0) / 254.0, cmap="coolwarm", vmin=0, vmax=1)
    for one, title in zip(axes, (f"depth, frame {frame}", "occluded (red): truth", "p(occluded): estimate")):
        one.set_title(title, fontsize=9)
        one.set_xticks([])
        one.set_yticks([])
        one.grid(False)
        one.spines[:].set_visible(False)
    figure.tight_layout()
    return save(figure, path)
