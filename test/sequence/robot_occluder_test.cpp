// SPDX-License-Identifier: BSD-3-Clause
// The robot's own links as known occluders, placed by joints that are wrong by centimetres: never worse than without.
#include "occluder_trial.h"

#include <gtest/gtest.h>

#include <iostream>

namespace depth_object_tracker {
namespace {

TEST(RobotOccluder, LinksThatAreOffByCentimetresDoNotHarm) {
  for (OccluderTrial trial : {OccluderTrial{"mug.obj", Scenario::kSlip, 1, 90, {}},
                              {"bracket.obj", Scenario::kRobot, 1, 90, {}},
                              {"drill.obj", Scenario::kRobot, 2, 90, {}},
                              {"box.obj", Scenario::kRobot, 3, 90, {}}}) {
    const TrialErrors without = runTrial(trial);
    trial.link_error_camera_m = Eigen::Vector3d::Zero();
    const TrialErrors with = runTrial(trial);
    std::cout << trial.object << ": median and worst position error [mm] without " << 1e3 * without.median_m << ' '
              << 1e3 * without.worst_m << ", with the links " << 1e3 * with.median_m << ' ' << 1e3 * with.worst_m
              << '\n';
    EXPECT_LT(with.median_m, 1.15 * without.median_m + 0.00005);
    EXPECT_LT(with.worst_m, 1.5 * without.worst_m + 0.0005);
  }
}

}  // namespace
}  // namespace depth_object_tracker
