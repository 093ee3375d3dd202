# SPDX-License-Identifier: BSD-3-Clause
"""Videos in YCBInEOAT's layout."""
import json
import unittest

import numpy as np

from evaluation import EvaluationError
from evaluation.find_scenes import find_scenes
from evaluation.scenes import load_truth
from tiny_data import INTRINSICS, EvaluateTest, path_of_poses, write_depth, write_mesh

FIRST_NS = 1581120424100262102


class YcbInEoat(EvaluateTest):
    def setUp(self):
        super().setUp()
        self.root = self.folder / "YCBInEOAT"
        self.video = self.root / "mustard0"
        self.poses = path_of_poses(6)
        (self.video / "annotated_poses").mkdir(parents=True)
        np.savetxt(self.video / "cam_K.txt", np.array(INTRINSICS).reshape(3, 3))
        for k, T in enumerate(self.poses):
            write_depth(self.video / "depth" / f"{FIRST_NS + k * 33_000_000}.png", 700 + k)
            np.savetxt(self.video / "annotated_poses" / f"{k:07d}.txt", T)
        write_mesh(self.root / "models/006_mustard_bottle/textured_simple.obj")

    def find(self, **options):
        return find_scenes([self.root], self.folder / "work", **options)

    def test_becomes_a_scene_in_metres_and_seconds(self):
        scene, = self.find()
        self.assertEqual(scene.name, "YCBInEOAT/mustard0")
        truth = load_truth(scene)
        self.assertEqual(truth.frames, list(range(6)))
        np.testing.assert_allclose(truth.poses[5], self.poses[5], atol=1e-9)
        self.assertAlmostEqual(truth.stamps[5], 0.165, places=9)
        cameras = json.loads((scene.folder / "scene_camera.json").read_text())
        self.assertEqual(cameras["0"]["cam_K"], INTRINSICS)
        self.assertTrue((scene.folder / "depth/000005.png").samefile(self.video / f"depth/{FIRST_NS + 5 * 33_000_000}.png"))

    def test_evaluates(self):
        done = self.evaluate(self.root, "--program", self.tracker)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertAlmostEqual(self.summary()["scenes"][0]["median"]["error_mm_median"], 1.0, places=5)

    def test_the_models_may_be_elsewhere(self):
        (self.root / "models").rename(self.folder / "ycb")
        with self.assertRaisesRegex(EvaluationError, "--models"):
            self.find()
        self.assertEqual(len(self.find(models=self.folder / "ycb")), 1)

    def test_what_is_wrong_is_named(self):
        (self.video / "annotated_poses/0000003.txt").write_text("1 2 3\n")
        with self.assertRaisesRegex(EvaluationError, "0000003.txt"):
            self.find()
        for path in (self.video / "depth").iterdir():
            path.unlink()
        with self.assertRaisesRegex(EvaluationError, "depth has no .png"):
            self.find()
        self.video.rename(self.root / "teapot0")
        with self.assertRaisesRegex(EvaluationError, "teapot0: the name tells no object"):
            self.find()


if __name__ == "__main__":
    unittest.main()
