# SPDX-License-Identifier: BSD-3-Clause
"""Reading of estimates and traces, and finding them."""
import json
import pathlib
import tempfile
import unittest

import numpy as np

from evaluation import EvaluationError
from evaluation.estimates import find_estimates, load_run, occlusion_folder
from evaluation.scenes import Scene

HEADER = "scene_id,im_id,obj_id,score,R,t,time\n"
IDENTITY = "1 0 0 0 1 0 0 0 1"


class Estimates(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.scene = Scene("set/000003", pathlib.Path("/data/set/000003"), object_id=2, scene_id=3)

    def write(self, name, text=HEADER + f"3,0,2,1,{IDENTITY},0 0 1000,0.01\n"):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def test_rows_in_metres_and_the_state_from_the_score(self):
        path = self.write("a.csv", HEADER + f"3,5,2,0,{IDENTITY},1 2 900,0.02\n3,4,2,0.9,{IDENTITY},100 0 1000,0.01\n")
        run = load_run(path, self.scene)
        self.assertEqual((run.frames, run.states), ([4, 5], ["TRACKING", "LOST"]))
        np.testing.assert_allclose(run.poses[0][:3, 3], [0.1, 0, 1.0])
        self.assertIsNone(run.covariances)

    def test_a_trace_gives_state_and_covariance(self):
        path = self.write("a.csv")
        line = {"frame": 0, "status": "OCCLUDED", "covariance": np.eye(6).ravel().tolist(), "visible_fraction": 0.3}
        self.write("a.jsonl", json.dumps(line) + "\n")
        run = load_run(path, self.scene)
        self.assertEqual(run.states, ["OCCLUDED"])
        np.testing.assert_array_equal(run.covariances[0], np.eye(6))
        self.write("a.jsonl", json.dumps({**line, "covariance": [None] * 36}) + "\n")
        self.assertTrue(np.isnan(load_run(path, self.scene).covariances[0]).all())

    def test_several_scenes_and_objects_in_one_file(self):
        rows = "".join(f"{s},{k},{o},{score},{IDENTITY},{o} 0 1000,0.01\n" for s in (2, 3) for o in (1, 2) for k in (0, 1)
                       for score in (0.5, 0.9))
        run = load_run(self.write("all.csv", HEADER + rows), self.scene)
        self.assertEqual(run.frames, [0, 1])
        self.assertEqual(run.poses[0][0, 3], 0.002)
        self.assertEqual(list(run.scores), [0.9, 0.9])

    def test_bad_files_are_named(self):
        for text in ("a,b\n1,2\n", HEADER, HEADER + "3,0,2,1,1 0 0,0 0 1,0\n", HEADER + f"3,x,2,1,{IDENTITY},0 0 1,0\n",
                     HEADER + "3,0,2,1,2 0 0 0 2 0 0 0 2,0 0 1,0\n", HEADER + "3,0\n"):
            with self.assertRaisesRegex(EvaluationError, "bad.csv"):
                load_run(self.write("bad.csv", text), self.scene)

    def test_a_short_trace_is_an_error(self):
        path = self.write("a.csv")
        self.write("a.jsonl", "")
        with self.assertRaisesRegex(EvaluationError, "lacks frame 0"):
            load_run(path, self.scene)

    def test_where_estimates_may_be(self):
        for names in (["set/000003/seed1.csv", "set/000003/seed2.csv"], ["x/000003/est.csv"], ["000003.csv"], ["000003_2.csv"],
                      ["set_000003_seed4.csv"], ["method_set-test_run1.csv"]):
            with self.subTest(names), tempfile.TemporaryDirectory() as folder:
                self.folder = pathlib.Path(folder)
                paths = [self.write(name) for name in names]
                self.write("000003_other.csv")
                self.write("other/000004/seed1.csv")
                self.write("notes.csv", "a,b\n")
                self.assertEqual(find_estimates(self.folder, self.scene, 2), paths)

    def test_a_single_scene_takes_every_file(self):
        path = self.write("EST.csv")
        self.assertEqual(find_estimates(self.folder, self.scene, 1), [path])
        self.assertEqual(find_estimates(self.folder, self.scene, 2), [])

    def test_occlusion_pictures_beside(self):
        path = self.write("seed1.csv")
        self.assertIsNone(occlusion_folder(path))
        (self.folder / "seed1_occlusion").mkdir()
        self.assertEqual(occlusion_folder(path), self.folder / "seed1_occlusion")


if __name__ == "__main__":
    unittest.main()
