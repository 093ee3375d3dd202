// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/fiducial_options.h"

#include "depth_object_tracker/ros/option_reader.h"

#include <stdexcept>

namespace depth_object_tracker {

FiducialInput fiducialInputFromName(const std::string& name) {
  if (name == "stereo") return FiducialInput::kStereo;
  if (name == "rgbd") return FiducialInput::kRgbd;
  throw std::invalid_argument("input is '" + name + "', must be one of: stereo, rgbd");
}

FiducialOptions loadFiducialOptions(const ros::NodeHandle& private_node) {
  FiducialOptions options;
  OptionReader reader(private_node, options.problems);
  reader.read("object_name", "a word", options.object_name);
  reader.read("fiducials_file", "the path of a YAML file", options.fiducials_file);
  if (options.fiducials_file.empty()) {
    options.problems.push_back("parameter '" + private_node.resolveName("fiducials_file") +
                               "' is not set; it names the YAML file with the tags on the object");
  }
  reader.readName("input", fiducialInputFromName, options.input);
  reader.read("publish_tf", "true or false", options.publish_tf);
  reader.readNumber("lost_after_s", 0.0, 60.0, options.tracker.lost_after_s);
  reader.readNumber("corner_stddev_px", 0.01, 10.0, options.tracker.noise.corner_stddev_px);
  reader.readNumber("depth_stddev_m", 1e-4, 0.1, options.tracker.noise.depth_stddev_m);
  reader.readNumber("max_row_difference_px", 0.1, 100.0, options.tracker.noise.max_row_difference_px);
  reader.readNumber("max_rms_m", 1e-4, 1.0, options.tracker.max_rms_m);
  double num_threads = options.tracker.num_threads;
  reader.readNumber("num_threads", 1.0, 64.0, num_threads);
  options.tracker.num_threads = static_cast<int>(num_threads);
  return options;
}

}  // namespace depth_object_tracker
