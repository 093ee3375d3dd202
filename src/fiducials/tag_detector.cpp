// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/fiducials/tag_detector.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <stdexcept>

extern "C" {
#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h11.h>
}

namespace depth_object_tracker {
namespace {

constexpr int kMaxWrongBits = 1;
constexpr float kMinMargin = 20.0f;   // of the decoded bits' contrast: less is a chance pattern
constexpr double kPixelCentre = 0.5;  // libapriltag counts from the corner of the first pixel

struct FamilyFunctions {
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};

const std::map<std::string, FamilyFunctions>& families() {
  static const std::map<std::string, FamilyFunctions> all{{"tag16h5", {tag16h5_create, tag16h5_destroy}},
                                                          {"tag25h9", {tag25h9_create, tag25h9_destroy}},
                                                          {"tag36h11", {tag36h11_create, tag36h11_destroy}}};
  return all;
}

/// As the library's own image_u8_destroy, which not every build of it exports.
void destroyPicture(image_u8_t* image) {
  std::free(image->buf);
  std::free(image);
}

const FamilyFunctions& familyNamed(const std::string& name) {
  const auto found = families().find(name);
  if (found != families().end()) return found->second;
  std::string known;
  for (const std::string& family : tagFamilies()) known += (known.empty() ? "" : ", ") + family;
  throw std::invalid_argument("tag family '" + name + "' is not known; known are " + known);
}

using Family = std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)>;
using Detector = std::unique_ptr<apriltag_detector_t, void (*)(apriltag_detector_t*)>;
using Picture = std::unique_ptr<image_u8_t, void (*)(image_u8_t*)>;
using Detections = std::unique_ptr<zarray_t, void (*)(zarray_t*)>;

}  // namespace

std::vector<std::string> tagFamilies() {
  std::vector<std::string> names;
  for (const auto& [name, functions] : families()) names.push_back(name);
  return names;
}

class TagDetector::Implementation {
 public:
  Implementation(const std::string& family, int num_threads)
      : family_(familyNamed(family).create(), familyNamed(family).destroy),
        detector_(apriltag_detector_create(), apriltag_detector_destroy) {
    apriltag_detector_add_family_bits(detector_.get(), family_.get(), kMaxWrongBits);
    detector_->nthreads = num_threads;
    detector_->quad_decimate = 1.0f;  // tags on small objects are small in the picture
    detector_->refine_edges = true;
  }

  std::vector<TagDetection> detect(const GrayImageView& view) {
    // The library only reads, but takes memory that may be written to.
    image_u8_t image{view.width, view.height, static_cast<int>(view.step), const_cast<std::uint8_t*>(view.data)};
    const Detections found(apriltag_detector_detect(detector_.get(), &image), apriltag_detections_destroy);
    std::vector<TagDetection> detections;
    for (int k = 0; k < zarray_size(found.get()); ++k) {
      apriltag_detection_t* raw = nullptr;
      zarray_get(found.get(), k, &raw);
      if (raw->decision_margin < kMinMargin) continue;
      TagDetection detection;
      detection.id = raw->id;
      for (std::size_t c = 0; c < 4; ++c) {
        detection.corners[c] = Eigen::Vector2d(raw->p[c][0], raw->p[c][1]).array() - kPixelCentre;
      }
      detections.push_back(detection);
    }
    return detections;
  }

 private:
  Family family_;
  Detector detector_;
};

TagDetector::TagDetector(const std::string& family, int num_threads)
    : implementation_(std::make_unique<Implementation>(family, num_threads)) {}
TagDetector::~TagDetector() = default;

std::vector<TagDetection> TagDetector::detect(const GrayImageView& image) {
  std::vector<TagDetection> detections = implementation_->detect(image);
  std::map<int, int> count;
  for (const TagDetection& detection : detections) ++count[detection.id];
  const auto is_ambiguous = [&](const TagDetection& detection) { return count[detection.id] > 1; };
  detections.erase(std::remove_if(detections.begin(), detections.end(), is_ambiguous), detections.end());
  return detections;
}

TagPicture drawTag(const std::string& family, int id) {
  const FamilyFunctions& functions = familyNamed(family);
  const Family made(functions.create(), functions.destroy);
  if (id < 0 || id >= static_cast<int>(made->ncodes)) {
    throw std::invalid_argument("tag " + std::to_string(id) + " is not in family '" + family +
                                "', which has numbers 0 to " + std::to_string(made->ncodes - 1));
  }
  const Picture image(apriltag_to_image(made.get(), static_cast<std::uint32_t>(id)), destroyPicture);
  TagPicture picture;
  picture.width = image->width;
  picture.square_width = made->width_at_border;
  for (int row = 0; row < image->height; ++row) {
    const std::uint8_t* begin = image->buf + static_cast<std::ptrdiff_t>(row) * image->stride;
    picture.modules.insert(picture.modules.end(), begin, begin + image->width);
  }
  return picture;
}

}  // namespace depth_object_tracker
