// SPDX-License-Identifier: BSD-3-Clause
// Stands in for Debian's program `nodelet` in a build with a sanitizer: a manager that has the sanitizer from its
// start, without which our plugins could not be loaded. All that is not a manager is left to Debian's program.
#include <nodelet/loader.h>
#include <ros/ros.h>
#include <unistd.h>

#include <cstdio>
#include <string>

int main(int argc, char** argv) {
  if (argc < 2 || std::string(argv[1]) != "manager") {
    execv(SYSTEM_NODELET_PROGRAM, argv);
    std::perror(SYSTEM_NODELET_PROGRAM);
    return 1;
  }
  ros::init(argc, argv, "manager");
  // Never destroyed: where a bond broke a moment before, nodelet::Loader's destructor unloads from the map that it has
  // just destroyed, and ends in std::terminate. Our nodelets are all that is of interest.
  static nodelet::Loader& manager = *new nodelet::Loader;
  ros::spin();
  manager.clear();
  return 0;
}
