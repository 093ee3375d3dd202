# SPDX-License-Identifier: BSD-3-Clause
"""The command evaluate from the outside."""
import csv
import json
import os
import re
import subprocess
import unittest

from tiny_data import EvaluateTest, write_plain_scene


class Runs(EvaluateTest):
    def test_scores_every_scene_below_and_writes_all_files(self):
        write_plain_scene(self.folder / "data/first")
        write_plain_scene(self.folder / "data/deeper/second")
        done = self.evaluate(self.folder / "data", "--program", self.tracker, "--seeds", 2, "--jobs", 2)
        self.assertEqual((done.returncode, done.stderr), (0, ""))  # no progress bar in a pipe
        self.assertRegex(done.stdout, r"data/first +ADD +1\.000 +1\.00 +1\.0 +99\.00 +0/2")
        self.assertRegex(done.stdout, r"(?m)^overall")
        summary = self.summary()
        self.assertEqual([scene["scene"] for scene in summary["scenes"]], ["deeper/second", "data/first"])
        for scene in summary["scenes"]:
            self.assertAlmostEqual(scene["median"]["error_mm_median"], 1.0, places=6)
            self.assertAlmostEqual(scene["median"]["nees_per_dof"], 1.0 / 6, places=6)  # 1 mm of 1 mm in one direction
            self.assertAlmostEqual(scene["median"]["time_ms_median"], 4.0)
            self.assertEqual(scene["confusion"]["TRACKING"]["TRACKING"], 24)
        with open(self.output / "summary.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["scene"] for row in rows], ["deeper/second", "data/first", "overall"])
        self.assertEqual(float(rows[2]["auc_error"]), 0.99)
        report = (self.output / "report.html").read_text(encoding="utf-8")
        self.assertGreaterEqual(report.count("data:image/png;base64,"), 6)
        self.assertNotRegex(report, r'(src|href)="(?!data:|#)')  # self-contained
        for file in ("plots/data/first/trajectory.png", "plots/reliability.png", "frames/data/first/seed2.csv",
                     "bop/faketracker_data-test_seed1.csv"):
            self.assertTrue((self.output / file).is_file(), file)

    def test_says_what_it_was_made_with(self):
        write_plain_scene(self.folder / "scene")
        config = self.folder / "mine.yaml"
        config.write_text("num_particles: 7\n", encoding="utf-8")
        self.evaluate(self.folder / "scene", "--program", self.tracker, "--config", config, "--", "--shift-mm", "2")
        made_with = self.summary()["provenance"]
        self.assertIn("num_particles: 7", made_with["configuration"])
        self.assertIn(str(self.tracker), made_with["program"])
        self.assertIn("--shift-mm 2", made_with["command"])
        self.assertIn("commit", made_with)
        self.assertAlmostEqual(self.summary()["scenes"][0]["median"]["error_mm_median"], 2.0, places=6)
        arguments = json.loads(next(self.output.rglob("*.arguments")).read_text())
        self.assertEqual(arguments["--config"], str(config))

    def test_failures_and_time_outs_are_reported_beside_what_worked(self):
        write_plain_scene(self.folder / "scene")
        for option, reason in (("--second-fails", "exit code 1: error: the second seed fails"),
                               ("--second-sleeps", "stopped after 3 s")):
            done = self.evaluate(self.folder / "scene", "--program", self.tracker, "--seeds", 2, "--timeout", 3, "--", option, "x")
            self.assertEqual(done.returncode, 1)
            self.assertIn(f"seed2: {reason}", done.stderr)
            self.assertIn("FAILED 1/2", done.stdout)
            scene = self.summary()["scenes"][0]
            self.assertEqual((scene["runs"], scene["failed_runs"]), (2, 1))
            self.assertAlmostEqual(scene["median"]["error_mm_median"], 1.0, places=6)
            self.assertIn(reason, (self.output / "report.html").read_text(encoding="utf-8"))

    def test_only_picks_scenes(self):
        write_plain_scene(self.folder / "data/first")
        write_plain_scene(self.folder / "data/second")
        self.evaluate(self.folder / "data", "--program", self.tracker, "--only", "sec")
        self.assertEqual([scene["scene"] for scene in self.summary()["scenes"]], ["data/second"])

    def test_scores_existing_estimates(self):
        write_plain_scene(self.folder / "data/first")
        write_plain_scene(self.folder / "data/second")
        self.evaluate(self.folder / "data", "--program", self.tracker, "--seeds", 2)
        again = self.folder / "again"
        done = self.evaluate(self.folder / "data", "--estimates", self.output / "estimates", output=again)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(self.summary()["overall"], self.summary(again)["overall"])
        for file in (self.output / "estimates/data/second").iterdir():
            file.unlink()
        done = self.evaluate(self.folder / "data", "--estimates", self.output / "estimates", output=again)
        self.assertEqual(done.returncode, 1)
        self.assertIn("data/second: no estimates found", done.stderr)


class Mistakes(EvaluateTest):
    def expect_error(self, code, pattern, *arguments):
        done = self.evaluate(*arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertRegex(done.stderr, pattern)
        self.assertNotIn("Traceback", done.stderr)

    def test_are_named_in_one_line(self):
        write_plain_scene(self.folder / "scene")
        empty = self.folder / "empty"
        empty.mkdir()
        self.expect_error(1, "there is no folder .*nowhere", self.folder / "nowhere", "--program", self.tracker)
        self.expect_error(1, "no scene found", empty, "--program", self.tracker)
        self.expect_error(1, "--only .* regular expression", self.folder / "scene", "--only", "(")
        self.expect_error(1, "no program", self.folder / "scene", "--program", self.folder / "none")
        self.expect_error(1, "no configuration", self.folder / "scene", "--program", self.tracker, "--config", "none.yaml")
        self.expect_error(2, "at least 1", self.folder / "scene", "--seeds", 0)
        self.expect_error(2, "exclude each other", self.folder / "scene", "--peer", "icp", "--estimates", empty)
        (self.folder / "scene/scene_gt.json").write_text("{", encoding="utf-8")
        self.expect_error(1, "scene_gt.json is not valid JSON", self.folder / "scene", "--program", self.tracker)

    def test_a_scene_without_a_mesh(self):
        write_plain_scene(self.folder / "scene")
        (self.folder / "scene/mesh.obj").unlink()
        self.expect_error(1, "scene has neither mesh.obj nor", self.folder / "scene", "--program", self.tracker)


@unittest.skipUnless("TRACK_SEQUENCE" in os.environ, "TRACK_SEQUENCE and SIMULATE_SCENE are not set: run this through ctest")
class TrackSequence(EvaluateTest):
    def test_agrees_with_the_programs_own_summary(self):
        scene = self.folder / "scene"
        mesh = os.path.join(os.path.dirname(__file__), "../../meshes/drill.obj")
        subprocess.run([os.environ["SIMULATE_SCENE"], scene, "--object", mesh, "--frames", "25", "--occluders", "passing",
                        "--occlusion-every", "1"],
                       check=True, capture_output=True)
        done = self.evaluate(scene, "--program", os.environ["TRACK_SEQUENCE"])
        self.assertEqual(done.returncode, 0, done.stderr)
        log = next(self.output.rglob("seed1.log")).read_text(encoding="utf-8")
        figures = self.summary()["scenes"][0]["median"]
        median, p95, largest = map(float, re.search(r"ADD \[mm\] +(\S+) +(\S+) +(\S+)", log).groups())
        self.assertAlmostEqual(figures["error_mm_median"], median, delta=0.02 * median)  # other vertices are averaged over
        self.assertAlmostEqual(figures["error_mm_p95"], p95, delta=0.02 * p95)
        self.assertAlmostEqual(figures["error_mm_max"], largest, delta=0.02 * largest)
        inside = float(re.search(r"95 % region: (\S+) %", log).group(1))
        self.assertAlmostEqual(100 * figures["inside95"], inside, delta=0.051)
        self.assertGreater(figures["occlusion_roc"], 0.8)
        self.assertGreaterEqual(figures["reaction_comes_frames"], 0)  # there are masks of successive frames


if __name__ == "__main__":
    unittest.main()
