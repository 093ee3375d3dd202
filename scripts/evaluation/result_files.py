# SPDX-License-Identifier: BSD-3-Clause
"""summary.csv, summary.json and a CSV of every frame."""
import csv
import json
import math

import numpy as np


def _plain(value):
    """JSON has neither NaN (null here) nor infinity ("inf": never)."""
    if isinstance(value, dict):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [_plain(entry) for entry in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        return None if math.isnan(value) else ("inf" if value > 0 else "-inf")
    return value


def write_json(path, provenance, summaries, total):
    content = {"provenance": provenance, "overall": total, "scenes": summaries}
    path.write_text(json.dumps(_plain(content), indent=1) + "\n", encoding="utf-8")


def _format(value):
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _row(name, summary, lost_runs):
    row = {"scene": name, "error_kind": summary.get("error_kind", ""), "runs": summary["runs"],
           "failed_runs": summary["failed_runs"], "lost_runs": lost_runs}
    for key, value in summary.get("median", {}).items():
        row[key] = _format(value)
        row[key + "_worst"] = _format(summary["worst"][key])
    for truth, said in summary.get("confusion", {}).items():
        for state, frames in said.items():
            row[f"true_{truth.lower()}_said_{state.lower()}"] = str(frames)
    for name_of_bin, figures in summary.get("nees_by_visibility", {}).items():
        for key in ("frames", "nees_per_dof", "inside95"):
            row[f"visible_{name_of_bin}_{key}"] = _format(figures[key])
    return row


def write_csv(path, summaries, total):
    """One row per scene and one named overall; a figure is the median over the seeds, FIGURE_worst the worst of them."""
    rows = [_row(s["scene"], s, s.get("lost_runs", 0)) for s in summaries] + [_row("overall", total, total["lost_runs"])]
    columns = list(max(rows, key=len))
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, columns, restval="")
        writer.writeheader()
        writer.writerows(rows)


def write_frames(path, table):
    """Every frame of one run: errors, state, calibration."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["frame", "stamp_s", "state", "visible", "add_mm", "add_s_mm", "translation_mm", "rotation_deg", "nees",
                         "dof", "stddev_translation_mm", "stddev_rotation_deg", "time_ms"])
        for k, frame in enumerate(table.frames):
            numbers = [table.visible[k], 1e3 * table.add[k], 1e3 * table.add_s[k], 1e3 * table.translation[k],
                       math.degrees(table.rotation[k]), table.nees[k], table.dof[k], 1e3 * table.stddev_translation[k],
                       math.degrees(table.stddev_rotation[k]), 1e3 * table.times_s[k]]
            writer.writerow([frame, _format(float(table.stamps[k])), table.states[k]] + [_format(float(x)) for x in numbers])
