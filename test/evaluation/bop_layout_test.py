# SPDX-License-Identifier: BSD-3-Clause
"""Data sets in BOP's layout: several objects, millimetres, targets, masks; results for the BOP toolkit."""
import csv
import json
import unittest

import numpy as np
from PIL import Image

from evaluation.bop_results import file_name
from evaluation.find_scenes import find_scenes
from evaluation.occlusion_score import OCCLUDED, VISIBLE, read_mask
from evaluation.scenes import Scene, load_truth
from tiny_data import EvaluateTest, path_of_poses, write_bop_scene, write_mesh


class BopLayout(EvaluateTest):
    def setUp(self):
        super().setUp()
        self.root = self.folder / "tinyset"
        self.scene = self.root / "test" / "000002"
        self.tracks = {3: path_of_poses(5), 7: path_of_poses(5, (0.1, 0.0, 0.7))}
        write_bop_scene(self.scene, self.tracks)
        for number in self.tracks:
            write_mesh(self.root / "models" / f"obj_{number:06d}.ply", scale=1000.0)
        turn = [-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
        (self.root / "models/models_info.json").write_text(json.dumps({"3": {"diameter": 200}, "7": {"symmetries_discrete": [turn]}}))

    def find(self, **options):
        return find_scenes([self.folder], self.folder / "work", **options)

    def test_one_scene_for_each_object(self):
        scenes = self.find()
        self.assertEqual([scene.name for scene in scenes],
                         ["tinyset/test/000002/obj_000003", "tinyset/test/000002/obj_000007"])
        self.assertEqual([(s.scene_id, s.object_id, s.mesh_scale) for s in scenes], [(2, 3, 1e-3), (2, 7, 1e-3)])
        truth = load_truth(scenes[1])
        np.testing.assert_allclose(truth.poses[4], self.tracks[7][4], atol=1e-12)

    def test_targets_choose_the_objects(self):
        targets = [{"scene_id": 2, "im_id": k, "obj_id": 7, "inst_count": 1} for k in (0, 4)]
        (self.root / "test_targets_bop19.json").write_text(json.dumps(targets))
        self.assertEqual([scene.object_id for scene in self.find()], [7])
        self.assertEqual([scene.object_id for scene in self.find(object_id=3)], [3])

    def test_visibility_and_masks_of_the_data_set(self):
        info = {str(k): [{"visib_fract": 0.9}, {"visib_fract": 0.1 * k}] for k in range(5)}
        (self.scene / "scene_gt_info.json").write_text(json.dumps(info))
        for kind, row in (("mask", [0, 255, 255]), ("mask_visib", [0, 0, 255])):
            (self.scene / kind).mkdir()
            Image.fromarray(np.array([row], np.uint8)).save(self.scene / kind / "000003_000001.png")
        truth = load_truth(self.find()[1])
        self.assertAlmostEqual(truth.visible[3], 0.3)
        self.assertEqual(list(truth.masks), [3])
        np.testing.assert_array_equal(read_mask(truth.masks[3]), [[0, OCCLUDED, VISIBLE]])

    def test_evaluates_and_writes_what_the_toolkit_reads(self):
        done = self.evaluate(self.root, "--program", self.tracker)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        scenes = self.summary()["scenes"]
        self.assertEqual([scene["error_kind"] for scene in scenes], ["ADD", "ADD-S"])
        self.assertAlmostEqual(scenes[0]["median"]["error_mm_median"], 1.0, places=5)
        with open(self.output / "bop/faketracker_tinyset-test_seed1.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([(r["scene_id"], r["im_id"], r["obj_id"]) for r in rows[:3]],
                         [("2", "0", "3"), ("2", "0", "7"), ("2", "1", "3")])
        self.assertEqual({r["time"] for r in rows}, {"0.008"})  # of both objects: one time for a picture
        again = self.evaluate(self.root, "--estimates", self.output / "bop", output=self.folder / "again")
        self.assertEqual((again.returncode, again.stderr), (0, ""))
        self.assertAlmostEqual(self.summary(self.folder / "again")["scenes"][1]["median"]["add_mm_median"], 1.0, places=5)

    def test_result_lines_are_what_the_toolkit_splits(self):
        self.evaluate(self.root, "--program", self.tracker)
        content = (self.output / "bop/faketracker_tinyset-test_seed1.csv").read_bytes().decode("ascii")
        self.assertNotIn("\r", content)
        header, *lines = content.splitlines()
        self.assertEqual(header, "scene_id,im_id,obj_id,score,R,t,time")
        times = {}
        for line in lines:
            scene_id, im_id, _, score, R, t, time = line.split(",")  # seven, none of them in quotes
            rotation = np.array([float(x) for x in R.split()]).reshape(3, 3)
            np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-6)
            self.assertEqual(len([float(x) for x in t.split()]), 3)
            float(score)
            self.assertEqual(times.setdefault((int(scene_id), int(im_id)), time), time)

    def test_file_names_come_apart_at_the_right_places(self):
        scene = Scene("", self.folder, data_set="my_set", split="test_primesense")
        self.assertEqual(file_name("track_sequence", scene, "seed1"), "tracksequence_myset-test-primesense_seed1.csv")


if __name__ == "__main__":
    unittest.main()
