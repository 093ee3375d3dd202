// SPDX-License-Identifier: BSD-3-Clause
// Runs a peer over a scene folder.
#include "depth_object_tracker/tools/estimate_csv.h"
#include "depth_object_tracker/tools/progress_bar.h"
#include "depth_object_tracker/tools/scene_pictures.h"
#include "depth_object_tracker/tools/sequence_inputs.h"
#include "peer_tracker.h"

#include <chrono>
#include <iostream>

namespace depth_object_tracker {
namespace {

void warnAboutOptions(const TrackSequenceOptions& options, const std::string& name) {
  if (!options.trace.empty() || !options.occlusion_dir.empty())
    warnUser(name + " has neither covariance nor occlusion: it ignores --trace and --occlusion-dir");
  if (!options.config.empty() || options.num_particles || options.proposal || options.downsampling)
    warnUser(name + " has settings of its own: it ignores the tracker's");
}

TrackerResult updateTimed(PeerTracker& tracker, const DepthPicture& picture, const PinholeCamera& camera,
                          const SceneFrame& frame) {
  const auto start = std::chrono::steady_clock::now();
  const PeerEstimate estimate = tracker.update(picture.view(frame.depth_unit_m), camera);
  TrackerResult result;
  result.time.total_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.has_pose = true;
  result.state = TrackerState::kTracking;
  result.T_camera_object = estimate.T_camera_object;
  result.score = estimate.score;
  return result;
}

void trackFrames(const std::vector<SceneFrame>& frames, const Pose& initial_pose, PeerTracker& tracker,
                 EstimateCsvWriter& estimates) {
  ScenePictures pictures(frames, warnUser);
  tracker.initialise(initial_pose, pictures.camera(frames.front()));
  ProgressBar progress(frames.size());
  std::size_t done = 0;
  for (const SceneFrame& frame : frames) {
    const DepthPicture picture = pictures.read(frame);
    estimates.write(frame.id, updateTimed(tracker, picture, pictures.camera(frame), frame));
    progress.update(++done);
  }
}

void runScene(const TrackSequenceOptions& options, const PeerFactory& make_tracker) {
  const BopScene scene = loadBopScene(options.scene, {options.object_id, options.fps, false});
  for (const std::string& warning : scene.warnings) warnUser(warning);
  const Pose initial_pose = chooseInitialPose(options, scene);
  const ObjectModel object = loadObjectModel(options);
  EstimateCsvWriter estimates(options.output, scene.scene_id, options.object_id);
  trackFrames(everyNthFrame(scene.frames, options.stride), initial_pose, *make_tracker(object.mesh, options),
              estimates);
  estimates.close();
}

}  // namespace

int runPeer(int argc, const char* const* argv, const char* name, const PeerFactory& make_tracker) {
  int exit_code = 0;
  const auto options = parseTrackSequenceOptions(argc, argv, exit_code);
  if (!options) return exit_code;
  try {
    warnAboutOptions(*options, name);
    runScene(*options, make_tracker);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << std::endl;
    return 1;
  }
  return 0;
}

}  // namespace depth_object_tracker
