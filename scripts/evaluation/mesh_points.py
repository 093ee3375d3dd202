# SPDX-License-Identifier: BSD-3-Clause
"""Vertices of OBJ, PLY and STL meshes, for distances between model points."""
import numpy as np

from . import EvaluationError

PLY_TYPES = {"char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
             "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
             "double": "f8", "float64": "f8"}


def _read_obj(path):
    """Vertices that faces use (all where there is no face)."""
    vertices, used = [], set()
    with open(path, encoding="utf-8", errors="replace") as file:
        for line in file:
            if line.startswith("v "):
                vertices.append([float(x) for x in line.split()[1:4]])
            elif line.startswith("f "):
                for corner in line.split()[1:]:
                    index = int(corner.split("/")[0])
                    used.add(index - 1 if index > 0 else len(vertices) + index)
    return np.array(vertices, float)[sorted(used)] if used else np.array(vertices, float)


def _ply_header(file, path):
    """(format, [(element, count, [property words])]); the file stands at the first data byte afterwards."""
    if file.readline().strip() != b"ply":
        raise EvaluationError(f"{path} does not start with the line \"ply\"")
    kind, elements = None, []
    while True:
        line = file.readline()
        if not line:
            raise EvaluationError(f"{path} ends within its header")
        words = line.decode("ascii", "replace").split()
        if words[:1] == ["format"]:
            kind = words[1]
        elif words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"]:
            elements[-1][2].append(words[1:])
        elif words[:1] == ["end_header"]:
            return kind, elements


def _read_ply(path):
    with open(path, "rb") as file:
        kind, elements = _ply_header(file, path)
        name, count, properties = elements[0]
        if name != "vertex":
            raise EvaluationError(f"{path}: the first element is {name}, not vertex")
        names = [words[-1] for words in properties]
        if kind == "ascii":
            rows = [file.readline().split() for _ in range(count)]
            return np.array([[float(row[names.index(axis)]) for axis in "xyz"] for row in rows])
        order = ">" if kind == "binary_big_endian" else "<"
        row = np.dtype([(words[-1], order + PLY_TYPES[words[0]]) for words in properties])
        data = np.frombuffer(file.read(count * row.itemsize), row, count)
        return np.stack([data[axis].astype(float) for axis in "xyz"], axis=1)


def _read_stl(path):
    content = path.read_bytes()
    count = int.from_bytes(content[80:84], "little") if len(content) >= 84 else 0
    if len(content) == 84 + 50 * count:
        triangles = np.frombuffer(content[84:], np.dtype([("v", "<f4", 12), ("attribute", "<u2")]), count)
        corners = triangles["v"][:, 3:].reshape(-1, 3).astype(float)
    else:
        corners = np.array([line.split()[1:4] for line in content.decode("ascii", "replace").splitlines()
                            if line.strip().startswith("vertex")], float)
    return np.unique(corners, axis=0)


READERS = {".obj": _read_obj, ".ply": _read_ply, ".stl": _read_stl}


def load_points(path, scale):
    """Vertices (n x 3) in metres. scale: metres per unit of the file."""
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise EvaluationError(f"{path}: evaluate reads vertices of .obj, .ply and .stl files; convert the mesh")
    try:
        points = reader(path)
    except OSError as error:
        raise EvaluationError(f"cannot read the mesh {path}: {error.strerror}") from error
    except (ValueError, IndexError, KeyError) as error:
        raise EvaluationError(f"{path} is not a usable mesh: {error!r}") from error
    if points.ndim != 2 or points.shape[0] == 0 or points.shape[1] != 3 or not np.all(np.isfinite(points)):
        raise EvaluationError(f"{path} has no usable vertices")
    return scale * points


def evenly_chosen(points, count):
    """At most `count` points, evenly spread over their order."""
    if len(points) <= count:
        return points
    return points[np.arange(count) * len(points) // count]
