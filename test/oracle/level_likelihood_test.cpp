// SPDX-License-Identifier: BSD-3-Clause
// The likelihood with simplified meshes against the likelihood with the mesh itself: the same order of poses, and its
// mode in the same place.
#include "depth_object_tracker/filter/depth_likelihood.h"
#include "depth_object_tracker/geometry/mesh_loader.h"
#include "depth_object_tracker/render/depth_renderer.h"

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

namespace depth_object_tracker {
namespace {

constexpr int kTrials = 10;
constexpr int kPosesPerTrial = 50;
const PinholeCamera kCamera{640, 480, 525.0, 525.0, 319.5, 239.5};

std::string sharedMeshes() {
  const char* folder = std::getenv("DEPTH_OBJECT_TRACKER_DATA");
  return std::string(folder != nullptr ? folder : SHARED_DATA_FOLDER) + "/meshes/";
}

struct Case {
  std::string mesh;
  int factor;  // 2: about what is chosen automatically; 5: the paper's
};

class LevelLikelihood : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    const std::string path = GetParam().mesh;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    mesh_ = loadMesh(path, 1.0);
    centre_ = surfaceCentroid(mesh_);
    full_ = std::make_unique<DepthLikelihood>(mesh_, centre_, pixel_config_, OcclusionChainConfig(), 1, 1, false);
    simplified_ = std::make_unique<DepthLikelihood>(mesh_, centre_, pixel_config_, OcclusionChainConfig(), 1, 1);
  }

  Pose randomPose() {
    Pose pose = Pose::Identity();
    const Eigen::Vector3d axis(normal_(engine_), normal_(engine_), normal_(engine_));
    pose.linear() = Eigen::AngleAxisd(3.0 * normal_(engine_), axis.normalized()).toRotationMatrix();
    pose.translation() = Eigen::Vector3d(0.05 * normal_(engine_), 0.05 * normal_(engine_), 0.7);
    return pose;
  }

  /// A structured-light image of the object at a pose before a wall, shown to both likelihoods.
  void show(const Pose& T_camera_centre) {
    image_.assign(static_cast<std::size_t>(kCamera.width * kCamera.height), 2.0f);
    Pose T_camera_object = T_camera_centre;
    T_camera_object.translation() -= T_camera_centre.linear() * centre_;
    DepthRenderer renderer(mesh_);
    for (const CoveredPixel& pixel : renderer.render(T_camera_object, kCamera)) {
      image_[static_cast<std::size_t>(pixel.row * kCamera.width + pixel.col)] = pixel.depth;
    }
    for (float& z : image_) z += 1.425e-3f * z * z * static_cast<float>(normal_(engine_));
    DepthImageView view;
    view.data = reinterpret_cast<const std::uint8_t*>(image_.data());
    view.width = kCamera.width;
    view.height = kCamera.height;
    view.step = static_cast<std::size_t>(kCamera.width) * sizeof(float);
    view.pixel_type = DepthImageView::PixelType::kFloat32;
    view.unit_m = 1.0f;
    Pose nearer = T_camera_centre, farther = T_camera_centre;
    nearer.translation().z() -= 0.05;
    farther.translation().z() += 0.05;
    for (DepthLikelihood* likelihood : {full_.get(), simplified_.get()}) {
      likelihood->setImage(view, makeSamplingGrid(kCamera, GetParam().factor), 0.033);
      likelihood->prepare({T_camera_centre, nearer, farther});
    }
  }

  /// Highest point on the way from a start, damped Gauss-Newton with a wide prior for what the image does not tell.
  static Pose climb(DepthLikelihood& likelihood, const Pose& start) {
    Pose pose = start, best = start;
    double highest = -1e9;
    for (int step = 0; step < 25; ++step) {
      const Linearisation model = likelihood.linearise(pose, 0.0, 0);
      Matrix6d information = model.information;
      information.diagonal().head<3>().array() += 25.0;  // 1 / (0.2 m)^2
      information.diagonal().tail<3>().array() += 0.1;
      pose = perturb(pose, 0.7 * information.ldlt().solve(model.gradient));
      const double log_likelihood = likelihood.logLikelihood(pose, 0);
      if (log_likelihood <= highest) continue;
      highest = log_likelihood;
      best = pose;
    }
    return best;
  }

  /// How far two likelihoods' modes are apart [m]: for each the higher one of the maxima that climbs from two starts
  /// reach.
  static double modeShift(DepthLikelihood& one, DepthLikelihood& other, const Pose& truth) {
    const Pose from_truth = climb(one, truth), other_from_truth = climb(other, truth);
    const Pose mode = higher(one, from_truth, climb(one, other_from_truth));
    const Pose other_mode = higher(other, other_from_truth, climb(other, from_truth));
    return (mode.translation() - other_mode.translation()).norm();
  }

  static Pose higher(DepthLikelihood& likelihood, const Pose& one, const Pose& other) {
    return likelihood.logLikelihood(one, 0) >= likelihood.logLikelihood(other, 0) ? one : other;
  }

  PixelModelConfig pixel_config_;
  TriangleMesh mesh_;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  std::unique_ptr<DepthLikelihood> full_, simplified_;
  std::vector<float> image_;
  std::mt19937 engine_{20};
  std::normal_distribution<double> normal_;
};

const std::string kMeshes = std::string(PROJECT_SOURCE_FOLDER) + "/meshes/";
INSTANTIATE_TEST_SUITE_P(Meshes, LevelLikelihood,
                         testing::Values(Case{kMeshes + "drill.obj", 2}, Case{kMeshes + "drill.obj", 5},
                                         Case{kMeshes + "mug.obj", 2}, Case{kMeshes + "mug.obj", 5},
                                         Case{kMeshes + "bottle.obj", 2}, Case{sharedMeshes() + "YcbPowerDrill.obj", 2},
                                         Case{sharedMeshes() + "YcbPowerDrill.obj", 5},
                                         Case{sharedMeshes() + "YcbMustardBottle.obj", 2},
                                         Case{sharedMeshes() + "YcbScissors.obj", 2}),
                         [](const testing::TestParamInfo<Case>& parameter) {
                           return std::filesystem::path(parameter.param.mesh).stem().string() + "Factor" +
                                  std::to_string(parameter.param.factor);
                         });

TEST_P(LevelLikelihood, PosesKeepTheirOrderAndTheModeItsPlace) {
  std::vector<double> shifts_m;
  int agreeing = 0, compared = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Pose truth = randomPose();
    show(truth);
    ASSERT_LT(simplified_->renderedTriangles(), full_->renderedTriangles()) << "nothing is simplified";
    const Pose pose = climb(*full_, truth);
    shifts_m.push_back(modeShift(*full_, *simplified_, truth));
    std::vector<double> with_mesh, with_level;
    for (int k = 0; k < kPosesPerTrial; ++k) {
      Vector6d displacement;
      for (int i = 0; i < 6; ++i) displacement[i] = normal_(engine_) * (i < 3 ? 0.002 : 0.02);
      with_mesh.push_back(full_->logLikelihood(perturb(pose, displacement), 0));
      with_level.push_back(simplified_->logLikelihood(perturb(pose, displacement), 0));
    }
    for (std::size_t i = 0; i < with_mesh.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (std::abs(with_mesh[i] - with_mesh[j]) <= 1.0) continue;
        ++compared;
        agreeing += (with_mesh[i] > with_mesh[j]) == (with_level[i] > with_level[j]) ? 1 : 0;
      }
    }
  }
  std::sort(shifts_m.begin(), shifts_m.end());
  const auto share = [&](std::size_t percent) { return 1e3 * shifts_m[(shifts_m.size() - 1) * percent / 100]; };
  std::printf("%zu of %zu triangles: order kept %.2f %%, mode moves %.4f mm (median), %.4f (80 %%), %.4f (largest)\n",
              simplified_->renderedTriangles(), full_->renderedTriangles(), 100.0 * agreeing / compared, share(50),
              share(80), share(100));
  EXPECT_GE(agreeing, 0.99 * compared);
  // The likelihood is rough by several nats (pixels at the outline are in or out as a whole): the largest moves are
  // jumps between neighbouring maxima, of which there are many with 200 to 450 pixels (factor 5).
  EXPECT_LE(share(GetParam().factor == 2 ? 80 : 50), 0.05);
}

}  // namespace
}  // namespace depth_object_tracker
