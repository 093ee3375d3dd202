// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark_report.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

/// printf to a stream.
template <typename... Values>
void print(std::ostream& out, const char* format, Values... values) {
  char line[256];
  std::snprintf(line, sizeof(line), format, values...);
  out << line << std::endl;
}

nlohmann::json toJson(const MachineInfo& machine) {
  return {{"processor", machine.processor}, {"cores", machine.cores},           {"load", machine.load},
          {"compiler", machine.compiler},   {"build_type", machine.build_type}, {"simd", machine.simd},
          {"commit", machine.commit}};
}

nlohmann::json toJson(const MemoryUse& use) {
  return {{"particles", use.particles},
          {"peak_mib", use.peak_mib},
          {"without_mib", use.without_mib},
          {"beliefs_mib", use.beliefs_mib},
          {"tiles_in_use", use.tiles_in_use}};
}

nlohmann::json toJson(const UpdateTiming& timing) {
  return {{"series", timing.given.series},
          {"triangles", timing.triangles},
          {"particles", timing.given.particles},
          {"width", timing.width},
          {"height", timing.height},
          {"covered_pixels", timing.covered_pixels},
          {"threads", timing.given.threads},
          {"simd", timing.simd},
          {"edge_stddev_px", timing.given.edge_stddev_px},
          {"repetitions", timing.repetitions},
          {"poses_per_s", timing.poses_per_s},
          {"fastest_poses_per_s", timing.fastest_poses_per_s},
          {"processor_us_per_pose", timing.processor_us_per_pose},
          {"heap_allocations", timing.heap_allocations}};
}

nlohmann::json toJson(const std::vector<StageTiming>& stages) {
  nlohmann::json json = nlohmann::json::array();
  for (const StageTiming& stage : stages) json.push_back({{"stage", stage.name}, {"ns_per_pose", stage.ns_per_pose}});
  return json;
}

template <typename Values>
nlohmann::json toList(const Values& values) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& value : values) list.push_back(toJson(value));
  return list;
}

}  // namespace

std::int64_t BenchmarkReport::heapAllocations() const {
  std::int64_t sum = 0;
  for (const UpdateTiming& timing : updates) sum += timing.heap_allocations;
  return sum;
}

void printMachine(const MachineInfo& machine, std::ostream& out) {
  print(out, "%s, %d cores, load %.2f", machine.processor.c_str(), machine.cores, machine.load);
  print(out, "%s, %s, SIMD %s%s%s\n", machine.compiler.c_str(), machine.build_type.c_str(), machine.simd.c_str(),
        machine.commit.empty() ? "" : ", commit ", machine.commit.c_str());
}

void printMemory(const std::vector<MemoryUse>& memory, std::ostream& out) {
  print(out, "%-28s %9s %9s %9s %9s", "resident memory [MiB]", "peak", "without", "beliefs", "tiles");
  for (const MemoryUse& use : memory) {
    print(out, "%6d particles             %9.1f %9.1f %9.1f %9d", use.particles, use.peak_mib, use.without_mib,
          use.beliefs_mib, use.tiles_in_use);
  }
  out << '\n';
}

void printUpdateHeader(std::ostream& out) {
  print(out, "%-10s %9s %9s %8s %7s %7s %-6s %7s %10s %10s %8s %8s %6s", "series", "triangles", "particles", "grid",
        "covered", "threads", "SIMD", "edge px", "poses/s", "fastest/s", "us/pose", "CPU us", "allocs");
}

void printUpdate(const UpdateTiming& timing, std::ostream& out) {
  const std::string grid = std::to_string(timing.width) + "x" + std::to_string(timing.height);
  print(out, "%-10s %9d %9d %8s %7d %7d %-6s %7.1f %10.0f %10.0f %8.2f %8.2f %6lld", timing.given.series.c_str(),
        timing.triangles, timing.given.particles, grid.c_str(), timing.covered_pixels, timing.given.threads,
        timing.simd.c_str(), timing.given.edge_stddev_px, timing.poses_per_s, timing.fastest_poses_per_s,
        1e6 / timing.poses_per_s, timing.processor_us_per_pose, static_cast<long long>(timing.heap_allocations));
}

void printStages(const std::vector<StageTiming>& soft, const std::vector<StageTiming>& hard, std::ostream& out) {
  print(out, "\n%-24s %12s %12s", "stage [ns per pose]", "soft outline", "hard outline");
  double soft_sum = 0.0, hard_sum = 0.0;
  for (std::size_t i = 0; i < soft.size(); ++i) {
    print(out, "%-24s %12.0f %12.0f", soft[i].name.c_str(), soft[i].ns_per_pose, hard[i].ns_per_pose);
    soft_sum += soft[i].ns_per_pose;
    hard_sum += hard[i].ns_per_pose;
  }
  print(out, "%-24s %12.0f %12.0f", "sum", soft_sum, hard_sum);
}

void writeJson(const BenchmarkReport& report, const std::string& file) {
  nlohmann::json json;
  json["machine"] = toJson(report.machine);
  json["memory"] = toList(report.memory);
  json["updates"] = toList(report.updates);
  json["stages"] = {{"soft", toJson(report.soft_stages)}, {"hard", toJson(report.hard_stages)}};
  std::ofstream out(file);
  out << json.dump(1) << '\n';
  if (!out.flush()) throw std::runtime_error("cannot write " + file);
}

}  // namespace depth_object_tracker
