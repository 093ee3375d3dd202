# SPDX-License-Identifier: BSD-3-Clause
"""The error table: median and worst over the seeds."""
import csv
import json

import numpy as np

SHOWN = [("add_mm_median", "ADD [mm]"), ("translation_mm_median", "position [mm]"), ("rotation_deg_median", "rotation [deg]"),
         ("add_mm_max", "largest ADD [mm]"), ("lost_frames", "frames lost")]


def _number(value):
    return "-" if not np.isfinite(value) else f"{value:.0f}" if value >= 100 or value == round(value) else f"{value:.2f}"


def summarise(results):
    """[row dictionaries], one per experiment and method, in their order."""
    groups = {}
    for result in results:
        groups.setdefault((result.scenario.letter, result.method.name), []).append(result)
    rows = []
    for group in groups.values():
        good = [result.figures for result in group if result.figures]
        row = {"experiment": group[0].scenario.letter, "what": group[0].scenario.title, "object": group[0].scenario.object_name,
               "method": group[0].method.name, "title": group[0].method.title, "seeds": len(group), "failed": len(group) - len(good)}
        for name in (good[0] if good else {}):
            values = np.array([figures[name] for figures in good], float)
            known = values[np.isfinite(values)]
            row[name] = float(np.median(known)) if known.size else None
            worst = known.min() if known.size and name == "measured_share" else known.max() if known.size else None
            row[f"{name}_worst"] = None if worst is None else float(worst)
        rows.append(row)
    return rows


def as_text(rows):
    """A Markdown table: median over the seeds, the worst seed in brackets."""
    lines = ["| experiment | method | " + " | ".join(title for _, title in SHOWN) + " |", "|---|---|" + "---|" * len(SHOWN)]
    for row in rows:
        cells = []
        for name, _ in SHOWN:
            value, worst = row.get(name), row.get(f"{name}_worst")
            cells.append("failed" if value is None else f"{_number(value)} ({_number(worst)})")
        lines.append(f"| {row['experiment']}: {row['object']} | {row['title']} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def write(rows, results, provenance, output):
    """summary.csv (one row per experiment and method), summary.json (that, every run, and how it was made), table.md."""
    columns = list(dict.fromkeys(key for row in rows for key in row))
    with open(output / "summary.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, columns)
        writer.writeheader()
        writer.writerows(rows)
    runs = [{"experiment": result.scenario.letter, "seed": result.seed, "method": result.method.name,
             "problem": result.problem, **{k: None if v != v else v for k, v in (result.figures or {}).items()}}
            for result in results]
    content = {"made": provenance, "summary": rows, "runs": runs}
    (output / "summary.json").write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    (output / "table.md").write_text(as_text(rows) + "\n", encoding="utf-8")
