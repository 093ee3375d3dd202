// SPDX-License-Identifier: BSD-3-Clause
// The likelihood's linear model against finite differences, where the outline is out of the image.
#include "depth_object_tracker/filter/depth_likelihood.h"
#include "depth_object_tracker/render/depth_renderer.h"

#include "plate_scene.h"

#include <gtest/gtest.h>

namespace depth_object_tracker {
namespace {

class PlateLikelihood : public testing::Test {
 protected:
  PlateLikelihood() : camera_(makeCamera(24, 18, 30.0)), mesh_(makePlate(3.0f)), centre_object_(0.1, -0.2, 0.05) {
    likelihood_.emplace(mesh_, centre_object_, PixelModelConfig(), OcclusionChainConfig(), 1, 1);
    true_pose_ = poseAt(0.02, -0.03, 1.1);
    true_pose_.linear() = expSo3({0.4, -0.3, 0.2});
    depth_m_.assign(static_cast<std::size_t>(camera_.width * camera_.height), 0.0f);
    Pose T_camera_object = true_pose_;
    T_camera_object.translation() -= true_pose_.linear() * centre_object_;
    DepthRenderer renderer(mesh_);
    for (const CoveredPixel& pixel : renderer.render(T_camera_object, camera_)) {
      depth_m_[static_cast<std::size_t>(pixel.row * camera_.width + pixel.col)] = pixel.depth;
    }
    likelihood_->setImage(viewOf(depth_m_, camera_), makeSamplingGrid(camera_, 1), 0.0);
    likelihood_->prepare({true_pose_});
  }

  /// Central differences of the log-likelihood; steps small against the noise, large against single precision.
  Vector6d numericGradient(const Pose& pose) {
    Vector6d gradient;
    for (int axis = 0; axis < 6; ++axis) {
      const double step = axis < 3 ? 2e-4 : 4e-4;
      gradient[axis] = (value(pose, axis, step) - value(pose, axis, -step)) / (2.0 * step);
    }
    return gradient;
  }

  double value(const Pose& pose, int axis, double step) {
    Vector6d delta = Vector6d::Zero();
    delta[axis] = step;
    return likelihood_->logLikelihood(perturb(pose, delta), 0);
  }

  PinholeCamera camera_;
  TriangleMesh mesh_;
  Eigen::Vector3d centre_object_;
  Pose true_pose_;
  std::vector<float> depth_m_;
  std::optional<DepthLikelihood> likelihood_;
};

TEST_F(PlateLikelihood, CoversTheWholeImage) {
  const PoseAssessment assessment = likelihood_->assess(true_pose_, 0);
  EXPECT_EQ(assessment.covered_pixels, camera_.width * camera_.height);
  EXPECT_EQ(assessment.measured_pixels, camera_.width * camera_.height);
  EXPECT_GT(assessment.visible_pixels, 0.99 * camera_.width * camera_.height);
}

TEST_F(PlateLikelihood, GradientIsThatOfTheLogLikelihood) {
  Vector6d offset;
  offset << 0.001, -0.002, 0.002, 0.002, -0.003, 0.001;
  for (const double scale : {0.5, 1.0, -1.0}) {
    const Pose pose = perturb(true_pose_, scale * offset);
    const Vector6d numeric = numericGradient(pose);
    const Vector6d analytic = likelihood_->linearise(pose, 0.0, 0).gradient;
    EXPECT_LT((analytic - numeric).norm(), 0.03 * numeric.norm()) << analytic.transpose() << "\n"
                                                                  << numeric.transpose();
  }
}

TEST_F(PlateLikelihood, InformationIsTheCurvatureAtThePeak) {
  const Linearisation model = likelihood_->linearise(true_pose_, 0.0, 0);
  const double slope = model.gradient.head<3>().norm();
  const double curvature_m = model.information.topLeftCorner(3, 3).norm();
  EXPECT_LT(slope, 1e-5 * curvature_m) << "the peak is within 10 micrometres";
  for (int axis = 0; axis < 6; ++axis) {
    const double step = 5e-4;
    const double sum = value(true_pose_, axis, step) + value(true_pose_, axis, -step);
    const double curvature = (sum - 2.0 * value(true_pose_, axis, 0.0)) / (step * step);
    EXPECT_NEAR(model.information(axis, axis), -curvature, 0.05 * model.information.diagonal().head<3>().maxCoeff())
        << "axis " << axis;
  }
  EXPECT_LT((model.information - model.information.transpose()).norm(), 1e-9 * model.information.norm());
}

TEST_F(PlateLikelihood, WiderNoisePullsFromFarther) {
  const Pose far = perturb(true_pose_, (Vector6d() << 0, 0, 0.03, 0, 0, 0).finished());
  const double narrow = likelihood_->linearise(far, 0.0, 0).gradient.z();
  const Linearisation wide = likelihood_->linearise(far, 0.03, 0);
  EXPECT_LT(wide.gradient.z(), 100.0 * std::min(narrow, -1e-6)) << "the pull goes back to the data";
  const double newton = wide.gradient.z() / wide.information(2, 2);
  EXPECT_NEAR(newton, -0.03, 0.003);
}

TEST_F(PlateLikelihood, PosesOutsideOfThePreparedRegionAreRefused) {
  likelihood_.emplace(makePlate(0.05f), Eigen::Vector3d::Zero(), PixelModelConfig(), OcclusionChainConfig(), 1, 1);
  likelihood_->setImage(viewOf(depth_m_, camera_), makeSamplingGrid(camera_, 1), 0.0);
  likelihood_->prepare({poseAt(-0.25, 0, 1)});
  EXPECT_TRUE(std::isfinite(likelihood_->logLikelihood(poseAt(-0.25, 0, 1), 0)));
  EXPECT_EQ(likelihood_->logLikelihood(poseAt(0.25, 0, 1), 0), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(likelihood_->linearise(poseAt(0.25, 0, 1), 0.0, 0).information.norm(), 0.0);
}

TEST_F(PlateLikelihood, EveryPreparedPoseHasAValue) {
  // The corners of an octahedron's box are farther from its middle than any of its points.
  TriangleMesh octahedron;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-0.1f, 0.1f}) octahedron.vertices.push_back(side * Eigen::Vector3f::Unit(axis));
  }
  for (const std::uint32_t x : {0u, 1u}) {
    for (const std::uint32_t y : {2u, 3u}) {
      for (const std::uint32_t z : {4u, 5u}) octahedron.triangles.push_back({x, y, z});
    }
  }
  const PinholeCamera camera = makeCamera(160, 120, 200.0);
  const std::vector<float> image(static_cast<std::size_t>(camera.width * camera.height), 1.2f);
  for (int k = 0; k < 50; ++k) {
    likelihood_.emplace(octahedron, Eigen::Vector3d::Zero(), PixelModelConfig(), OcclusionChainConfig(), 1, 1);
    likelihood_->setImage(viewOf(image, camera), makeSamplingGrid(camera, 1), 0.0);
    Pose pose = poseAt(0.05, -0.02, 1.0);
    pose.linear() = expSo3(0.05 * k * Eigen::Vector3d(1.0, -0.7, 0.4));
    likelihood_->prepare({pose});
    EXPECT_TRUE(std::isfinite(likelihood_->logLikelihood(pose, 0))) << k;
  }
}

}  // namespace
}  // namespace depth_object_tracker
