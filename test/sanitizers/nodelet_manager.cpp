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
  nodelet::Loader manager;
  ros::spin();
  // Where a bond broke a moment before, the loader's destructor looks for the bond's nodelet in the map that it has
  // just destroyed; in an emptied one that ends well.
  manager.clear();
  return 0;
}
