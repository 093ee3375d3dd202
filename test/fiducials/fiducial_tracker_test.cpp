// SPDX-License-Identifier: BSD-3-Clause
// The whole way from the simulated cameras to the pose: good while tags are seen, honest when none is.
#include "depth_object_tracker/fiducials/fiducial_tracker.h"

#include "depth_object_tracker/geometry/mesh_loader.h"
#include "depth_object_tracker/simulator/scene_simulator.h"
#include "depth_object_tracker/simulator/stereo_pair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

const std::string kFolder = PROJECT_SOURCE_FOLDER;

class TaggedBox : public testing::Test {
 protected:
  static SimulationConfig configOf(Occluders occluders) {
    SimulationConfig config;
    config.occluders = occluders;
    config.seed = 3;
    config.first_rest_s = 0.1;
    config.fiducials_file = kFolder + "/config/fiducials/box.yaml";
    return config;
  }

  explicit TaggedBox(Occluders occluders = Occluders::kNone)
      : config_(configOf(occluders)),
        mesh_(loadMesh(kFolder + "/meshes/box.obj")),
        simulator_(mesh_, config_),
        tracker_(loadFiducialMap(config_.fiducials_file), FiducialTrackerConfig()) {}

  const FiducialEstimate& step(double stamp_s) {
    const SimulatedFrame& frame = simulator_.render(stamp_s);
    truth_ = leftCameraPose(config_.stereo).inverse() * frame.T_camera_object;
    return tracker_.updateStereo(view(frame.left), view(frame.right),
                                 {config_.stereo.camera, config_.stereo.baseline_m}, stamp_s);
  }

  GrayImageView view(const std::vector<std::uint8_t>& pixels) const {
    const PinholeCamera& camera = config_.stereo.camera;
    return {pixels.data(), camera.width, camera.height, static_cast<std::size_t>(camera.width)};
  }

  /// Mean distance of the mesh's vertices [m].
  double add(const Pose& T_camera_object) const {
    double sum = 0.0;
    for (const Eigen::Vector3f& vertex : mesh_.vertices) {
      sum += (T_camera_object * vertex.cast<double>() - truth_ * vertex.cast<double>()).norm();
    }
    return sum / static_cast<double>(mesh_.vertices.size());
  }

  SimulationConfig config_;
  TriangleMesh mesh_;
  SceneSimulator simulator_;
  FiducialTracker tracker_;
  Pose truth_;
};

TEST_F(TaggedBox, IsTrackedWithinTwoMillimetres) {
  std::vector<double> errors;
  for (int frame = 0; frame < 15; ++frame) {
    const FiducialEstimate& estimate = step(0.1 * frame);
    if (estimate.hasPose()) errors.push_back(add(estimate.T_camera_object));
  }
  ASSERT_GT(errors.size(), 10U);
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.002);
}

TEST_F(TaggedBox, HiddenTagsAreHiddenAndThenLost) {
  int frame = 0;
  for (; frame < 20 && step(0.1 * frame).state != FiducialState::kTracking; ++frame) {
  }
  ASSERT_EQ(tracker_.estimate().state, FiducialState::kTracking);
  const double uncertainty = tracker_.estimate().covariance.trace();
  const std::vector<std::uint8_t> dark(static_cast<std::size_t>(1024 * 768), 10);
  const StereoCamera camera{config_.stereo.camera, config_.stereo.baseline_m};
  const double from_s = 0.1 * frame;
  EXPECT_EQ(tracker_.updateStereo(view(dark), view(dark), camera, from_s + 0.3).state, FiducialState::kHidden);
  EXPECT_GT(tracker_.estimate().covariance.trace(), uncertainty);
  EXPECT_EQ(tracker_.updateStereo(view(dark), view(dark), camera, from_s + 1.5).state, FiducialState::kLost);
  EXPECT_FALSE(tracker_.estimate().hasPose());
}

TEST_F(TaggedBox, ComesBackAfterALossAndAfterAJumpInTime) {
  const std::vector<std::uint8_t> dark(static_cast<std::size_t>(1024 * 768), 10);
  const StereoCamera camera{config_.stereo.camera, config_.stereo.baseline_m};
  EXPECT_EQ(tracker_.updateStereo(view(dark), view(dark), camera, 50.0).state, FiducialState::kUninitialized);
  int frame = 0;
  for (; frame < 20 && step(0.1 * frame).state != FiducialState::kTracking; ++frame) {
  }
  EXPECT_EQ(tracker_.estimate().state, FiducialState::kTracking);
  EXPECT_LT(add(tracker_.estimate().T_camera_object), 0.006);
}

TEST(FiducialTracker, RefusesAMapThatCannotBe) {
  EXPECT_THROW(FiducialTracker(FiducialMap(), FiducialTrackerConfig()), std::invalid_argument);
  FiducialMap map;
  map.tags.emplace_back();
  map.tags.back().id = 100000;
  EXPECT_THROW(FiducialTracker(map, FiducialTrackerConfig()), std::invalid_argument);
}

}  // namespace
}  // namespace depth_object_tracker
