# SPDX-License-Identifier: BSD-3-Clause
"""What the figures were made with: commit, machine, configuration, command."""
import datetime
import os
import pathlib
import platform
import re
import shlex
import subprocess
import sys

import numpy


def _git(folder, *arguments):
    try:
        finished = subprocess.run(["git", "-C", str(folder), *arguments], capture_output=True, text=True, check=False)
    except OSError:
        return ""
    return finished.stdout.strip() if finished.returncode == 0 else ""


def commit(folder):
    """Commit of the source tree that holds the folder, "+" appended where tracked files differ; empty elsewhere."""
    name = _git(folder, "rev-parse", "--short=12", "HEAD")
    if not name:
        return ""
    return name + ("+" if _git(folder, "status", "--porcelain", "--untracked-files=no") else "")


def processor():
    try:
        found = re.search(r"model name\s*:\s*(.+)", pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8"))
    except OSError:
        found = None
    return found.group(1).strip() if found else platform.processor() or platform.machine()


def configuration(program, config):
    """Text of the file; without one the defaults, of which config/tracker.yaml tells (a test compares the two)."""
    if program is None:
        return "unknown: existing estimates"
    if config:
        return f"{config.name}\n{config.read_text(encoding='utf-8')}"
    # Where it is installed there may be none; the programs are then of the same version.
    defaults = pathlib.Path(__file__).resolve().parents[2] / "config/tracker.yaml"
    is_ours = program is not None and program.name in ("track_sequence", "track_bag")
    if not is_ours or not defaults.is_file():
        return "the program's defaults"
    return f"the program's defaults\n{defaults.read_text(encoding='utf-8')}"


def describe(source_folder, program, config, num_jobs):
    """Flat dictionary of strings."""
    return {
        "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
        "commit": commit(source_folder) or "unknown (not run from a source tree)",
        "command": " ".join(shlex.quote(argument) for argument in sys.argv),
        "program": str(program or "none: existing estimates"),
        "configuration": configuration(program, config),
        "processor": f"{processor()}, {os.cpu_count()} cores" + (
            f" ({num_jobs} runs at a time: times are not those of an idle machine)" if num_jobs > 1 else ""),
        "load": ", ".join(f"{x:.1f}" for x in os.getloadavg()) + " (1, 5 and 15 minutes) at the end",
        "system": f"{platform.system()} {platform.release()}, Python {platform.python_version()}, numpy {numpy.__version__}",
    }
