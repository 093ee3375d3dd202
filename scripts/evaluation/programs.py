# SPDX-License-Identifier: BSD-3-Clause
"""Where the tracker programs are."""
import os
import pathlib
import shutil
import sys

from . import EvaluationError

PEERS = {"icp": "track_icp", "pcl": "track_pcl"}


def find_program(name, source_folder):
    """Beside the command as it was called or installed, in build/ of the source tree, in the sourced catkin workspaces, on the PATH."""
    workspaces = [pathlib.Path(prefix) for prefix in os.environ.get("CMAKE_PREFIX_PATH", "").split(":") if prefix]
    candidates = [pathlib.Path(sys.argv[0]).absolute().parent / name, source_folder / name]
    candidates += [source_folder.parent / "build" / place / name for place in ("", "devel/lib/depth_object_tracker")]
    candidates += [prefix / "lib/depth_object_tracker" / name for prefix in workspaces]
    candidates += [pathlib.Path(found) for found in [shutil.which(name)] if found]
    for candidate in candidates:
        if candidate.is_file() and os.access(candidate, os.X_OK):
            return candidate.resolve()
    hint = " (it needs PCL, libpcl-dev, when building)" if name in PEERS.values() else ""
    raise EvaluationError(f"no program {name} found; build it{hint}, or name it with --program")


def check_program(path):
    if not path.is_file() or not os.access(path, os.X_OK):
        raise EvaluationError(f"{path} is no program (--program)")
    return path.resolve()
