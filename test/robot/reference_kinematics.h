// SPDX-License-Identifier: BSD-3-Clause
// Forward kinematics read from the XML with nothing in common with the package's: own parser, own rotations.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <tinyxml2.h>

#include <cmath>
#include <map>
#include <sstream>
#include <string>

namespace depth_object_tracker {

class ReferenceKinematics {
 public:
  explicit ReferenceKinematics(const std::string& urdf) {
    document_.Parse(urdf.c_str());
    const auto* robot = document_.FirstChildElement("robot");
    for (auto* joint = robot->FirstChildElement("joint"); joint; joint = joint->NextSiblingElement("joint")) {
      joint_of_link_[joint->FirstChildElement("child")->Attribute("link")] = joint;
      joints_[joint->Attribute("name")] = joint;
    }
  }

  /// T_root_link, by walking from the link up to the root. Joints that are not given stand at 0.
  Eigen::Matrix4d pose(std::string link, const std::map<std::string, double>& positions) const {
    Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
    while (joint_of_link_.count(link) > 0) {
      const tinyxml2::XMLElement* joint = joint_of_link_.at(link);
      T = origin(joint) * motion(joint, position(joint, positions)) * T;
      link = joint->FirstChildElement("parent")->Attribute("link");
    }
    return T;
  }

 private:
  using Element = tinyxml2::XMLElement;

  static Eigen::Vector3d vector(const Element* element, const char* name, const Eigen::Vector3d& otherwise) {
    if (element == nullptr || element->Attribute(name) == nullptr) return otherwise;
    std::istringstream text(element->Attribute(name));
    Eigen::Vector3d v;
    text >> v[0] >> v[1] >> v[2];
    return v;
  }

  static Eigen::Matrix4d about(int axis, double angle) {
    Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    T(a, a) = T(b, b) = std::cos(angle);
    T(a, b) = -std::sin(angle);
    T(b, a) = std::sin(angle);
    return T;
  }

  static Eigen::Matrix4d origin(const Element* joint) {
    const Element* element = joint->FirstChildElement("origin");
    const Eigen::Vector3d rpy = vector(element, "rpy", Eigen::Vector3d::Zero());
    Eigen::Matrix4d T = about(2, rpy[2]) * about(1, rpy[1]) * about(0, rpy[0]);
    T.topRightCorner<3, 1>() = vector(element, "xyz", Eigen::Vector3d::Zero());
    return T;
  }

  static Eigen::Matrix4d motion(const Element* joint, double q) {
    const Eigen::Vector3d axis = vector(joint->FirstChildElement("axis"), "xyz", Eigen::Vector3d::UnitX()).normalized();
    Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
    const std::string type = joint->Attribute("type");
    if (type == "prismatic") T.topRightCorner<3, 1>() = q * axis;
    if (type == "revolute" || type == "continuous") {  // Rodrigues
      Eigen::Matrix3d K;
      K << 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0;
      T.topLeftCorner<3, 3>() += std::sin(q) * K + (1.0 - std::cos(q)) * K * K;
    }
    return T;
  }

  double position(const Element* joint, const std::map<std::string, double>& positions) const {
    if (const Element* mimic = joint->FirstChildElement("mimic")) {
      return mimic->DoubleAttribute("multiplier", 1.0) * position(joints_.at(mimic->Attribute("joint")), positions) +
             mimic->DoubleAttribute("offset", 0.0);
    }
    const auto found = positions.find(joint->Attribute("name"));
    return found == positions.end() ? 0.0 : found->second;
  }

  tinyxml2::XMLDocument document_;
  std::map<std::string, const Element*> joint_of_link_, joints_;
};

}  // namespace depth_object_tracker
