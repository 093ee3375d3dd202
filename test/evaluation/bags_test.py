# SPDX-License-Identifier: BSD-3-Clause
"""Bags as scenes."""
import importlib.util
import json
import os
import unittest

import numpy as np
from PIL import Image

from evaluation import EvaluationError, bags
from evaluation.find_scenes import find_scenes
from evaluation.object_files import read_object
from evaluation.poses import quaternion
from evaluation.scenes import load_truth
from evaluation.symmetries import load_symmetries
from tiny_data import INTRINSICS, EvaluateTest, path_of_poses, write_mesh

HAS_ROSBAG = importlib.util.find_spec("rosbag") is not None
EPOCH_S = 1_000_000_000


class Topics(unittest.TestCase):
    def test_the_only_depth_image_is_taken(self):
        self.assertEqual(bags.choose_image_topic(["/a"], "x.bag"), "/a")
        self.assertEqual(bags.choose_image_topic(["/rgb/image", "/depth/image"], "x.bag"), "/depth/image")
        for topics in ([], ["/a", "/b"], ["/depth/a", "/depth/b"]):
            with self.assertRaisesRegex(EvaluationError, "x.bag has . depth images"):
                bags.choose_image_topic(topics, "x.bag")


class Objects(EvaluateTest):
    def test_symmetries_of_the_yaml_are_those_of_bop(self):
        write_mesh(self.folder / "cup.obj")
        (self.folder / "cup.yaml").write_text("mesh: cup.obj\nmesh_scale: 0.5\nsymmetries:\n  continuous:\n"
                                              "    - {axis: [0, 0, 2], offset: [0, 1, 0]}\n")
        mesh, scale, models_info = read_object(self.folder / "cup.yaml", self.folder)
        self.assertEqual((mesh, scale), (self.folder / "cup.obj", 0.5))
        (axis, offset), = load_symmetries(models_info, 1, scale).continuous
        np.testing.assert_allclose(axis, [0, 0, 1])
        np.testing.assert_allclose(offset, [0, 0.5, 0])
        (self.folder / "bad.yaml").write_text("name: no mesh\n")
        with self.assertRaisesRegex(EvaluationError, "bad.yaml is no object YAML"):
            read_object(self.folder / "bad.yaml", self.folder)


@unittest.skipUnless(HAS_ROSBAG, "python3-rosbag is not installed")
class Bags(EvaluateTest):
    def setUp(self):
        super().setUp()
        write_mesh(self.folder / "data/box.obj")
        self.poses = path_of_poses(6)
        self.write_bag()

    def write_bag(self, encoding="16UC1", with_truth=True):
        import genpy
        import rosbag
        from geometry_msgs.msg import PoseStamped
        from sensor_msgs.msg import CameraInfo, Image as ImageMessage

        with rosbag.Bag(str(self.folder / "data/box.bag"), "w") as bag:
            for k, T in enumerate(self.poses):
                stamp = genpy.Time(EPOCH_S, k * 33_000_000)
                info, image, truth = CameraInfo(), ImageMessage(), PoseStamped()
                info.header.stamp = image.header.stamp = truth.header.stamp = stamp
                info.K = INTRINSICS
                image.width, image.height, image.encoding = 40, 30, encoding
                pixels = np.full((30, 44), 700 + k, "<u2") if encoding == "16UC1" else np.full((30, 44), 0.7123, "<f4")
                image.step, image.data = pixels.strides[0], pixels.tobytes()  # four pixels of padding
                truth.pose.position.x, truth.pose.position.y, truth.pose.position.z = T[:3, 3]
                o = truth.pose.orientation
                o.w, o.x, o.y, o.z = quaternion(T[:3, :3])
                bag.write("/camera/depth/camera_info", info, stamp)
                bag.write("/camera/depth/image_raw", image, stamp)
                if with_truth:
                    bag.write("/ground_truth/pose", truth, stamp)

    def find(self):
        return find_scenes([self.folder / "data"], self.folder / "work", object_file=self.folder / "data/box.obj")

    def test_becomes_a_scene_folder(self):
        scene, = self.find()
        self.assertEqual((scene.name, scene.mesh), ("data/box", self.folder / "data/box.obj"))
        truth = load_truth(scene)
        self.assertEqual(truth.frames, list(range(6)))
        np.testing.assert_allclose(truth.poses[5], self.poses[5], atol=1e-9)
        self.assertAlmostEqual(truth.stamps[5], 0.165, places=9)
        cameras = json.loads((scene.folder / "scene_camera.json").read_text())
        self.assertEqual(cameras["0"]["cam_K"], INTRINSICS)
        picture = np.asarray(Image.open(scene.folder / "depth/000003.png"))
        self.assertEqual((picture.shape, picture.min(), picture.max()), ((30, 40), 703, 703))

    def test_metres_become_tenths_of_millimetres(self):
        self.write_bag("32FC1")
        scene, = self.find()
        camera = json.loads((scene.folder / "scene_camera.json").read_text())["0"]
        counts = np.asarray(Image.open(scene.folder / "depth/000000.png"))
        self.assertAlmostEqual(counts[0, 0] * camera["depth_scale"], 712.3)

    def test_what_is_missing_is_told(self):
        with self.assertRaisesRegex(EvaluationError, "--object"):
            find_scenes([self.folder / "data/box.bag"], self.folder / "work")
        self.write_bag(with_truth=False)
        with self.assertRaisesRegex(EvaluationError, "no ground truth on /ground_truth/pose"):
            self.find()
        (self.folder / "data/box.bag").write_bytes(b"no bag at all")
        with self.assertRaisesRegex(EvaluationError, "cannot read .*box.bag as a rosbag"):
            self.find()

    def test_another_program_gets_the_folder(self):
        done = self.evaluate(self.folder / "data/box.bag", "--object", self.folder / "data/box.obj", "--program", self.tracker)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertRegex(done.stdout, r"data/box +ADD +1\.000")

    @unittest.skipUnless("TRACK_BAG" in os.environ, "track_bag is not built")
    def test_our_tracker_gets_the_bag(self):
        environment = os.pathsep.join([os.path.dirname(os.environ["TRACK_BAG"]), os.environ["PATH"]])
        os.environ["PATH"] = environment
        done = self.evaluate(self.folder / "data/box.bag", "--object", self.folder / "data/box.obj")
        self.assertIn("data/box", done.stdout, done.stderr)
        log = (self.output / "estimates/data/box/seed1.log")
        self.assertTrue(log.is_file(), done.stderr)
        self.assertTrue((self.output / "estimates/data/box/seed1.jsonl").is_file(), log.read_text())


if __name__ == "__main__":
    unittest.main()
