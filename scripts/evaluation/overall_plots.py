# SPDX-License-Identifier: BSD-3-Clause
"""Plots over all sequences: accuracy against threshold, reliability, ROC."""
from .plot_style import LINES, TRUTH, log_axis, new_figure, save


def _scene_lines(axes, summaries, draw):
    """One thin line per scene; a legend where there is room for it."""
    for k, summary in enumerate(summaries):
        draw(summary, {"color": LINES[k % len(LINES)], "linewidth": 0.9, "alpha": 0.8, "label": summary["scene"],
                       "linestyle": ["-", "--", ":"][(k // len(LINES)) % 3]})
    if len(summaries) <= 16:
        axes.legend(frameon=False, fontsize=7, bbox_to_anchor=(1.02, 1.0), loc="upper left")


def plot_accuracy(path, summaries, total):
    figure, axes = new_figure(1, 1, 7, 4)
    axes.set_title("Accuracy", fontsize=10, loc="left")

    def draw(summary, style):
        curve = summary["accuracy_curve"]
        axes.plot([1e3 * x for x in curve["threshold_m"]], curve["share"], **style)

    draw(total, {"color": TRUTH, "linewidth": 2.2, "label": "all frames"})
    _scene_lines(axes, summaries, draw)
    log_axis(axes.xaxis)
    axes.set_xlim(0.1, 100.0)
    axes.set_ylim(0.0, 1.01)
    axes.set_xlabel("threshold on ADD (ADD-S for symmetric objects) [mm]")
    axes.set_ylabel("share of frames within")
    return save(figure, path)


def plot_reliability(path, summaries, total):
    """Observed against expected coverage; above the diagonal the covariance is too large, below it too small."""
    figure, axes = new_figure(1, 1, 7, 4)
    axes.set_title("Covariance: above the diagonal it is too large, below it too small", fontsize=10, loc="left")
    axes.plot([0, 1], [0, 1], color="#999999", linewidth=1.0, linestyle="--")

    def draw(summary, style):
        axes.plot(summary["reliability"]["expected"], summary["reliability"]["observed"], **style)

    draw(total, {"color": TRUTH, "linewidth": 2.2, "marker": "o", "markersize": 3, "label": "all frames"})
    _scene_lines(axes, [s for s in summaries if s["median"]["nees_frames"] > 0], draw)
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(0.0, 1.01)
    axes.set_xlabel("confidence region")
    axes.set_ylabel("share of frames with the truth inside")
    return save(figure, path)


def plot_roc(path, counters):
    """counters: {name: RocCounter}; the first is drawn thick."""
    figure, axes = new_figure(1, 1, 7, 4)
    axes.set_title("Occlusion per pixel: ROC curve and the area below it", fontsize=10, loc="left")
    axes.plot([0, 1], [0, 1], color="#999999", linewidth=1.0, linestyle="--")
    for k, (name, counter) in enumerate(counters.items()):
        style = {"color": TRUTH, "linewidth": 2.2} if k == 0 else {"color": LINES[k % len(LINES)], "linewidth": 0.9}
        axes.plot(*counter.curve(), label=f"{name}: {counter.area():.3f}", **style)
    axes.set_xlabel("visible pixels called occluded")
    axes.set_ylabel("occluded pixels called so")
    if len(counters) <= 16:
        axes.legend(frameon=False, fontsize=7, bbox_to_anchor=(1.02, 1.0), loc="upper left")
    return save(figure, path)
