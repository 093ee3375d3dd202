// SPDX-License-Identifier: BSD-3-Clause
// Visible share of the object per frame, where a scene says it.
#include "visibility_file.h"

#include "depth_object_tracker/tools/input_error.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>

namespace depth_object_tracker {
namespace {

std::vector<std::string> splitRow(std::string line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

std::size_t columnOf(const std::vector<std::string>& header, const std::string& name, const std::string& file) {
  const auto found = std::find(header.begin(), header.end(), name);
  if (found == header.end()) throw InputError(file + " has no column \"" + name + "\"");
  return static_cast<std::size_t>(found - header.begin());
}

double toNumber(const std::string& cell, const std::string& where) {
  char* end = nullptr;
  const double number = std::strtod(cell.c_str(), &end);
  if (cell.empty() || *end != '\0' || !std::isfinite(number))
    throw InputError(where + ": \"" + cell + "\" is not a number");
  return number;
}

}  // namespace

void readVisibility(BopScene& scene) {
  const std::string path = (std::filesystem::path(scene.folder) / "visibility.csv").string();
  if (!std::filesystem::exists(path)) return;
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) throw InputError(path + " is empty or cannot be read");
  const std::vector<std::string> header = splitRow(line);
  const std::size_t frame_column = columnOf(header, "frame", path);
  const std::size_t fraction_column = columnOf(header, "fraction_visible", path);

  std::map<int, double> fractions;
  for (int number = 2; std::getline(file, line); ++number) {
    const std::vector<std::string> cells = splitRow(line);
    const std::string where = path + ", line " + std::to_string(number);
    if (cells.empty()) continue;
    if (cells.size() <= std::max(frame_column, fraction_column)) throw InputError(where + " has too few columns");
    const double frame = toNumber(cells[frame_column], where);
    if (frame < 0.0 || frame > std::numeric_limits<int>::max())
      throw InputError(where + ": \"" + cells[frame_column] + "\" is not a frame number");
    fractions[static_cast<int>(frame)] = toNumber(cells[fraction_column], where);
  }
  scene.has_visibility = true;
  for (SceneFrame& frame : scene.frames) {
    const auto found = fractions.find(frame.id);
    if (found != fractions.end()) frame.visible_fraction = found->second;
  }
}

}  // namespace depth_object_tracker
