#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""relay_joint_commands gives a controller's numbers their names and stamps, and leaves out what does not fit."""
import os
import sys
import threading
import unittest

import rospy
import rostest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

PATIENCE_S = 60.0 * float(os.environ.get("TEST_SLOWNESS", "1"))


class Relay(unittest.TestCase):
    def setUp(self):
        self.heard = []
        self.came = threading.Condition()
        self.subscriber = rospy.Subscriber("/joint_commands", JointState, self.on_command)
        self.publisher = rospy.Publisher("/arm_controller/command", Float64MultiArray, queue_size=10)
        deadline = rospy.Time.now() + rospy.Duration(PATIENCE_S)
        while not (self.publisher.get_num_connections() and self.subscriber.get_num_connections()):
            self.assertLess(rospy.Time.now(), deadline, "the relay does not come up")
            rospy.sleep(0.05)

    def on_command(self, message):
        with self.came:
            self.heard.append(message)
            self.came.notify_all()

    def test_names_and_stamps(self):
        before = rospy.Time.now()
        self.publisher.publish(Float64MultiArray(data=[0.1]))  # one joint of three: left out
        self.publisher.publish(Float64MultiArray(data=[0.1, -0.2, 0.3]))
        with self.came:
            self.assertTrue(self.came.wait_for(lambda: self.heard, PATIENCE_S))
            message = self.heard[0]
        self.assertEqual(message.name, ["joint_1", "joint_2", "joint_3"])
        self.assertEqual(list(message.velocity), [0.1, -0.2, 0.3])
        self.assertEqual(len(message.position), 0)
        self.assertGreaterEqual(message.header.stamp, before)
        self.assertLessEqual(message.header.stamp, rospy.Time.now())


if __name__ == "__main__":
    rospy.init_node("relay_joint_commands_rostest")
    rostest.rosrun("depth_object_tracker", "relay_joint_commands_rostest", Relay, sys.argv)
