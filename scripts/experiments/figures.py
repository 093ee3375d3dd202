# SPDX-License-Identifier: BSD-3-Clause
"""The paper's figures 4 to 7."""
import csv
import io
import subprocess

import numpy as np

from evaluation import EvaluationError
from evaluation.plot_style import ESTIMATE, FORWARD_KINEMATICS, new_figure, save
from evaluation.scene_plots import LABELS, six_numbers

FIDUCIALS = "#3f8f4f"
TRUTH_BAND = "#c4c4c4"
FONT_SIZE = 11
# Name, label, colour, width, dashes: told apart without colours too. The truth is a wide band below all of them.
DRAWN = [("kinematics", "forward kinematics", FORWARD_KINEMATICS, 1.6, (0, (7, 2))),
         ("fiducials", "fiducials", FIDUCIALS, 1.8, (0, (1.5, 1.5))), ("ours", "this tracker", ESTIMATE, 1.3, "solid")]


def _limits(curves):
    """Of what every curve but the worst outliers needs, with some room."""
    values = np.concatenate([curve[np.isfinite(curve)] for curve in curves])
    low, high = values.min(), values.max()
    room = max(0.06 * (high - low), 1e-3)
    return low - room, high + room


def plot_poses(path, title, tables):
    """x y z roll pitch yaw over time. tables: {method name: FrameTable}; poses of frames with score 0 are not drawn."""
    reference = next(iter(tables.values()))
    times = reference.stamps - reference.stamps[0]
    truth = six_numbers(reference.true_poses)
    figure, axes = new_figure(2, 3, 12, 6, sharex=True)
    curves = {}
    for name, label, colour, width, dashes in DRAWN:
        if name not in tables:
            continue
        table = tables[name]
        curve = six_numbers([T if score > 0.0 else None for T, score in zip(table.poses, table.scores)])
        curve[:, 3:] -= 360.0 * np.round((curve[:, 3:] - truth[:, 3:]) / 360.0)
        curves[name] = curve
        for k, one in enumerate(axes.ravel()):
            one.plot(times, curve[:, k], color=colour, linewidth=width, linestyle=dashes, label=label)
    for k, one in enumerate(axes.ravel()):
        one.plot(times, truth[:, k], color=TRUTH_BAND, linewidth=5.0, label="truth", zorder=1.5, solid_capstyle="round")
        # Whoever loses the object must not hide what the others do.
        near = [curves[name][:, k] for name in ("ours", "kinematics") if name in curves]
        one.set_ylim(*_limits([truth[:, k]] + near))
        one.set_ylabel(LABELS[k], fontsize=FONT_SIZE)
        one.tick_params(labelsize=FONT_SIZE - 1)
        one.set_xlim(times[0], times[-1])
    for one in axes[1]:
        one.set_xlabel("time [s]", fontsize=FONT_SIZE)
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.suptitle(title, fontsize=FONT_SIZE + 2)
    figure.tight_layout(rect=(0, 0.06, 1, 1))
    figure.legend(handles, labels, loc="lower center", ncol=len(labels), frameon=False, fontsize=FONT_SIZE + 1, handlelength=3)
    return save(figure, path, dpi=80)


def read_curves(program, depth_m):
    """{column: array} of what pixel_model_curves prints."""
    finished = subprocess.run([str(program), "--depth", repr(depth_m)], capture_output=True, text=True, check=False, timeout=60)
    if finished.returncode != 0:
        raise EvaluationError(f"pixel_model_curves failed: {finished.stderr.strip()}")
    rows = list(csv.DictReader(io.StringIO(finished.stdout)))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def plot_likelihood(path, program, depth_m=1.5):
    """Density of a reading of an object at depth_m: visible, occluded, and by the prior (Figure 4)."""
    curves = read_curves(program, depth_m)
    figure, axes = new_figure(1, 2, 12, 4.4, sharey=True)
    for one, occluded, title in ((axes[0], "occluded_paper", "as in the paper"),
                                 (axes[1], "occluded_consistent", "default: occluders do not know of the object")):
        one.axvline(depth_m, color="#bbbbbb", linewidth=1.0)
        mixture = 0.75 * curves["visible"] + 0.25 * curves[occluded]
        one.plot(curves["z"], mixture, color=TRUTH_BAND, linewidth=5.0, label="both, p(occluded) = 0.25")
        one.plot(curves["z"], curves["visible"], color=ESTIMATE, linewidth=1.6, label="p(z | visible)")
        one.plot(curves["z"], curves[occluded], color=FORWARD_KINEMATICS, linewidth=1.6, linestyle=(0, (7, 2)),
                 label="p(z | occluded)")
        one.set_yscale("log")
        one.set_ylim(5e-4, 3e2)
        one.set_xlim(0.0, 3.0)
        one.set_xlabel("measured depth z [m]", fontsize=FONT_SIZE)
        one.tick_params(labelsize=FONT_SIZE - 1)
        one.set_title(title, fontsize=FONT_SIZE + 1)
        one.annotate("the object", (depth_m, 1e2), (depth_m + 0.12, 1e2), fontsize=FONT_SIZE, color="#555555", va="center")
    axes[0].set_ylabel("density [1/m]", fontsize=FONT_SIZE)
    handles, labels = axes[0].get_legend_handles_labels()
    figure.tight_layout(rect=(0, 0.09, 1, 1))
    figure.legend(handles, labels, loc="lower center", ncol=len(labels), frameon=False, fontsize=FONT_SIZE + 1, handlelength=3)
    return save(figure, path, dpi=80)
