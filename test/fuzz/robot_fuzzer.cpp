// SPDX-License-Identifier: BSD-3-Clause
// A robot's URDF and what it says about its joints.
#include "depth_object_tracker/robot/link_meshes.h"
#include "depth_object_tracker/robot/robot_state.h"
#include "fuzz_input.h"

#include <ros/console.h>

#include <cmath>
#include <optional>

namespace dot = depth_object_tracker;

namespace {

constexpr const char* kArm = R"(<robot name="arm"><link name="base"/><link name="l1"/><link name="l2"/><link name="l3"/>
<joint name="a" type="revolute"><parent link="base"/><child link="l1"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="b" type="continuous"><parent link="l1"/><child link="l2"/><origin xyz="0 0 1" rpy="0 1 0"/><axis xyz="0 1 0"/></joint>
<joint name="c" type="prismatic"><parent link="l2"/><child link="l3"/><axis xyz="1 0 0"/><limit lower="0" upper="1" effort="1" velocity="1"/><mimic joint="a" multiplier="2" offset="1"/></joint></robot>)";

double number(FuzzedDataProvider& input) {
  return input.ConsumeIntegralInRange(0, 7) == 0 ? input.ConsumeFloatingPoint<double>()
                                                 : input.ConsumeFloatingPointInRange(-4.0, 4.0);
}

double stamp(FuzzedDataProvider& input) {
  return input.ConsumeIntegralInRange(0, 15) == 0 ? input.ConsumeFloatingPoint<double>()
                                                  : 100.0 + 0.01 * input.ConsumeIntegralInRange(-100, 300);
}

dot::JointReport makeReport(FuzzedDataProvider& input) {
  dot::JointReport report;
  report.stamp_s = stamp(input);
  for (int k = input.ConsumeIntegralInRange(0, 4); k > 0; --k) {
    report.names.push_back(input.ConsumeIntegralInRange(0, 7) == 0
                               ? input.ConsumeRandomLengthString(8)
                               : std::string(1, input.PickValueInArray({'a', 'b', 'c'})));
  }
  const auto values = [&input, &report] {
    std::vector<double> list(input.ConsumeIntegralInRange(0, 3) == 0 ? input.ConsumeIntegralInRange<std::size_t>(0, 6)
                                                                     : report.names.size());
    for (double& value : list) value = number(input);
    return list;
  };
  report.positions = values();
  report.velocities = values();
  return report;
}

void useModel(const dot::RobotModel& model, FuzzedDataProvider& input) {
  dot::RobotStateConfig config;
  config.control_source = input.PickValueInArray(
      {dot::ControlSource::kMeasured, dot::ControlSource::kVelocities, dot::ControlSource::kCommands});
  config.joint_time_offset_s = input.ConsumeFloatingPointInRange(-1.0, 1.0);
  dot::RobotState state(model, config);
  const std::vector<std::string> links = model.linkNames();
  for (int step = 0; step < 20 && input.remaining_bytes() > 0; ++step) {
    state.addJointStates(makeReport(input));
    if (input.ConsumeBool()) state.addCommands(makeReport(input));
    const std::string& link = links[input.ConsumeIntegralInRange<std::size_t>(0, links.size() - 1)];
    const double from_s = stamp(input), to_s = input.ConsumeBool() ? from_s + 0.033 : stamp(input);
    state.linkPose(link, from_s);
    state.linkMotion(link, from_s, to_s);
    state.awaitsJoints(link, to_s);
    state.jointPosition("a", to_s);
    if (input.ConsumeIntegralInRange(0, 31) == 0) state.forget();
  }
  model.rootLink();
  dot::loadLinkMeshes(model, input.ConsumeBool() ? dot::LinkShapes::kVisual : dot::LinkShapes::kCollision,
                      [](const std::string&, double) -> dot::TriangleMesh { throw dot::MeshError("no meshes here"); });
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  ros::console::set_logger_level(ROSCONSOLE_ROOT_LOGGER_NAME, ros::console::levels::Fatal);
  ros::console::notifyLoggerLevelsChanged();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider input(data, size);
  if (input.ConsumeIntegralInRange(0, 3) == 0) {
    static const dot::RobotModel arm = dot::RobotModel::fromText(kArm, "robot_description");
    useModel(arm, input);
    return 0;
  }
  const std::string urdf = input.ConsumeRandomLengthString();
  std::optional<dot::RobotModel> model;
  try {
    if (input.ConsumeIntegralInRange(0, 63) == 0) {
      model = dot::RobotModel::fromFile(dot::MemoryFileName(urdf).path());
    } else {
      model = dot::RobotModel::fromText(urdf, "robot_description");
    }
  } catch (const dot::RobotModelError&) {
    return 0;
  }
  useModel(*model, input);
  return 0;
}
