// SPDX-License-Identifier: BSD-3-Clause
// Program: tracks an object through a rosbag.
#include "bag_recording.h"
#include "bag_tracker.h"
#include "result_bag.h"
#include "track_bag_options.h"

#include "depth_object_tracker/tools/bop_scene.h"
#include "depth_object_tracker/tools/estimate_csv.h"
#include "depth_object_tracker/tools/input_error.h"
#include "depth_object_tracker/tools/progress_bar.h"
#include "depth_object_tracker/tools/sequence_summary.h"
#include "depth_object_tracker/tools/trace_writer.h"

#include <iostream>

namespace depth_object_tracker {
namespace {

BuiltTracker buildFrom(const TrackBagOptions& options) {
  const bool is_description =
      options.object.rfind(".yaml") != std::string::npos || options.object.rfind(".yml") != std::string::npos;
  ObjectSource source;
  (is_description ? source.object_file : source.mesh) = options.object;
  BuiltTracker built = buildTracker(source, makeTrackerConfig(options));
  if (!built.tracker) throw InputError(built.problem);
  return built;
}

BuiltRobot buildRobot(const TrackBagOptions& options, const tf2::BufferCore& tf) {
  BuiltRobot robot;
  if (options.urdf.empty()) return robot;
  robot.connection = std::make_shared<RobotConnection>(RobotModel::fromFile(options.urdf), RobotConnectionConfig(), tf);
  return robot;
}

InitialPose chooseInitialPose(const TrackBagOptions& options, const BagRecording& recording) {
  InitialPose pose;
  if (!options.init.empty()) {
    pose.T_frame_object = loadPoseFile(options.init);
  } else if (const auto truth = recording.firstTruth()) {
    pose.T_frame_object = *truth;
  } else {
    throw InputError("no initial pose: give --init FILE.json, or --find to search the image; " + options.bag +
                     " has no /ground_truth/pose");
  }
  return pose;
}

/// Everything that one run writes.
class BagRunOutputs {
 public:
  BagRunOutputs(const TrackBagOptions& options, const PoseErrorMeter& meter)
      : estimates_(options.output, options.scene_id, options.object_id),
        meter_(meter),
        summary_(meter.symmetric(), meter.degreesOfFreedom()) {
    if (!options.trace.empty()) trace_.emplace(options.trace);
    if (!options.output_bag.empty()) bag_.emplace(options.output_bag);
  }

  void write(const FrameOutcome& outcome, const std::optional<Pose>& truth) {
    TrackerResult result = outcome.result;
    if (!result.has_pose) result.T_camera_object = last_pose_;  // a row per image, whatever happens
    last_pose_ = result.T_camera_object;
    estimates_.write(frame_, result);
    if (trace_) trace_->write(frame_, result);
    ++frame_;
    std::optional<PoseError> error;
    std::optional<double> squared;
    if (truth && result.has_pose) {
      error = meter_.measure(result.T_camera_object, *truth);
      squared = meter_.normalisedErrorSquared(result.T_camera_object, result.covariance, *truth);
    }
    summary_.add(result, error, squared, std::nullopt);
  }

  std::optional<ResultBag>& bag() { return bag_; }

  void close() {
    estimates_.close();
    if (trace_) trace_->close();
    if (bag_) bag_->close();
    summary_.print(std::cout);
  }

 private:
  EstimateCsvWriter estimates_;
  std::optional<TraceWriter> trace_;
  std::optional<ResultBag> bag_;
  const PoseErrorMeter& meter_;
  SequenceSummary summary_;
  Pose last_pose_ = Pose::Identity();
  int frame_ = 0;
};

void trackBag(const TrackBagOptions& options) {
  const BagRecording recording(options.bag, options.image_topic);
  const BuiltTracker built = buildFrom(options);
  const PoseErrorMeter meter(built.tracker->object().mesh, built.tracker->object().symmetries);
  BagRunOutputs outputs(options, meter);
  ProgressBar progress(recording.numImages());
  std::size_t num_done = 0;
  BagTracker* tracker = nullptr;
  BagTracker bag_tracker(recording, [&](const FrameOutcome& outcome, const ros::Time& recorded_at) {
    outputs.write(outcome, recording.truthAt(outcome.header.stamp));
    if (outputs.bag()) outputs.bag()->write(outcome, tracker->session(), recorded_at);
    progress.update(++num_done);
  });
  tracker = &bag_tracker;
  TrackerSession& session = bag_tracker.session();
  session.setTracker(built);
  session.setRobot(buildRobot(options, bag_tracker.tf()));
  if (options.find) {
    session.initialiseAnywhere(nullptr);
  } else {
    session.initialise(chooseInitialPose(options, recording), nullptr);
  }
  bag_tracker.run();
  outputs.close();
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  int exit_code = 0;
  const auto options = depth_object_tracker::parseTrackBagOptions(argc, argv, exit_code);
  if (!options) return exit_code;
  ros::Time::setNow(ros::TIME_MIN);
  if (ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, ros::console::levels::Warn))
    ros::console::notifyLoggerLevelsChanged();
  try {
    depth_object_tracker::trackBag(*options);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << std::endl;
    return 1;
  }
  return 0;
}
