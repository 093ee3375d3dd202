# SPDX-License-Identifier: BSD-3-Clause
"""report.html: everything in one file, pictures embedded."""
import base64
import html
import math

from .state_confusion import STATES, TRUE_STATES

STYLE = """
body { font: 14px/1.45 system-ui, sans-serif; color: #222; max-width: 1500px; margin: 2em auto; padding: 0 1em; }
table { border-collapse: collapse; margin: .6em 0 1.2em; font-size: 13px; }
th, td { padding: .2em .6em; text-align: right; border-bottom: 1px solid #ddd; font-variant-numeric: tabular-nums; white-space: nowrap; }
th { white-space: normal; vertical-align: bottom; min-width: 3em; }
th:first-child, td:first-child { text-align: left; }
tr.overall td { border-top: 2px solid #888; font-weight: 600; }
.bad { color: #c8442c; font-weight: 600; }
img { max-width: 100%; }
h2 { margin-top: 2em; border-bottom: 1px solid #ccc; }
p { max-width: 1000px; }
pre { background: #f6f6f6; padding: .6em; overflow-x: auto; font-size: 12px; }
.tables { display: flex; gap: 3em; flex-wrap: wrap; }
"""

# (heading, key, digits, factor, from "median" or "worst")
COLUMNS = [("median [mm]", "error_mm_median", 3, 1, "median"), ("95 % [mm]", "error_mm_p95", 2, 1, "median"),
           ("max [mm]", "error_mm_max", 1, 1, "worst"), ("AUC ADD [%]", "auc_add", 2, 100, "median"),
           ("AUC ADD&#8209;S [%]", "auc_add_s", 2, 100, "median"), ("within 5&nbsp;cm, 5&nbsp;deg [%]", "within_5cm_5deg", 1, 100, "median"),
           ("translation 95 % [mm]", "translation_mm_p95", 2, 1, "median"),
           ("rotation 95 % [deg]", "rotation_deg_p95", 2, 1, "median"), ("lost frames", "lost_frames", 0, 1, "worst"),
           ("back after full occlusion [frames]", "recovery_after_occlusion_frames", 0, 1, "worst"),
           ("in 95&nbsp;% region [%]", "inside95", 1, 100, "median"), ("NEES/dof", "nees_per_dof", 2, 1, "median"),
           ("occlusion ROC area", "occlusion_roc", 3, 1, "median"), ("time [ms]", "time_ms_median", 1, 1, "median"),
           ("time 99&nbsp;% [ms]", "time_ms_p99", 1, 1, "worst")]

DETAILS = [("ADD [mm]", "add_mm"), ("ADD-S [mm]", "add_s_mm"), ("translation [mm]", "translation_mm"),
           ("rotation [deg]", "rotation_deg")]

# (label, key, digits)
OTHERS = [("judged frames", "judged_frames", 0), ("loss episodes", "loss_episodes", 0),
          ("frames back after a loss", "recovery_after_loss_frames", 0), ("full occlusions", "full_occlusions", 0),
          ("rank correlation of stddev and error, translation", "rank_translation", 2),
          ("rank correlation of stddev and error, rotation", "rank_rotation", 2),
          ("occlusion lag [frames]", "occlusion_lag_frames", 2),
          ("occluder comes: reaction of 90 % of the pixels [frames]", "reaction_comes_frames", 2),
          ("occluder goes: reaction of 90 % of the pixels [frames]", "reaction_goes_frames", 2),
          ("longest TRACKING while truly lost [frames]", "wrong_as_tracking_longest", 0),
          ("false LOST frames", "false_lost_frames", 0), ("jitter at rest [mm]", "jitter_mm", 3),
          ("jitter at rest [deg]", "jitter_deg", 3), ("delay [frames]", "delay_frames", 2)]


def number(value, digits):
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return "–"
    if isinstance(value, float) and math.isinf(value):
        return '<span class="bad">never</span>'
    if abs(value) >= 1e5:
        return f"{value:.1e}"
    return f"{value:,.{digits}f}"


def table(headings, rows, last_is_total=False):
    """Cells are HTML already."""
    lines = ["<table><tr>" + "".join(f"<th>{h}</th>" for h in headings) + "</tr>"]
    for k, row in enumerate(rows):
        kind = ' class="overall"' if last_is_total and k == len(rows) - 1 else ""
        lines.append(f"<tr{kind}>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>")
    return "\n".join(lines) + "</table>"


def picture(path):
    content = base64.b64encode(path.read_bytes()).decode("ascii")
    return f'<p><img alt="{html.escape(path.stem)}" src="data:image/png;base64,{content}"></p>'


def anchor(name):
    return html.escape(name.replace("/", "_"))


def summary_row(name, summary, lost, runs):
    if "median" not in summary:
        return [name, '<span class="bad">failed</span>'] + [""] * (len(COLUMNS) + 1)
    cells = [number(factor * summary[source].get(key, math.nan), digits) for _, key, digits, factor, source in COLUMNS]
    lost_cell = f'<span class="bad">{lost}/{runs}</span>' if lost else f"0/{runs}"
    return [name, summary.get("error_kind", ""), lost_cell] + cells


def summary_table(summaries, total):
    rows = [summary_row(f'<a href="#{anchor(s["scene"])}">{html.escape(s["scene"])}</a>', s, s.get("lost_runs", 0), s["runs"])
            for s in summaries]
    rows.append(summary_row("overall", total, total["scenes_lost"], total["scenes"]))
    return table(["scene", "error", "lost runs"] + [heading for heading, *_ in COLUMNS], rows, last_is_total=True)


def confusion_table(confusion):
    rows = [[f"truly {truth}"] + [str(confusion[truth][state]) for state in STATES] for truth in TRUE_STATES]
    return table(["frames"] + [f"said {state}" for state in STATES], rows)


def visibility_table(bins):
    rows = [[name, str(f["frames"]), number(f["nees_per_dof"], 2), number(f["nees_per_dof_median"], 2),
             number(100 * f["inside95"], 1)] for name, f in bins.items()]
    return table(["visible share", "frames", "NEES/dof mean", "median", "in 95 % region [%]"], rows)


def details_table(summary):
    rows = []
    for label, key in DETAILS:
        for prefix, frames in (("", "seen"), ("all_", "all")):
            rows.append([f"{label}, {frames} frames"] + [number(summary["median"][f"{prefix}{key}_{p}"], 3)
                                                         for p in ("median", "p95", "max")]
                        + [number(summary["worst"][f"{prefix}{key}_max"], 3)])
    return table(["", "median", "95 %", "max", "max, worst run"], rows)


def others_table(summary):
    rows = [[label, number(summary["median"].get(key, math.nan), digits), number(summary["worst"].get(key, math.nan), digits)]
            for label, key, digits in OTHERS]
    return table(["", "median of the runs", "worst"], rows)


def scene_section(summary, pictures):
    parts = [f'<h2 id="{anchor(summary["scene"])}">{html.escape(summary["scene"])}</h2>']
    for failure in summary["failures"]:
        parts.append(f'<p class="bad">{html.escape(failure["run"])} failed: {html.escape(failure["problem"])}</p>')
    if "median" in summary:
        parts += [picture(path) for path in pictures]
        parts.append('<div class="tables"><div>' + details_table(summary) + "</div><div>" + others_table(summary) + "</div></div>")
        parts.append('<div class="tables"><div>' + confusion_table(summary["confusion"]) + "</div><div>"
                     + visibility_table(summary["nees_by_visibility"]) + "</div></div>")
    return "\n".join(parts)


def provenance_table(made_with):
    """Texts of several lines are folded up behind their first."""
    def cell(value):
        first, *others = value.split("\n")
        return f"<details><summary>{html.escape(first)}</summary><pre>{html.escape(value)}</pre></details>" if others else html.escape(value)

    rows = [[html.escape(key), cell(value)] for key, value in made_with.items()]
    return table(["made with", ""], rows).replace("<td>", '<td style="text-align:left; white-space:normal">')


def write_report(path, made_with, summaries, total, overall_pictures, scene_pictures):
    """overall_pictures: paths; scene_pictures: {scene: paths}."""
    failures = f'<p class="bad">{total["failed_runs"]} of {total["runs"]} runs failed; they are listed with their scenes.</p>'
    parts = [f'<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>Evaluation</title><style>{STYLE}</style></head><body>',
             "<h1>Evaluation</h1>", provenance_table(made_with), failures if total["failed_runs"] else "",
             "<p>Errors are ADD, or ADD-S for objects with declared symmetries, over frames with at least 10 % of the object in "
             "sight; medians over the runs, maxima, lost frames, recovery and 99 % times of the worst run. A loss is an error over "
             "5 cm in more than 15 frames, counted while the object has been in sight for 10 frames. NEES over frames with a "
             "published pose. Grey in the pictures: the object is out of sight. Overall: mean of the AUCs, median of the other medians, NEES and ROC over all frames and pixels.</p>",
             summary_table(summaries, total)]
    parts += [picture(p) for p in overall_pictures]
    if "confusion" in total:
        parts.append('<div class="tables"><div>' + confusion_table(total["confusion"]) + "</div><div>"
                     + visibility_table(total["nees_by_visibility"]) + "</div></div>")
    parts += [scene_section(summary, scene_pictures.get(summary["scene"], [])) for summary in summaries]
    parts.append("</body></html>")
    path.write_text("\n".join(parts) + "\n", encoding="utf-8")
