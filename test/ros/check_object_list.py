#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Lists of objects for track_many: what is right is read, what is wrong is named."""
import importlib.machinery
import importlib.util
import pathlib
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "track_many"
loader = importlib.machinery.SourceFileLoader("track_many", str(SCRIPT))
spec = importlib.util.spec_from_loader("track_many", loader)
track_many = importlib.util.module_from_spec(spec)
loader.exec_module(track_many)


class ObjectList(unittest.TestCase):
    def read(self, text):
        with tempfile.TemporaryDirectory() as folder:
            self.path = pathlib.Path(folder) / "list.yaml"
            self.path.write_text(text, encoding="utf-8")
            return track_many.read_list(str(self.path))

    def expect_problem(self, text, *parts):
        with self.assertRaises(track_many.ListError) as caught:
            self.read(text)
        for part in parts:
            self.assertIn(part, str(caught.exception))

    def test_names_and_paths(self):
        first, second = self.read("objects: [{object: mug.yaml, init: search}, {object: 'package://p/m.obj', name: other, "
                                  "init: o.json, parameters: {num_particles: 9}}]")
        self.assertEqual(first["name"], "mug")
        self.assertEqual(first["object"], str((self.path.parent / "mug.yaml").resolve()))
        self.assertEqual(first["init"], "search")
        self.assertEqual(second["object"], "package://p/m.obj")
        self.assertEqual(second["init"], str((self.path.parent / "o.json").resolve()))
        self.assertEqual(second["parameters"], {"num_particles": 9})

    def test_what_is_wrong_is_named(self):
        self.expect_problem("objects: [{object: mug.yaml}, {object: mug.yaml}]", "'mug'", "its own `name`")
        self.expect_problem("objects: [{object: mug.yaml, nme: a}]", "object 1", "'nme'", "'name'")
        self.expect_problem("objects: [{name: a}]", "object 1", "lacks `object`")
        self.expect_problem("objects: [{object: m.obj, name: 2 mugs}]", "'2 mugs'", "letter")
        self.expect_problem("objects: [{object: m.obj, parameters: 3}]", "`parameters` must be a map")
        self.expect_problem("objects: []", "at least one")
        self.expect_problem("objets: [{object: m.obj}]", "'objets'", "'objects'")
        self.expect_problem("[1, 2]", "must be a map")
        self.expect_problem("objects: [", "cannot read it")
        with self.assertRaises(track_many.ListError):
            track_many.read_list("/nowhere/list.yaml")

    def test_the_shipped_test_list_is_right(self):
        entries = track_many.read_list(str(pathlib.Path(__file__).parent / "crossing_objects.yaml"))
        self.assertEqual([entry["name"] for entry in entries], ["bracket", "near_mug", "far_mug", "drill"])


if __name__ == "__main__":
    unittest.main()
