// SPDX-License-Identifier: BSD-3-Clause
// What a running tracker publishes: contents, stamps, zero copy, and nothing costly that nobody asked for.
#include <gtest/gtest.h>

#include <vector>

#include "rostest_main.h"
#include "tracker_harness.h"

#include "depth_object_tracker/ros/result_publisher.h"

#include <depth_object_tracker/ParticleCloud.h>
#include <geometry_msgs/PoseArray.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/UInt64.h>
#include <std_srvs/Trigger.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include <numeric>

namespace depth_object_tracker {
namespace {

const std::string kName = "/tracker_outputs";

class Outputs : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    setGoodParameters(kName);
    ros::param::set(kName + "/publish_debug", true);
    harness_ = new TrackerHarness(kName);
  }
  static void TearDownTestSuite() {
    delete harness_;
    harness_ = nullptr;
  }
  void SetUp() override {
    ASSERT_TRUE(harness_->isReady());
    ASSERT_TRUE(tracker().initialise());
    tracker().expectTracking();
  }
  static TrackerHarness& tracker() { return *harness_; }

  /// Listens to an output and steps until it comes with the stamp of the image.
  template <typename Message>
  boost::shared_ptr<const Message> take(const std::string& topic) {
    Recorder<Message> recorder(node_, kName + "/" + topic);
    const bool came = waitUntil([&] {
      tracker().step();
      return waitUntil([&] { return recorder.size() > 0; }, 0.5);
    });
    EXPECT_TRUE(came) << topic;
    return recorder.newest();
  }

  ros::NodeHandle node_;
  static TrackerHarness* harness_;
};
TrackerHarness* Outputs::harness_ = nullptr;

TEST_F(Outputs, TheLikelihoodReadsTheBufferThatTheCameraPublished) {
  Recorder<std_msgs::UInt64> addresses(node_, kName + "/debug/last_image_address");
  const auto image = tracker().goodImage();
  const std::uint8_t* published = image->data.data();
  tracker().setStamp(tracker().stamp() + ros::Duration(1.0 / 30.0));
  tracker().send(image);  // through image_transport
  EXPECT_TRUE(waitUntil([&] {
    return addresses.newest() && addresses.newest()->data == reinterpret_cast<std::uintptr_t>(published);
  })) << "read at "
      << (addresses.newest() ? addresses.newest()->data : 0) << ", published at "
      << reinterpret_cast<std::uintptr_t>(published);
}

TEST_F(Outputs, PlainPublishersAreReadInPlaceToo) {
  Recorder<std_msgs::UInt64> addresses(node_, kName + "/debug/last_image_address");
  ros::Publisher publisher = node_.advertise<sensor_msgs::Image>("/camera/depth/image_raw", 1);
  ASSERT_TRUE(waitUntil([&] { return publisher.getNumSubscribers() > 0; }));
  // Without camera_info of its own an image goes out with the next one's arrival, and one may be overtaken on its way.
  std::vector<sensor_msgs::ImagePtr> sent;
  EXPECT_TRUE(waitUntil([&] {
    tracker().setStamp(tracker().stamp() + ros::Duration(1.0 / 30.0));
    sent.push_back(tracker().goodImage());
    sent.back()->header.stamp = tracker().stamp();
    publisher.publish(sensor_msgs::ImageConstPtr(sent.back()));
    for (const auto& address : addresses.messages()) {
      for (const auto& image : sent) {
        if (address->data == reinterpret_cast<std::uintptr_t>(image->data.data())) return true;
      }
    }
    return false;
  }));
}

TEST_F(Outputs, PoseTwistAndTfCarryTheStampAndFrameOfTheImage) {
  Recorder<tf2_msgs::TFMessage> transforms(node_, "/tf");
  const auto twist = take<geometry_msgs::TwistWithCovarianceStamped>("twist");
  ASSERT_TRUE(twist);
  EXPECT_EQ(twist->header.stamp, tracker().stamp());
  EXPECT_LT(std::abs(twist->twist.twist.linear.x), 0.1);
  const auto pose = tracker().poses().newest();
  EXPECT_EQ(pose->header.frame_id, "camera_depth_optical_frame");
  for (int i = 0; i < 6; ++i) EXPECT_GT(pose->pose.covariance[static_cast<std::size_t>(7 * i)], 0.0);
  ASSERT_TRUE(waitUntil([&] {
    tracker().step();
    return transforms.newest() && transforms.newest()->transforms.at(0).header.stamp == tracker().stamp();
  }));
  const auto& transform = transforms.newest()->transforms.at(0);
  EXPECT_EQ(transform.header.frame_id, "camera_depth_optical_frame");
  EXPECT_EQ(transform.child_frame_id, "bracket");
  EXPECT_NEAR(transform.transform.translation.z, testPose().translation().z(), 0.003);
}

TEST_F(Outputs, Particles) {
  const auto cloud = take<ParticleCloud>("particles");
  ASSERT_TRUE(cloud);
  ASSERT_EQ(cloud->poses.size(), cloud->weights.size());
  EXPECT_GE(cloud->poses.size(), 10u);
  EXPECT_NEAR(std::accumulate(cloud->weights.begin(), cloud->weights.end(), 0.0), 1.0, 1e-3);
  EXPECT_EQ(take<geometry_msgs::PoseArray>("particle_poses")->poses.size(), cloud->poses.size());
  const auto points = take<sensor_msgs::PointCloud2>("particle_points");
  EXPECT_EQ(points->width, cloud->poses.size());
  ASSERT_EQ(points->fields.size(), 4u);
  EXPECT_EQ(points->fields[3].name, "intensity");
}

TEST_F(Outputs, OcclusionMapAndItsCamera) {
  const auto image = take<sensor_msgs::Image>("occlusion");
  ASSERT_TRUE(image);
  EXPECT_EQ(image->encoding, "32FC1");
  int on_object = 0, off_object = 0;
  for (std::size_t i = 0; i + 4 <= image->data.size(); i += 4) {
    float p_occluded;
    std::memcpy(&p_occluded, &image->data[i], 4);
    if (std::isnan(p_occluded)) {
      ++off_object;
      continue;
    }
    ++on_object;
    EXPECT_GE(p_occluded, 0.0f);
    EXPECT_LE(p_occluded, 1.0f);
  }
  EXPECT_GT(on_object, 50);
  EXPECT_GT(off_object, 50);
  const auto info = take<sensor_msgs::CameraInfo>("camera_info");
  EXPECT_EQ(info->width, image->width);
  EXPECT_EQ(info->height, image->height);
  EXPECT_NEAR(info->K[0] / info->width, testCamera().fx / testCamera().width, 0.05);
}

TEST_F(Outputs, OverlayAndMarker) {
  const auto overlay = take<sensor_msgs::Image>("overlay");
  EXPECT_EQ(overlay->encoding, "bgr8");
  EXPECT_EQ(overlay->width, 320u);
  EXPECT_EQ(overlay->data.size(), 320u * 240u * 3u);
  const auto markers = take<visualization_msgs::MarkerArray>("marker");
  ASSERT_EQ(markers->markers.size(), 1u);
  EXPECT_EQ(markers->markers[0].type, visualization_msgs::Marker::TRIANGLE_LIST);
  EXPECT_EQ(markers->markers[0].points.size() % 3, 0u);
  EXPECT_GT(markers->markers[0].points.size(), 100u);
  EXPECT_NEAR(markers->markers[0].pose.position.z, testPose().translation().z(), 0.003);
}

TEST_F(Outputs, StatusIsLatchedAndPosesAreNot) {
  Recorder<TrackerStatus> statuses(node_, kName + "/status");
  Recorder<geometry_msgs::PoseWithCovarianceStamped> poses(node_, kName + "/pose");
  EXPECT_TRUE(waitUntil([&] { return statuses.size() > 0 && poses.isConnected(); }));
  ros::WallDuration(0.5).sleep();  // an old pose would come with the connection
  EXPECT_EQ(poses.size(), 0u);
}

TEST_F(Outputs, TheObjectIsDescribedOnceForAll) {
  Recorder<visualization_msgs::Marker> objects(node_, kName + "/object");
  ASSERT_TRUE(waitUntil([&] { return objects.size() > 0; }));
  const auto object = objects.newest();
  EXPECT_EQ(object->header.frame_id, tracker().status()->object_name) << "the frame that tf moves";
  EXPECT_TRUE(object->header.stamp.isZero() && object->frame_locked);
  EXPECT_EQ(object->type, visualization_msgs::Marker::TRIANGLE_LIST);
  EXPECT_GT(object->points.size(), 100u);
  EXPECT_DOUBLE_EQ(object->pose.orientation.w, 1.0);
  for (int i = 0; i < 3; ++i) tracker().step();
  EXPECT_EQ(objects.size(), 1u) << "not for every image";
}

TEST_F(Outputs, StatusCountsAndTimes) {
  const TrackerStatus before = *tracker().status();
  const TrackerStatus after = tracker().step();
  EXPECT_EQ(after.frames_received, before.frames_received + 1);
  EXPECT_EQ(after.frames_processed, before.frames_processed + 1);
  EXPECT_EQ(after.frames_dropped, before.frames_dropped);
  EXPECT_GT(after.frame_time_s, 0.0f);
  EXPECT_GE(after.latency_s, after.frame_time_s);
  EXPECT_GT(after.num_particles, 0u);
  EXPECT_GT(after.position_stddev_m, 0.0f);
  EXPECT_LT(after.position_stddev_m, 0.1f);
}

TEST_F(Outputs, NothingIsPublishedWhileUninitialized) {
  std_srvs::Trigger reset;
  ASSERT_TRUE(ros::service::call(kName + "/reset", reset));
  Recorder<geometry_msgs::TwistWithCovarianceStamped> twists(node_, kName + "/twist");
  Recorder<tf2_msgs::TFMessage> transforms(node_, "/tf");
  const auto num_poses = tracker().poses().size();
  for (int i = 0; i < 5; ++i) tracker().step();
  EXPECT_EQ(tracker().poses().size(), num_poses);
  EXPECT_EQ(twists.size(), 0u);
  EXPECT_EQ(transforms.size(), 0u);
}

TEST_F(Outputs, WhatIsDrawnOfAnOlderPoseGoesAway) {
  std_srvs::Trigger reset;
  ASSERT_TRUE(ros::service::call(kName + "/reset", reset));
  const auto particles = take<geometry_msgs::PoseArray>("particle_poses");
  ASSERT_TRUE(particles);
  EXPECT_TRUE(particles->poses.empty());
  EXPECT_EQ(take<sensor_msgs::PointCloud2>("particle_points")->width, 0u);
  const auto occlusion = take<sensor_msgs::Image>("occlusion");
  ASSERT_TRUE(occlusion);
  EXPECT_GT(occlusion->width, 0u);
  ASSERT_EQ(occlusion->data.size(), std::size_t{4} * occlusion->width * occlusion->height);
  for (std::size_t i = 0; i + 4 <= occlusion->data.size(); i += 4) {
    float p_occluded;
    std::memcpy(&p_occluded, &occlusion->data[i], 4);
    EXPECT_TRUE(std::isnan(p_occluded));
  }
}

/// The publisher of the nodelet, without the nodelet, to look inside.
TEST(LazyOutputs, CostlyMessagesAreMadeOnlyForSubscribers) {
  ros::NodeHandle node("/lazy_outputs");
  ResultPublisher publisher(node, NodeletOptions());
  ObjectSource source;
  source.mesh = testMeshFile();
  const BuiltTracker built = buildTracker(source, TrackerConfig());
  ASSERT_TRUE(built.tracker);
  publisher.setObject(built);
  TestScene scene;
  const auto depth_m = scene.depth(testPose());
  FrameOutcome outcome;
  outcome.depth.data = reinterpret_cast<const std::uint8_t*>(depth_m.data());
  outcome.depth.width = 320;
  outcome.depth.height = 240;
  outcome.depth.step = 320 * 4;
  outcome.depth.pixel_type = DepthImageView::PixelType::kFloat32;
  outcome.depth.unit_m = 1.0f;
  outcome.camera = testCamera();
  built.tracker->initialise(testPose());
  outcome.result = built.tracker->update(outcome.depth, outcome.camera, 1.0);
  outcome.processed = outcome.is_new_estimate = true;

  publisher.publish(outcome, built);
  EXPECT_EQ(publisher.numCostlyMessages(), 0u);
  {
    Recorder<sensor_msgs::Image> overlay(node, "overlay");
    ASSERT_TRUE(waitUntil([&] {
      publisher.publish(outcome, built);
      return overlay.size() > 0;
    }));
    EXPECT_GT(publisher.numCostlyMessages(), 0u);
  }
  std::uint64_t before = 0;
  EXPECT_TRUE(waitUntil([&] {  // until the unsubscription has arrived
    before = publisher.numCostlyMessages();
    publisher.publish(outcome, built);
    return publisher.numCostlyMessages() == before;
  }));
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "tracker_outputs_rostest");
}
