# SPDX-License-Identifier: BSD-3-Clause
"""Object YAMLs, as the tracker reads them: name, mesh, mesh_scale, symmetries."""
import json
import pathlib

from . import EvaluationError

PACKAGE = "depth_object_tracker"


def find_package(name):
    """Folder of a ROS package; our own also without ROS's index."""
    try:
        import rospkg
        return pathlib.Path(rospkg.RosPack().get_path(name))
    except Exception as error:  # of several kinds, by what is installed
        own = pathlib.Path(__file__).resolve().parents[2]
        if name == PACKAGE and (own / "meshes").is_dir():
            return own
        raise EvaluationError(f"the package {name} is not found: source its workspace") from error


def read_object(path, folder):
    """(mesh, scale, models_info or None) of an object YAML or a mesh in metres; symmetries go into folder."""
    if not path.is_file():
        raise EvaluationError(f"there is no object {path}")
    if path.suffix not in (".yaml", ".yml"):
        return path, 1.0, None
    import yaml

    try:
        entry = yaml.safe_load(path.read_text(encoding="utf-8"))
        uri, scale, symmetries = str(entry["mesh"]), float(entry.get("mesh_scale", 1.0)), entry.get("symmetries") or {}
    except (yaml.YAMLError, KeyError, TypeError, ValueError, AttributeError) as error:
        raise EvaluationError(f"{path} is no object YAML (name, mesh, mesh_scale, symmetries): {error!r}") from error
    if uri.startswith("package://"):
        package, _, rest = uri[len("package://"):].partition("/")
        mesh = find_package(package) / rest
    else:
        mesh = path.parent / (uri[len("file://"):] if uri.startswith("file://") else uri)
    info = {"1": {"symmetries_continuous": symmetries.get("continuous", []), "symmetries_discrete": symmetries.get("discrete", [])}}
    models_info = folder / "models_info.json"
    models_info.write_text(json.dumps(info), encoding="utf-8")
    return mesh, scale, models_info
