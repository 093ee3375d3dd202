// SPDX-License-Identifier: BSD-3-Clause
// Runs the tracker over a scene folder and writes what it says.
#include "depth_object_tracker/tools/sequence_run.h"

#include "depth_object_tracker/tools/bop_scene.h"
#include "depth_object_tracker/tools/estimate_csv.h"
#include "depth_object_tracker/tools/input_error.h"
#include "depth_object_tracker/tools/occlusion_picture.h"
#include "depth_object_tracker/tools/progress_bar.h"
#include "depth_object_tracker/tools/scene_pictures.h"
#include "depth_object_tracker/tools/sequence_inputs.h"
#include "depth_object_tracker/tools/sequence_summary.h"
#include "depth_object_tracker/tools/trace_writer.h"
#include "depth_object_tracker/tracker/object_tracker.h"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>

namespace depth_object_tracker {
namespace {

namespace fs = std::filesystem;

/// Everything that one run writes.
class RunOutputs {
 public:
  RunOutputs(const TrackSequenceOptions& options, int scene_id)
      : estimates_(options.output, scene_id, options.object_id), occlusion_folder_(options.occlusion_dir) {
    if (!options.trace.empty()) trace_.emplace(options.trace);
    if (occlusion_folder_.empty()) return;
    std::error_code problem;
    fs::create_directories(occlusion_folder_, problem);
    if (!fs::is_directory(occlusion_folder_)) throw InputError("cannot make the folder " + occlusion_folder_);
  }

  void write(int frame, const TrackerResult& result, const ObjectTracker& tracker, int width, int height) {
    estimates_.write(frame, result);
    if (trace_) trace_->write(frame, result);
    if (!occlusion_folder_.empty()) writeOcclusion(frame, result, tracker, width, height);
  }

  void close() {
    estimates_.close();
    if (trace_) trace_->close();
  }

 private:
  void writeOcclusion(int frame, const TrackerResult& result, const ObjectTracker& tracker, int width,
                      int height) const {
    const bool has_object = result.has_pose && result.state != TrackerState::kLost;
    const std::vector<float> object_depth = has_object ? tracker.renderEstimate() : std::vector<float>{};
    char name[32];
    std::snprintf(name, sizeof(name), "%06d.png", frame);
    writeGreyPng((fs::path(occlusion_folder_) / name).string(),
                 makeOcclusionPicture(tracker.occlusionMap(), object_depth, width, height,
                                      tracker.config().occlusion.initial_p_occluded),
                 width, height);
  }

  EstimateCsvWriter estimates_;
  std::optional<TraceWriter> trace_;
  std::string occlusion_folder_;
};

TrackerResult updateTimed(ObjectTracker& tracker, const DepthPicture& picture, const PinholeCamera& camera,
                          const SceneFrame& frame) {
  const auto start = std::chrono::steady_clock::now();
  TrackerResult result = tracker.update(picture.view(frame.depth_unit_m), camera, frame.stamp_s, frame.control);
  result.time.total_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

void trackFrames(const std::vector<SceneFrame>& frames, ObjectTracker& tracker, const Pose& initial_pose,
                 RunOutputs& outputs, const PoseErrorMeter& meter, SequenceSummary& summary) {
  ScenePictures pictures(frames, warnUser);
  ProgressBar progress(frames.size());
  Pose last_pose = initial_pose;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const SceneFrame& frame = frames[k];
    const DepthPicture picture = pictures.read(frame);
    TrackerResult result = updateTimed(tracker, picture, pictures.camera(frame), frame);
    if (!result.has_pose) result.T_camera_object = last_pose;  // a row per frame, whatever happens
    last_pose = result.T_camera_object;
    outputs.write(frame.id, result, tracker, picture.width, picture.height);
    std::optional<PoseError> error;
    std::optional<double> squared;
    if (frame.T_camera_object_truth) {
      error = meter.measure(result.T_camera_object, *frame.T_camera_object_truth);
      squared = meter.normalisedErrorSquared(result.T_camera_object, result.covariance, *frame.T_camera_object_truth);
    }
    summary.add(result, error, squared, frame.visible_fraction);
    progress.update(k + 1);
  }
  if (pictures.numMissing() == 0) return;
  warnUser(std::to_string(pictures.numMissing()) + " of " + std::to_string(frames.size()) +
           " frames have no depth picture");
}

}  // namespace

void runSequence(const TrackSequenceOptions& options) {
  const TrackerConfig config = makeTrackerConfig(options);
  const BopScene scene = loadBopScene(options.scene, {options.object_id, options.fps, !options.no_control});
  for (const std::string& warning : scene.warnings) warnUser(warning);
  const Pose initial_pose = chooseInitialPose(options, scene);

  ObjectTracker tracker(loadObjectModel(options), config);
  tracker.initialise(initial_pose);
  const PoseErrorMeter meter(tracker.object().mesh, tracker.object().symmetries);
  RunOutputs outputs(options, scene.scene_id);
  SequenceSummary summary(meter.symmetric(), meter.degreesOfFreedom());
  trackFrames(everyNthFrame(scene.frames, options.stride), tracker, initial_pose, outputs, meter, summary);
  outputs.close();
  summary.print(std::cout);
}

}  // namespace depth_object_tracker
