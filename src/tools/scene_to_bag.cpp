// SPDX-License-Identifier: BSD-3-Clause
// Program: converts a BOP scene folder to a rosbag.
#include "depth_object_tracker/tools/progress_bar.h"
#include "depth_object_tracker/tools/scene_pictures.h"
#include "scene_bag_writer.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <iostream>

namespace depth_object_tracker {
namespace {

struct SceneToBagOptions {
  std::string scene;
  std::string bag;
  BopSceneOptions reading;
};

void warn(const std::string& message) {
  std::cerr << "warning: " << message << std::endl;
}

void reportLoss(const RoundingLoss& loss) {
  const std::uint64_t kept = loss.readings - loss.out_of_range;
  if (loss.max_mm > 1e-6 && kept > 0) {
    std::printf("depth rounded to whole mm: error %.3f mm on average, %.3f mm at most\n",
                loss.sum_mm / static_cast<double>(kept), loss.max_mm);
  }
  if (loss.out_of_range > 0) {
    warn(std::to_string(loss.out_of_range) + " of " + std::to_string(loss.readings) +
         " readings do not fit into 16 bits of mm and are written as \"no reading\"");
  }
}

void convert(const SceneToBagOptions& options) {
  const BopScene scene = loadBopScene(options.scene, options.reading);
  for (const std::string& warning : scene.warnings) warn(warning);
  ScenePictures pictures(scene.frames, warn);
  SceneBagWriter writer(options.bag, scene.frames.front().stamp_s);
  ProgressBar progress(scene.frames.size());
  for (std::size_t k = 0; k < scene.frames.size(); ++k) {
    writer.write(scene.frames[k], pictures.read(scene.frames[k]), pictures.camera(scene.frames[k]));
    progress.update(k + 1);
  }
  writer.close();
  reportLoss(writer.loss());
  std::printf("%zu frames written to %s\n", scene.frames.size(), options.bag.c_str());
}

int run(int argc, char** argv) {
  SceneToBagOptions options;
  CLI::App app(
      "Converts a BOP scene folder to a rosbag: depth, camera_info, grasp, control twist and ground truth.\n"
      "Scenes whose stamps count from 0 start at 1000000000 s.",
      "scene_to_bag");
  app.add_option("SCENE", options.scene, "BOP scene folder")->required();
  app.add_option("BAG", options.bag, "bag to write (an existing one is replaced)")->required();
  app.add_option("--object-id", options.reading.object_id, "object in scene_gt.json (default 1)");
  app.add_option("--fps", options.reading.fps, "frame rate where there is no timestamp (default 30)")
      ->check(CLI::PositiveNumber);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  convert(options);
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
