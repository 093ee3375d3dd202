// SPDX-License-Identifier: BSD-3-Clause
// The services of a running tracker.
#include <gtest/gtest.h>

#include "rostest_main.h"
#include "tracker_harness.h"

#include "depth_object_tracker/geometry/stable_poses.h"

#include <depth_object_tracker/Grasp.h>
#include <depth_object_tracker/LoadObject.h>
#include <depth_object_tracker/SetGrasp.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <atomic>
#include <thread>

namespace depth_object_tracker {
namespace {

const char* const kName = "/tracker_services";

template <typename Service>
typename Service::Response callService(const std::string& service, typename Service::Request request = {}) {
  Service call;
  call.request = request;
  EXPECT_TRUE(ros::service::call(std::string(kName) + "/" + service, call)) << service;
  return call.response;
}

constexpr double kTableBelowM = 0.45;  // under the camera

/// Up from the table, optical frame: the camera looks down by 45 degrees.
Eigen::Vector3d testTableNormal() {
  return Eigen::Vector3d(0.0, -1.0, -1.0).normalized();
}

/// The test's object as it rests most likely, turned somehow, before the camera.
Pose restingOnTestTable() {
  const TriangleMesh mesh = loadMesh(testMeshFile());
  const Eigen::Vector3d centre = surfaceCentroid(mesh), up = testTableNormal();
  const StablePose rest = stablePoses(mesh, centre).front();
  Pose pose = Pose::Identity();
  pose.linear() = expSo3(0.7 * up) * Eigen::Quaterniond::FromTwoVectors(rest.up, up).toRotationMatrix();
  const Eigen::Vector3d foot = kTableBelowM / -up.z() * Eigen::Vector3d::UnitZ();
  pose.translation() = foot + rest.height_m * up - pose.linear() * centre;
  return pose;
}

sensor_msgs::ImagePtr imageOfTestTable(TestScene& scene, const Pose& T_camera_object) {
  const PinholeCamera camera = testCamera();
  std::vector<float> depth_m = scene.depth(T_camera_object);
  for (int row = 0; row < camera.height; ++row) {
    for (int col = 0; col < camera.width; ++col) {
      const double table = -kTableBelowM / testTableNormal().dot(camera.ray(col, row));
      float& depth = depth_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(camera.width) +
                             static_cast<std::size_t>(col)];
      if (table > 0.0) depth = std::min(depth, static_cast<float>(table));
    }
  }
  return makeUint16Image(depth_m, camera.width, camera.height);
}

class Services : public testing::Test {
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
    ASSERT_TRUE(tracker().initialise());
    tracker().expectTracking();
  }

  static TrackerHarness& tracker() { return *harness_; }
  static int state() { return static_cast<int>(tracker().status()->state); }

  static InitializeTracker::Request requestAt(const Pose& pose, const std::string& frame, double timeout_s) {
    InitializeTracker::Request request;
    request.pose.header.frame_id = frame;
    request.pose.pose.pose = toPoseMessage(pose);
    request.timeout_s = timeout_s;
    return request;
  }

  static TrackerHarness* harness_;
};
TrackerHarness* Services::harness_ = nullptr;

TEST_F(Services, ResetForgetsThePoseUntilToldAnew) {
  EXPECT_TRUE(callService<std_srvs::Trigger>("reset").success);
  ASSERT_TRUE(waitUntil([&] { return state() == TrackerStatus::UNINITIALIZED; }));
  const auto num_poses = tracker().poses().size();
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(static_cast<int>(tracker().step().state), static_cast<int>(TrackerStatus::UNINITIALIZED));
  EXPECT_NE(tracker().status()->reason, "");
  EXPECT_EQ(tracker().poses().size(), num_poses);
  EXPECT_TRUE(tracker().initialise());
  tracker().expectTracking();
}

TEST_F(Services, PauseStopsTheWorkAndGoesOnAfterwards) {
  std_srvs::SetBool::Request request;
  request.data = true;
  EXPECT_TRUE(callService<std_srvs::SetBool>("pause", request).success);
  ASSERT_TRUE(waitUntil([&] { return tracker().status()->paused; }));
  request.data = false;
  EXPECT_TRUE(callService<std_srvs::SetBool>("pause", request).success);
  ASSERT_TRUE(waitUntil([&] { return !tracker().status()->paused; }));
  tracker().expectTracking();
}

TEST_F(Services, InitializeWaitsUntilTracking) {
  std::atomic<bool> answered{false};
  InitializeTracker::Response response;
  std::thread caller([&] {
    response = callService<InitializeTracker>("initialize", requestAt(testPose(), "", 600.0));
    answered = true;
  });
  const bool came = waitUntil([&] {
    tracker().step();
    return answered.load();
  });
  if (!came) callService<std_srvs::Trigger>("reset");  // ends the waiting
  caller.join();
  EXPECT_TRUE(came);
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_NEAR(response.pose.pose.pose.position.z, testPose().translation().z(), 0.005);
  EXPECT_EQ(response.pose.header.frame_id, "camera_depth_optical_frame");
}

TEST_F(Services, InitializeFindsTheObjectInTheWholeImage) {
  EXPECT_TRUE(callService<std_srvs::Trigger>("reset").success);
  InitializeTracker::Request request;
  request.mode = InitializeTracker::Request::GLOBAL;
  request.timeout_s = 600.0;
  std::atomic<bool> answered{false};
  InitializeTracker::Response response;
  std::thread caller([&] {
    response = callService<InitializeTracker>("initialize", request);
    answered = true;
  });
  const bool came = waitUntil([&] {
    tracker().step();
    return answered.load();
  });
  if (!came) callService<std_srvs::Trigger>("reset");  // ends the waiting
  caller.join();
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_NEAR(response.pose.pose.pose.position.z, testPose().translation().z(), 0.01);
  EXPECT_TRUE(tracker().initialise());
  tracker().expectTracking();
}

TEST_F(Services, InitializeFindsTheObjectOnATable) {
  EXPECT_TRUE(callService<std_srvs::Trigger>("reset").success);
  const Pose T_camera_object = restingOnTestTable();
  InitializeTracker::Request request;
  request.mode = InitializeTracker::Request::ON_TABLE;
  request.timeout_s = 600.0;
  std::atomic<bool> answered{false};
  InitializeTracker::Response response;
  std::thread caller([&] {
    response = callService<InitializeTracker>("initialize", request);
    answered = true;
  });
  const bool came = waitUntil([&] {
    tracker().setStamp(tracker().stamp() + ros::Duration(1.0 / 30.0));
    tracker().send(imageOfTestTable(tracker().scene(), T_camera_object));
    return answered.load();
  });
  if (!came) callService<std_srvs::Trigger>("reset");  // ends the waiting
  caller.join();
  EXPECT_TRUE(response.success) << response.message;
  const auto& p = response.pose.pose.pose.position;
  EXPECT_LT((Eigen::Vector3d(p.x, p.y, p.z) - T_camera_object.translation()).norm(), 0.01);
  EXPECT_TRUE(tracker().initialise());
  tracker().expectTracking();
}

TEST_F(Services, InitializeInHandNeedsTheHand) {
  InitializeTracker::Request request = requestAt(testPose(), "", 0.0);
  request.mode = InitializeTracker::Request::IN_HAND;
  const InitializeTracker::Response response = callService<InitializeTracker>("initialize", request);
  EXPECT_FALSE(response.success);
  EXPECT_NE(response.message.find("link"), std::string::npos) << response.message;
  tracker().expectTracking();
}

TEST_F(Services, InitializeTimesOutWithoutImagesAndOthersAreAnsweredMeanwhile) {
  std::atomic<bool> answered{false};
  InitializeTracker::Response response;
  std::thread caller([&] {
    response = callService<InitializeTracker>("initialize", requestAt(testPose(), "", 2.0));
    answered = true;
  });
  EXPECT_TRUE(callService<SetGrasp>("set_grasp").success);
  EXPECT_TRUE(waitUntil([&] { return answered.load(); }));
  caller.join();
  EXPECT_FALSE(response.success);
  EXPECT_NE(response.message.find("not tracking within"), std::string::npos) << response.message;
}

TEST_F(Services, ANewerInitializeEndsTheOlder) {
  InitializeTracker::Response older;
  std::thread caller([&] { older = callService<InitializeTracker>("initialize", requestAt(testPose(), "", 600.0)); });
  std::atomic<bool> done{false};
  std::thread newer([&] {
    while (!done) {
      EXPECT_TRUE(tracker().initialise());
      ros::WallDuration(0.1).sleep();
    }
  });
  caller.join();
  done = true;
  newer.join();
  EXPECT_FALSE(older.success);
  EXPECT_NE(older.message.find("superseded"), std::string::npos) << older.message;
}

TEST_F(Services, InitializeTakesAPoseInAnotherTfFrame) {
  Pose T_base_camera = Pose::Identity();
  T_base_camera.translation() = Eigen::Vector3d(0.5, -1.0, 1.2);
  T_base_camera.linear() = expSo3(Eigen::Vector3d(-2.0, 0.1, 0.3));
  tf2_ros::StaticTransformBroadcaster broadcaster;
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "base";
  transform.child_frame_id = "camera_depth_optical_frame";
  transform.transform = toTransformMessage(T_base_camera);
  broadcaster.sendTransform(transform);
  EXPECT_TRUE(callService<std_srvs::Trigger>("reset").success);
  InitializeTracker::Response response;
  EXPECT_TRUE(waitUntil([&] {
    response = callService<InitializeTracker>("initialize", requestAt(T_base_camera * testPose(), "base", 0.0));
    return response.success;
  })) << response.message;
  tracker().expectTracking();
}

TEST_F(Services, LoadObjectReplacesTheObject) {
  LoadObject::Request request;
  request.mesh = std::string(PROJECT_SOURCE_FOLDER) + "/meshes/box.obj";
  request.name = "carton";
  const auto response = callService<LoadObject>("load_object", request);
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_GT(response.diameter_m, 0.05);
  EXPECT_GT(response.num_triangles, 10u);
  const TrackerStatus status = tracker().step();
  EXPECT_EQ(status.object_name, "carton");
  EXPECT_EQ(static_cast<int>(status.state), static_cast<int>(TrackerStatus::UNINITIALIZED));
  const auto back = callService<LoadObject>("load_object");
  EXPECT_TRUE(back.success) << back.message;
  EXPECT_TRUE(tracker().initialise());
  tracker().expectTracking();
  EXPECT_EQ(tracker().status()->object_name, "bracket");
}

TEST_F(Services, LoadObjectReadsNoFileFromAnywhere) {
  LoadObject::Request request;
  request.mesh = "/etc/hostname";
  const auto response = callService<LoadObject>("load_object", request);
  EXPECT_FALSE(response.success);
  EXPECT_NE(response.message.find("~object_folders"), std::string::npos) << response.message;
  tracker().step();
  EXPECT_EQ(tracker().status()->object_name, "bracket");
}

TEST_F(Services, SetGraspRefusesLinksThatItCannotFollow) {
  SetGrasp::Request request;
  request.grasped = true;
  request.link = "hand";
  const auto response = callService<SetGrasp>("set_grasp", request);
  EXPECT_FALSE(response.success);
  EXPECT_NE(response.message.find("hand"), std::string::npos) << response.message;
  EXPECT_FALSE(tracker().step().grasped);
}

TEST_F(Services, AHeldObjectFollowsItsControlTwist) {
  ros::NodeHandle node;
  ros::Publisher twists = node.advertise<geometry_msgs::TwistStamped>("/control_twist", 100);
  ros::Publisher grasps = node.advertise<Grasp>("/grasp", 1, true);
  ASSERT_TRUE(waitUntil([&] { return twists.getNumSubscribers() > 0 && grasps.getNumSubscribers() > 0; }));
  Grasp grasp;
  grasp.object_name = "somebody_else";
  grasp.grasped = true;
  grasps.publish(grasp);
  EXPECT_FALSE(tracker().step().grasped);
  grasp.object_name = "";
  grasps.publish(grasp);
  EXPECT_TRUE(waitUntil([&] { return tracker().step().grasped; }));
  Pose pose = testPose();
  for (int i = 0; i < 10; ++i) {
    geometry_msgs::TwistStamped twist;
    twist.header.stamp = tracker().stamp() + ros::Duration(1.0 / 30.0);
    twist.twist.linear.x = 0.3;
    twists.publish(twist);
    pose.translation().x() += 0.01;
    tracker().step(pose);
  }
  EXPECT_LT(std::abs(tracker().poses().newest()->pose.pose.position.x - pose.translation().x()), 0.005);
  grasp.grasped = false;
  grasps.publish(grasp);
  EXPECT_TRUE(waitUntil([&] { return !tracker().step(pose).grasped; }));
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "tracker_services_rostest");
}
