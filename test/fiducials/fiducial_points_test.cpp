// SPDX-License-Identifier: BSD-3-Clause
// Corners in pictures become points in space, with the uncertainty that they have.
#include "depth_object_tracker/fiducials/fiducial_points.h"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <random>

namespace depth_object_tracker {
namespace {

const StereoCamera kStereo{{1024, 768, 840.0, 840.0, 511.5, 383.5}, 0.12};

FiducialMap oneTag() {
  FiducialMap map;
  Fiducial tag;
  tag.id = 5;
  tag.size_m = 0.04;
  map.tags.push_back(tag);
  return map;
}

Pose somePose() {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(0.05, -0.02, 0.7);
  pose.linear() = expSo3(Eigen::Vector3d(0.4, -0.3, 0.2));
  return pose;
}

TagDetection project(const Fiducial& tag, const Pose& T_view_object, const PinholeCamera& camera) {
  TagDetection detection;
  detection.id = tag.id;
  const auto corners = tag.corners();
  for (std::size_t k = 0; k < 4; ++k) detection.corners[k] = camera.project(T_view_object * corners[k]);
  return detection;
}

TagDetection projectRight(const Fiducial& tag, const Pose& T_left_object) {
  return project(tag, Eigen::Translation3d(-kStereo.baseline_m, 0.0, 0.0) * T_left_object, kStereo.left);
}

TEST(Triangulation, RecoversTheCorners) {
  const FiducialMap map = oneTag();
  const auto points = triangulateTags(map, {project(map.tags[0], somePose(), kStereo.left)},
                                      {projectRight(map.tags[0], somePose())}, kStereo, {});
  ASSERT_EQ(points.size(), 4U);
  for (const FiducialPoint& point : points) {
    EXPECT_EQ(point.tag_id, 5);
    EXPECT_LT((point.p_camera - somePose() * point.p_object).norm(), 1e-9);
  }
}

TEST(Triangulation, CovarianceIsThatOfNoisyCorners) {
  const FiducialMap map = oneTag();
  FiducialNoise noise;
  noise.corner_stddev_px = 0.3;
  std::mt19937 engine(1);
  std::normal_distribution<double> normal(0.0, noise.corner_stddev_px);
  const TagDetection left = project(map.tags[0], somePose(), kStereo.left),
                     right = projectRight(map.tags[0], somePose());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  constexpr int kDraws = 4000;
  for (int k = 0; k < kDraws; ++k) {
    TagDetection noisy_left = left, noisy_right = right;
    noisy_left.corners[0] += Eigen::Vector2d(normal(engine), normal(engine));
    noisy_right.corners[0] += Eigen::Vector2d(normal(engine), normal(engine));
    const auto points = triangulateTags(map, {noisy_left}, {noisy_right}, kStereo, noise);
    const Eigen::Vector3d error = points.at(0).p_camera - somePose() * points.at(0).p_object;
    scatter += error * error.transpose() / kDraws;
  }
  const Eigen::Matrix3d predicted = triangulateTags(map, {left}, {right}, kStereo, noise).at(0).covariance;
  EXPECT_LT((scatter - predicted).norm(), 0.1 * predicted.norm());
}

TEST(Triangulation, LeavesOutWhatDoesNotFit) {
  const FiducialMap map = oneTag();
  const TagDetection left = project(map.tags[0], somePose(), kStereo.left);
  TagDetection right = projectRight(map.tags[0], somePose());
  EXPECT_TRUE(triangulateTags(map, {left}, {}, kStereo, {}).empty());
  EXPECT_TRUE(triangulateTags(map, {right}, {left}, kStereo, {}).empty());  // behind the cameras
  right.corners[2].y() += 5.0;                                              // another row
  EXPECT_EQ(triangulateTags(map, {left}, {right}, kStereo, {}).size(), 3U);
  TagDetection stranger = left;
  stranger.id = 6;
  EXPECT_TRUE(triangulateTags(map, {stranger}, {stranger}, kStereo, {}).empty());
}

TEST(RegisteredDepth, RecoversTheCornersFromTheTagsPlane) {
  const FiducialMap map = oneTag();
  const PinholeCamera camera{640, 480, 525.0, 525.0, 319.5, 239.5};
  const Pose pose = somePose();
  const Eigen::Vector3d normal = pose.linear().col(2);
  std::vector<float> depth(640 * 480);
  for (int row = 0; row < 480; ++row) {
    for (int col = 0; col < 640; ++col) {
      depth[static_cast<std::size_t>(row * 640 + col)] =
          static_cast<float>(normal.dot(pose.translation()) / normal.dot(camera.ray(col, row)));
    }
  }
  DepthImageView view;
  view.data = reinterpret_cast<const std::uint8_t*>(depth.data());
  view.width = 640;
  view.height = 480;
  view.step = 640 * sizeof(float);
  view.pixel_type = DepthImageView::PixelType::kFloat32;
  view.unit_m = 1.0f;
  const TagDetection detection = project(map.tags[0], pose, camera);
  const auto points = locateTagsByDepth(map, {detection}, view, camera, {});
  ASSERT_EQ(points.size(), 4U);
  for (const FiducialPoint& point : points) EXPECT_LT((point.p_camera - pose * point.p_object).norm(), 1e-4);
  depth.assign(depth.size(), 0.0f);  // no readings
  EXPECT_TRUE(locateTagsByDepth(map, {detection}, view, camera, {}).empty());
}

}  // namespace
}  // namespace depth_object_tracker
