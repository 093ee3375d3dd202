// SPDX-License-Identifier: BSD-3-Clause
// What is remembered, what is not, and what a bad file or folder leads to.
#include "depth_object_tracker/ros/pose_memory.h"

#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace depth_object_tracker {
namespace {

TrackerResult goodResult() {
  TrackerResult result;
  result.state = TrackerState::kTracking;
  result.has_pose = true;
  result.visible_fraction = 0.8;
  result.score = 1.0;
  result.T_camera_object.translation() = Eigen::Vector3d(0.1, -0.2, 0.7);
  result.T_camera_object.linear() = expSo3(Eigen::Vector3d(0.3, 0.2, -0.1));
  return result;
}

class PoseMemoryTest : public testing::Test {
 protected:
  std::optional<Pose> recall(const std::string& object) { return recallPose(file_, object, problem_); }

  TemporaryFolder folder_;
  std::string file_ = (folder_.path() / "made" / "pose.json").string();
  std::string problem_;
};

TEST_F(PoseMemoryTest, ComesBackAsItWas) {
  PoseMemory memory(file_);
  EXPECT_FALSE(recall("mug").has_value());
  EXPECT_EQ(problem_, "");
  memory.note(goodResult(), "mug");
  EXPECT_EQ(memory.save(), "");
  const auto pose = recall("mug");
  ASSERT_TRUE(pose.has_value()) << problem_;
  EXPECT_TRUE(pose->isApprox(goodResult().T_camera_object, 1e-9));
  EXPECT_FALSE(recall("drill").has_value()) << "the pose of another object";
  EXPECT_EQ(problem_, "");
}

TEST_F(PoseMemoryTest, KeepsOnlyGoodPoses) {
  PoseMemory memory(file_);
  memory.note(goodResult(), "mug");
  ASSERT_EQ(memory.save(), "");
  for (int i = 0; i < 4; ++i) {
    TrackerResult bad = goodResult();
    bad.T_camera_object.translation().x() = 5.0;
    if (i == 0) bad.state = TrackerState::kLost;
    if (i == 1) bad.visible_fraction = 0.1;
    if (i == 2) bad.score = 0.3;
    if (i == 3) bad.T_camera_object.translation().y() = std::nan("");
    memory.note(bad, "mug");
    EXPECT_EQ(memory.save(), "");
  }
  EXPECT_LT(recall("mug")->translation().x(), 1.0);
}

TEST_F(PoseMemoryTest, TellsWhenItCannotWrite) {
  PoseMemory memory("/dev/null/pose.json");
  EXPECT_EQ(memory.save(), "") << "nothing to write";
  memory.note(goodResult(), "mug");
  EXPECT_NE(memory.save().find("~last_pose_file '/dev/null/pose.json' cannot be written"), std::string::npos);
}

TEST_F(PoseMemoryTest, TellsWhatIsWrongWithAFile) {
  file_ = folder_.write("pose.json", "{\"object\": \"mug\", \"cam_R_m2c\": [1, 2");
  EXPECT_FALSE(recall("mug").has_value());
  EXPECT_NE(problem_.find("pose.json"), std::string::npos) << problem_;
  file_ = folder_.write("pose.json", "{\"object\": 7, \"cam_R_m2c\": [2,0,0,0,1,0,0,0,1], \"cam_t_m2c\": [0,0,1]}");
  EXPECT_FALSE(recall("mug").has_value());
  EXPECT_NE(problem_.find("not a rotation matrix"), std::string::npos) << problem_;
  file_ = folder_.path().string();
  EXPECT_FALSE(recall("mug").has_value());
}

}  // namespace
}  // namespace depth_object_tracker
