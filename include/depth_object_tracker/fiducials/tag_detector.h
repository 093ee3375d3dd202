// SPDX-License-Identifier: BSD-3-Clause
// Finds AprilTags in grey pictures (libapriltag).
#pragma once

#include "depth_object_tracker/fiducials/gray_image.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace depth_object_tracker {

struct TagDetection {
  int id = 0;
  std::array<Eigen::Vector2d, 4> corners;  ///< pixels (integers are pixel centres), in the order of Fiducial::corners()
};

/// Names of the families that can be used.
std::vector<std::string> tagFamilies();

/// Not thread-safe.
class TagDetector {
 public:
  /// @param num_threads >= 1
  /// @throws std::invalid_argument when there is no such family, with the names that there are.
  explicit TagDetector(const std::string& family, int num_threads = 1);
  ~TagDetector();

  /// Tags read without a wrong bit or with one; a number that is read twice is left out: one of them is another tag.
  std::vector<TagDetection> detect(const GrayImageView& image);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// The picture of a tag: square, row-major, one value per module, 0 black or 255 white, white margin included.
struct TagPicture {
  int width = 0;         ///< modules along an edge, margin included
  int square_width = 0;  ///< modules along an edge of the black square
  std::vector<std::uint8_t> modules;
};

/// @throws std::invalid_argument when the family has no such number.
TagPicture drawTag(const std::string& family, int id);

}  // namespace depth_object_tracker
