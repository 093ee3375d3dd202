// SPDX-License-Identifier: BSD-3-Clause
// Loads a nodelet into a manager, as `nodelet load` does, and ends when that manager does, so that roslaunch can start
// it again. `nodelet load` may miss it: a bond of which only the first heartbeat was heard never breaks (bond 1.8).
// usage: load_nodelet TYPE MANAGER
#include "depth_object_tracker/ros/manager_watch.h"

#include <bondcpp/bond.h>
#include <nodelet/NodeletList.h>
#include <nodelet/NodeletLoad.h>
#include <nodelet/NodeletUnload.h>
#include <ros/ros.h>
#include <ros/xmlrpc_manager.h>

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

namespace depth_object_tracker {
namespace {

volatile std::sig_atomic_t g_stop = 0;

void onInterrupt(int) {
  g_stop = 1;
}

/// As by rosnode kill. The nodelet is to be unloaded first, so roscpp must not end the connections yet.
void onShutdown(XmlRpc::XmlRpcValue&, XmlRpc::XmlRpcValue& result) {
  g_stop = 1;
  result = ros::xmlrpc::responseInt(1, "", 0);
}

class NodeletLoader {
 public:
  NodeletLoader(const std::string& type, const std::string& manager)
      : type_(type),
        manager_(ros::names::resolve(manager)),
        bond_id_(name_ + "_" + std::to_string(getpid()) + "_" + std::to_string(ros::WallTime::now().toNSec())),
        bond_(manager_ + "/bond", bond_id_),
        watch_(manager_) {}

  int run() {
    if (!waitForManager()) return 0;
    if (!watch_.begin()) return fail("does not answer");
    if (!load() && !(unload() && load())) {
      return fail("cannot load '" + name_ + "' of type " + type_ + "; its log says why");
    }
    bond_.start();
    ros::AsyncSpinner spinner(1);
    spinner.start();
    // A manager that hangs keeps this thread waiting, and is the bond's to find out.
    std::thread([this] {
      while (!watch_.isGone()) ros::WallDuration(0.5).sleep();
      is_gone_ = true;
    }).detach();
    while (g_stop == 0 && !is_gone_ && !bond_.isBroken()) ros::WallDuration(0.1).sleep();
    if (g_stop == 0) return fail("is gone, and '" + name_ + "' with it");
    unload();
    bond_.breakBond();
    return 0;
  }

 private:
  bool waitForManager() {
    const std::string service = manager_ + "/load_nodelet";
    while (g_stop == 0 && ros::ok()) {
      if (ros::service::waitForService(service, ros::Duration(0.5))) return true;
      ROS_WARN_STREAM_THROTTLE(
          10.0, name_ << ": waiting for the nodelet manager '" << manager_ << "'; rosnode list tells which there are");
    }
    return false;
  }

  bool load() const {
    nodelet::NodeletLoad call;
    call.request.name = name_;
    call.request.type = type_;
    call.request.bond_id = bond_id_;
    for (const auto& [source, target] : ros::names::getRemappings()) {
      call.request.remap_source_args.push_back(source);
      call.request.remap_target_args.push_back(target);
    }
    return ros::service::call(manager_ + "/load_nodelet", call) && call.response.success;
  }

  /// True when there was one, as after a loader that was killed.
  bool unload() const {
    nodelet::NodeletList list;
    if (!ros::service::call(manager_ + "/list", list)) return false;
    const auto& nodelets = list.response.nodelets;
    if (std::find(nodelets.begin(), nodelets.end(), name_) == nodelets.end()) return false;
    nodelet::NodeletUnload call;
    call.request.name = name_;
    return ros::service::call(manager_ + "/unload_nodelet", call) && call.response.success;
  }

  int fail(const std::string& what) const {
    ROS_ERROR_STREAM(name_ << ": the nodelet manager '" << manager_ << "' " << what);
    return 1;
  }

  const std::string name_ = ros::this_node::getName();
  const std::string type_, manager_, bond_id_;
  bond::Bond bond_;
  ManagerWatch watch_;
  std::atomic<bool> is_gone_{false};
};

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  ros::init(argc, argv, "load_nodelet", ros::init_options::NoSigintHandler);
  if (argc != 3) {
    std::fprintf(stderr, "usage: load_nodelet TYPE MANAGER\n");
    return 2;
  }
  ros::NodeHandle node;  // keeps the node alive until the end
  std::signal(SIGINT, depth_object_tracker::onInterrupt);
  ros::XMLRPCManager::instance()->unbind("shutdown");
  ros::XMLRPCManager::instance()->bind("shutdown", depth_object_tracker::onShutdown);
  depth_object_tracker::NodeletLoader loader(argv[1], argv[2]);
  const int status = loader.run();
  ros::shutdown();
  std::fflush(nullptr);
  std::_Exit(status);  // the thread that watches may be waiting for a manager that hangs
}
