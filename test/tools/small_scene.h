// SPDX-License-Identifier: BSD-3-Clause
// A scene folder of a few small pictures: a box before a wall, moving slowly.
#pragma once

#include "depth_object_tracker/geometry/pose.h"
#include "temporary_folder.h"

#include <cstdint>
#include <string>
#include <vector>

namespace depth_object_tracker {

class SmallScene {
 public:
  static constexpr int kWidth = 160;
  static constexpr int kHeight = 120;

  explicit SmallScene(int num_frames = 6);

  std::string path() const { return (folder_.path() / "000007").string(); }
  std::string file(const std::string& name) const { return path() + "/" + name; }
  std::string output(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string picture(int frame) const;

  /// Replaces a file of the scene.
  void write(const std::string& name, const std::string& content) const;
  /// Replaces a picture by one of another kind.
  void writePicture(int frame, int width, int height, int bits, int channels) const;
  std::string read(const std::string& name) const;

  static Pose truth(int frame);

 private:
  TemporaryFolder folder_;
};

/// Replaces the first occurrence; throws when there is none.
std::string replaceFirst(std::string text, const std::string& from, const std::string& to);

/// Exit code, standard output and standard error of a program.
struct ProgramRun {
  int exit_code = -1;
  std::string out;
  std::string err;
};
ProgramRun runProgram(const std::string& program, const std::vector<std::string>& arguments);

}  // namespace depth_object_tracker
