// SPDX-License-Identifier: BSD-3-Clause
// Errors, their summary, and what is written per frame.
#include "depth_object_tracker/geometry/mesh_loader.h"
#include "depth_object_tracker/tools/occlusion_picture.h"
#include "depth_object_tracker/tools/pose_error.h"
#include "depth_object_tracker/tools/sequence_summary.h"
#include "small_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <sstream>

namespace depth_object_tracker {
namespace {

using testing::HasSubstr;

TEST(NearestPointIndex, AgreesWithBruteForce) {
  std::mt19937 generator(4);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  const auto draw = [&] { return Eigen::Vector3f(uniform(generator), uniform(generator), uniform(generator)); };
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 500; ++i) points.push_back(draw());
  points.insert(points.end(), 40, points.front());  // equal points must not break the splits
  const NearestPointIndex index(points);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3f query = 1.5f * draw();
    float nearest = std::numeric_limits<float>::max();
    for (const Eigen::Vector3f& point : points) nearest = std::min(nearest, (point - query).norm());
    EXPECT_NEAR(index.distance(query), nearest, 1e-6f);
  }
}

TEST(PoseError, TranslationMovesAllPointsAlike) {
  const SmallScene scene(1);
  const PoseErrorMeter meter(loadMesh(scene.file("mesh.obj")), {});
  Vector6d delta = Vector6d::Zero();
  delta.head<3>() = Eigen::Vector3d(0.003, 0.0, -0.004);
  const PoseError error = meter.measure(perturb(SmallScene::truth(0), delta), SmallScene::truth(0));
  EXPECT_NEAR(error.add_m, 0.005, 1e-12);
  EXPECT_DOUBLE_EQ(error.adds_m, error.add_m);
  EXPECT_NEAR(error.translation_m, 0.005, 1e-12);
  EXPECT_NEAR(error.rotation_rad, 0.0, 1e-9);
}

TEST(PoseError, DeclaredSymmetriesAreNoError) {
  const SmallScene scene(1);
  Symmetries symmetries;
  symmetries.discrete.push_back(Pose(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX())));
  const PoseErrorMeter meter(loadMesh(scene.file("mesh.obj")), symmetries);
  const PoseError error = meter.measure(SmallScene::truth(0) * symmetries.discrete[0], SmallScene::truth(0));
  EXPECT_GT(error.add_m, 0.05);
  EXPECT_NEAR(error.adds_m, 0.0, 1e-6);
  EXPECT_NEAR(error.rotation_rad, 0.0, 1e-6);
}

TEST(PoseError, NormalisedErrorIsChiSquareDistributed) {
  const SmallScene scene(1);
  const TriangleMesh mesh = loadMesh(scene.file("mesh.obj"));
  Symmetries about_y;
  about_y.continuous.push_back({Eigen::Vector3d::UnitY(), Eigen::Vector3d(0.01, 0.0, 0.02)});
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  Vector6d stddev;
  stddev << 1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3;
  const Matrix6d covariance = stddev.cwiseAbs2().asDiagonal();
  for (const bool symmetric : {false, true}) {
    const PoseErrorMeter meter(mesh, symmetric ? about_y : Symmetries{});
    EXPECT_EQ(meter.degreesOfFreedom(), symmetric ? 5 : 6);
    double sum = 0.0;
    constexpr int kDraws = 4000;
    for (int i = 0; i < kDraws; ++i) {
      Vector6d e;
      for (int k = 0; k < 6; ++k) e(k) = stddev(k) * normal(generator);
      sum += meter.normalisedErrorSquared(perturb(SmallScene::truth(0), e), covariance, SmallScene::truth(0)).value();
    }
    const double standard_error = std::sqrt(2.0 * meter.degreesOfFreedom() / kDraws);
    EXPECT_NEAR(sum / kDraws, meter.degreesOfFreedom(), 4.0 * standard_error + 0.05) << symmetric;
  }
  EXPECT_FALSE(
      PoseErrorMeter(mesh, {}).normalisedErrorSquared(SmallScene::truth(0), Matrix6d::Zero(), SmallScene::truth(0)));
}

TEST(SequenceSummary, PercentilesAndAreaUnderCurve) {
  EXPECT_DOUBLE_EQ(percentile({3.0, 1.0, 2.0}, 0.5), 2.0);
  EXPECT_DOUBLE_EQ(percentile({1.0, 2.0}, 0.75), 1.75);
  EXPECT_TRUE(std::isnan(percentile({}, 0.5)));
  EXPECT_NEAR(areaUnderAccuracyCurve({0.0, 0.05, 0.2}), (1.0 + 0.5 + 0.0) / 3.0, 1e-12);
}

PoseError errorOf(double add_m) {
  return {add_m, add_m, add_m, 0.0};
}

TEST(SequenceSummary, ALossIsMoreThanFifteenFramesInARow) {
  SequenceSummary fifteen(false, 6), sixteen(false, 6);
  for (int k = 0; k < 40; ++k) {
    fifteen.add({}, errorOf(k >= 10 && k < 25 ? 0.06 : 0.001), std::nullopt, std::nullopt);
    sixteen.add({}, errorOf(k >= 10 && k < 26 ? 0.06 : 0.001), std::nullopt, std::nullopt);
  }
  EXPECT_EQ(fifteen.losses().episodes, 0);
  EXPECT_EQ(sixteen.losses().episodes, 1);
  EXPECT_EQ(sixteen.losses().frames, 16);
}

TEST(SequenceSummary, AHiddenObjectIsNoLoss) {
  SequenceSummary summary(false, 6);
  for (int k = 0; k < 60; ++k) {
    const bool hidden = k >= 10 && k < 40;
    summary.add({}, errorOf(hidden ? 0.3 : 0.001), std::nullopt, hidden ? 0.0 : 1.0);
  }
  EXPECT_EQ(summary.losses().episodes, 0);
  std::ostringstream text;
  summary.print(text);
  EXPECT_THAT(text.str(), HasSubstr("30 frames with at least 10 % of the object visible"));
}

TEST(OcclusionPicture, GreyValuesAsTheContractSays) {
  OcclusionMap map;
  map.grid = makeSamplingGrid({6, 3, 10.0, 10.0, 2.5, 1.0}, 3);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  map.p_occluded = {1.0f, 0.5f};  // cells over columns 0..2 and 3..5
  std::vector<float> object_depth(18, 1.0f);
  object_depth[0] = 0.0f;
  std::vector<std::uint8_t> picture = makeOcclusionPicture(map, object_depth, 6, 3, 0.25);
  EXPECT_EQ(picture[0], 0);        // off the object
  EXPECT_EQ(picture[1], 255);      // 1 + 254
  EXPECT_EQ(picture[5], 1 + 127);  // 1 + round(254 / 2)
  map.p_occluded = {nan, nan};
  EXPECT_EQ(makeOcclusionPicture(map, object_depth, 6, 3, 0.25)[7], 1 + 64);  // nothing known: the prior
  EXPECT_EQ(makeOcclusionPicture(map, {}, 6, 3, 0.25), std::vector<std::uint8_t>(18, 0));
}

}  // namespace
}  // namespace depth_object_tracker
