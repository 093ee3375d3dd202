// SPDX-License-Identifier: BSD-3-Clause
// openni2.launch as a user runs it: the camera's nodelet and the tracker in one manager, the device virtual or
// recorded.
#include "camera_listener.h"
#include "rostest_main.h"

#include "depth_object_tracker/ros/openni2_camera_publisher.h"

#include <dynamic_reconfigure/Reconfigure.h>
#include <nodelet/NodeletLoad.h>
#include <nodelet/NodeletUnload.h>
#include <sensor_msgs/SetCameraInfo.h>
#include <tf2_msgs/TFMessage.h>

namespace depth_object_tracker {
namespace {

void setMode(int width, int height) {
  dynamic_reconfigure::Reconfigure call;
  for (const auto& [name, value] : {std::make_pair("width", width), std::make_pair("height", height)}) {
    dynamic_reconfigure::IntParameter parameter;
    parameter.name = name;
    parameter.value = value;
    call.request.config.ints.push_back(parameter);
  }
  ASSERT_TRUE(waitUntil([] { return ros::service::exists("/camera/driver/set_parameters", false); }));
  ASSERT_TRUE(ros::service::call("/camera/driver/set_parameters", call));
}

/// One listener for all: connections take their time.
class Live : public testing::Test {
 protected:
  static void SetUpTestSuite() { listener_ = new CameraListener; }
  static void TearDownTestSuite() {
    delete listener_;
    listener_ = nullptr;
  }
  void SetUp() override {
    ASSERT_TRUE(waitUntil([&] { return listener().images().size() > 0 && listener().hearsLogs(); }));
  }
  static CameraListener& listener() { return *listener_; }
  static CameraListener* listener_;
};
CameraListener* Live::listener_ = nullptr;

TEST_F(Live, ImagesAreThoseOfTheDevice) {
  ASSERT_TRUE(waitUntil([&] { return listener().images().size() >= 10 && listener().infos().size() >= 10; }));
  VirtualScene scene;
  ros::Time last_stamp;
  for (const auto& image : listener().images().messages()) {
    ASSERT_EQ(image->encoding, "16UC1");
    ASSERT_EQ(image->step, 2 * image->width);
    EXPECT_EQ(image->header.frame_id, "camera_depth_optical_frame");
    EXPECT_GT(image->header.stamp, last_stamp);
    EXPECT_LE(image->header.stamp, ros::Time::now());
    last_stamp = image->header.stamp;
    std::vector<std::uint16_t> expected(image->data.size() / 2);
    scene.render(virtualTime(CameraListener::pixels(*image)), static_cast<int>(image->width),
                 static_cast<int>(image->height), expected.data());
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), CameraListener::pixels(*image)));
  }
  const auto info = listener().infos().newest();
  const PinholeCamera camera = virtualCamera(320, 240);
  EXPECT_EQ(info->width, 320u);
  EXPECT_NEAR(info->K[0], camera.fx, 1e-3);
  EXPECT_NEAR(info->K[4], camera.fy, 1e-3);
  EXPECT_NEAR(info->K[2], 159.5, 1e-9);
  EXPECT_EQ(info->header.frame_id, "camera_depth_optical_frame");
}

TEST_F(Live, MetresAreTheSameDepth) {
  Recorder<sensor_msgs::Image> metres(ros::NodeHandle(), "/camera/depth/image");
  const auto matching = [&]() -> sensor_msgs::ImageConstPtr {
    for (const auto& image : listener().images().messages()) {
      if (metres.newest() && image->header.stamp == metres.messages().front()->header.stamp) return image;
    }
    return nullptr;
  };
  ASSERT_TRUE(waitUntil([&] { return matching() != nullptr; }));
  const auto millimetres = matching(), image = metres.messages().front();
  EXPECT_EQ(image->encoding, "32FC1");
  for (std::size_t i = 0; i < image->data.size() / 4; ++i) {
    float depth_m = 0.0f;
    std::memcpy(&depth_m, &image->data[4 * i], 4);
    ASSERT_FLOAT_EQ(depth_m, 0.001f * static_cast<float>(CameraListener::pixels(*millimetres)[i])) << i;
  }
}

TEST_F(Live, TheTrackerFollowsTheObject) {
  listener().expectTracking();
}

TEST_F(Live, ThePlaceOfTheCameraIsInTf) {
  ros::NodeHandle node;
  Recorder<tf2_msgs::TFMessage> transforms(node, "/tf_static");
  ASSERT_TRUE(waitUntil([&] { return transforms.size() > 0; }));
  const auto& transform = transforms.newest()->transforms.at(0);
  EXPECT_EQ(transform.header.frame_id, "camera_link");
  EXPECT_EQ(transform.child_frame_id, "camera_depth_optical_frame");
  const Eigen::Vector3d forward = fromTransformMessage(transform.transform) * Eigen::Vector3d::UnitZ();
  EXPECT_LT((forward - Eigen::Vector3d::UnitX()).norm(), 1e-9);
}

TEST_F(Live, TheModeChangesWhileItRuns) {
  setMode(640, 480);
  ASSERT_TRUE(listener().waitForNewImages(3, 640));
  ASSERT_TRUE(waitUntil([&] { return listener().infos().newest()->width == 640; }));
  listener().expectTracking();
  setMode(320, 240);
  ASSERT_TRUE(listener().waitForNewImages(3, 320));
}

TEST_F(Live, ADeviceThatIsUnpluggedComesBack) {
  unplug();
  EXPECT_TRUE(listener().waitForLog("was unplugged; waiting for it"));
  EXPECT_TRUE(waitUntil([&] { return listener().status() && listener().status()->reason.find("no image") == 0; }));
  plugIn();
  ASSERT_TRUE(listener().waitForNewImages(3, 320));
  listener().expectTracking();
}

TEST_F(Live, AWrongDeviceIsSaidAndHarmsNobody) {
  ros::param::set("/wrong/driver/device", "1d27/0601@9/9");
  nodelet::NodeletLoad load;
  load.request.name = "/wrong/driver";
  load.request.type = "depth_object_tracker/OpenNI2Camera";
  ASSERT_TRUE(ros::service::call("/camera/camera_nodelet_manager/load_nodelet", load));
  EXPECT_TRUE(listener().waitForLog("/wrong/driver: no depth camera '1d27/0601@9/9'; connected: 'virtual://depth/1'"));
  nodelet::NodeletUnload unload;
  unload.request.name = "/wrong/driver";
  ASSERT_TRUE(ros::service::call("/camera/camera_nodelet_manager/unload_nodelet", unload));
  listener().expectTracking();
}

TEST_F(Live, AParameterOutOfRangeIsSaidAndHarmsNobody) {
  ros::param::set("/wrong/second/fps", 0);
  nodelet::NodeletLoad load;
  load.request.name = "/wrong/second";
  load.request.type = "depth_object_tracker/OpenNI2Camera";
  ASSERT_TRUE(ros::service::call("/camera/camera_nodelet_manager/load_nodelet", load));
  EXPECT_TRUE(listener().waitForLog("parameter '/wrong/second/fps' is 0; valid range is [1, 1000]"));
  listener().expectTracking();
}

TEST(Recorded, IsTrackedFromItsFirstToItsLastImage) {
  constexpr int kFrames = 90;
  const std::string folder = std::getenv("VIRTUAL_DEPTH_FOLDER");
  CameraListener listener;
  ASSERT_TRUE(waitUntil([&] { return listener.hearsLogs(); }));
  recordVirtualCamera(folder + "/unfinished.oni", kFrames, true);
  ASSERT_TRUE(listener.waitForTracker());
  ASSERT_TRUE(waitUntil([&] { return listener.images().isConnected(); }));
  {  // where the object is in the first image
    CameraLog log;
    DepthCameraOptions options;
    options.device = folder + "/unfinished.oni";
    DepthCamera camera(options, log.events());
    camera.setWanted(true);
    ASSERT_TRUE(waitUntil([&] { return log.size() > 0; }));
    listener.initialise(virtualPose(virtualTime(log.images().front().pixels())));
  }
  ros::WallDuration(0.5).sleep();  // until the pose has arrived
  ASSERT_EQ(std::rename((folder + "/unfinished.oni").c_str(), (folder + "/recording.oni").c_str()), 0);
  ASSERT_TRUE(listener.waitForLog("recording.oni' has ended"));
  ASSERT_TRUE(waitUntil([&] { return listener.poses().size() >= kFrames / 2; }));
  const auto images = listener.images().messages();
  EXPECT_GE(images.size(), static_cast<std::size_t>(kFrames - 5));
  for (std::size_t i = 1; i < images.size(); ++i) {
    const std::uint64_t interval_us =
        virtualTime(CameraListener::pixels(*images[i])) - virtualTime(CameraListener::pixels(*images[i - 1]));
    EXPECT_NEAR((images[i]->header.stamp - images[i - 1]->header.stamp).toSec(),
                1e-6 * static_cast<double>(interval_us), 1e-5);
  }
  EXPECT_NEAR(listener.infos().newest()->K[0], virtualCamera(320, 240).fx, 0.01);
  CameraListener::expectSmall(listener.errorsSince(images.front()->header.stamp + ros::Duration(0.3)));
}

/// The publisher without a device.
class Publisher : public testing::Test {
 protected:
  Publisher() {
    frame_.data = pixels_.data();
    frame_.width = frame_.full_width = frame_.stride_px = 4;
    frame_.height = frame_.full_height = 2;
    frame_.horizontal_fov_rad = 1.0;
  }
  void publish() {
    frame_.timestamp_s += 0.033;
    publisher_.publish(frame_);
  }

  ros::NodeHandle node_;
  std::atomic<bool> is_wanted_{false};
  std::vector<std::uint16_t> pixels_ = std::vector<std::uint16_t>(8, 1000);
  DepthFrame frame_;
  OpenNI2CameraPublisher publisher_{node_, "/publisher", OpenNI2CameraOptions(),
                                    [this](bool is_wanted) { is_wanted_ = is_wanted; }};
};

TEST_F(Publisher, MakesNothingThatNobodyWants) {
  publish();
  EXPECT_EQ(publisher_.numImages(), 0u);
  EXPECT_FALSE(is_wanted_);
  {
    Recorder<sensor_msgs::Image> images(node_, "/publisher/depth/image");
    ASSERT_TRUE(waitUntil([&] { return is_wanted_.load(); }));
    publish();
    EXPECT_EQ(publisher_.numImages(), 1u);  // not two: nobody wants millimetres
    EXPECT_TRUE(waitUntil([&] { return images.size() == 1; }));
  }
  EXPECT_TRUE(waitUntil([&] { return !is_wanted_; }));
}

TEST_F(Publisher, ACalibrationIsUsedForItsOwnSizeOnly) {
  Recorder<sensor_msgs::CameraInfo> infos(node_, "/publisher/depth/camera_info");
  ASSERT_TRUE(waitUntil([&] { return is_wanted_.load(); }));
  sensor_msgs::SetCameraInfo call;
  call.request.camera_info = factoryCameraInfo(frame_);
  call.request.camera_info.K[0] = 123.0;
  ASSERT_TRUE(ros::service::call("/publisher/depth/set_camera_info", call));
  ASSERT_TRUE(call.response.success) << call.response.status_message;
  publish();
  ASSERT_TRUE(waitUntil([&] { return infos.size() == 1; }));
  EXPECT_DOUBLE_EQ(infos.newest()->K[0], 123.0);
  frame_.full_width = frame_.width = 2;
  publish();
  ASSERT_TRUE(waitUntil([&] { return infos.size() == 2; }));
  EXPECT_NEAR(infos.newest()->K[0], factoryFocalLengthPx(frame_), 1e-9);
}

TEST_F(Publisher, RegisteredImagesAreSeenFromTheColourCamera) {
  Recorder<sensor_msgs::Image> images(node_, "/publisher/depth/image_raw");
  ASSERT_TRUE(waitUntil([&] { return is_wanted_.load(); }));
  publish();
  frame_.is_registered = true;
  publish();
  ASSERT_TRUE(waitUntil([&] { return images.size() == 2; }));
  EXPECT_EQ(images.messages()[0]->header.frame_id, "camera_depth_optical_frame");
  EXPECT_EQ(images.messages()[1]->header.frame_id, "camera_rgb_optical_frame");
}

TEST(CameraOptions, ARelativeRecordingIsMeantFromTheGivenFolder) {
  const ros::NodeHandle node("/options_of_a_camera");
  const auto deviceFor = [&](const std::string& device) {
    node.setParam("device", device);
    return loadOpenNI2CameraOptions(node).camera.device;
  };
  node.setParam("paths_from", "/data");
  EXPECT_EQ(deviceFor("sub/mug.oni"), "/data/sub/mug.oni");
  EXPECT_EQ(deviceFor("/other/mug.oni"), "/other/mug.oni");
  EXPECT_EQ(deviceFor("1d27/0601@1/5"), "1d27/0601@1/5") << "a URI";
  node.deleteParam("paths_from");
  EXPECT_EQ(deviceFor("mug.oni"), "mug.oni");
}

TEST_F(Publisher, APartOfTheImageSaysWhichOne) {
  frame_.full_width = 10;
  frame_.full_height = 8;
  frame_.column_offset = 1;
  frame_.row_offset = 3;
  frame_.is_mirrored = true;
  const sensor_msgs::CameraInfo info = factoryCameraInfo(frame_);
  EXPECT_EQ(info.width, 10u);
  EXPECT_EQ(info.roi.x_offset, 5u);
  EXPECT_EQ(info.roi.y_offset, 3u);
  EXPECT_EQ(info.roi.width, 4u);
  EXPECT_EQ(info.roi.height, 2u);
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "openni2_camera_rostest");
}
