# SPDX-License-Identifier: BSD-3-Clause
"""Tiny scenes in every layout that evaluate reads, and a tracker program that is wrong by a known amount."""
import json
import pathlib
import stat
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from PIL import Image

from evaluation.poses import exp_so3, pose

EVALUATE = pathlib.Path(__file__).resolve().parents[2] / "scripts/evaluate"
INTRINSICS = [100.0, 0, 20.0, 0, 100.0, 15.0, 0, 0, 1.0]
CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * [0.03, 0.05, 0.08]
FACES = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7],
         [1, 7, 3]]

# Writes the truth shifted along x.
FAKE_TRACKER = '''#!/usr/bin/python3
import json, pathlib, sys, time
options = dict(zip(sys.argv[2::2], sys.argv[3::2]))
scene, seed, number = pathlib.Path(sys.argv[1]), int(options["--seed"]), int(options["--object-id"])
pathlib.Path(options["--output"] + ".arguments").write_text(json.dumps(options))
if seed == 2 and "--second-fails" in options:
    sys.exit("error: the second seed fails")
if seed == 2 and "--second-sleeps" in options:
    time.sleep(60)
shift = float(options.get("--shift-mm", 1.0))
truth = json.loads((scene / "scene_gt.json").read_text())
rows, lines = ["scene_id,im_id,obj_id,score,R,t,time"], []
for frame, entries in truth.items():
    entry = next(e for e in entries if e["obj_id"] == number)
    R, t = entry["cam_R_m2c"], entry["cam_t_m2c"]
    rows.append(f"0,{frame},{number},1," + " ".join(map(repr, R)) + f",{t[0] + shift!r} {t[1]!r} {t[2]!r},0.004")
    lines.append(json.dumps({"frame": int(frame), "status": "TRACKING", "visible_fraction": 1.0,
                             "covariance": [1e-6 if i % 7 == 0 else 0.0 for i in range(36)]}))
pathlib.Path(options["--output"]).write_text("\\n".join(rows) + "\\n")
if "--trace" in options:
    pathlib.Path(options["--trace"]).write_text("\\n".join(lines) + "\\n")
'''


def path_of_poses(count, start=(0.0, 0.0, 0.6)):
    """Slow motion along x with a turn."""
    return [pose(exp_so3([0.01 * k, 0.02 * k, 0]), np.array(start) + [0.002 * k, 0, 0]) for k in range(count)]


def write_depth(path, value=800):
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(np.full((30, 40), value, np.uint16)).save(path)


def write_mesh(path, scale=1.0):
    """Box, .obj or ASCII .ply; scale: file units per metre."""
    path.parent.mkdir(parents=True, exist_ok=True)
    corners = [" ".join(f"{x:.9g}" for x in corner) for corner in scale * CORNERS]
    if path.suffix == ".obj":
        lines = [f"v {c}" for c in corners] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in FACES]
    else:
        lines = ["ply", "format ascii 1.0", f"element vertex {len(corners)}", "property float x", "property float y",
                 "property float z", f"element face {len(FACES)}", "property list uchar int vertex_indices", "end_header",
                 *corners, *(f"3 {a} {b} {c}" for a, b, c in FACES)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def truth_entry(T, object_id):
    return {"obj_id": object_id, "cam_R_m2c": T[:3, :3].ravel().tolist(), "cam_t_m2c": (1e3 * T[:3, 3]).tolist()}


def write_bop_scene(folder, tracks):
    """tracks: {object id: [4x4]} of equal length; pictures, cameras and truth."""
    count = len(next(iter(tracks.values())))
    for k in range(count):
        write_depth(folder / "depth" / f"{k:06d}.png")
    camera = {"cam_K": INTRINSICS, "depth_scale": 1.0}
    (folder / "scene_camera.json").write_text(json.dumps({str(k): {**camera, "timestamp": k / 30} for k in range(count)}))
    truth = {str(k): [truth_entry(poses[k], number) for number, poses in tracks.items()] for k in range(count)}
    (folder / "scene_gt.json").write_text(json.dumps(truth))


def write_plain_scene(folder, count=12):
    """With a mesh of its own."""
    write_bop_scene(folder, {1: path_of_poses(count)})
    write_mesh(folder / "mesh.obj")


class EvaluateTest(unittest.TestCase):
    """A temporary folder with the fake tracker in it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.output = self.folder / "output"
        self.tracker = self.folder / "fake_tracker"
        self.tracker.write_text(FAKE_TRACKER, encoding="utf-8")
        self.tracker.chmod(self.tracker.stat().st_mode | stat.S_IXUSR)

    def evaluate(self, *arguments, output=None):
        command = [sys.executable, "-B", EVALUATE, "--output", output or self.output, *arguments]
        return subprocess.run([str(x) for x in command], capture_output=True, text=True, check=False)

    def summary(self, output=None):
        return json.loads(((output or self.output) / "summary.json").read_text(encoding="utf-8"))
