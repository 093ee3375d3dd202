// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/robot/joint_state_buffer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

namespace depth_object_tracker {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(JointStateBuffer, InterpolatesPositionsOfPartialReportsInAnyOrder) {
  JointStateBuffer buffer;
  EXPECT_EQ(buffer.add({10.00, {"b", "a"}, {2.0, 1.0}, {}}), "");
  EXPECT_EQ(buffer.add({10.04, {"c"}, {7.0}, {}}), "");  // another publisher
  EXPECT_EQ(buffer.add({10.10, {"a", "b"}, {3.0, 4.0}, {}}), "");
  EXPECT_NEAR(*buffer.position("a", 10.05), 2.0, 1e-12);
  EXPECT_NEAR(*buffer.position("b", 10.025), 2.5, 1e-12);
  EXPECT_NEAR(*buffer.position("c", 10.05), 7.0, 1e-12);
  EXPECT_FALSE(buffer.position("unheard of", 10.05));
}

TEST(JointStateBuffer, ALateReportIsPutInItsPlace) {
  JointStateBuffer buffer;
  buffer.add({10.0, {"a"}, {0.0}, {}});
  buffer.add({10.1, {"a"}, {1.0}, {}});
  buffer.add({10.05, {"a"}, {0.9}, {}});
  EXPECT_NEAR(*buffer.position("a", 10.025), 0.45, 1e-12);
  EXPECT_NEAR(*buffer.newestStamp("a"), 10.1, 1e-12);
}

TEST(JointStateBuffer, FollowsACurveByItsVelocities) {
  JointStateBuffer buffer;
  const auto angle = [](double t_s) { return std::sin(4.0 * t_s); };
  for (int k = 0; k <= 10; ++k) {
    const double t_s = 10.0 + 0.05 * k;
    buffer.add({t_s, {"a"}, {angle(t_s)}, {4.0 * std::cos(4.0 * t_s)}});
  }
  for (double t_s = 10.0; t_s < 10.5; t_s += 0.013) EXPECT_NEAR(*buffer.position("a", t_s), angle(t_s), 5e-6);
}

TEST(JointStateBuffer, StaleDataAreNoData) {
  JointStateBuffer buffer(0.1);
  buffer.add({10.0, {"a"}, {1.0}, {2.0}});
  EXPECT_NEAR(*buffer.position("a", 10.05), 1.1, 1e-12);  // goes on for a moment
  EXPECT_FALSE(buffer.position("a", 10.11));
  buffer.add({11.0, {"a"}, {5.0}, {}});
  EXPECT_FALSE(buffer.position("a", 10.5));  // a gap is not bridged
}

TEST(JointStateBuffer, BadNumbersAreLeftOutAndNamed) {
  JointStateBuffer buffer;
  const std::string problem = buffer.add({10.0, {"a", "b"}, {kNan, 2.0}, {}});
  EXPECT_NE(problem.find("'a'"), std::string::npos) << problem;
  EXPECT_EQ(problem.find("'b'"), std::string::npos) << problem;
  EXPECT_FALSE(buffer.position("a", 10.0));
  EXPECT_NEAR(*buffer.position("b", 10.0), 2.0, 1e-12);
  EXPECT_NE(buffer.add({10.0, {"a", "b"}, {1.0}, {}}), "");
  EXPECT_NE(buffer.add({kNan, {"a"}, {1.0}, {}}), "");
  EXPECT_NE(buffer.add({0.0, {"a"}, {1.0}, {}}), "");
  EXPECT_EQ(buffer.add({10.1, {}, {}, {}}), "");
}

TEST(JointStateBuffer, TimeThatJumpsBackStartsAnew) {
  JointStateBuffer buffer;
  buffer.add({100.0, {"a"}, {1.0}, {}});
  buffer.add({10.0, {"a"}, {2.0}, {}});
  EXPECT_NEAR(*buffer.position("a", 10.0), 2.0, 1e-12);
  EXPECT_FALSE(buffer.position("a", 100.0));
}

TEST(JointStateBuffer, ContinuousJointsTurnThroughTheirJump) {
  JointStateBuffer buffer(0.1, {"wheel"});
  buffer.add({10.0, {"wheel", "other"}, {3.1, 3.1}, {}});
  buffer.add({10.1, {"wheel", "other"}, {-3.1, -3.1}, {}});
  EXPECT_NEAR(std::cos(*buffer.position("wheel", 10.05)), -1.0, 1e-9);
  EXPECT_NEAR(std::cos(*buffer.position("other", 10.05)), 1.0, 1e-9);  // has a stop: it went all the way back
}

TEST(JointStateBuffer, IntegratesVelocitiesOverAnyInterval) {
  JointStateBuffer buffer;
  for (int k = 0; k <= 20; ++k) {
    const double t_s = 10.0 + 0.02 * k;
    buffer.add({t_s, {"a"}, {}, {3.0 * t_s}});
  }
  const auto integral = [](double from, double to) { return 1.5 * (to * to - from * from); };
  EXPECT_NEAR(*buffer.travel("a", 10.013, 10.333), integral(10.013, 10.333), 1e-9);
  EXPECT_NEAR(*buffer.travel("a", 10.021, 10.022), integral(10.021, 10.022), 1e-9);
  EXPECT_FALSE(buffer.travel("a", 10.3, 10.6));
  EXPECT_FALSE(buffer.position("a", 10.1));  // velocities alone say nothing of where it is
}

TEST(JointStateBuffer, ACommandHoldsUntilTheNext) {
  JointStateBuffer buffer(0.1);
  buffer.add({10.00, {"a"}, {}, {1.0}});
  buffer.add({10.05, {"a"}, {}, {-2.0}});
  EXPECT_NEAR(*buffer.commandedTravel("a", 10.01, 10.07), 0.04 * 1.0 - 0.02 * 2.0, 1e-12);
  EXPECT_FALSE(buffer.commandedTravel("a", 10.1, 10.2));  // no longer than max_age_s
}

}  // namespace
}  // namespace depth_object_tracker
