# SPDX-License-Identifier: BSD-3-Clause
"""Figures over seeds and sequences."""
import math
import unittest

import numpy as np

from evaluation.aggregate import summarise_all, summarise_scene
from evaluation.runs import Job, Outcome
from evaluation.scenes import Scene
from evaluation.sequence_score import FrameTable, score_run


def make_outcome(scene, label, errors_m, states=None):
    n = len(errors_m)
    errors, nothing = np.array(errors_m, float), np.full(n, math.nan)
    table = FrameTable(frames=list(range(n)), stamps=np.arange(n) / 30, true_poses=[None] * n, poses=[None] * n, scores=np.ones(n),
                       states=states or ["TRACKING"] * n, visible=np.ones(n), estimated_visible=nothing, times_s=np.full(n, 0.002),
                       add=errors, add_s=errors, translation=errors, rotation=np.zeros(n), error_vectors=np.zeros((n, 6)),
                       nees=np.full(n, 3.0), dof=np.full(n, 6.0), stddev_translation=nothing, stddev_rotation=nothing,
                       symmetric=False)
    return Outcome(Job(scene, label, None), score_run(table), table)


SCENES = [Scene("a", None), Scene("b", None)]


class Aggregate(unittest.TestCase):
    def test_median_and_worst_over_seeds(self):
        outcomes = [make_outcome(SCENES[0], f"seed{k}", [0.001 * k] * 10) for k in (1, 2, 6)]
        summary = summarise_scene(SCENES[0], outcomes)
        self.assertAlmostEqual(summary["median"]["error_mm_median"], 2.0)
        self.assertAlmostEqual(summary["worst"]["error_mm_median"], 6.0)
        self.assertAlmostEqual(summary["median"]["auc_error"], 0.98)
        self.assertAlmostEqual(summary["worst"]["auc_error"], 0.94)  # of shares the lowest is the worst
        self.assertEqual(summary["nees_by_visibility"]["0.9-1"]["frames"], 30)

    def test_lost_runs(self):
        outcomes = [make_outcome(SCENES[0], "seed1", [0.001] * 30), make_outcome(SCENES[0], "seed2", [0.001] * 5 + [0.2] * 25)]
        summary = summarise_scene(SCENES[0], outcomes)
        self.assertEqual(summary["lost_runs"], 1)
        self.assertEqual(summary["worst"]["lost_frames"], 25)
        self.assertEqual(summary["worst"]["recovery_after_loss_frames"], math.inf)
        self.assertEqual(summary["confusion"]["LOST"]["TRACKING"], 25)
        self.assertEqual(summary["worst"]["wrong_as_tracking_longest"], 25)

    def test_overall_is_mean_auc_and_median_of_medians(self):
        outcomes = {"a": [make_outcome(SCENES[0], "seed1", [0.001] * 10)], "b": [make_outcome(SCENES[1], "seed1", [0.003] * 30)]}
        summaries = [summarise_scene(scene, outcomes[scene.name]) for scene in SCENES]
        total = summarise_all(summaries, outcomes)
        self.assertAlmostEqual(total["median"]["auc_error"], 0.98)
        self.assertAlmostEqual(total["median"]["error_mm_median"], 2.0)
        self.assertAlmostEqual(total["median"]["nees_per_dof"], 0.5)
        self.assertEqual((total["scenes"], total["scenes_lost"], total["failed_runs"]), (2, 0, 0))
        self.assertEqual(total["confusion"]["TRACKING"]["TRACKING"], 40)

    def test_failed_runs_stay_in_sight(self):
        outcomes = {"a": [Outcome(Job(SCENES[0], "seed1", None), problem="stopped after 3 s")]}
        summary = summarise_scene(SCENES[0], outcomes["a"])
        self.assertEqual(summary["failures"], [{"run": "seed1", "problem": "stopped after 3 s"}])
        self.assertEqual(summarise_all([summary], outcomes)["failed_runs"], 1)


if __name__ == "__main__":
    unittest.main()
