// SPDX-License-Identifier: BSD-3-Clause
// What looks like the object, but was there when the object was surely seen elsewhere.
#include "depth_object_tracker/tracker/distractors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace depth_object_tracker {
namespace {

const PinholeCamera kCamera{64, 48, 60.0, 60.0, 31.5, 23.5};
constexpr float kWallM = 1.5f, kObjectM = 0.8f;

Pose at(double x, double y, double z) {
  Pose T = Pose::Identity();
  T.translation() << x, y, z;
  return T;
}

/// A square plate of 20 cm before the camera.
TriangleMesh plate() {
  TriangleMesh mesh;
  mesh.vertices = {{-0.1f, -0.1f, 0.0f}, {0.1f, -0.1f, 0.0f}, {0.1f, 0.1f, 0.0f}, {-0.1f, 0.1f, 0.0f}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// A wall; the plate before it where it is seen, and a finger before the plate.
class DistractorsOfAPlate : public testing::Test {
 protected:
  DistractorsOfAPlate() : distractors_(plate(), Eigen::Vector3d::Zero()), depth_m_(64 * 48, kWallM) {
    for (int row = 17; row < 31; ++row) {
      for (int col = 25; col < 39; ++col) depth_m_[index(row, col)] = kObjectM;
    }
    depth_m_[index(24, 32)] = kFingerM;
    remember();
  }

  static std::size_t index(int row, int col) {
    return static_cast<std::size_t>(row) * 64 + static_cast<std::size_t>(col);
  }

  void remember() {
    DepthImageView view;
    view.data = reinterpret_cast<const std::uint8_t*>(depth_m_.data());
    view.width = kCamera.width;
    view.height = kCamera.height;
    view.step = sizeof(float) * 64;
    view.pixel_type = DepthImageView::PixelType::kFloat32;
    view.unit_m = 1.0f;
    distractors_.remember(view, kCamera, object_);
  }

  static constexpr float kFingerM = 0.7f;
  const Pose object_ = at(0.0, 0.0, 0.8), arm_ = at(0.3, 0.0, 0.8);
  Distractors distractors_;
  std::vector<float> depth_m_;
};

TEST_F(DistractorsOfAPlate, AreLookedForOnceInTheImageWithoutTheObject) {
  const auto scene = distractors_.unsearched();
  ASSERT_TRUE(scene.has_value());
  EXPECT_TRUE(scene->T_camera_centre.isApprox(object_));
  EXPECT_EQ(scene->camera, kCamera);
  int object = 0, wall = 0, finger = 0;
  for (int row = 0; row < kCamera.height; ++row) {
    for (int col = 0; col < kCamera.width; ++col) {
      const float z = scene->depth.at(row, col);
      object += std::abs(z - kObjectM) < 0.01f ? 1 : 0;
      wall += std::abs(z - kWallM) < 0.01f ? 1 : 0;
      finger += std::abs(z - kFingerM) < 0.01f ? 1 : 0;
    }
  }
  EXPECT_EQ(object, 0);
  EXPECT_EQ(wall, 64 * 48 - 14 * 14);
  EXPECT_EQ(finger, 1) << "before the object, not of it";
  EXPECT_FALSE(distractors_.unsearched().has_value());
  remember();
  EXPECT_TRUE(distractors_.unsearched().has_value());
}

TEST_F(DistractorsOfAPlate, SpeakAgainstAPoseWhereTheyWere) {
  EXPECT_EQ(distractors_.against(arm_, object_, 0.5), 0.0) << "none are known yet";
  distractors_.found({arm_, object_});
  EXPECT_GT(distractors_.against(arm_, object_, 0.5), 4.0);
  EXPECT_EQ(distractors_.against(object_, object_, 0.5), 0.0) << "the object is no distractor of itself";
  EXPECT_EQ(distractors_.against(at(-0.5, 0.3, 1.2), object_, 0.5), 0.0) << "nothing was there";
}

TEST_F(DistractorsOfAPlate, MayBeWhereTheObjectMayBeInTime) {
  distractors_.found({arm_});
  const double soon = distractors_.against(at(0.24, 0.0, 0.8), object_, 0.5);
  EXPECT_GT(soon, 2.0);
  EXPECT_LT(distractors_.against(at(0.24, 0.0, 0.8), object_, 10.0), 0.1 * soon);
  EXPECT_EQ(distractors_.against(at(0.24, 0.0, 0.8), at(0.26, 0.0, 0.8), 0.5), 0.0) << "the object is expected there";
}

TEST_F(DistractorsOfAPlate, StayWhereTheyAreWhenTheCameraMoves) {
  distractors_.found({arm_});
  const Pose T_now_before = at(0.1, 0.0, 0.0);
  distractors_.moveCamera(T_now_before);
  EXPECT_GT(distractors_.against(T_now_before * arm_, T_now_before * object_, 0.5), 4.0);
}

TEST_F(DistractorsOfAPlate, AreNoneWhenWhatWasFollowedMayBeSomethingElse) {
  distractors_.found({arm_});
  remember();
  distractors_.forget();
  EXPECT_FALSE(distractors_.unsearched().has_value());
  EXPECT_EQ(distractors_.against(arm_, object_, 0.5), 0.0);
}

TEST_F(DistractorsOfAPlate, AreForgottenWhenTheObjectIsSeenAgain) {
  distractors_.found({arm_});
  remember();
  EXPECT_EQ(distractors_.against(arm_, object_, 0.5), 0.0);
}

}  // namespace
}  // namespace depth_object_tracker
