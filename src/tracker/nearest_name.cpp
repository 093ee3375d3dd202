// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/nearest_name.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>

namespace depth_object_tracker {
namespace {

constexpr std::size_t kLongestName = 100;  // nobody types longer ones: bounds the work for hostile keys

/// Number of letters to insert, delete or replace to turn one word into the other.
std::size_t editDistance(const std::string& from, const std::string& to) {
  std::vector<std::size_t> row(to.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < from.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < to.size(); ++j) {
      const std::size_t replaced = diagonal + (from[i] == to[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

const std::string& nearestName(const std::string& name, const std::vector<std::string>& names) {
  const std::string word = name.substr(0, kLongestName);
  const std::string* nearest = &names.front();
  std::size_t nearest_distance = std::numeric_limits<std::size_t>::max();
  for (const std::string& known : names) {
    const std::size_t distance = editDistance(word, known);
    if (distance < nearest_distance) nearest = &known, nearest_distance = distance;
  }
  return *nearest;
}

}  // namespace depth_object_tracker
