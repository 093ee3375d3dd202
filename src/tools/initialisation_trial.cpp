// SPDX-License-Identifier: BSD-3-Clause
#include "tools/initialisation_trial.h"

#include "depth_object_tracker/simulator/random_source.h"

#include <ctime>

namespace depth_object_tracker {
namespace {

constexpr std::uint64_t kErrorStream = 211;
constexpr double kRightM = 0.005, kWrongM = 0.02;
constexpr int kRightFrames = 3;

double processorSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Displaced about the object's middle.
Pose displaced(const Pose& T_camera_object, const Eigen::Vector3d& centre_object, const Eigen::Vector3d& translation,
               const Eigen::Vector3d& rotation) {
  Vector6d displacement;
  displacement << translation, rotation;
  return perturb(T_camera_object * Eigen::Translation3d(centre_object), displacement) *
         Eigen::Translation3d(-centre_object);
}

void start(ObjectTracker& tracker, const TrialFrame& frame, InitialisationMode mode, std::uint64_t seed) {
  constexpr double kDegree = M_PI / 180.0;
  constexpr double kPoseErrorM = 0.05, kPoseErrorRad = 30.0 * kDegree;
  constexpr double kGraspErrorM = 0.02, kGraspErrorRad = 15.0 * kDegree;
  RandomSource random(seed, kErrorStream);
  const Eigen::Vector3d centre = surfaceCentroid(tracker.object().mesh);
  switch (mode) {
    case InitialisationMode::kFromPose:
      return tracker.initialise(displaced(frame.T_camera_object, centre, kPoseErrorM * random.unitVector(),
                                          kPoseErrorRad * random.unitVector()));
    case InitialisationMode::kInHand:
      // The kinematics are off as the simulated robot's are, the grasp besides.
      return tracker.initialise(displaced(frame.T_camera_object_kinematics, centre, kGraspErrorM * random.unitVector(),
                                          kGraspErrorRad * random.unitVector()));
    case InitialisationMode::kOnTable:
      return tracker.initialiseOnTable();
    case InitialisationMode::kGlobal:
      return tracker.initialiseAnywhere();
  }
}

bool isTable(const std::optional<ImagePlane>& plane, const TrialScene& scene) {
  constexpr double kSameM = 0.01, kSameCosine = 0.9994;  // 2 degrees
  if (!plane || plane->normal.dot(scene.table_normal) < kSameCosine) return false;
  // Where the object is: the planes may cross elsewhere.
  const Eigen::Vector3d p = scene.frames.front().T_camera_object.translation();
  return std::abs(plane->heightOf(p) - (scene.table_normal.dot(p) - scene.table_offset_m)) < kSameM;
}

DepthImageView viewOf(const TrialFrame& frame, const PinholeCamera& camera) {
  DepthImageView view;
  view.data = reinterpret_cast<const std::uint8_t*>(frame.depth_mm.data());
  view.width = camera.width;
  view.height = camera.height;
  view.step = static_cast<std::size_t>(view.width) * sizeof(std::uint16_t);
  return view;
}

/// A mug's handle may be behind the mug.
bool isUndecidable(ImageEvidence& evidence, const TrialScene& scene, const TrackerResult& result) {
  constexpr double kSurelyNat = 3.0;
  const TrialFrame& last = scene.frames.back();
  return result.has_pose && evidence.between(viewOf(last, scene.camera), scene.camera, last.T_camera_object,
                                             result.T_camera_object) < kSurelyNat;
}

}  // namespace

const char* modeName(InitialisationMode mode) {
  switch (mode) {
    case InitialisationMode::kFromPose:
      return "FROM_POSE";
    case InitialisationMode::kOnTable:
      return "ON_TABLE";
    case InitialisationMode::kInHand:
      return "IN_HAND";
    default:
      return "GLOBAL";
  }
}

TrialOutcome runTrial(ObjectTracker& tracker, const PoseErrorMeter& meter, ImageEvidence& evidence,
                      const TrialScene& scene, InitialisationMode mode, std::uint64_t seed) {
  TrialOutcome outcome;
  start(tracker, scene.frames.front(), mode, seed);
  int right = 0;
  double spent_s = 0.0;
  TrackerResult result;
  for (std::size_t k = 0; k < scene.frames.size() && right < kRightFrames; ++k) {
    const TrialFrame& frame = scene.frames[k];
    const bool is_first = k == 0;
    const double begin_s = processorSeconds();
    result = tracker.update(viewOf(frame, scene.camera), scene.camera, frame.stamp_s);
    spent_s += processorSeconds() - begin_s;
    if (is_first && mode == InitialisationMode::kOnTable) outcome.plane_found = isTable(tracker.table(), scene);
    const PoseError error = meter.measure(result.T_camera_object, frame.T_camera_object);
    const bool is_tracking = result.has_pose && result.state == TrackerState::kTracking;
    outcome.add_m = result.has_pose ? error.adds_m : -1.0;  // = ADD where no symmetry is declared
    outcome.wrong_frames += is_tracking && error.adds_m > kWrongM ? 1 : 0;
    right = is_tracking && error.adds_m < kRightM ? right + 1 : 0;
    if (right == 1) {
      outcome.frames = static_cast<int>(k) + 1;
      outcome.compute_s = spent_s;
    }
  }
  if (right == 0) {
    outcome.frames = 0;
    outcome.compute_s = spent_s;
    outcome.undecidable = isUndecidable(evidence, scene, result);
  }
  return outcome;
}

}  // namespace depth_object_tracker
