#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Simulated time that goes so many times slower than the clock on the wall. usage: slow_clock.py FACTOR"""
import time

import rospy
from rosgraph_msgs.msg import Clock

BEGIN_S = 1000.0


def main():
    rospy.init_node("slow_clock", disable_rostime=True)
    factor = float(rospy.myargv()[1])
    clock = rospy.Publisher("/clock", Clock, queue_size=1)
    begin = time.monotonic()
    while not rospy.is_shutdown():
        clock.publish(Clock(rospy.Time.from_sec(BEGIN_S + (time.monotonic() - begin) / factor)))
        time.sleep(0.005)


if __name__ == "__main__":
    main()
