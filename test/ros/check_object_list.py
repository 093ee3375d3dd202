#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""track_many without ROS: what is right in a list of objects is read, what is wrong is named; whether its manager is dead."""
import importlib.machinery
import importlib.util
import pathlib
import tempfile
import threading
import unittest
import xmlrpc.server

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


class ManagerProcess(unittest.TestCase):
    """As a node answers: code, message, value."""

    def setUp(self):
        self.server = xmlrpc.server.SimpleXMLRPCServer(("localhost", 0), logRequests=False)
        self.answer = [1, "", 4711]
        self.server.register_function(lambda caller: self.answer, "getPid")
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        self.loader = track_many.Loader.__new__(track_many.Loader)
        self.loader.process = (f"http://localhost:{self.server.server_address[1]}/", 4711)

    def tearDown(self):
        self.server.server_close()

    def test_the_same_process_is_alive(self):
        self.assertFalse(self.loader.manager_is_seen_dead())
        self.server.shutdown()

    def test_another_process_at_its_address_is_another_manager(self):
        self.answer = [1, "", 4712]
        self.assertTrue(self.loader.manager_is_seen_dead())
        self.server.shutdown()

    def test_nobody_at_its_address(self):
        self.server.shutdown()
        self.server.server_close()
        self.assertTrue(self.loader.manager_is_seen_dead())

    def test_one_that_hangs_is_left_to_the_bonds(self):
        self.server.shutdown()  # connections are taken, and nobody answers
        track_many.ImpatientTransport.TIMEOUT_S = 0.2
        self.assertFalse(self.loader.manager_is_seen_dead())


if __name__ == "__main__":
    unittest.main()
