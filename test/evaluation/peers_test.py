# SPDX-License-Identifier: BSD-3-Clause
"""The comparison trackers on a small simulated scene."""
import os
import subprocess
import unittest

from tiny_data import EvaluateTest

MESH = os.path.join(os.path.dirname(__file__), "../../meshes/drill.obj")


class Peers(EvaluateTest):
    @classmethod
    def setUpClass(cls):
        if "TRACK_ICP" not in os.environ:
            raise unittest.SkipTest("TRACK_ICP, TRACK_PCL and SIMULATE_SCENE are not set: run this through ctest")

    def setUp(self):
        super().setUp()
        self.scene = self.folder / "scene"
        subprocess.run([os.environ["SIMULATE_SCENE"], self.scene, "--object", MESH, "--frames", "12", "--speed", "slow"],
                       check=True, capture_output=True)

    def test_icp_follows_to_a_millimetre(self):
        done = self.evaluate(self.scene, "--peer", "icp", "--program", os.environ["TRACK_ICP"])
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        figures = self.summary()["scenes"][0]["median"]
        self.assertEqual(figures["frames"], 12)
        self.assertLess(figures["error_mm_median"], 1.0)

    def test_pcls_particle_filter_follows(self):
        done = self.evaluate(self.scene, "--peer", "pcl", "--program", os.environ["TRACK_PCL"])
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertLess(self.summary()["scenes"][0]["median"]["error_mm_median"], 30.0)

    def test_they_have_track_sequences_command_line(self):
        for program in (os.environ["TRACK_ICP"], os.environ["TRACK_PCL"]):
            done = subprocess.run([program, self.folder / "none", "--output", self.folder / "est.csv"], capture_output=True, text=True,
                                  check=False)
            self.assertEqual(done.returncode, 1)
            self.assertIn("error: there is no scene folder", done.stderr)
            done = subprocess.run([program, self.scene, "--output", self.folder / "est.csv", "--trace", self.folder / "t.jsonl",
                                   "--stride", "6"], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0)
            self.assertIn("ignores --trace", done.stderr)
            self.assertEqual(len((self.folder / "est.csv").read_text().splitlines()), 1 + 2)


if __name__ == "__main__":
    unittest.main()
