# SPDX-License-Identifier: BSD-3-Clause
"""Folding of equivalent poses and reading of models_info.json."""
import json
import math
import pathlib
import tempfile
import unittest

import numpy as np

from evaluation import EvaluationError
from evaluation.poses import exp_so3, pose, rotation_about_point
from evaluation.symmetries import Symmetries, constrained_basis, fold, load_symmetries

Z = np.array([0.0, 0.0, 1.0])
T_REFERENCE = pose(exp_so3([0.4, -1.0, 0.3]), [0.1, 0.2, 0.9])


class Folding(unittest.TestCase):
    def test_a_turn_about_the_axis_disappears_also_beside_the_origin(self):
        for offset in (np.zeros(3), np.array([0.03, -0.02, 0.5])):
            turned = T_REFERENCE @ rotation_about_point(exp_so3(2.5 * Z), offset)
            np.testing.assert_allclose(fold(turned, T_REFERENCE, Symmetries([(Z, offset)])), T_REFERENCE, atol=1e-9)

    def test_a_tilt_across_the_axis_stays(self):
        tilted = T_REFERENCE @ pose(exp_so3([0.2, 0, 0]) @ exp_so3(1.0 * Z), [0, 0, 0])
        folded = fold(tilted, T_REFERENCE, Symmetries([(Z, np.zeros(3))]))
        np.testing.assert_allclose(T_REFERENCE[:3, :3].T @ folded[:3, :3], exp_so3([0.2, 0, 0]), atol=1e-9)

    def test_the_nearest_of_discrete_equivalents(self):
        symmetries = Symmetries(discrete=[pose(exp_so3(math.pi * axis), [0, 0, 0]) for axis in np.eye(3)])
        turned = T_REFERENCE @ pose(exp_so3([math.pi - 0.1, 0, 0]), [0, 0, 0])
        folded = fold(turned, T_REFERENCE, symmetries)
        np.testing.assert_allclose(T_REFERENCE[:3, :3].T @ folded[:3, :3], exp_so3([-0.1, 0, 0]), atol=1e-9)

    def test_a_ball_takes_over_any_orientation_about_its_centre(self):
        centre = np.array([0.1, 0.0, 0.0])
        symmetries = Symmetries([(Z, centre), (np.array([1.0, 0, 0]), centre)])
        turned = T_REFERENCE @ rotation_about_point(exp_so3([1.0, 2.0, -0.5]), centre)
        np.testing.assert_allclose(fold(turned, T_REFERENCE, symmetries), T_REFERENCE, atol=1e-9)

    def test_without_symmetries_nothing_changes(self):
        T = pose(exp_so3([1, 2, 0.5]), [1, 2, 3])
        np.testing.assert_array_equal(fold(T, T_REFERENCE, Symmetries()), T)


class FreeDirections(unittest.TestCase):
    def test_dimensions(self):
        axis = (Z, np.zeros(3))
        self.assertEqual(constrained_basis(T_REFERENCE, Symmetries()).shape, (6, 6))
        self.assertEqual(constrained_basis(T_REFERENCE, Symmetries([axis])).shape, (6, 5))
        self.assertEqual(constrained_basis(T_REFERENCE, Symmetries([axis, (np.array([1.0, 0, 0]), np.zeros(3))])).shape, (6, 4))

    def test_spinning_is_orthogonal_to_the_basis(self):
        offset = np.array([0.05, 0.02, 0.0])
        basis = constrained_basis(T_REFERENCE, Symmetries([(Z, offset)]))
        spun = T_REFERENCE @ rotation_about_point(exp_so3(1e-6 * Z), offset)
        motion = np.concatenate([spun[:3, 3] - T_REFERENCE[:3, 3], 1e-6 * T_REFERENCE[:3, 2]])
        np.testing.assert_allclose(basis.T @ motion, 0.0, atol=1e-12)


class ModelsInfo(unittest.TestCase):
    def load(self, content, scale=1e-3, object_id=5):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "models_info.json"
            path.write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
            return load_symmetries(path, object_id, scale)

    def test_millimetres_become_metres(self):
        found = self.load({"5": {"symmetries_continuous": [{"axis": [0, 0, 2], "offset": [10, 0, 0]}],
                                 "symmetries_discrete": [[-1, 0, 0, 20, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]]}})
        np.testing.assert_allclose(found.continuous[0][0], Z)
        np.testing.assert_allclose(found.continuous[0][1], [0.01, 0, 0])
        np.testing.assert_allclose(found.discrete[0][:3, 3], [0.02, 0, 0])

    def test_other_objects_and_missing_files_have_none(self):
        self.assertFalse(self.load({"4": {"symmetries_continuous": [{"axis": [0, 0, 1], "offset": [0, 0, 0]}]}}).any())
        self.assertFalse(load_symmetries(None, 1, 1.0).any())

    def test_bad_files_are_named(self):
        for content in ("{", "[]", {"5": {"symmetries_continuous": [{"axis": [0, 0, 0], "offset": [0, 0, 0]}]}},
                        {"5": {"symmetries_discrete": [[1, 2, 3]]}}, {"5": {"symmetries_continuous": [{"axis": [0, 0, 1]}]}}):
            with self.assertRaisesRegex(EvaluationError, "models_info.json"):
                self.load(content)


if __name__ == "__main__":
    unittest.main()
