// SPDX-License-Identifier: BSD-3-Clause
// /diagnostics of a running nodelet, and the log that goes with a mistake in the set-up.
#include <gtest/gtest.h>

#include "rostest_main.h"
#include "tracker_harness.h"

#include <diagnostic_msgs/DiagnosticArray.h>

namespace depth_object_tracker {
namespace {

const char* const kName = "/tracker_diagnostics";

/// The newest diagnostics of one task.
class DiagnosticsReader {
 public:
  explicit DiagnosticsReader(ros::NodeHandle node) : recorder_(node, "/diagnostics") {}

  std::optional<diagnostic_msgs::DiagnosticStatus> newest(const std::string& task) const {
    std::optional<diagnostic_msgs::DiagnosticStatus> found;
    for (const auto& message : recorder_.messages()) {
      for (const auto& status : message->status) {
        if (status.name == "tracker_diagnostics: " + task) found = status;
      }
    }
    return found;
  }

  bool waitFor(const std::string& task, int level, const std::string& part, const std::function<void()>& meanwhile) {
    return waitUntil([&] {
      meanwhile();
      const auto status = newest(task);
      return status && static_cast<int>(status->level) == level && status->message.find(part) != std::string::npos;
    });
  }

 private:
  Recorder<diagnostic_msgs::DiagnosticArray> recorder_;
};

TEST(TrackerDiagnosticsTopic, FollowsWhatHappens) {
  using Level = diagnostic_msgs::DiagnosticStatus;
  setGoodParameters(kName);
  DiagnosticsReader diagnostics{ros::NodeHandle()};
  TrackerHarness tracker(kName);
  ASSERT_TRUE(tracker.isReady());
  const auto step = [&] { tracker.step(); };

  EXPECT_TRUE(diagnostics.waitFor("tracking", Level::WARN, "UNINITIALIZED: no initial pose", [] {}));
  ASSERT_TRUE(tracker.initialise());
  EXPECT_TRUE(diagnostics.waitFor("tracking", Level::OK, "TRACKING", step));
  EXPECT_TRUE(diagnostics.waitFor("self-check", Level::OK, "nothing suspicious", step));
  EXPECT_TRUE(diagnostics.waitFor("load", Level::OK, "ms a frame", step));
  // The stamps of this test are made up, far in the past.
  EXPECT_TRUE(diagnostics.waitFor("input", Level::WARN, "behind the clock", step));
  EXPECT_TRUE(tracker.waitForLog({"behind the clock", "use_sim_time"}));
  EXPECT_TRUE(waitUntil([&] {
    tracker.step();
    return tracker.hasLogged({"tf knows no parent", "camera_depth_optical_frame"});
  }));
  EXPECT_TRUE(diagnostics.waitFor("input", Level::ERROR, "no image for", [] {}));

  EXPECT_TRUE(tracker.waitForLog({"depth images there are", "/camera/depth/image_raw"}));

  PinholeCamera other = testCamera();
  other.cx += 60.0;
  tracker.setStamp(tracker.stamp() + ros::Duration(0.1));
  tracker.send(tracker.goodImage(), makeCameraInfo(other));
  EXPECT_TRUE(tracker.waitForLog({"/camera/depth/camera_info", "principal point", "middle"}));
  EXPECT_TRUE(diagnostics.waitFor("self-check", Level::WARN, "principal point", [] {}));
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "tracker_diagnostics_rostest");
}
