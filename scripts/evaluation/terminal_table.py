# SPDX-License-Identifier: BSD-3-Clause
"""The compact table that people read while it grows."""
import math

from .state_confusion import TRUE_STATES, right_share

COLUMNS = ["error", "median", "95%", "max", "AUC", "lost/runs", "frames", "recover", "in95%", "NEES/dof", "ROC", "T/O/L right%",
           "ms", "p99"]
WIDTHS = [5, 7, 7, 7, 6, 9, 6, 7, 5, 8, 5, 12, 5, 6]
LEGEND = """columns of the table:
error: ADD, or ADD-S for symmetric objects [mm], over frames with at least 10 % of the object in sight; median over the
seeds (max, lost frames, recovery: the worst); AUC to 10 cm; lost/runs: runs with a loss (over 5 cm for more than 15 frames);
recover: seen frames until under 2 cm after a full occlusion; in95%: truth inside the 95 % region; T/O/L right%: frames said
to be TRACKING/OCCLUDED/LOST of those that are; ms: time per frame."""


def _number(value, digits):
    if value is None or math.isnan(value):
        return "-"
    if math.isinf(value):
        return "never"
    if abs(value) >= 1e5:
        return f"{value:.1e}"
    return f"{value:.{digits}f}"


def _cells(summary, lost, runs):
    median, worst = summary["median"], summary["worst"]
    right = "/".join(_number(100.0 * right_share(summary["confusion"], truth), 0) for truth in TRUE_STATES)
    return [summary.get("error_kind", ""), _number(median["error_mm_median"], 3), _number(median["error_mm_p95"], 2),
            _number(worst["error_mm_max"], 1), _number(100.0 * median["auc_error"], 2), f"{lost}/{runs}",
            _number(worst["lost_frames"], 0), _number(worst["recovery_after_occlusion_frames"], 0),
            _number(100.0 * median["inside95"], 1), _number(median["nees_per_dof"], 2), _number(median["occlusion_roc"], 3),
            right, _number(median["time_ms_median"], 1), _number(worst["time_ms_p99"], 1)]


def _line(name, cells, width):
    return f"{name:{width}}  " + "  ".join(f"{cell:>{w}}" for cell, w in zip(cells, WIDTHS))


def name_width(scenes):
    return max([len(scene.name) for scene in scenes] + [len("overall")])


def header(width):
    return _line("scene", COLUMNS, width)


def scene_line(summary, width):
    if "median" not in summary:
        problem = summary["failures"][0]["problem"] if summary["failures"] else "no estimates"
        return f"{summary['scene']:{width}}  FAILED {summary['failed_runs']}/{summary['runs']}: {problem}"
    line = _line(summary["scene"], _cells(summary, summary["lost_runs"], summary["runs"]), width)
    if summary["failed_runs"]:
        line += f"  FAILED {summary['failed_runs']}/{summary['runs']}: {summary['failures'][0]['problem']}"
    return line


def overall_line(total, width):
    if "median" not in total:
        return f"{'overall':{width}}  no run could be scored"
    cells = _cells(total, total["scenes_lost"], total["scenes"])
    cells[0] = ""
    return _line("overall", cells, width)
