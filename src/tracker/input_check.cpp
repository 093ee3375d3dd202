// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/input_check.h"

#include "depth_object_tracker/render/depth_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace depth_object_tracker {
namespace {

using Kind = InputFinding::Kind;

constexpr int kSampledSide = 64;  // about so many rows and columns are looked at
constexpr double kLeastValidFraction = 0.005;
constexpr double kMostReadings = 0.9;
constexpr double kNearestSceneM = 0.1;  // no camera measures a whole scene nearer than this
constexpr double kMaxAspectError = 0.05;
constexpr double kMaxCentreShift = 0.1;  // of the image's side; rectified and factory cameras stay below 0.05
constexpr double kMinFieldOfViewRad = 0.2, kMaxFieldOfViewRad = 2.6;
constexpr double kMaxViewsFilled = 2.0;  // diameter over what the camera sees
constexpr double kMinDiameterPixels = 6.0;
constexpr int kPoseGridFactor = 4;
constexpr std::size_t kMinPoseCells = 3;  // of the coarse grid: about 50 pixels
constexpr double kMostBehind = 0.8;       // share of the object's readings behind it
constexpr double kUnitTolerance = 0.12;   // of a power of ten, in decades

template <typename... Numbers>
std::string format(const char* text, Numbers... numbers) {
  char buffer[640];
  std::snprintf(buffer, sizeof(buffer), text, numbers...);
  return buffer;
}

double percentile(std::vector<double>& values, double share) {
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

const char* unitAdvice(DepthImageView::PixelType type) {
  return type == DepthImageView::PixelType::kUint16
             ? "16UC1 must be millimetres: set the camera's depth unit, or convert the image to 32FC1 metres"
             : "32FC1 must be metres: divide millimetres by 1000, or publish them as 16UC1";
}

/// "mesh_scale: 0.001" when that makes a handy object of it.
std::string scaleAdvice(double diameter_m) {
  for (const double scale : {0.001, 0.01, 0.0254, 1000.0, 100.0}) {
    const double scaled = diameter_m * scale;
    if (scaled > 0.03 && scaled < 1.0) {
      return format("multiply mesh_scale (metres per unit of the mesh file) by %g, which makes the object %.3g m",
                    scale, scaled);
    }
  }
  return "correct mesh_scale (metres per unit of the mesh file)";
}

/// Power of ten that a ratio is near to; 0 when it is near to none, or to 1.
int decadesOff(double ratio) {
  const double decades = std::log10(ratio);
  const double whole = std::round(decades);
  return std::abs(decades - whole) < kUnitTolerance ? static_cast<int>(whole) : 0;
}

struct PoseReadings {
  std::size_t covered = 0;
  std::vector<double> measured_m, rendered_m;
};

PoseReadings readAtPose(const TriangleMesh& mesh, const Pose& T_camera_object, const DepthImageView& depth,
                        const PinholeCamera& camera) {
  const SamplingGrid grid = makeSamplingGrid(camera, kPoseGridFactor);
  DepthRenderer renderer(mesh);
  PoseReadings readings;
  for (const CoveredPixel& pixel : renderer.render(T_camera_object, grid.camera)) {
    ++readings.covered;
    const double measured = depth.at(grid.fullRow(pixel.row), grid.fullCol(pixel.col));
    if (!std::isfinite(measured)) continue;
    readings.measured_m.push_back(measured);
    readings.rendered_m.push_back(pixel.depth);
  }
  return readings;
}

std::string depthAtPoseProblem(PoseReadings& readings, double diameter_m) {
  if (readings.measured_m.size() < kMinPoseCells) return "";
  const double margin = std::max(0.05, 0.5 * diameter_m);
  std::size_t behind = 0;
  for (std::size_t i = 0; i < readings.measured_m.size(); ++i) {
    behind += readings.measured_m[i] > readings.rendered_m[i] + margin ? 1 : 0;
  }
  const double share = static_cast<double>(behind) / static_cast<double>(readings.measured_m.size());
  const double measured = percentile(readings.measured_m, 0.5), expected = percentile(readings.rendered_m, 0.5);
  const int decades = decadesOff(measured / expected);
  if (decades != 0 && (share > kMostBehind || decades < 0)) {
    return format(
        "where the initial pose has the object, at %.3g m, the camera measures %.3g m, 10^%d times as much: compare "
        "the "
        "units of depth image and pose (both in metres)",
        expected, measured, decades);
  }
  if (share <= kMostBehind) return "";
  return format(
      "where the initial pose has the object, at %.2f m, %.0f %% of the readings lie well behind it, at %.2f m: the "
      "object is not there; is the pose that of the mesh's origin, in metres, in the frame that header.frame_id names?",
      expected, 100.0 * share, measured);
}

}  // namespace

DepthSummary summariseDepth(const DepthImageView& depth, double max_depth_m) {
  DepthSummary summary;
  std::vector<double> readings;
  int num_pixels = 0, num_beyond = 0;
  const int row_step = std::max(1, depth.height / kSampledSide), col_step = std::max(1, depth.width / kSampledSide);
  for (int row = row_step / 2; row < depth.height; row += row_step) {
    for (int col = col_step / 2; col < depth.width; col += col_step) {
      ++num_pixels;
      const double reading = depth.at(row, col);
      if (!std::isfinite(reading)) continue;
      readings.push_back(reading);
      num_beyond += reading > max_depth_m ? 1 : 0;
    }
  }
  if (readings.empty()) return summary;
  const auto count = static_cast<double>(readings.size());
  summary.valid_fraction = count / num_pixels;
  summary.beyond_fraction = num_beyond / count;
  summary.near_m = percentile(readings, 0.05);
  summary.median_m = percentile(readings, 0.5);
  summary.far_m = percentile(readings, 0.95);
  return summary;
}

InputFindings checkCamera(const PinholeCamera& camera, bool is_part) {
  InputFindings findings;
  if (!camera.findProblem().empty()) return findings;  // refused elsewhere
  if (std::abs(camera.fx / camera.fy - 1.0) > kMaxAspectError) {
    findings.push_back(
        {Kind::kPixelAspect,
         format("fx is %.1f and fy %.1f, although depth cameras have square pixels: are they swapped, or was the image "
                "stretched? For a stretched image fx goes with its width and fy with its height",
                camera.fx, camera.fy)});
  }
  const double middle_x = 0.5 * (camera.width - 1), middle_y = 0.5 * (camera.height - 1);
  const bool is_shifted = std::abs(camera.cx - middle_x) > kMaxCentreShift * camera.width ||
                          std::abs(camera.cy - middle_y) > kMaxCentreShift * camera.height;
  if (is_shifted && !is_part) {
    findings.push_back({Kind::kPrincipalPoint,
                        format("the principal point (cx, cy) = (%.1f, %.1f) is far from the middle (%.1f, %.1f) of the "
                               "%dx%d image: is it the calibration of another resolution (one of about %.0fx%.0f "
                               "would fit), or of a cropped image without its roi?",
                               camera.cx, camera.cy, middle_x, middle_y, camera.width, camera.height,
                               2.0 * camera.cx + 1.0, 2.0 * camera.cy + 1.0)});
  }
  const double field_of_view = 2.0 * std::atan(0.5 * camera.width / camera.fx);
  if (!is_part && (field_of_view < kMinFieldOfViewRad || field_of_view > kMaxFieldOfViewRad)) {
    findings.push_back({Kind::kFieldOfView,
                        format("fx = %.1f pixels makes a field of view of %.0f degrees for an image %d pixels wide: fx "
                               "must be in pixels of this image",
                               camera.fx, field_of_view * 180.0 / M_PI, camera.width)});
  }
  return findings;
}

InputFindings checkDepth(const DepthSummary& depth, DepthImageView::PixelType pixel_type, double max_depth_m) {
  InputFindings findings;
  if (depth.valid_fraction < kLeastValidFraction) {
    findings.push_back(
        {Kind::kNoDepth, format("has no valid depth: %.1f %% of its pixels have a reading (the others are 0, NaN or "
                                "infinite). Is the lens covered, the projector off, or everything too near?",
                                100.0 * depth.valid_fraction)});
  } else if (depth.beyond_fraction > kMostReadings) {
    findings.push_back({Kind::kDepthUnit,
                        format("has %.0f %% of its readings beyond max_depth_m = %g m, half of them beyond %.3g m: is "
                               "the unit right? %s",
                               100.0 * depth.beyond_fraction, max_depth_m, depth.median_m, unitAdvice(pixel_type))});
  } else if (depth.far_m < kNearestSceneM) {
    findings.push_back({Kind::kDepthUnit, format("has 95 %% of its readings nearer than %.2g m, which no depth camera "
                                                 "measures: is the unit right? %s",
                                                 depth.far_m, unitAdvice(pixel_type))});
  }
  return findings;
}

InputFindings checkMeshSize(double diameter_m, const DepthSummary& depth, const PinholeCamera& camera) {
  InputFindings findings;
  if (depth.valid_fraction < kLeastValidFraction) return findings;
  const double view_m = depth.far_m * std::hypot(camera.width / camera.fx, camera.height / camera.fy);
  const double diameter_px = diameter_m / depth.near_m * std::max(camera.fx, camera.fy);
  if (diameter_m > kMaxViewsFilled * view_m) {
    findings.push_back({Kind::kMeshTooLarge,
                        format("the mesh is %.4g m in diameter, but all that the camera sees is %.2g m across: is the "
                               "mesh in millimetres? ",
                               diameter_m, view_m) +
                            scaleAdvice(diameter_m)});
  } else if (diameter_px < kMinDiameterPixels) {
    findings.push_back({Kind::kMeshTooSmall,
                        format("the mesh is %.3g m in diameter, at most %.1f pixels of the image even at the nearest "
                               "reading (%.2f m): was mesh_scale applied twice? ",
                               diameter_m, diameter_px, depth.near_m) +
                            scaleAdvice(diameter_m)});
  }
  return findings;
}

InputFindings checkInitialPose(const TriangleMesh& mesh, double diameter_m, const Pose& T_camera_object,
                               const DepthImageView& depth, const PinholeCamera& camera) {
  const Eigen::Vector3d centre = T_camera_object * surfaceCentroid(mesh);
  if (centre.z() <= 0.0) {
    return {
        {Kind::kPoseBehindCamera,
         format("the initial pose has the object at (%.2f, %.2f, %.2f), behind the camera: optical frames have x to "
                "the right, y down and z forward; a pose in other axes must name its frame in header.frame_id",
                centre.x(), centre.y(), centre.z())}};
  }
  PoseReadings readings = readAtPose(mesh, T_camera_object, depth, camera);
  if (readings.covered < kMinPoseCells) {
    const Eigen::Vector2d pixel = camera.project(centre);
    return {{Kind::kPoseOutsideImage,
             format("the initial pose has the object at (%.2f, %.2f, %.2f), around pixel (%.0f, %.0f) of the %dx%d "
                    "image, where it covers next to nothing: is the pose in metres and in the frame that "
                    "header.frame_id names?",
                    centre.x(), centre.y(), centre.z(), pixel.x(), pixel.y(), camera.width, camera.height)}};
  }
  const std::string problem = depthAtPoseProblem(readings, diameter_m);
  if (problem.empty()) return {};
  return {{Kind::kPoseDepth, problem}};
}

}  // namespace depth_object_tracker
