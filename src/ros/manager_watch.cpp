// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/manager_watch.h"

#include <XmlRpc.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>

namespace depth_object_tracker {
namespace {

constexpr int kFailuresOfTheDead = 3;  // one may be a machine short of sockets

}  // namespace

bool ManagerWatch::begin() {
  XmlRpc::XmlRpcValue arguments, response, uri;
  arguments[0] = ros::this_node::getName();
  arguments[1] = node_;
  if (!ros::master::execute("lookupNode", arguments, response, uri, false)) return false;
  if (!ros::network::splitURI(static_cast<std::string>(uri), host_, port_)) return false;
  num_failures_ = 0;
  process_ = askProcess();
  return process_ > 0;
}

bool ManagerWatch::isGone() {
  const int process = askProcess();
  num_failures_ = process > 0 ? 0 : num_failures_ + 1;
  return num_failures_ >= kFailuresOfTheDead || (process > 0 && process != process_);
}

int ManagerWatch::askProcess() const {
  XmlRpc::XmlRpcClient client(host_.c_str(), static_cast<int>(port_), "/");
  XmlRpc::XmlRpcValue arguments, answer;
  arguments[0] = ros::this_node::getName();
  if (!client.execute("getPid", arguments, answer)) return 0;
  if (answer.getType() != XmlRpc::XmlRpcValue::TypeArray || answer.size() < 3) return 0;
  return answer[2].getType() == XmlRpc::XmlRpcValue::TypeInt ? static_cast<int>(answer[2]) : 0;
}

}  // namespace depth_object_tracker
