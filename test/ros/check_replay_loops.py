#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Watches the tracker while a bag loops and is paused: it must go on, with small errors, whatever time does."""
import os
import sys
import threading
import time
import unittest

import numpy
import rosservice
import rospy
import rostest
from depth_object_tracker.msg import TrackerStatus
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from std_srvs.srv import SetBool

PATIENCE_S = 120.0 * float(os.environ.get("TEST_SLOWNESS", "1"))  # wall clock: simulated time stands still now and then
MAX_MEDIAN_M = 0.005


def position(pose):
    return numpy.array([pose.position.x, pose.position.y, pose.position.z])


class ReplayLoops(unittest.TestCase):
    def setUp(self):
        self.lock = threading.Lock()
        self.truth = {}  # by stamp; the same in every loop
        self.loops = [[]]  # stamps and estimates of each round
        self.status = None
        rospy.Subscriber("/ground_truth/pose", PoseStamped, self.on_truth)
        rospy.Subscriber("/tracker/pose", PoseWithCovarianceStamped, self.on_pose)
        rospy.Subscriber("/tracker/status", TrackerStatus, self.on_status)

    def on_truth(self, message):
        with self.lock:
            self.truth[message.header.stamp.to_nsec()] = position(message.pose)

    def on_pose(self, message):
        stamp = message.header.stamp.to_nsec()
        with self.lock:
            if self.loops[-1] and stamp < self.loops[-1][-1][0]:
                self.loops.append([])
            self.loops[-1].append((stamp, position(message.pose.pose)))

    def on_status(self, message):
        self.status = message

    def count(self):
        with self.lock:
            return sum(len(loop) for loop in self.loops)

    def wait_for(self, what, condition):
        end = time.monotonic() + PATIENCE_S
        while not condition():
            self.assertLess(time.monotonic(), end, f"waited in vain for {what}; last status: {self.status}")
            time.sleep(0.05)

    def pause(self, is_paused):
        name = next(name for name in rosservice.get_service_list() if name.endswith("/pause_playback"))
        self.assertTrue(rospy.ServiceProxy(name, SetBool)(is_paused).success)

    def check_errors(self):
        with self.lock:
            for loop in self.loops[1:-1]:
                errors = [numpy.linalg.norm(estimate - self.truth[stamp]) for stamp, estimate in loop if stamp in self.truth]
                self.assertGreater(len(errors), 10)
                self.assertLess(numpy.median(errors), MAX_MEDIAN_M)

    def test_loops_and_pauses(self):
        self.wait_for("estimates", lambda: self.count() > 5)
        self.pause(True)
        self.wait_for("a status that says so", lambda: self.status.reason.startswith("no image on"))
        before = self.count()
        time.sleep(1.5)
        self.assertLessEqual(self.count(), before)
        self.pause(False)
        self.wait_for("estimates after the pause", lambda: self.count() > before + 5)
        self.wait_for("three times from the start", lambda: len(self.loops) >= 4)
        self.check_errors()


if __name__ == "__main__":
    rospy.init_node("check_replay_loops")
    rostest.rosrun("depth_object_tracker", "replay_loop_rostest", ReplayLoops, sys.argv)
