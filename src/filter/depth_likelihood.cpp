// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/depth_likelihood.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

// Pixels seen flatter than this tell more about the mesh's edges than about the pose.
constexpr double kMinIncidenceCosine = 0.12;

double boundingRadius(const TriangleMesh& mesh, const Eigen::Vector3d& centre) {
  double squared = 0.0;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    squared = std::max(squared, (vertex.cast<double>() - centre).squaredNorm());
  }
  return std::sqrt(squared);
}

std::vector<Eigen::Vector3f> triangleNormals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> normals;
  normals.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d edge1 = (mesh.vertices[b] - mesh.vertices[a]).cast<double>();
    const Eigen::Vector3d edge2 = (mesh.vertices[c] - mesh.vertices[a]).cast<double>();
    normals.push_back(edge1.cross(edge2).normalized().cast<float>());
  }
  return normals;
}

/// Surface noise widened by an extra standard deviation [m].
void widen(MeasuredPixel& pixel, float extra_stddev_m) {
  const float widened =
      1.0f / std::sqrt(1.0f / (pixel.inverse_stddev * pixel.inverse_stddev) + extra_stddev_m * extra_stddev_m);
  pixel.visible_peak *= widened / pixel.inverse_stddev;
  pixel.inverse_stddev = widened;
}

/// What a reading of the surface says: the depth along the beam changes by n.(dt + dtheta x (p - c)) / n.ray.
void addSurfaceTerm(const MeasuredPixel& pixel, float rendered_depth, float responsibility, const Eigen::Vector3d& ray,
                    const Eigen::Vector3d& from_centre, const Eigen::Vector3d& normal, Linearisation& sum) {
  const double slope = normal.dot(ray);
  if (responsibility < 1e-4f || std::abs(slope) < kMinIncidenceCosine * ray.norm()) return;
  Vector6d jacobian;
  jacobian.head<3>() = normal / slope;
  jacobian.tail<3>() = from_centre.cross(normal) / slope;
  const double weight = responsibility * pixel.inverse_stddev * pixel.inverse_stddev;
  sum.gradient += weight * (pixel.depth - rendered_depth) * jacobian;
  sum.information.selfadjointView<Eigen::Lower>().rankUpdate(jacobian, weight);
}

/// What a pixel near the outline says: moving the object along the outward image normal covers it more.
/// @param slope d log L / d distance to the outline [nat/px]. Its square stands for the information (Fisher's
/// identity).
void addOutlineTerm(double slope, const Eigen::Vector2d& normal, const Eigen::Vector3d& ray, double depth,
                    const Eigen::Vector3d& from_centre, const PinholeCamera& camera, Linearisation& sum) {
  const Eigen::Vector3d image_motion(camera.fx * normal.x() / depth, camera.fy * normal.y() / depth,
                                     -(camera.fx * normal.x() * ray.x() + camera.fy * normal.y() * ray.y()) / depth);
  Vector6d jacobian;
  jacobian.head<3>() = image_motion;
  jacobian.tail<3>() = from_centre.cross(image_motion);
  sum.gradient += slope * jacobian;
  sum.information.selfadjointView<Eigen::Lower>().rankUpdate(jacobian, slope * slope);
}

/// Log of a product of many positive factors; takes one logarithm for many of them.
class LogProduct {
 public:
  void multiply(float factor) {
    product_ *= factor;
    if (++count_ == kFactorsPerLog) flush();
  }
  double log() {
    flush();
    return sum_;
  }

 private:
  // A factor lies within about 1e-7 and 1e5: sixteen of them stay far inside of the range of a double.
  static constexpr int kFactorsPerLog = 16;
  void flush() {
    sum_ += std::log(product_);
    product_ = 1.0;
    count_ = 0;
  }
  double product_ = 1.0, sum_ = 0.0;
  int count_ = 0;
};

}  // namespace

DepthLikelihood::DepthLikelihood(const TriangleMesh& mesh, const Eigen::Vector3d& centre_object,
                                 const PixelModelConfig& pixel_config, const OcclusionChainConfig& occlusion_config,
                                 int num_particles, int num_threads)
    : mesh_(mesh),
      centre_object_(centre_object),
      radius_(boundingRadius(mesh, centre_object)),
      normals_object_(triangleNormals(mesh)),
      image_(pixel_config),
      memory_(occlusion_config, num_particles),
      weights_(static_cast<std::size_t>(num_particles), 1.0 / num_particles),
      pool_(num_threads),
      renderers_(static_cast<std::size_t>(pool_.numThreads()), DepthRenderer(mesh)),
      outlines_(renderers_.size()),
      edge_stddev_px_(pixel_config.edge_stddev_px) {}

void DepthLikelihood::setImage(const DepthImageView& view, const SamplingGrid& grid, double dt_s) {
  const SamplingGrid& last = image_.grid();
  if (last.full != grid.full) {
    memory_.reset();
  } else if (last.factor != grid.factor) {
    memory_.resampleGrid(last, grid);
  }
  image_.setImage(view, grid);
  memory_.advance(dt_s);
}

CellBox DepthLikelihood::boundingBox(const Pose& T_camera_centre) const {
  const PinholeCamera& camera = image_.grid().camera;
  const Eigen::Vector3d p = T_camera_centre.translation();
  const double nearest = p.z() - radius_;
  if (!(p.allFinite())) return CellBox();
  if (nearest <= kNearPlaneM) return image_.imageBox();
  // The sphere's silhouette is inside of the projection of its bounding cube's front face and centre offsets.
  const auto bounds = [&](double x, double focal, double principal) {
    const double low = std::min((x - radius_) / nearest, (x - radius_) / (p.z() + radius_));
    const double high = std::max((x + radius_) / nearest, (x + radius_) / (p.z() + radius_));
    const double limit = 1e6;
    return std::pair<int, int>{static_cast<int>(std::floor(std::clamp(focal * low + principal, -limit, limit))),
                               static_cast<int>(std::ceil(std::clamp(focal * high + principal, -limit, limit))) + 1};
  };
  const auto [col_begin, col_end] = bounds(p.x(), camera.fx, camera.cx);
  const auto [row_begin, row_end] = bounds(p.y(), camera.fy, camera.cy);
  return intersect({row_begin, row_end, col_begin, col_end}, image_.imageBox());
}

void DepthLikelihood::prepare(const std::vector<Pose>& T_camera_centre) {
  CellBox box;
  for (const Pose& pose : T_camera_centre) box = unite(box, boundingBox(pose));
  image_.prepare(box);
  memory_.cover(box, image_.imageBox());
  memory_.mean(weights_, mean_belief_);
}

const std::vector<SoftPixel>& DepthLikelihood::render(const Pose& T_camera_centre, int thread) {
  Pose T_camera_object = T_camera_centre;
  T_camera_object.translation() -= T_camera_centre.linear() * centre_object_;
  const auto i = static_cast<std::size_t>(thread);
  const PinholeCamera& camera = image_.grid().camera;
  return outlines_[i].soften(renderers_[i].render(T_camera_object, camera), camera, edgeStddev());
}

float DepthLikelihood::meanBelief(int row, int col) const {
  return memory_.probability(memory_.inRegion(row, col) ? mean_belief_[memory_.cell(row, col)] : memory_.unmeasured());
}

double DepthLikelihood::logLikelihood(const Pose& T_camera_centre, int thread) {
  return broadLogLikelihood(T_camera_centre, 0.0, thread);
}

double DepthLikelihood::broadLogLikelihood(const Pose& T_camera_centre, double extra_stddev_m, int thread) {
  if (!image_.isPrepared(boundingBox(T_camera_centre))) return -std::numeric_limits<double>::infinity();
  LogProduct likelihood;
  for (const SoftPixel& covered : render(T_camera_centre, thread)) {
    MeasuredPixel pixel = image_.pixel(covered.row, covered.col);
    if (pixel.depth <= 0.0f) continue;
    if (extra_stddev_m > 0.0) widen(pixel, static_cast<float>(extra_stddev_m));
    const PixelRatios ratios = image_.ratios(pixel, covered.depth);
    const float p_occluded = image_.believedOcclusion(meanBelief(covered.row, covered.col), pixel, covered.depth);
    const float hit = (1.0f - p_occluded) * ratios.visible + p_occluded * ratios.occluded;
    likelihood.multiply(1.0f + covered.coverage * (hit - 1.0f));
  }
  return likelihood.log();
}

Linearisation DepthLikelihood::linearise(const Pose& T_camera_centre, double extra_stddev_m, int thread) {
  Linearisation result;
  if (!image_.isPrepared(boundingBox(T_camera_centre))) return result;
  const Eigen::Matrix3d R = T_camera_centre.linear();
  const Eigen::Vector3d centre = T_camera_centre.translation();
  const PinholeCamera& camera = image_.grid().camera;
  const SoftOutline& outline = outlines_[static_cast<std::size_t>(thread)];
  for (const SoftPixel& covered : render(T_camera_centre, thread)) {
    MeasuredPixel pixel = image_.pixel(covered.row, covered.col);
    if (pixel.depth <= 0.0f) continue;
    if (extra_stddev_m > 0.0) widen(pixel, static_cast<float>(extra_stddev_m));
    const PixelRatios ratios = image_.ratios(pixel, covered.depth);
    const float p_occluded = image_.believedOcclusion(meanBelief(covered.row, covered.col), pixel, covered.depth);
    const float hit = (1.0f - p_occluded) * ratios.visible + p_occluded * ratios.occluded;
    const float total = 1.0f + covered.coverage * (hit - 1.0f);
    const Eigen::Vector3d ray = camera.ray(covered.col, covered.row);
    const Eigen::Vector3d from_centre = ray * covered.depth - centre;
    if (covered.coverage >= 0.5f) {
      const float responsibility = covered.coverage * (1.0f - p_occluded) * ratios.surface / total;
      addSurfaceTerm(pixel, covered.depth, responsibility, ray, from_centre,
                     R * normals_object_[covered.triangle].cast<double>(), result);
    }
    if (covered.coverage < 1.0f) {
      const double edge_stddev = edgeStddev(), distance = outline.distance(covered);
      const double density =
          std::exp(-0.5 * distance * distance / (edge_stddev * edge_stddev)) / (edge_stddev * std::sqrt(2.0 * M_PI));
      addOutlineTerm(density * (hit - 1.0) / total, outline.outwardNormal(covered).cast<double>(), ray, covered.depth,
                     from_centre, camera, result);
    }
  }
  result.information = result.information.selfadjointView<Eigen::Lower>();
  return result;
}

void DepthLikelihood::update(const std::vector<Pose>& T_camera_centre, std::vector<double>& log_likelihoods) {
  prepare(T_camera_centre);  // every particle remembers all of its pixels, also one that was drawn far from the others
  log_likelihoods.assign(T_camera_centre.size(), 0.0);
  pool_.run(static_cast<int>(T_camera_centre.size()), [&](int index, int thread) {
    const auto i = static_cast<std::size_t>(index);
    log_likelihoods[i] = updateParticle(index, T_camera_centre[i], thread);
  });
}

double DepthLikelihood::updateParticle(int index, const Pose& T_camera_centre, int thread) {
  float* beliefs = memory_.particle(index);
  LogProduct likelihood;
  for (const SoftPixel& covered : render(T_camera_centre, thread)) {
    const MeasuredPixel& pixel = image_.pixel(covered.row, covered.col);
    if (pixel.depth <= 0.0f) continue;
    const PixelRatios ratios = image_.ratios(pixel, covered.depth);
    const bool remembered = memory_.inRegion(covered.row, covered.col);
    float* belief = remembered ? beliefs + memory_.cell(covered.row, covered.col) : nullptr;
    const float p_occluded = image_.believedOcclusion(memory_.probability(remembered ? *belief : memory_.unmeasured()),
                                                      pixel, covered.depth);
    const float hit = (1.0f - p_occluded) * ratios.visible + p_occluded * ratios.occluded;
    const float total = 1.0f + covered.coverage * (hit - 1.0f);
    likelihood.multiply(total);
    // A beam that misses the object says nothing about occlusion: that share of the belief stays.
    const float occluded = p_occluded * (1.0f + covered.coverage * (ratios.occluded - 1.0f));
    if (remembered) *belief = memory_.stored(occluded / total);
  }
  return likelihood.log();
}

void DepthLikelihood::resample(const std::vector<int>& source) {
  for (std::size_t slot = 0; slot < source.size(); ++slot) {
    if (source[slot] != static_cast<int>(slot)) memory_.copy(source[slot], static_cast<int>(slot));
  }
  weights_.assign(source.size(), 1.0 / static_cast<double>(source.size()));
}

PoseAssessment DepthLikelihood::assess(const Pose& T_camera_centre, int thread) {
  PoseAssessment result;
  image_.prepare(boundingBox(T_camera_centre));
  LogProduct likelihood;
  for (const SoftPixel& covered : render(T_camera_centre, thread)) {
    const bool inside = covered.coverage >= 0.5f;
    result.covered_pixels += inside ? 1 : 0;
    const MeasuredPixel& pixel = image_.pixel(covered.row, covered.col);
    if (pixel.depth <= 0.0f) continue;
    const PixelRatios ratios = image_.ratios(pixel, covered.depth);
    const float p_occluded = image_.believedOcclusion(meanBelief(covered.row, covered.col), pixel, covered.depth);
    const float visible = (1.0f - p_occluded) * ratios.visible, occluded = p_occluded * ratios.occluded;
    const float total = 1.0f + covered.coverage * (visible + occluded - 1.0f);
    likelihood.multiply(total);
    if (!inside) continue;
    const double not_occluded = visible / (visible + occluded);
    ++result.measured_pixels;
    result.visible_pixels += (1.0f - p_occluded) * ratios.surface / (visible + occluded);
    result.achieved += not_occluded * std::log(total);
    // A visible pixel's log density has the mean of a Gaussian's: half a nat below its peak.
    const double peak = (1.0f - p_occluded) * pixel.visible_peak;
    result.expected += not_occluded * (std::log(1.0 + covered.coverage * (peak - 1.0)) - 0.5);
  }
  result.log_likelihood = likelihood.log();
  return result;
}

double DepthLikelihood::edgeStddev() const {
  // On a coarse grid the outline is known to a fraction of a cell at best: cells are in or out as a whole.
  constexpr double kCellStddev = 0.3;
  return edge_stddev_px_ > 0.0 ? std::hypot(kCellStddev, edge_stddev_px_ / image_.grid().factor) : 0.0;
}

void DepthLikelihood::occlusionMap(const std::vector<Pose>& T_camera_centre, const std::vector<double>& weights,
                                   std::vector<float>& map) {
  const PinholeCamera& camera = image_.grid().camera;
  const std::size_t num_cells = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  std::vector<float> covering(num_cells, 0.0f);
  map.assign(num_cells, 0.0f);
  for (std::size_t i = 0; i < T_camera_centre.size(); ++i) {
    const auto weight = static_cast<float>(weights[i]);
    if (weight <= 0.0f) continue;
    const float* beliefs = memory_.particle(static_cast<int>(i));
    for (const SoftPixel& covered : render(T_camera_centre[i], 0)) {
      if (covered.coverage < 0.5f) continue;
      const bool remembered = memory_.inRegion(covered.row, covered.col);
      const float stored = remembered ? beliefs[memory_.cell(covered.row, covered.col)] : memory_.unmeasured();
      const std::size_t cell =
          static_cast<std::size_t>(covered.row) * static_cast<std::size_t>(camera.width) + covered.col;
      covering[cell] += weight;
      map[cell] += weight * memory_.probability(stored);
    }
  }
  for (std::size_t i = 0; i < num_cells; ++i) {
    map[i] = covering[i] >= 0.5f ? map[i] / covering[i] : std::numeric_limits<float>::quiet_NaN();
  }
}

}  // namespace depth_object_tracker
