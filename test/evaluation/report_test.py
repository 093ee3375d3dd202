# SPDX-License-Identifier: BSD-3-Clause
"""Tables for people and for programs."""
import json
import math
import pathlib
import tempfile
import unittest

from aggregate_test import SCENES, make_outcome
from evaluation import provenance, report, result_files, terminal_table
from evaluation.aggregate import summarise_all, summarise_scene


class Tables(unittest.TestCase):
    def setUp(self):
        outcomes = {"a": [make_outcome(SCENES[0], "seed1", [0.001] * 5 + [0.2] * 25)]}
        self.summary = summarise_scene(SCENES[0], outcomes["a"])
        self.total = summarise_all([self.summary], outcomes)

    def test_terminal_lines_are_as_wide_as_their_header(self):
        header = terminal_table.header(10)
        self.assertEqual(len(terminal_table.scene_line(self.summary, 10)), len(header))
        self.assertEqual(len(terminal_table.overall_line(self.total, 10)), len(header))

    def test_json_has_neither_nan_nor_infinity(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "summary.json"
            result_files.write_json(path, {}, [self.summary], self.total)
            content = json.loads(path.read_text(), parse_constant=lambda name: self.fail(name))
        self.assertIsNone(content["scenes"][0]["median"]["occlusion_roc"])
        self.assertEqual(content["scenes"][0]["worst"]["recovery_after_loss_frames"], "inf")

    def test_html_escapes_what_others_wrote(self):
        failed = {"scene": "a<b>", "runs": 1, "failed_runs": 1, "failures": [{"run": "seed1", "problem": "<script>"}]}
        section = report.scene_section(failed, [])
        self.assertIn("&lt;script&gt;", section)
        self.assertNotIn("<script>", section)

    def test_long_texts_are_folded_up(self):
        table = report.provenance_table({"commit": "abc", "configuration": "defaults\n<a>: 1\n"})
        self.assertIn("<summary>defaults</summary>", table)
        self.assertIn("&lt;a&gt;: 1", table)
        self.assertNotIn("<summary>abc", table)

    def test_defaults_are_told_in_full(self):
        made_with = provenance.describe(pathlib.Path("."), pathlib.Path("/bin/track_sequence"), None, 1)
        self.assertIn("num_particles: ", made_with["configuration"])
        self.assertNotIn("num_particles", provenance.describe(pathlib.Path("."), pathlib.Path("/bin/track_icp"), None, 1)["configuration"])

    def test_numbers(self):
        self.assertEqual(report.number(1234.5, 1), "1,234.5")
        self.assertEqual(report.number(math.nan, 1), "–")
        self.assertEqual(report.number(269838.98, 2), "2.7e+05")
        self.assertIn("never", report.number(math.inf, 1))


if __name__ == "__main__":
    unittest.main()
