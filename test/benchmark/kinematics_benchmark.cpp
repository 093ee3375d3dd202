// SPDX-License-Identifier: BSD-3-Clause
// Program: what following a robot costs. Joint states and commands of a 7-DoF arm at 250 Hz, the hand's motion after
// each of them, and once per image (30 Hz) the motion of what it holds.
#include "depth_object_tracker/robot/hand_motion.h"
#include "depth_object_tracker/robot/robot_state.h"

#include <cmath>
#include <ctime>
#include <iostream>

namespace {

using namespace depth_object_tracker;

constexpr double kJointRateHz = 250.0;
constexpr double kImageRateHz = 30.0;
constexpr double kDurationS = 120.0;
constexpr int kJoints = 7;

JointReport reportAt(double t_s, bool with_positions) {
  JointReport report;
  report.stamp_s = t_s;
  for (int joint = 1; joint <= kJoints; ++joint) {
    const double rate = 1.0 + 0.2 * joint;
    report.names.push_back("joint_" + std::to_string(joint));
    if (with_positions) report.positions.push_back(0.2 * joint + 0.3 * std::sin(rate * t_s));
    report.velocities.push_back(0.3 * rate * std::cos(rate * t_s));
  }
  return report;
}

}  // namespace

int main() {
  try {
    RobotState state(RobotModel::fromFile(std::string(PROJECT_SOURCE_FOLDER) + "/config/robots/arm.urdf"), {});
    const int num_reports = static_cast<int>(kDurationS * kJointRateHz);
    double moved_m = 0.0, next_image_s = 1.0;
    const std::clock_t begin = std::clock();
    for (int k = 0; k < num_reports; ++k) {
      const double t_s = k / kJointRateHz;
      state.addJointStates(reportAt(t_s, true));
      state.addCommands(reportAt(t_s, false));
      if (k == 0) continue;
      const LinkMotion motion = state.linkMotion("hand_link", t_s - 1.0 / kJointRateHz, t_s);
      moved_m += (motion.T_root_link_to.translation() - motion.T_root_link_from.translation()).norm();
      if (t_s < next_image_s) continue;
      const LinkMotion held = state.linkMotion("hand_link", next_image_s - 1.0 / kImageRateHz, next_image_s);
      moved_m +=
          1e-9 * carryWithHand(held.T_root_link_from, held.T_root_link_to, held.T_root_link_from, 1.0 / kImageRateHz)
                     .linear_m_s.norm();
      next_image_s += 1.0 / kImageRateHz;
    }
    const double cpu_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    std::cout << "kinematics of " << kJoints << " joints at " << kJointRateHz << " Hz: " << 1e6 * cpu_s / num_reports
              << " us per report, " << 100.0 * cpu_s / kDurationS << " % of a core (the hand went " << moved_m
              << " m)\n";
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
