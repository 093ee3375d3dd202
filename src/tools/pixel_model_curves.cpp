// SPDX-License-Identifier: BSD-3-Clause
// Program: the density of one pixel's reading under the measurement model, as a table for plots (the paper's Figure 4).
#include "depth_object_tracker/model/pixel_likelihood.h"

#include <CLI/CLI.hpp>

#include <iostream>

namespace depth_object_tracker {
namespace {

int run(int argc, char** argv) {
  CLI::App app(
      "Prints p(z | visible), p(z | occluded) and p(z | no object) over the measured depth z as CSV, with the paper's "
      "noise.");
  double depth_m = 1.5, from_m = 0.02, to_m = 3.0, step_m = 0.002;
  app.add_option("--depth", depth_m, "of the object [m]")->check(CLI::Range(0.05, 10.0))->capture_default_str();
  app.add_option("--from", from_m, "[m]")->check(CLI::Range(1e-3, 10.0))->capture_default_str();
  app.add_option("--to", to_m, "[m]")->check(CLI::Range(1e-3, 10.0))->capture_default_str();
  app.add_option("--step", step_m, "[m]")->check(CLI::Range(1e-4, 1.0))->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  PixelModelConfig consistent;
  consistent.object_noise_stddev_m = 0.003;
  PixelModelConfig paper = consistent;
  paper.occluder_model = OccluderModel::kPaper;
  std::cout << "z,visible,occluded_paper,occluded_consistent,miss\n";
  for (double z = from_m; z <= to_m; z += step_m) {
    std::cout << z << ',' << visibleDensity(z, depth_m, paper) << ',' << occludedDensity(z, depth_m, paper) << ','
              << occludedDensity(z, depth_m, consistent) << ',' << missDensity(z, paper) << '\n';
  }
  return 0;
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  try {
    return depth_object_tracker::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
}
