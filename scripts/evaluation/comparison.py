# SPDX-License-Identifier: BSD-3-Clause
"""Several trackers on the same frames: one table, one picture, one page."""
import csv
import html
import math

from . import report

# (heading, key, digits, factor, from "median" or "worst")
FIGURES = [("median error [mm]", "error_mm_median", 2, 1, "median"), ("95 % [mm]", "error_mm_p95", 1, 1, "median"),
           ("AUC [%]", "auc_error", 1, 100, "median"), ("within 5 cm, 5 deg [%]", "within_5cm_5deg", 1, 100, "median"),
           ("lost frames", "lost_frames", 0, 1, "worst"), ("time [ms]", "time_ms_median", 1, 1, "median")]
LEGEND = ("Errors are ADD, or ADD-S for objects with declared symmetries, over frames with at least 10 % of the object in sight. "
          "Overall: mean of the scenes' AUCs (threshold 10 cm), median of their other medians, lost frames of the scene with most. A loss "
          "is an error over 5 cm in more than 15 frames, counted while the object has been in sight for 10 frames.")
PER_SCENE = [("median error [mm]", "error_mm_median", 2, "median"), ("lost frames", "lost_frames", 0, "worst")]


def value_of(summary, key, source):
    """NaN where there is none; "inf" of the file is infinite."""
    value = summary.get(source, {}).get(key) if summary else None
    if value is None:
        return math.nan
    return float(value)


def scene_names(results):
    """In the order of the first tracker's."""
    return list(dict.fromkeys(scene["scene"] for summary in results.values() for scene in summary["scenes"]))


def _by_scene(summary):
    return {scene["scene"]: scene for scene in summary["scenes"]}


def overall_table(results):
    rows = []
    for name, summary in results.items():
        total = summary["overall"]
        cells = [report.number(factor * value_of(total, key, source), digits) for _, key, digits, factor, source in FIGURES]
        lost = f'{total.get("scenes_lost", 0)} of {total["scenes"]}'
        rows.append([html.escape(name), lost, str(total["failed_runs"])] + cells)
    return report.table(["tracker", "scenes with a loss", "failed runs"] + [heading for heading, *_ in FIGURES], rows)


def scene_table(results, heading, key, digits, source):
    scenes = {name: _by_scene(summary) for name, summary in results.items()}
    rows = []
    for scene in scene_names(results):
        rows.append([html.escape(scene)] + [report.number(value_of(found.get(scene), key, source), digits)
                                            for found in scenes.values()])
    return f"<h3>{heading}</h3>" + report.table(["scene"] + [html.escape(name) for name in results], rows)


def plot(path, results):
    """Median error by scene and tracker, logarithmic: good and lost trackers fit into one picture."""
    from .plot_style import LINES, log_axis, new_figure, save

    names = scene_names(results)
    figure, axes = new_figure(1, 1, 11, 0.3 * len(names) + 1.4)
    log_axis(axes.xaxis, fine=True)
    for k, (tracker, summary) in enumerate(results.items()):
        found = _by_scene(summary)
        values = [value_of(found.get(scene), "error_mm_median", "median") for scene in names]
        axes.scatter(values, range(len(names)), s=40, marker="osD^v"[k % 5], label=tracker, color=LINES[k % len(LINES)], zorder=2)
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    axes.set_xlabel("median error [mm] (ADD; ADD-S for symmetric objects)")
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncol=4, frameon=False, fontsize="small")
    return save(figure, path)


def write_csv(path, results):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["tracker", "scene"] + [key for _, key, *_ in FIGURES])
        for tracker, summary in results.items():
            for scene in summary["scenes"] + [{**summary["overall"], "scene": "overall"}]:
                writer.writerow([tracker, scene["scene"]] + [f"{value_of(scene, key, source):.6g}"
                                                            for _, key, _, _, source in FIGURES])


def write_page(path, results, pictures, notes, reports=None):
    """results: {tracker: content of its summary.json}; notes: sentences, what was left out among them; reports: {tracker: address
    of its own report}."""
    parts = ['<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>Report</title>'
             f"<style>{report.STYLE}</style></head><body><h1>Trackers on the same frames</h1>", f"<p>{html.escape(LEGEND)}</p>"]
    parts += [f"<p>{html.escape(note)}</p>" for note in notes]
    parts.append(overall_table(results))
    parts += [report.picture(picture) for picture in pictures]
    parts += [scene_table(results, *figure) for figure in PER_SCENE]
    for name, summary in results.items():
        parts.append(f"<h2>{html.escape(name)}</h2>")
        if reports and name in reports:
            parts.append(f'<p><a href="{html.escape(reports[name])}">All figures and pictures by scene</a></p>')
        parts.append(report.provenance_table(summary["provenance"]))
    parts.append("</body></html>")
    path.write_text("\n".join(parts) + "\n", encoding="utf-8")
