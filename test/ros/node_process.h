// SPDX-License-Identifier: BSD-3-Clause
// The process of another node, for tests in which it dies.
#pragma once

#include <XmlRpc.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>

#include <csignal>
#include <cstdint>
#include <string>

namespace depth_object_tracker {

/// Process of a node, asked of the node itself; 0 when it does not answer.
inline int processOf(const std::string& node) {
  XmlRpc::XmlRpcValue arguments, response, payload;
  arguments[0] = ros::this_node::getName();
  arguments[1] = node;
  if (!ros::master::execute("lookupNode", arguments, response, payload, false)) return 0;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(static_cast<std::string>(payload), host, port)) return 0;
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port));
  XmlRpc::XmlRpcValue question, answer;
  question[0] = ros::this_node::getName();
  const bool answered =
      client.execute("getPid", question, answer) && answer.getType() == XmlRpc::XmlRpcValue::TypeArray;
  return answered ? static_cast<int>(answer[2]) : 0;
}

/// As a crash would: the node cannot tidy up. False when there is no such node.
inline bool killNode(const std::string& node) {
  const int process = processOf(node);
  return process > 1 && ::kill(process, SIGKILL) == 0;
}

}  // namespace depth_object_tracker
