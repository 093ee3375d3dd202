// SPDX-License-Identifier: BSD-3-Clause
// Program: tracks an object through a BOP scene folder.
#include "depth_object_tracker/tools/sequence_run.h"

#include <iostream>

int main(int argc, char** argv) {
  int exit_code = 0;
  const auto options = depth_object_tracker::parseTrackSequenceOptions(argc, argv, exit_code);
  if (!options) return exit_code;
  try {
    depth_object_tracker::runSequence(*options);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << std::endl;
    return 1;
  }
  return 0;
}
