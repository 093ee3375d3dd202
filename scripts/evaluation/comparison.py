# SPDX-License-Identifier: BSD-3-Clause
"""Several trackers on the same frames: one table, one picture, one page."""
import csv
import html
import math

from . import report

# (heading, key, digits, factor, from "median" or "worst")
FIGURES = [("median error [mm]", "error_mm_median", 2, 1, "median"), ("95 % [mm]", "error_mm_p95", 1, 1, "median"),
           ("AUC", "auc_error", 1, 100, "median"), ("within 5 cm, 5 deg [%]", "within_5cm_5deg", 1, 100, "median"),
           ("lost frames", "lost_frames", 0, 1, "worst"), ("ms", "time_ms_median", 1, 1, "median")]
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
    from .plot_style import LINES, new_figure, save

    names = scene_names(results)
    figure, axes = new_figure(1, 1, 11, 0.4 * len(names) + 1.6)
    height = 0.8 / max(1, len(results))
    for k, (tracker, summary) in enumerate(results.items()):
        found = _by_scene(summary)
        values = [value_of(found.get(scene), "error_mm_median", "median") for scene in names]
        places = [i + (k - 0.5 * (len(results) - 1)) * height for i in range(len(names))]
        axes.barh(places, values, height=height, label=tracker, color=LINES[k % len(LINES)])
    axes.set_xscale("log")
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    axes.set_xlabel("median error [mm] (ADD; ADD-S for symmetric objects)")
    axes.legend(loc="best", fontsize="small")
    return save(figure, path)


def write_csv(path, results):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["tracker", "scene"] + [key for _, key, *_ in FIGURES])
        for tracker, summary in results.items():
            for scene in summary["scenes"] + [{**summary["overall"], "scene": "overall"}]:
                writer.writerow([tracker, scene["scene"]] + [f"{value_of(scene, key, source):.6g}"
                                                            for _, key, _, _, source in FIGURES])


def write_page(path, results, pictures, notes):
    """results: {tracker: content of its summary.json}; notes: sentences, what was left out among them."""
    parts = ['<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>Report</title>'
             f"<style>{report.STYLE}</style></head><body><h1>Trackers on the same frames</h1>"]
    parts += [f"<p>{html.escape(note)}</p>" for note in notes]
    parts.append(overall_table(results))
    parts += [report.picture(picture) for picture in pictures]
    parts += [scene_table(results, *figure) for figure in PER_SCENE]
    for name, summary in results.items():
        parts.append(f"<h2>{html.escape(name)}</h2>" + report.provenance_table(summary["provenance"]))
    parts.append("</body></html>")
    path.write_text("\n".join(parts) + "\n", encoding="utf-8")
