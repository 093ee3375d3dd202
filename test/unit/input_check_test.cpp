// SPDX-License-Identifier: BSD-3-Clause
// Each mistake in setting up is found and told by what to do; a good set-up is left in peace.
#include "depth_object_tracker/tracker/input_check.h"

#include "depth_object_tracker/geometry/mesh_loader.h"
#include "depth_object_tracker/render/depth_renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

using Kind = InputFinding::Kind;
constexpr double kMaxDepthM = 6.0;
constexpr float kWallM = 1.4f;

PinholeCamera goodCamera() {
  return {320, 240, 285.0, 285.0, 159.5, 119.5};
}

Pose goodPose() {
  Pose T_camera_object = Pose::Identity();
  T_camera_object.translation() = Eigen::Vector3d(0.03, -0.02, 0.6);
  T_camera_object.linear() = expSo3(Eigen::Vector3d(0.5, -0.4, 0.3));
  return T_camera_object;
}

class InputCheck : public testing::Test {
 protected:
  InputCheck()
      : mesh_(loadMesh(std::string(PROJECT_SOURCE_FOLDER) + "/meshes/bracket.obj")), depth_m_(320 * 240, kWallM) {
    DepthRenderer renderer(mesh_);
    for (const CoveredPixel& pixel : renderer.render(goodPose(), goodCamera())) {
      depth_m_[static_cast<std::size_t>(pixel.row) * 320 + static_cast<std::size_t>(pixel.col)] = pixel.depth;
    }
  }

  /// The image as 32FC1, each value times `factor`.
  DepthImageView floats(float factor = 1.0f) {
    floats_ = depth_m_;
    for (float& depth : floats_) depth *= factor;
    DepthImageView view;
    view.data = reinterpret_cast<const std::uint8_t*>(floats_.data());
    view.width = 320, view.height = 240, view.step = 320 * 4;
    view.pixel_type = DepthImageView::PixelType::kFloat32;
    view.unit_m = 1.0f;
    return view;
  }

  /// The image as 16UC1 with so many counts a metre.
  DepthImageView counts(float per_m = 1000.0f) {
    counts_.clear();
    for (const float depth : depth_m_) counts_.push_back(static_cast<std::uint16_t>(std::lround(depth * per_m)));
    DepthImageView view;
    view.data = reinterpret_cast<const std::uint8_t*>(counts_.data());
    view.width = 320, view.height = 240, view.step = 320 * 2;
    return view;
  }

  InputFindings lookAt(const DepthImageView& view, const PinholeCamera& camera, double mesh_scale = 1.0) {
    const DepthSummary summary = summariseDepth(view, kMaxDepthM);
    InputFindings findings = checkDepth(summary, view.pixel_type, kMaxDepthM);
    for (const auto& finding : checkCamera(camera, false)) findings.push_back(finding);
    if (findings.empty()) findings = checkMeshSize(diameter(mesh_) * mesh_scale, summary, camera);
    return findings;
  }

  InputFindings lookAtPose(const Pose& pose, const DepthImageView& view) {
    return checkInitialPose(mesh_, diameter(mesh_), pose, view, goodCamera());
  }

  static void expectOnly(const InputFindings& findings, Kind kind, const std::vector<std::string>& parts) {
    ASSERT_EQ(findings.size(), 1u) << (findings.empty() ? "nothing found" : findings.back().message);
    EXPECT_EQ(findings[0].kind, kind) << findings[0].message;
    for (const std::string& part : parts) {
      EXPECT_NE(findings[0].message.find(part), std::string::npos) << part << " is not in: " << findings[0].message;
    }
  }

  TriangleMesh mesh_;
  std::vector<float> depth_m_, floats_;
  std::vector<std::uint16_t> counts_;
};

TEST_F(InputCheck, LeavesAGoodSetUpInPeace) {
  EXPECT_TRUE(lookAt(floats(), goodCamera()).empty());
  EXPECT_TRUE(lookAt(counts(), goodCamera()).empty());
  EXPECT_TRUE(lookAtPose(goodPose(), counts()).empty());
}

TEST_F(InputCheck, NoDepth) {
  depth_m_.assign(depth_m_.size(), 0.0f);
  expectOnly(lookAt(counts(), goodCamera()), Kind::kNoDepth, {"no valid depth", "0.0 %", "lens"});
  depth_m_.assign(depth_m_.size(), std::numeric_limits<float>::quiet_NaN());
  expectOnly(lookAt(floats(), goodCamera()), Kind::kNoDepth, {"no valid depth"});
}

TEST_F(InputCheck, FloatsInMillimetres) {
  expectOnly(lookAt(floats(1000.0f), goodCamera()), Kind::kDepthUnit, {"1.4e+03 m", "32FC1 must be metres"});
}

TEST_F(InputCheck, CountsOfTenthsOfAMillimetre) {
  expectOnly(lookAt(counts(10000.0f), goodCamera()), Kind::kDepthUnit, {"14 m", "16UC1 must be millimetres"});
}

TEST_F(InputCheck, CountsOfCentimetresAndMetres) {
  for (float& depth : depth_m_) depth = std::min(depth, 0.9f);
  expectOnly(lookAt(counts(100.0f), goodCamera()), Kind::kDepthUnit, {"nearer", "16UC1 must be millimetres"});
  expectOnly(lookAt(counts(2.0f), goodCamera()), Kind::kDepthUnit, {"nearer", "16UC1 must be millimetres"});
}

TEST_F(InputCheck, CountsOfCentimetresAgainstTheInitialPose) {
  for (float& depth : depth_m_)
    depth *= 2.0f;  // far enough away that centimetres taken for millimetres look like depth
  Pose pose = goodPose();
  pose.translation().z() = 1.2;
  expectOnly(lookAtPose(pose, counts(100.0f)), Kind::kPoseDepth, {"1.2", "10^-1", "units"});
}

TEST_F(InputCheck, MeshInMillimetres) {
  expectOnly(lookAt(counts(), goodCamera(), 1000.0), Kind::kMeshTooLarge, {"mesh_scale", "0.001"});
}

TEST_F(InputCheck, MeshScaleAppliedTwice) {
  expectOnly(lookAt(counts(), goodCamera(), 0.001), Kind::kMeshTooSmall, {"mesh_scale", "1000"});
}

TEST_F(InputCheck, MeshInInches) {
  expectOnly(lookAt(counts(), goodCamera(), 1.0 / 0.0254), Kind::kMeshTooLarge, {"mesh_scale"});
}

TEST_F(InputCheck, FocalLengthsSwapped) {
  PinholeCamera camera = goodCamera();
  camera.fy = 380.0;  // of an image that was squeezed
  std::swap(camera.fx, camera.fy);
  expectOnly(checkCamera(camera, false), Kind::kPixelAspect, {"fx is 380.0", "fy 285.0", "swapped"});
}

TEST_F(InputCheck, PrincipalPointSwapped) {
  PinholeCamera camera = goodCamera();
  std::swap(camera.cx, camera.cy);
  expectOnly(checkCamera(camera, false), Kind::kPrincipalPoint, {"119.5", "320x240"});
}

TEST_F(InputCheck, CalibrationOfAnotherResolution) {
  PinholeCamera camera = goodCamera();
  camera.fx = camera.fy = 570.0;
  camera.cx = 319.5, camera.cy = 239.5;
  expectOnly(checkCamera(camera, false), Kind::kPrincipalPoint, {"(319.5, 239.5)", "about 640x480"});
}

TEST_F(InputCheck, CalibrationShifted) {
  PinholeCamera camera = goodCamera();
  camera.cx += 48.0;
  expectOnly(checkCamera(camera, false), Kind::kPrincipalPoint, {"207.5", "159.5"});
  EXPECT_TRUE(checkCamera(camera, true).empty()) << "a part of the picture may have its middle anywhere";
}

TEST_F(InputCheck, FocalLengthInMillimetres) {
  PinholeCamera camera = goodCamera();
  camera.fx = camera.fy = 4.2;
  expectOnly(checkCamera(camera, false), Kind::kFieldOfView, {"4.2", "pixels"});
}

TEST_F(InputCheck, PoseInTheAxesOfABodyFrame) {
  Pose pose = goodPose();  // x forward, y left, z up
  pose.translation() = Eigen::Vector3d(0.6, 0.1, -0.05);
  expectOnly(lookAtPose(pose, counts()), Kind::kPoseBehindCamera, {"z forward", "header.frame_id"});
}

TEST_F(InputCheck, PoseOutsideOfTheImage) {
  Pose pose = goodPose();
  pose.translation().x() = 1.5;
  expectOnly(lookAtPose(pose, counts()), Kind::kPoseOutsideImage, {"320x240", "pixel"});
}

TEST_F(InputCheck, PoseWhereNothingIs) {
  Pose pose = goodPose();
  pose.translation().x() -= 0.25;
  expectOnly(lookAtPose(pose, counts()), Kind::kPoseDepth, {"1.40 m", "not there"});
}

TEST_F(InputCheck, AHiddenObjectIsNoMistake) {
  for (float& depth : depth_m_) depth = 0.4f;  // a board before everything
  EXPECT_TRUE(lookAtPose(goodPose(), counts()).empty());
}

TEST_F(InputCheck, SurvivesAnything) {
  for (const float depth : {0.0f, 1e-30f, 1e30f, std::numeric_limits<float>::infinity()}) {
    depth_m_.assign(depth_m_.size(), depth);
    const auto view = floats();
    EXPECT_FALSE(lookAt(view, goodCamera()).empty()) << depth;
    lookAtPose(goodPose(), view);
  }
  EXPECT_TRUE(checkCamera(PinholeCamera(), false).empty());
}

}  // namespace
}  // namespace depth_object_tracker
