# SPDX-License-Identifier: BSD-3-Clause
"""Vertices of mesh files."""
import pathlib
import struct
import tempfile
import unittest

import numpy as np

from evaluation import EvaluationError
from evaluation.mesh_points import evenly_chosen, load_points

CORNERS = np.array([[0, 0, 0], [10, 0, 0], [0, 20, 0], [0, 0, 30]], float)
PLY_HEADER = ("ply\nformat {}\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
              "property uchar red\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n")


class MeshFiles(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def load(self, name, content, scale=1e-3):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return load_points(path, scale)

    def test_obj_takes_what_faces_use(self):
        text = "".join(f"v {x} {y} {z}\n" for x, y, z in CORNERS) + "v 99 99 99\nf 1/1/1 2//2 3\nf -5 -4 -2\n"
        np.testing.assert_allclose(self.load("a.obj", text), 1e-3 * CORNERS)

    def test_ascii_ply(self):
        text = PLY_HEADER.format("ascii 1.0") + "".join(f"{x} {y} {z} 7\n" for x, y, z in CORNERS) + "3 0 1 2\n"
        np.testing.assert_allclose(self.load("a.ply", text), 1e-3 * CORNERS)

    def test_binary_ply_of_either_endianness(self):
        for kind, order in (("binary_little_endian 1.0", "<"), ("binary_big_endian 1.0", ">")):
            data = b"".join(struct.pack(order + "fffB", *corner, 7) for corner in CORNERS)
            np.testing.assert_allclose(self.load("a.ply", PLY_HEADER.format(kind).encode() + data), 1e-3 * CORNERS)

    def test_binary_and_ascii_stl_join_corners(self):
        triangle = CORNERS[:3]
        data = b"\0" * 80 + struct.pack("<I", 2) + 2 * (struct.pack("<3f", 0, 0, 1) + triangle.astype("<f4").tobytes() + b"\0\0")
        self.assertEqual(self.load("a.stl", data).shape, (3, 3))
        text = "solid\nfacet normal 0 0 1\nouter loop\n" + "".join(f"vertex {x} {y} {z}\n" for x, y, z in triangle)
        np.testing.assert_allclose(sorted(map(tuple, self.load("b.stl", text, 1.0))), sorted(map(tuple, triangle)))

    def test_bad_files_are_named(self):
        for name, content in (("a.obj", ""), ("a.obj", "v 1 2\nf 1 2 3\n"), ("a.ply", "no ply\n"), ("a.ply", "ply\nformat ascii 1.0\n"),
                              ("a.dae", "<x/>"), ("a.obj", "v nan 0 0\n"), ("b.ply", PLY_HEADER.format("binary_little_endian 1.0"))):
            with self.assertRaisesRegex(EvaluationError, name):
                self.load(name, content)
        with self.assertRaisesRegex(EvaluationError, "none.obj"):
            load_points(self.folder / "none.obj", 1.0)

    def test_evenly_chosen(self):
        points = np.arange(30.0).reshape(10, 3)
        self.assertEqual(len(evenly_chosen(points, 4)), 4)
        self.assertIs(evenly_chosen(points, 10), points)


if __name__ == "__main__":
    unittest.main()
