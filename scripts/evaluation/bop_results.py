# SPDX-License-Identifier: BSD-3-Clause
"""Estimates as the BOP toolkit wants them: METHOD_DATASET-SPLIT[-SPLITTYPE]_RUN.csv with all scenes and objects."""
import csv
import re

import numpy as np

from .estimates import COLUMNS


def plain_name(text):
    """Letters and digits only: the toolkit takes a name apart at "_" and "-"."""
    return re.sub(r"[^A-Za-z0-9]", "", text) or "unnamed"


def file_name(method, scene, label):
    """The split folder test_primesense becomes test-primesense."""
    split = "-".join(plain_name(part) for part in scene.split.split("_"))
    return f"{plain_name(method)}_{plain_name(scene.data_set)}-{split}_{plain_name(label)}.csv"


def scene_numbers(scenes):
    """{scene name: number}: the folder's own, or 1, 2, ... where those of different folders are not all different."""
    folders = list(dict.fromkeys(scene.folder for scene in scenes))
    own = {scene.folder: scene.scene_id for scene in scenes}
    if len(set(own.values())) == len(folders):
        return {scene.name: scene.scene_id for scene in scenes}
    return {scene.name: 1 + folders.index(scene.folder) for scene in scenes}


def _numbers(array):
    return " ".join(f"{x:.10g}" for x in np.asarray(array).ravel())


def make_rows(scenes, tables):
    """Rows of one file. Frames in which the tracker has no pose (LOST) claim none. The toolkit wants one time for a picture:
    the sum over its objects. tables: {scene name: FrameTable}."""
    numbers = scene_numbers(scenes)
    rows, seconds = [], {}
    for scene in scenes:
        table = tables[scene.name]
        for k, frame in enumerate(table.frames):
            picture = (numbers[scene.name], frame)
            seconds[picture] = seconds.get(picture, 0.0) + float(table.times_s[k])
            if table.states[k] not in ("LOST", "UNINITIALIZED"):
                T = table.poses[k]
                rows.append([*picture, scene.object_id, f"{table.scores[k]:.10g}", _numbers(T[:3, :3]), _numbers(1e3 * T[:3, 3])])
    return [row + [f"{seconds[row[0], row[1]]:.10g}"] for row in sorted(rows, key=lambda row: row[:3])]


def write(folder, method, scenes, outcomes):
    """One file per data set, split and run; beside it, where folders have no numbers, which number is which scene."""
    groups = {}
    for scene in scenes:
        for outcome in outcomes[scene.name]:
            if outcome.table:
                groups.setdefault(file_name(method, scene, outcome.job.label), []).append((scene, outcome.table))
    folder.mkdir(parents=True, exist_ok=True)
    for name, entries in groups.items():
        members = [scene for scene, _ in entries]
        with open(folder / name, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(COLUMNS)
            writer.writerows(make_rows(members, {scene.name: table for scene, table in entries}))
        numbers = scene_numbers(members)
        if any(numbers[scene.name] != scene.scene_id for scene in members):
            text = "".join(f"{numbers[scene.name]},{scene.name}\n" for scene in members)
            (folder / (name[:-4] + "_scenes.txt")).write_text("scene_id,scene\n" + text, encoding="utf-8")
