#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A tracker that was started outside of this process loads its object, answers its services and sees images."""
import os
import sys
import threading
import unittest

import rospy
import rostest
from depth_object_tracker.msg import TrackerStatus
from depth_object_tracker.srv import InitializeTracker
from sensor_msgs.msg import CameraInfo, Image
from std_srvs.srv import SetBool, Trigger

PATIENCE_S = 60.0 * float(os.environ.get("TEST_SLOWNESS", "1"))


class TrackerRuns(unittest.TestCase):
    def setUp(self):
        self.newest = None
        self.came = threading.Condition()
        self.subscriber = rospy.Subscriber("/tracker/status", TrackerStatus, self.on_status)

    def on_status(self, status):
        with self.came:
            self.newest = status
            self.came.notify_all()

    def wait_for_status(self, predicate):
        with self.came:
            self.assertTrue(self.came.wait_for(lambda: self.newest and predicate(self.newest), PATIENCE_S), self.newest)
            return self.newest

    def test_object_is_loaded_and_services_answer(self):
        status = self.wait_for_status(lambda s: True)
        self.assertEqual(status.object_name, sys.argv[1])
        self.assertEqual(status.state, TrackerStatus.UNINITIALIZED)
        for name, service, request in (("reset", Trigger, ()), ("pause", SetBool, (False,))):
            rospy.wait_for_service("/tracker/" + name, PATIENCE_S)
            self.assertTrue(rospy.ServiceProxy("/tracker/" + name, service)(*request).success)
        response = rospy.ServiceProxy("/tracker/initialize", InitializeTracker)()
        self.assertFalse(response.success)
        self.assertIn("quaternion", response.message)

    def test_images_arrive_over_the_network(self):
        images = rospy.Publisher("/camera/depth/image_raw", Image, queue_size=1)
        infos = rospy.Publisher("/camera/depth/camera_info", CameraInfo, queue_size=1)
        image = Image(width=64, height=48, encoding="16UC1", step=128, data=bytes([0, 4]) * (64 * 48))
        info = CameraInfo(width=64, height=48, K=[60.0, 0, 31.5, 0, 60.0, 23.5, 0, 0, 1])
        image.header.frame_id = info.header.frame_id = "optical"
        rate = rospy.Rate(20)
        for number in range(int(20 * PATIENCE_S)):
            image.header.stamp = info.header.stamp = rospy.Time(100 + 0.05 * number)
            images.publish(image)
            infos.publish(info)
            rate.sleep()
            if self.newest and self.newest.frames_processed > 3:
                break
        status = self.wait_for_status(lambda s: s.frames_processed > 3)
        self.assertEqual(status.header.frame_id, "optical")
        self.assertIn("initial pose", status.reason)


if __name__ == "__main__":
    rospy.init_node("check_tracker_runs")
    rostest.rosrun("depth_object_tracker", "check_tracker_runs", TrackerRuns, sys.argv)
