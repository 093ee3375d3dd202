#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Every argument of every launch file is documented: for `roslaunch --ros-args`, and in the README's table.

Usage: check_launch_files.py LAUNCH_FOLDER README
Needs a sourced devel or install space.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import yaml

LEAST_WORDS = 1


def arguments_of(launch):
    """Those that a user may set: others have a value."""
    root = ElementTree.parse(str(launch)).getroot()
    return [element for element in root.findall("arg") if "value" not in element.attrib]


def readme_rows(readme):
    """Text of the README's table row of each launch file."""
    rows = {}
    for line in readme.read_text(encoding="utf-8").splitlines():
        match = re.match(r"\| `(\w+\.launch)` \| (.*) \|$", line)
        if match:
            rows[match.group(1)] = match.group(2)
    return rows


def check_ros_args(launch, names):
    answer = subprocess.run(["roslaunch", "--ros-args", str(launch)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            text=True, check=False, timeout=60)
    text = answer.stdout
    if answer.returncode != 0:
        yield f"roslaunch --ros-args fails: {text}"
    if "undocumented" in text.lower() or "warning" in text.lower():
        yield f"roslaunch --ros-args complains: {text}"
    for name in names:
        if not re.search(rf"^\s*{re.escape(name)}\b", text, re.MULTILINE):
            yield f"roslaunch --ros-args does not list '{name}': {text}"


def check_relative_paths(launch, names):
    """A path that is given as a name means the file where roslaunch was called."""
    given = [f"{name}:=here.yaml" for name in names if name in ("object", "objects", "bag")]
    given += ["device:=here.oni"] if "device" in names else []
    with tempfile.TemporaryDirectory() as folder:
        answer = subprocess.run(["roslaunch", "--dump-params", str(launch), *given], cwd=folder,
                                env={**os.environ, "PWD": folder}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                text=True, check=False, timeout=60)
        readers = re.findall(rf"^(\S+)/paths_from: {re.escape(folder)}$", answer.stdout, re.MULTILINE)
        if len(readers) != (2 if "device" in names else 1):  # the camera reads paths, too
            yield f"relative paths are not meant from the working folder: {answer.stdout}"


def problems_of(launch, rows):
    arguments = arguments_of(launch)
    names = [argument.attrib["name"] for argument in arguments]
    for argument in arguments:
        if len(argument.attrib.get("doc", "").split()) < LEAST_WORDS:
            yield f"argument '{argument.attrib['name']}' has no doc"
    if not launch.read_text(encoding="utf-8").lstrip().startswith("<!--"):
        yield "does not begin with a comment that says what it does"
    yield from check_ros_args(launch, names)
    yield from check_relative_paths(launch, names)
    row = rows.get(launch.name)
    if row is None:
        yield "has no row in the README's table of launch files"
        return
    described = set(re.findall(r"\b(\w+):=", row))
    if described != set(names):
        yield f"the README lacks {sorted(set(names) - described)} and has {sorted(described - set(names))} too many"


def check_views(folder):
    """The demo's rviz and that of own cameras differ in where they look from, and in nothing else."""
    lines = [(folder / name).read_text(encoding="utf-8").splitlines() for name in ("tracker.rviz", "camera.rviz")]
    differing = {pair[0].split(":")[0].strip() for pair in zip(*lines) if pair[0] != pair[1]}
    if len(lines[0]) != len(lines[1]) or differing != {"Fixed Frame", "Focal Point", "Pitch", "Yaw"}:
        yield f"rviz/tracker.rviz and rviz/camera.rviz differ in more than their view: {sorted(differing)}"


def check_rviz_names(folder):
    """What rviz listens to goes by the names that a launch file was given; its configuration has the default ones."""
    configuration = yaml.safe_load((folder / "rviz/camera.rviz").read_text(encoding="utf-8"))
    topics = {value for display in configuration["Visualization Manager"]["Displays"]
              for key, value in display.items() if key.endswith("Topic")}
    camera = {"/camera/depth/image_raw", "/camera/depth/camera_info"}
    for name, wanted in (("track", topics - {"/ground_truth_marker/marker"} | camera | {"/tracker/status"}),
                         ("track_many", camera | {"/tracker/marker"}), ("replay", camera)):
        root = ElementTree.parse(str(folder / f"launch/{name}.launch")).getroot()
        rviz = next(node for node in root.findall("node") if node.attrib["type"] == "rviz")
        remapped = {remap.attrib["from"]: remap.attrib["to"] for remap in rviz.findall("remap")}
        for topic in sorted(wanted):
            if "$(" not in remapped.get(topic, ""):
                yield f"{name}.launch: rviz would listen to {topic}, whatever the tracker's and the camera's names"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    launch_files = sorted(pathlib.Path(sys.argv[1]).resolve().glob("*.launch"))
    rows = readme_rows(pathlib.Path(sys.argv[2]))
    problems = [f"{launch.name}: {problem}" for launch in launch_files for problem in problems_of(launch, rows)]
    problems += check_views(pathlib.Path(sys.argv[1]).resolve().parent / "rviz")
    problems += check_rviz_names(pathlib.Path(sys.argv[1]).resolve().parent)
    problems += [f"README: there is no {name}" for name in rows if name not in {launch.name for launch in launch_files}]
    for problem in problems:
        print(problem)
    print(f"{len(launch_files)} launch files, {len(problems)} problems")
    sys.exit(1 if problems or not launch_files else 0)


if __name__ == "__main__":
    main()
