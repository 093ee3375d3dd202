// SPDX-License-Identifier: BSD-3-Clause
// Program: tracks an object by the AprilTags on it, in the grey stereo pictures of a scene folder.
#include "depth_object_tracker/fiducials/fiducial_tracker.h"
#include "depth_object_tracker/tools/bop_scene.h"
#include "depth_object_tracker/tools/estimate_csv.h"
#include "depth_object_tracker/tools/input_error.h"
#include "depth_object_tracker/tools/progress_bar.h"
#include "depth_object_tracker/tools/sequence_inputs.h"
#include "stereo_scene.h"

#include <CLI/CLI.hpp>

#include <chrono>
#include <iostream>

namespace {

using namespace depth_object_tracker;

constexpr double kPredictedScore = 0.5;  // no tag is seen, but the pose may still hold

struct Options {
  std::string scene, output, fiducials, init;
  int object_id = 1, stride = 1;
  double fps = 30.0;
  bool use_control = true;
};

void addOptions(CLI::App& app, Options& options) {
  app.add_option("scene", options.scene, "scene folder with stereo.json, stereo/left and stereo/right")->required();
  app.add_option("--output", options.output, "estimates, BOP's result format")->required();
  app.add_option("--fiducials", options.fiducials, "AprilTags on the object; default: SCENE/fiducials.yaml");
  app.add_option("--init", options.init, "pose before the first tag is seen; default: the first ground truth");
  app.add_option("--object-id", options.object_id)->capture_default_str();
  app.add_option("--stride", options.stride, "every Nth frame")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--fps", options.fps, "for frames without timestamp")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  app.add_flag("!--no-control", options.use_control, "ignore scene_control.json");
}

Pose initialPose(const Options& options, const BopScene& scene) {
  if (!options.init.empty()) return loadPoseFile(options.init);
  if (scene.first_truth) return *scene.first_truth;
  throw InputError("no initial pose: give --init FILE, or a scene with scene_gt.json");
}

/// The initial pose is told until the first tag is seen, the last pose when lost, both with score 0.
TrackerResult toResult(const FiducialEstimate& estimate, const Pose& T_camera_left) {
  TrackerResult result;
  result.has_pose = true;
  result.T_camera_object = T_camera_left * estimate.T_camera_object;
  result.state = estimate.state == FiducialState::kTracking ? TrackerState::kTracking
                 : estimate.hasPose()                       ? TrackerState::kOccluded
                                                            : TrackerState::kLost;
  result.score = estimate.state == FiducialState::kTracking ? 1.0 : estimate.hasPose() ? kPredictedScore : 0.0;
  return result;
}

/// One frame after the other; a frame without a pair of pictures counts as one in which nothing is seen.
class SceneRun {
 public:
  SceneRun(const Options& options, const BopScene& scene)
      : stereo_(loadStereoScene(options.scene)), tracker_(loadFiducialMap(mapFile(options)), FiducialTrackerConfig()) {
    Matrix6d covariance = Matrix6d::Zero();
    covariance.diagonal() << Eigen::Vector3d::Constant(1e-4), Eigen::Vector3d::Constant(2e-2);
    tracker_.initialise(stereo_.T_camera_left.inverse() * initialPose(options, scene), covariance);
  }

  TrackerResult process(const SceneFrame& frame) {
    StereoPictures pictures = readStereoPictures(stereo_, frame.id);
    if (!pictures.isUsable()) {
      warnUser("frame " + std::to_string(frame.id) + " has no pair of stereo pictures of one size");
      pictures.left = pictures.right = cv::Mat(8, 8, CV_8UC1, cv::Scalar(0));
    }
    stereo_.camera.left.width = pictures.left.cols;
    stereo_.camera.left.height = pictures.left.rows;
    const auto start = std::chrono::steady_clock::now();
    TrackerResult result = toResult(tracker_.updateStereo(viewOf(pictures.left), viewOf(pictures.right), stereo_.camera,
                                                          frame.stamp_s, frame.control),
                                    stereo_.T_camera_left);
    result.time.total_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
  }

 private:
  static std::string mapFile(const Options& options) {
    return options.fiducials.empty() ? options.scene + "/fiducials.yaml" : options.fiducials;
  }

  StereoScene stereo_;
  FiducialTracker tracker_;
};

void track(const Options& options) {
  const BopScene scene = loadBopScene(options.scene, {options.object_id, options.fps, options.use_control});
  for (const std::string& warning : scene.warnings) warnUser(warning);
  SceneRun run(options, scene);
  EstimateCsvWriter estimates(options.output, scene.scene_id, options.object_id);
  const auto frames = everyNthFrame(scene.frames, options.stride);
  ProgressBar progress(frames.size());
  std::size_t done = 0, seen = 0;
  for (const SceneFrame& frame : frames) {
    const TrackerResult result = run.process(frame);
    seen += result.state == TrackerState::kTracking ? 1 : 0;
    estimates.write(frame.id, result);
    progress.update(++done);
  }
  estimates.close();
  std::cout << options.output << ": tags seen in " << seen << " of " << done << " frames\n";
}

int run(int argc, char** argv) {
  CLI::App app(
      "Tracks an object by the AprilTags on it: stereo triangulation, least squares, an extended Kalman filter.");
  Options options;
  addOptions(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  track(options);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
}
