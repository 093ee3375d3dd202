// SPDX-License-Identifier: BSD-3-Clause
#include "machine_info.h"

#include "depth_object_tracker/geometry/simd_target.h"

#include <cstdio>
#include <fstream>
#include <thread>

namespace depth_object_tracker {
namespace {

std::string processorName() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (line.compare(0, 10, "model name") == 0 && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

double loadAverage() {
  double load = 0.0;
  std::ifstream("/proc/loadavg") >> load;
  return load;
}

std::string gitCommit() {
  FILE* pipe = popen("git -C '" PROJECT_SOURCE_FOLDER "' describe --always --dirty --abbrev=12 2>/dev/null", "r");
  if (pipe == nullptr) return "";
  char line[128] = "";
  const bool read = std::fgets(line, sizeof(line), pipe) != nullptr;
  pclose(pipe);
  const std::string commit = read ? line : "";
  return commit.substr(0, commit.find('\n'));
}

std::string compilerName() {
#ifdef __clang__
  return "Clang " __clang_version__;
#else
  return "GCC " __VERSION__;
#endif
}

}  // namespace

MachineInfo machineInfo() {
  return {processorName(), static_cast<int>(std::thread::hardware_concurrency()),
          loadAverage(),   compilerName(),
          BUILD_TYPE,      simdTarget(),
          gitCommit()};
}

}  // namespace depth_object_tracker
