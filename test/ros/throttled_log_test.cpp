// SPDX-License-Identifier: BSD-3-Clause
// What repeats itself is said once in a while, and what is new at once.
#include "depth_object_tracker/ros/throttled_log.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

namespace depth_object_tracker {
namespace {

/// All that is logged.
class Listener : public ros::console::LogAppender {
 public:
  Listener() { ros::console::register_appender(this); }
  ~Listener() override { ros::console::deregister_appender(this); }
  void log(ros::console::Level level, const char* text, const char*, const char*, int) override {
    if (level >= ros::console::levels::Warn) said.emplace_back(text);
  }
  std::vector<std::string> said;
};

TEST(ThrottledLog, SaysEachKindOnceInAWhile) {
  ThrottledLog log("/tracker");
  Listener listener;
  for (int i = 0; i < 100; ++i) log.warn("image " + std::to_string(i) + " refused: the lens is covered");
  log.warn("image 7 refused: no camera_info");
  log.error("initial pose refused");
  EXPECT_EQ(listener.said,
            (std::vector<std::string>{"/tracker: image 0 refused: the lens is covered",
                                      "/tracker: image 7 refused: no camera_info", "/tracker: initial pose refused"}));
  std::this_thread::sleep_for(ThrottledLog::kPeriod);
  log.warn("image 101 refused: the lens is covered");
  EXPECT_EQ(listener.said.size(), 4u) << "still so after a while: said again";
}

}  // namespace
}  // namespace depth_object_tracker
