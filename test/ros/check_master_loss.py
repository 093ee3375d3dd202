#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Starts a master, a tracker and the program that kills the master and goes on.
usage: check_master_loss.py TRACKER_NODE TEST_PROGRAM MESH"""
import os
import socket
import subprocess
import sys
import time

PATIENCE_S = 60.0 * float(os.environ.get("TEST_SLOWNESS", "1"))


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


def wait_for_port(port):
    deadline = time.monotonic() + PATIENCE_S
    while time.monotonic() < deadline:
        with socket.socket() as probe:
            if probe.connect_ex(("localhost", port)) == 0:
                return
        time.sleep(0.05)
    sys.exit("the master does not start")


def main():
    tracker_node, program, mesh = sys.argv[1:]
    port = free_port()
    environment = dict(os.environ, ROS_MASTER_URI=f"http://localhost:{port}")
    master = subprocess.Popen(["rosmaster", "--core", "-p", str(port)], env=environment, stdout=subprocess.DEVNULL)
    tracker = None
    try:
        wait_for_port(port)
        tracker = subprocess.Popen([tracker_node, "__name:=tracker", "depth/image:=/camera/depth/image_raw", f"_mesh:={mesh}",
                                    "_tracker/num_particles:=40"], env=environment)
        status = subprocess.run([program], env=dict(environment, MASTER_PROCESS=str(master.pid)), timeout=5 * PATIENCE_S, check=False).returncode
        if tracker.poll() is not None:
            sys.exit(f"the tracker ended, with {tracker.returncode}")
        sys.exit(status)
    finally:
        for process in (tracker, master):
            if process and process.poll() is None:
                process.kill()
            if process:
                process.wait()


if __name__ == "__main__":
    main()
