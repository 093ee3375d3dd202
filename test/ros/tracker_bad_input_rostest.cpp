// SPDX-License-Identifier: BSD-3-Clause
// Bad input to a running nodelet: each is told by name, nothing crashes, tracking goes on when good input returns.
#include <gtest/gtest.h>

#include "rostest_main.h"
#include "tracker_harness.h"

#include <depth_object_tracker/LoadObject.h>

#include <limits>

namespace depth_object_tracker {
namespace {

const char* const kName = "/tracker_bad_input";

class BadInput : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    setGoodParameters(kName);
    harness_ = new TrackerHarness(kName);
  }
  static void TearDownTestSuite() {
    delete harness_;
    harness_ = nullptr;
  }

  void SetUp() override {
    ASSERT_TRUE(harness_->isReady());
    tracker().setStamp(tracker().stamp() + ros::Duration(0.5));
    ASSERT_TRUE(tracker().initialise());
    tracker().expectTracking();
  }
  void TearDown() override { tracker().expectTracking(); }

  static TrackerHarness& tracker() { return *harness_; }

  static void nextStamp() { tracker().setStamp(tracker().stamp() + ros::Duration(1.0 / 30.0)); }

  static void expectReason(const TrackerStatus& status, const std::vector<std::string>& parts) {
    EXPECT_NE(static_cast<int>(status.state), static_cast<int>(TrackerStatus::TRACKING));
    for (const auto& part : parts)
      EXPECT_NE(status.reason.find(part), std::string::npos) << part << " is not in: " << status.reason;
  }

  /// A whole second of images without a reading: told at the latest then.
  static void expectNothingSeen(const std::function<sensor_msgs::ImagePtr()>& make_image) {
    TrackerStatus status;
    for (int i = 0; i < 10; ++i) {
      nextStamp();
      status = tracker().send(make_image());
    }
    EXPECT_NE(static_cast<int>(status.state), static_cast<int>(TrackerStatus::TRACKING));
    EXPECT_NE(status.reason.find("no valid depth"), std::string::npos) << status.reason;
    EXPECT_EQ(status.valid_pixel_fraction, 0.0f);
    EXPECT_TRUE(tracker().waitForLog({"/camera/depth/image_raw", "no valid depth"}));
  }

  static InitializeTracker::Response callInitialize(const geometry_msgs::PoseWithCovarianceStamped& pose) {
    InitializeTracker call;
    call.request.pose = pose;
    EXPECT_TRUE(ros::service::call(std::string(kName) + "/initialize", call));
    return call.response;
  }

  static geometry_msgs::PoseWithCovarianceStamped goodPose() {
    geometry_msgs::PoseWithCovarianceStamped pose;
    pose.header.frame_id = "camera_depth_optical_frame";
    pose.pose.pose = toPoseMessage(testPose());
    return pose;
  }

  static TrackerHarness* harness_;
};
TrackerHarness* BadInput::harness_ = nullptr;

TEST_F(BadInput, AllZeroDepth) {
  expectNothingSeen([] { return makeUint16Image(std::vector<float>(320 * 240, 0.0f), 320, 240); });
}

TEST_F(BadInput, AllNanDepth) {
  expectNothingSeen(
      [] { return makeFloatImage(std::vector<float>(320 * 240, std::numeric_limits<float>::quiet_NaN()), 320, 240); });
}

TEST_F(BadInput, SomeNanAndInfiniteDepth) {
  nextStamp();
  auto depth_m = tracker().scene().depth(testPose());
  for (std::size_t i = 0; i < depth_m.size(); i += 3) depth_m[i] = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 1; i < depth_m.size(); i += 7) depth_m[i] = -std::numeric_limits<float>::infinity();
  const TrackerStatus status = tracker().send(makeFloatImage(depth_m, 320, 240));
  EXPECT_EQ(static_cast<int>(status.state), static_cast<int>(TrackerStatus::TRACKING)) << status.reason;
  for (const auto& pose : tracker().poses().messages()) EXPECT_TRUE(std::isfinite(pose->pose.pose.position.x));
}

TEST_F(BadInput, NoImages) {
  EXPECT_TRUE(tracker().waitForReason("no image on '/camera/depth/image_raw'"));
}

TEST_F(BadInput, ImageSmallerThanItsHeaderSays) {
  nextStamp();
  const auto image = tracker().goodImage();
  image->data.resize(1000);
  expectReason(tracker().send(image), {"/camera/depth/image_raw", "1000 bytes", "153600"});
  nextStamp();
  const auto empty = tracker().goodImage();
  empty->data.clear();
  expectReason(tracker().send(empty), {"0 bytes"});
  nextStamp();
  const auto short_rows = tracker().goodImage();
  short_rows->step = 10;
  expectReason(tracker().send(short_rows), {"step=10"});
}

TEST_F(BadInput, WrongEncoding) {
  nextStamp();
  const auto image = tracker().goodImage();
  image->encoding = "rgb8";
  expectReason(tracker().send(image), {"/camera/depth/image_raw", "rgb8", "16UC1", "32FC1"});
  EXPECT_TRUE(tracker().waitForLog({"rgb8"}));
}

TEST_F(BadInput, CameraInfoOfAnotherSize) {
  nextStamp();
  PinholeCamera other = testCamera();
  other.width = 640;
  other.height = 480;
  expectReason(tracker().send(tracker().goodImage(), makeCameraInfo(other)),
               {"/camera/depth/camera_info", "640x480", "320x240"});
}

TEST_F(BadInput, CameraInfoWithoutFocalLength) {
  nextStamp();
  PinholeCamera uncalibrated = testCamera();
  uncalibrated.fx = uncalibrated.fy = 0.0;
  expectReason(tracker().send(tracker().goodImage(), makeCameraInfo(uncalibrated)),
               {"/camera/depth/camera_info", "fx=0"});
}

TEST_F(BadInput, RepeatedStamps) {
  const auto processed = tracker().status()->frames_processed;
  const auto num_poses = tracker().poses().size();
  TrackerStatus status;
  for (int i = 0; i < 5; ++i) status = tracker().send(tracker().goodImage());
  EXPECT_EQ(status.frames_processed, processed);
  EXPECT_EQ(tracker().poses().size(), num_poses);
  EXPECT_TRUE(tracker().waitForLog({"/camera/depth/image_raw", "repeats"}));
}

TEST_F(BadInput, StampsTenSecondsAheadAndBack) {
  tracker().setStamp(tracker().stamp() + ros::Duration(10.0));
  tracker().expectTracking();
  tracker().setStamp(tracker().stamp() - ros::Duration(10.0));
  tracker().send(tracker().goodImage());
  EXPECT_TRUE(tracker().waitForLog({"/camera/depth/image_raw", "jumped back in time"}));
  tracker().expectTracking();
}

TEST_F(BadInput, QuaternionWithoutNorm) {
  auto pose = goodPose();
  pose.pose.pose.orientation = geometry_msgs::Quaternion();
  const auto response = callInitialize(pose);
  EXPECT_FALSE(response.success);
  EXPECT_NE(response.message.find("norm 0"), std::string::npos) << response.message;
}

TEST_F(BadInput, QuaternionThatIsNotANumber) {
  auto pose = goodPose();
  pose.pose.pose.orientation.x = std::numeric_limits<double>::quiet_NaN();
  const auto response = callInitialize(pose);
  EXPECT_FALSE(response.success);
  EXPECT_NE(response.message.find("quaternion"), std::string::npos) << response.message;
  EXPECT_TRUE(tracker().waitForLog({"~initialize refused", "quaternion"}));
}

TEST_F(BadInput, BadPosesOnTheTopic) {
  ros::NodeHandle node;
  ros::Publisher publisher =
      node.advertise<geometry_msgs::PoseWithCovarianceStamped>(std::string(kName) + "/initial_pose", 1);
  ASSERT_TRUE(waitUntil([&] { return publisher.getNumSubscribers() > 0; }));
  auto pose = goodPose();
  pose.pose.pose.orientation = geometry_msgs::Quaternion();
  publisher.publish(pose);
  EXPECT_TRUE(tracker().waitForLog({"~initial_pose refused", "norm 0"}));
  pose = goodPose();
  pose.pose.covariance[0] = -1.0;
  publisher.publish(pose);
  EXPECT_TRUE(tracker().waitForLog({"~initial_pose refused", "covariance[0]"}));
}

TEST_F(BadInput, UnknownFrame) {
  auto pose = goodPose();
  pose.header.frame_id = "no_such_frame";
  const auto response = callInitialize(pose);
  EXPECT_FALSE(response.success);
  EXPECT_NE(response.message.find("no_such_frame"), std::string::npos) << response.message;
  EXPECT_NE(response.message.find("camera_depth_optical_frame"), std::string::npos) << response.message;
}

TEST_F(BadInput, UnknownFrameOnTheTopic) {
  ros::NodeHandle node;
  ros::Publisher publisher =
      node.advertise<geometry_msgs::PoseWithCovarianceStamped>(std::string(kName) + "/initial_pose", 1);
  ASSERT_TRUE(waitUntil([&] { return publisher.getNumSubscribers() > 0; }));
  auto pose = goodPose();
  pose.header.frame_id = "lost_frame";
  publisher.publish(pose);
  const auto told = [&] {
    tracker().step();
    return tracker().hasLogged({"lost_frame", "camera_depth_optical_frame"});
  };
  EXPECT_TRUE(waitUntil(told));
}

TEST_F(BadInput, MissingMeshFile) {
  LoadObject call;
  call.request.mesh = "/no/such/mesh.obj";
  ASSERT_TRUE(ros::service::call(std::string(kName) + "/load_object", call));
  EXPECT_FALSE(call.response.success);
  EXPECT_NE(call.response.message.find("/no/such/mesh.obj"), std::string::npos) << call.response.message;
}

TEST_F(BadInput, ModesAndTimeoutsThatDoNotExist) {
  InitializeTracker call;
  call.request.mode = InitializeTracker::Request::GLOBAL + 1;
  call.request.pose = goodPose();
  ASSERT_TRUE(ros::service::call(std::string(kName) + "/initialize", call));
  EXPECT_FALSE(call.response.success);
  EXPECT_NE(call.response.message.find("not available"), std::string::npos) << call.response.message;
  call.request.mode = InitializeTracker::Request::FROM_POSE;
  call.request.timeout_s = std::numeric_limits<double>::quiet_NaN();
  ASSERT_TRUE(ros::service::call(std::string(kName) + "/initialize", call));
  EXPECT_FALSE(call.response.success);
  EXPECT_NE(call.response.message.find("timeout_s"), std::string::npos) << call.response.message;
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "tracker_bad_input_rostest");
}
