// SPDX-License-Identifier: BSD-3-Clause
// Camera nodelet and tracker nodelet, both through pluginlib in one process: the likelihood reads the camera's own
// buffers.
#include <gtest/gtest.h>

#include "rostest_main.h"
#include "tracker_harness.h"

#include <std_msgs/UInt64.h>

namespace depth_object_tracker {
namespace {

TEST(ZeroCopy, TheLikelihoodReadsWhatTheCameraNodeletPublished) {
  const std::string object = std::string(PROJECT_SOURCE_FOLDER) + "/test/ros/bracket_object.yaml";
  ros::param::set("/simulator/object_file", object);
  ros::param::set("/tracker/object_file", object);
  ros::param::set("/tracker/tracker/num_particles", 30);
  ros::param::set("/tracker/publish_debug", true);

  ros::NodeHandle node;
  Recorder<std_msgs::UInt64> addresses(node, "/tracker/debug/last_image_address");
  // In the publisher's process a subscriber gets the publisher's pointer. Keeping them all, no address is ever used
  // twice.
  Recorder<sensor_msgs::Image> images(node, "/camera/depth/image_raw");
  nodelet::Loader loader(false);
  ASSERT_TRUE(
      loader.load("/tracker", "depth_object_tracker/Tracker", {{"/depth/image", "/camera/depth/image_raw"}}, {}));
  ASSERT_TRUE(loader.load("/simulator", "depth_object_tracker/Simulator",
                          {{"/simulator/initial_pose", "/tracker/initial_pose"}}, {}));
  ASSERT_TRUE(waitUntil([&] { return addresses.size() >= 10; }));

  const auto wasPublishedAt = [&](std::uint64_t address) {
    for (const auto& image : images.messages()) {
      if (reinterpret_cast<std::uintptr_t>(image->data.data()) == address) return true;
    }
    return false;
  };
  // The recorder may have joined after the tracker: what was read last was certainly published to both.
  const auto read = addresses.messages();
  for (std::size_t i = read.size() - 5; i < read.size(); ++i) {
    const std::uint64_t address = read[i]->data;
    EXPECT_TRUE(waitUntil([&] { return wasPublishedAt(address); }, 10.0 * kSlowness))
        << "image " << i << " was read at " << address << ", where none was published";
  }
  loader.unload("/simulator");
  loader.unload("/tracker");
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "zero_copy_rostest");
}
