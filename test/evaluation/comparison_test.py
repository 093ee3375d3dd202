# SPDX-License-Identifier: BSD-3-Clause
"""Several trackers in one page."""
import csv
import json
import pathlib
import tempfile
import unittest

from aggregate_test import SCENES, make_outcome
from evaluation import comparison, result_files
from evaluation.aggregate import summarise_all, summarise_scene


class Comparison(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.results = {"good": self.summary([0.001] * 30), "bad <one>": self.summary([0.001] * 5 + [0.2] * 25)}

    def summary(self, errors):
        outcomes = {"a": [make_outcome(SCENES[0], "seed1", errors)]}
        scene = summarise_scene(SCENES[0], outcomes["a"])
        path = self.folder / "summary.json"
        result_files.write_json(path, {"commit": "abc"}, [scene], summarise_all([scene], outcomes))
        return json.loads(path.read_text())

    def test_the_table_has_a_row_for_every_tracker_and_scene(self):
        comparison.write_csv(self.folder / "comparison.csv", self.results)
        with open(self.folder / "comparison.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([(row["tracker"], row["scene"]) for row in rows],
                         [(name, scene) for name in self.results for scene in (SCENES[0].name, "overall")])
        self.assertAlmostEqual(float(rows[0]["error_mm_median"]), 1.0)
        self.assertAlmostEqual(float(rows[2]["error_mm_median"]), 200.0)

    def test_the_page_is_self_contained_and_tells_what_it_was_made_with(self):
        picture = comparison.plot(self.folder / "comparison.png", self.results)
        comparison.write_page(self.folder / "index.html", self.results, [picture], ["A note."])
        page = (self.folder / "index.html").read_text(encoding="utf-8")
        self.assertIn("data:image/png;base64,", page)
        self.assertNotRegex(page, r'(src|href)="(?!data:|#)')
        for part in ("abc", "A note.", "bad &lt;one&gt;", SCENES[0].name):
            self.assertIn(part, page)

    def test_the_page_links_to_the_reports_of_single_trackers(self):
        comparison.write_page(self.folder / "index.html", self.results, [], [], {"good": "good/report.html"})
        page = (self.folder / "index.html").read_text(encoding="utf-8")
        self.assertEqual(page.count('href="'), 1)
        self.assertIn('href="good/report.html"', page)


if __name__ == "__main__":
    unittest.main()
