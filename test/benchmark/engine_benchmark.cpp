// SPDX-License-Identifier: BSD-3-Clause
// Program: how many poses a second the engine evaluates, and where the time goes.
#include "benchmark_object.h"
#include "benchmark_report.h"

#include "depth_object_tracker/geometry/mesh_loader.h"
#include "depth_object_tracker/geometry/simd_target.h"

#include <CLI/CLI.hpp>

#include <iostream>
#include <map>

namespace dot = depth_object_tracker;

namespace {

struct Options {
  std::string json, mesh, simd = "auto";
  bool quick = false;
};

void addOptions(CLI::App& app, Options& options) {
  std::vector<std::string> targets = dot::availableSimdTargets();
  targets.emplace_back("auto");
  app.add_option("--json", options.json, "file for all figures");
  app.add_flag("--quick", options.quick, "measure for a shorter time");
  app.add_option("--mesh", options.mesh, "also measure this object (mesh file in metres)");
  app.add_option("--simd", options.simd, "instruction set (default auto)")->check(CLI::IsMember(targets));
}

/// Every mesh once. 0 triangles = the user's mesh.
class Meshes {
 public:
  explicit Meshes(const std::string& file) {
    if (!file.empty()) meshes_[0] = dot::loadMesh(file);
  }
  const dot::TriangleMesh& get(int triangles) {
    const auto found = meshes_.find(triangles);
    if (found != meshes_.end()) return found->second;
    return meshes_[triangles] = dot::makeBenchmarkObject(triangles);
  }

 private:
  std::map<int, dot::TriangleMesh> meshes_;
};

template <typename Value>
void addSeries(const std::string& name, Value dot::UpdateCase::*field, const std::vector<Value>& values,
               dot::UpdateCase row, std::vector<dot::UpdateCase>& rows) {
  row.series = name;
  for (const Value& value : values) {
    row.*field = value;
    rows.push_back(row);
  }
}

/// Each series changes one thing about the default row.
std::vector<dot::UpdateCase> makeRows(const Options& options) {
  using Row = dot::UpdateCase;
  Row row, two_threads, large;
  row.simd = two_threads.simd = large.simd = options.simd;
  two_threads.threads = 2;
  large.covered_pixels = 900;
  std::vector<Row> rows;
  addSeries("triangles", &Row::triangles, {500, 1000, 5000, 20000, 100000}, row, rows);
  addSeries("particles", &Row::particles, {50, 200, 1000, 5000}, row, rows);
  addSeries("particles", &Row::particles, {50, 200, 1000, 5000}, two_threads, rows);
  addSeries("pixels", &Row::factor, {5, 3, 1}, row, rows);
  addSeries("covered", &Row::triangles, {1000, 5000, 20000}, row, rows);
  addSeries("covered", &Row::triangles, {1000, 5000, 20000}, large, rows);
  addSeries("outline", &Row::edge_stddev_px, {0.8, 0.0}, row, rows);
  addSeries("simd", &Row::simd, dot::availableSimdTargets(), row, rows);
  if (!options.mesh.empty()) {
    row.triangles = 0;
    addSeries("mesh", &Row::covered_pixels, {430, 900}, row, rows);
  }
  return rows;
}

void run(const Options& options) {
  const double min_seconds = options.quick ? 0.05 : 0.3;
  const dot::UpdateCase defaults;
  Meshes meshes(options.mesh);
  dot::selectSimdTarget(options.simd);
  dot::BenchmarkReport report;
  report.machine = dot::machineInfo();
  dot::printMachine(report.machine, std::cout);
  for (const int particles : {2000, 5000}) {
    report.memory.push_back(dot::measureMemory(meshes.get(defaults.triangles), particles));
  }
  dot::printMemory(report.memory, std::cout);

  dot::printUpdateHeader(std::cout);
  for (const dot::UpdateCase& row : makeRows(options)) {
    dot::selectSimdTarget(row.simd);
    report.updates.push_back(dot::timeUpdate(row, meshes.get(row.triangles), min_seconds));
    dot::printUpdate(report.updates.back(), std::cout);
  }
  dot::selectSimdTarget(options.simd);
  std::cout << "heap allocations while timing: " << report.heapAllocations() << '\n';

  const dot::TriangleMesh& mesh = meshes.get(defaults.triangles);
  const dot::BenchmarkScene scene(mesh, defaults.factor, defaults.covered_pixels);
  const auto stages = [&](double edge_stddev_px) {
    return dot::timeStages(scene, mesh, edge_stddev_px, defaults.particles, min_seconds);
  };
  report.soft_stages = stages(defaults.edge_stddev_px);
  report.hard_stages = stages(0.0);
  dot::printStages(report.soft_stages, report.hard_stages, std::cout);
  if (!options.json.empty()) dot::writeJson(report, options.json);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Measures how many poses a second the tracker's engine evaluates.");
  Options options;
  addOptions(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    run(options);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
