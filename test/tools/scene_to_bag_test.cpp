// SPDX-License-Identifier: BSD-3-Clause
// The program scene_to_bag from the outside.
#include "small_scene.h"

#include <depth_object_tracker/Grasp.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <opencv2/imgcodecs.hpp>

namespace depth_object_tracker {
namespace {

using testing::HasSubstr;

template <typename Message>
std::vector<boost::shared_ptr<Message>> messagesOf(const std::string& bag_path, const std::string& topic) {
  rosbag::Bag bag(bag_path, rosbag::bagmode::Read);
  std::vector<boost::shared_ptr<Message>> messages;
  for (const rosbag::MessageInstance& instance : rosbag::View(bag, rosbag::TopicQuery(topic))) {
    messages.push_back(instance.instantiate<Message>());
  }
  return messages;
}

ProgramRun convert(const SmallScene& scene) {
  return runProgram(SCENE_TO_BAG, {scene.path(), scene.output("scene.bag")});
}

TEST(SceneToBag, WritesWhatACameraAndARobotWouldSend) {
  const SmallScene scene;
  ASSERT_EQ(convert(scene).exit_code, 0);
  const std::string bag = scene.output("scene.bag");

  const auto images = messagesOf<sensor_msgs::Image>(bag, "/camera/depth/image_raw");
  ASSERT_EQ(images.size(), 6u);
  EXPECT_EQ(images[3]->encoding, "16UC1");
  EXPECT_EQ(images[3]->header.frame_id, "camera_depth_optical_frame");
  EXPECT_GT(images[0]->header.stamp.toSec(), 1.0);  // ROS takes 0 for "no stamp"
  EXPECT_NEAR((images[3]->header.stamp - images[0]->header.stamp).toSec(), 0.1, 1e-8);
  const cv::Mat picture = cv::imread(scene.picture(3), cv::IMREAD_UNCHANGED);
  for (int row = 0; row < picture.rows; ++row) {
    for (int col = 0; col < picture.cols; ++col) {
      const std::size_t at = static_cast<std::size_t>(row) * images[3]->step + 2 * static_cast<std::size_t>(col);
      ASSERT_EQ(images[3]->data[at] + 256 * images[3]->data[at + 1], picture.at<std::uint16_t>(row, col));
    }
  }

  const auto infos = messagesOf<sensor_msgs::CameraInfo>(bag, "/camera/depth/camera_info");
  ASSERT_EQ(infos.size(), 6u);
  EXPECT_EQ(infos[3]->header.stamp, images[3]->header.stamp);
  EXPECT_DOUBLE_EQ(infos[3]->K[2], 79.5);
  EXPECT_EQ(infos[3]->width, 160u);

  const auto truths = messagesOf<geometry_msgs::PoseStamped>(bag, "/ground_truth/pose");
  ASSERT_EQ(truths.size(), 6u);
  const auto& q = truths[3]->pose.orientation;
  EXPECT_LT(Eigen::Quaterniond(q.w, q.x, q.y, q.z).angularDistance(Eigen::Quaterniond(SmallScene::truth(3).linear())),
            1e-6);
  EXPECT_NEAR(truths[3]->pose.position.z, 0.7, 1e-9);
}

TEST(SceneToBag, WritesGraspLatchedAndTwistAtTheEndOfItsInterval) {
  const SmallScene scene;
  scene.write("scene_control.json", R"({"0": {"grasped": true, "linear": [1,2,3], "angular": [4,5,6]},
    "1": {"grasped": true, "linear": [7,0,0], "angular": [0,8,0]}, "2": {"grasped": false}})");
  ASSERT_EQ(convert(scene).exit_code, 0);
  const std::string bag = scene.output("scene.bag");
  const auto images = messagesOf<sensor_msgs::Image>(bag, "/camera/depth/image_raw");
  const auto twists = messagesOf<geometry_msgs::TwistStamped>(bag, "/control_twist");
  ASSERT_EQ(twists.size(), 2u);
  EXPECT_EQ(twists[1]->header.stamp, images[1]->header.stamp);
  EXPECT_DOUBLE_EQ(twists[1]->twist.linear.x, 7.0);
  EXPECT_DOUBLE_EQ(twists[1]->twist.angular.y, 8.0);
  const auto grasps = messagesOf<Grasp>(bag, "/grasp");
  ASSERT_EQ(grasps.size(), 2u);
  EXPECT_TRUE(grasps[0]->grasped);
  EXPECT_FALSE(grasps[1]->grasped);
  EXPECT_EQ(grasps[1]->header.stamp, images[2]->header.stamp);

  rosbag::Bag reader(bag, rosbag::bagmode::Read);
  rosbag::View view(reader, rosbag::TopicQuery("/grasp"));
  for (const rosbag::ConnectionInfo* connection : view.getConnections())
    EXPECT_EQ(connection->header->at("latching"), "1");
}

TEST(SceneToBag, OtherUnitsAreRoundedToMillimetresAndTheLossIsTold) {
  const SmallScene scene(2);
  std::string cameras = scene.read("scene_camera.json");
  for (int i = 0; i < 2; ++i) cameras = replaceFirst(cameras, "\"depth_scale\":1.0", "\"depth_scale\":0.3");
  scene.write("scene_camera.json", cameras);
  const ProgramRun run = convert(scene);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("rounded to whole mm"));
  const auto images = messagesOf<sensor_msgs::Image>(scene.output("scene.bag"), "/camera/depth/image_raw");
  EXPECT_EQ(images[0]->data[0] + 256 * images[0]->data[1], 330);  // the wall: 1100 counts
}

TEST(SceneToBag, BadInputEndsWithOneLine) {
  const SmallScene scene(2);
  ProgramRun run = runProgram(SCENE_TO_BAG, {"/no/scene", scene.output("x.bag")});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("error: there is no scene folder /no/scene"));
  run = runProgram(SCENE_TO_BAG, {scene.path(), "/no/folder/x.bag"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("/no/folder/x.bag"));
  EXPECT_EQ(runProgram(SCENE_TO_BAG, {scene.path()}).exit_code, 2);
}

}  // namespace
}  // namespace depth_object_tracker
