# SPDX-License-Identifier: BSD-3-Clause
"""Where the package's programs are, and a port for a roscore of one's own."""
import pathlib
import socket
import subprocess


def free_port():
    with socket.socket() as probe:
        probe.bind(("", 0))
        return probe.getsockname()[1]


def program_folder():
    """Not rosrun: it looks past a build folder inside of the source folder."""
    command = ["catkin_find", "--first-only", "--without-underlays", "--libexec", "depth_object_tracker"]
    return pathlib.Path(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout.strip())
