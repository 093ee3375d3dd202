// SPDX-License-Identifier: BSD-3-Clause
// Images come at 60 Hz, faster than the tracker can use them: it drops what is old, and its queue never grows.
#include <gtest/gtest.h>

#include "rostest_main.h"
#include "tracker_harness.h"

#include <algorithm>
#include <cstdio>

namespace depth_object_tracker {
namespace {

const char* const kName = "/tracker_overload";
constexpr int kImages = 240;
constexpr double kRateHz = 60.0;

class Overload : public testing::Test {
 protected:
  Overload()
      : images_(node_.advertise<sensor_msgs::Image>("/camera/depth/image_raw", 2)),
        infos_(node_.advertise<sensor_msgs::CameraInfo>("/camera/depth/camera_info", 2)),
        loader_(false),
        statuses_(node_, std::string(kName) + "/status") {
    setGoodParameters(kName);
    ros::param::set(std::string(kName) + "/tracker/num_particles", 3000);
    ros::param::set(std::string(kName) + "/tracker/target_model_pixels", 6000);
    ros::param::set(std::string(kName) + "/tracker/frame_budget_s", 0.0);  // it would make frames quick enough
    const nodelet::M_string remappings{{ros::names::resolve("depth/image"), "/camera/depth/image_raw"}};
    is_loaded_ = loader_.load(kName, "depth_object_tracker/Tracker", remappings, {}) &&
                 waitUntil([&] { return images_.getNumSubscribers() > 0 && infos_.getNumSubscribers() > 0; }) &&
                 waitUntil([&] { return statuses_.size() > 0; });
  }
  ~Overload() override { loader_.unload(kName); }

  bool initialise() {
    InitializeTracker call;
    call.request.pose.header.frame_id = "camera_depth_optical_frame";
    call.request.pose.pose.pose = toPoseMessage(testPose());
    return ros::service::call(std::string(kName) + "/initialize", call) && call.response.success;
  }

  ros::Time stampOf(int image) const { return ros::Time(1000.0 + image / kRateHz); }

  void publish(int image) {
    const auto message = boost::make_shared<sensor_msgs::Image>(*picture_);
    const auto info = makeCameraInfo(testCamera());
    message->header.stamp = info->header.stamp = stampOf(image);
    infos_.publish(info);
    images_.publish(sensor_msgs::ImageConstPtr(message));
  }

  ros::NodeHandle node_;
  ros::Publisher images_, infos_;
  nodelet::Loader loader_;
  Recorder<TrackerStatus> statuses_;
  TestScene scene_;
  sensor_msgs::ImagePtr picture_ = makeUint16Image(scene_.depth(testPose()), testCamera().width, testCamera().height);
  bool is_loaded_ = false;
};

TEST_F(Overload, DropsOldImagesAndNeverQueues) {
  ASSERT_TRUE(is_loaded_);
  ASSERT_TRUE(initialise());
  ros::WallRate rate(kRateHz);
  for (int image = 0; image < kImages; ++image) {
    publish(image);
    rate.sleep();
  }
  // The newest wins: the last image is used, whatever was dropped before it.
  ASSERT_TRUE(waitUntil([&] { return statuses_.newest()->header.stamp == stampOf(kImages - 1); }));

  std::vector<float> latencies;
  ros::Time last_stamp;
  float last_frame_time_s = 0.0f;
  for (const auto& status : statuses_.messages()) {
    if (status->header.stamp.isZero() || status->header.stamp == last_stamp) continue;
    EXPECT_GT(status->header.stamp, last_stamp);
    // At most the one image that waits for its turn is neither used nor dropped.
    EXPECT_LE(status->frames_received, status->frames_processed + status->frames_dropped + 1);
    latencies.push_back(status->latency_s);
    // An image waits for the one in work, no longer: latency is bounded by two frames. The rest is other programs'
    // time.
    EXPECT_LE(status->latency_s, last_frame_time_s + status->frame_time_s + 1.0f);
    last_stamp = status->header.stamp;
    last_frame_time_s = status->frame_time_s;
  }
  const TrackerStatus last = *statuses_.newest();
  EXPECT_LE(last.frames_received, static_cast<std::uint64_t>(kImages));  // roscpp itself keeps one image, the newest
  EXPECT_EQ(last.frames_processed + last.frames_dropped, last.frames_received);
  EXPECT_GT(last.frames_dropped, 0u) << "not overloaded: this test shows nothing";
  EXPECT_EQ(static_cast<int>(last.state), static_cast<int>(TrackerStatus::TRACKING)) << last.reason;
  std::sort(latencies.begin(), latencies.end());
  std::printf("%d images at 60 Hz: %lu used, %lu dropped; latency [ms]: median %.1f, most %.1f; frame %.1f ms\n",
              kImages, static_cast<unsigned long>(last.frames_processed),
              static_cast<unsigned long>(last.frames_dropped), 1e3 * latencies[latencies.size() / 2],
              1e3 * latencies.back(), 1e3 * last_frame_time_s);
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "tracker_overload_rostest");
}
