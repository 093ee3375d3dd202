// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/robot_options.h"

#include "depth_object_tracker/geometry/isolated_mesh_loader.h"
#include "depth_object_tracker/ros/object_source.h"
#include "depth_object_tracker/ros/option_reader.h"

#include <exception>
#include <utility>

namespace depth_object_tracker {
namespace {

constexpr const char* kDescriptionParameter = "robot_description";

RobotModel loadModel(const RobotOptions& options, const ros::NodeHandle& private_node) {
  if (!options.urdf_file.empty()) return RobotModel::fromFile(resolveMeshUri(options.urdf_file, findPackage));
  std::string name, text;
  if (!private_node.searchParam(kDescriptionParameter, name)) {
    throw RobotModelError(
        "the parameter 'robot_description' is not set; load the robot's URDF into it, or set ~urdf_file");
  }
  if (!private_node.getParam(name, text)) throw RobotModelError("the parameter '" + name + "' is not a text");
  return RobotModel::fromText(text, name);
}

}  // namespace

RobotOptions loadRobotOptions(const ros::NodeHandle& private_node) {
  RobotOptions options;
  OptionReader reader(private_node, options.problems);
  reader.read("robot", "true or false", options.enabled);
  reader.read("urdf_file", "the path of a URDF file", options.urdf_file);
  reader.read("robot_occluder", "true or false", options.use_links_as_occluders);
  reader.read("robot_base_frame", "the name of a tf frame", options.config.base_frame);
  reader.readNumber("joint_time_offset_s", -1.0, 1.0, options.config.state.joint_time_offset_s);
  reader.readNumber("max_joint_age_s", 0.001, 1.0, options.config.state.max_joint_age_s);
  reader.readName("control_source", controlSourceFromName, options.config.state.control_source);
  reader.readName("camera_pose_source", cameraPoseSourceFromName, options.config.camera_pose_source);
  GraspDetectorConfig& detection = options.grasp_detection;
  reader.read("grasp_detection/link", "the name of a link", detection.link);
  reader.read("grasp_detection/joint", "the name of a joint", detection.joint);
  reader.readNumber("grasp_detection/open_position", -10.0, 10.0, detection.open_position);
  reader.readNumber("grasp_detection/closed_position", -10.0, 10.0, detection.closed_position);
  reader.readNumber("grasp_detection/decide_after_s", 0.01, 10.0, detection.decide_after_s);
  reader.readNumber("grasp_detection/max_distance_m", 0.001, 10.0, detection.max_distance_m);
  reader.readNumber("grasp_detection/max_relative_speed_m_s", 0.001, 10.0, detection.max_relative_speed_m_s);
  return options;
}

BuiltRobot buildRobot(const RobotOptions& options, const ros::NodeHandle& private_node, const tf2::BufferCore& tf) {
  BuiltRobot built;
  if (!options.enabled) return built;
  for (const std::string& problem : options.problems) built.problem += (built.problem.empty() ? "" : "; ") + problem;
  if (built.problem.empty()) {
    try {
      built.connection = std::make_shared<RobotConnection>(loadModel(options, private_node), options.config, tf);
      if (options.use_links_as_occluders) {
        const RobotModel& model = built.connection->model();
        const LinkMeshes meshes = loadLinkMeshes(model, LinkShapes::kCollision, IsolatedMeshLoader(findPackage));
        built.warnings = meshes.problems;
        built.occluder = std::make_shared<RobotOccluder>(model, meshes);
      }
      if (!options.grasp_detection.link.empty()) {
        built.connection->model().chainTo(options.grasp_detection.link);  // throws when there is none
        built.grasp_detector = std::make_shared<GraspDetector>(options.grasp_detection);
      }
    } catch (const std::exception& error) {
      built.connection.reset();
      built.problem = error.what();
    }
  }
  if (!built.problem.empty()) built.problem = "there is no robot: " + built.problem;
  return built;
}

}  // namespace depth_object_tracker
