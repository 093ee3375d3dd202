// SPDX-License-Identifier: BSD-3-Clause
// Scenes of the BOP format. The first byte chooses the file that the rest becomes; the others are good ones.
#include "depth_object_tracker/tools/bop_models_info.h"
#include "depth_object_tracker/tools/bop_scene.h"
#include "depth_object_tracker/tools/depth_picture.h"
#include "depth_object_tracker/tools/input_error.h"
#include "fuzz_input.h"

#include <fcntl.h>

#include <array>
#include <filesystem>

namespace dot = depth_object_tracker;
namespace fs = std::filesystem;

namespace {

constexpr std::array<const char*, 7> kFiles = {"scene_camera.json", "scene_gt.json",    "scene_control.json",
                                               "visibility.csv",    "models_info.json", "init.json",
                                               "depth/000001.png"};
constexpr std::array<const char*, 6> kGood = {
    R"({"1": {"cam_K": [500, 0, 320, 0, 500, 240, 0, 0, 1], "depth_scale": 1.0}, "2": {"cam_K": [500, 0, 320, 0, 500, 240, 0, 0, 1], "depth_scale": 0.1, "timestamp": 3.5}})",
    R"({"1": [{"obj_id": 1, "cam_R_m2c": [1, 0, 0, 0, 1, 0, 0, 0, 1], "cam_t_m2c": [0, 0, 600]}]})",
    R"({"1": {"grasped": true, "linear": [0.1, 0, 0], "angular": [0, 0, 1]}, "2": {"grasped": true}})",
    "frame,fraction_visible\n1,0.5\n2,1\n",
    R"({"1": {"symmetries_continuous": [{"axis": [0, 0, 1], "offset": [0, 0, 0]}], "symmetries_discrete": [[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]]}})",
    R"({"cam_R_m2c": [1, 0, 0, 0, 1, 0, 0, 0, 1], "cam_t_m2c": [0, 0, 600]})"};

/// A folder of this process's own, in memory where that is possible.
class SceneFolder {
 public:
  SceneFolder() {
    const fs::path base = fs::is_directory("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path();
    std::string name = (base / "bop_fuzzer_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) std::abort();
    path_ = name;
    fs::create_directory(path_ / "depth");
    for (std::size_t i = 0; i < kGood.size(); ++i) write(i, kGood[i]);
  }
  ~SceneFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  SceneFolder(const SceneFolder&) = delete;
  SceneFolder& operator=(const SceneFolder&) = delete;

  /// One file becomes that; the others are good ones.
  void put(std::size_t which, const std::string& content) {
    if (changed_ != which && changed_ < kGood.size()) write(changed_, kGood[changed_]);
    changed_ = which;
    write(which, content);
  }
  std::string file(std::size_t which) const { return (path_ / kFiles[which]).string(); }
  std::string path() const { return path_.string(); }

 private:
  void write(std::size_t which, const std::string& content) const {
    const int descriptor = open(file(which).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (descriptor < 0 || ::write(descriptor, content.data(), content.size()) != static_cast<ssize_t>(content.size()))
      std::abort();
    close(descriptor);
  }

  fs::path path_;
  std::size_t changed_ = kFiles.size();
};

/// Each may refuse its file with an InputError and nothing else.
template <typename Call>
void attempt(const Call& call) {
  try {
    call();
  } catch (const dot::InputError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static SceneFolder folder;
  if (size == 0) return 0;
  const std::size_t which = data[0] % kFiles.size();
  folder.put(which, dot::toText(data + 1, size - 1));
  if (which < 4) {
    attempt([&] {
      const dot::BopScene scene = dot::loadBopScene(folder.path(), {});
      dot::everyNthFrame(scene.frames, 2);
    });
  } else if (which == 4) {
    attempt([&] { dot::loadBopSymmetries(folder.file(which), 1, 0.001); });
  } else if (which == 5) {
    attempt([&] { dot::loadPoseFile(folder.file(which)); });
  } else {
    attempt([&] {
      const dot::DepthPicture picture = dot::readDepthPicture(folder.file(which));
      const dot::DepthImageView view = picture.view(0.001);
      if (view.width > 0 && view.height > 0) view.at(view.height - 1, view.width - 1);
    });
  }
  return 0;
}
