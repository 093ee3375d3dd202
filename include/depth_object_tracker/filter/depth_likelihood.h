// SPDX-License-Identifier: BSD-3-Clause
// The paper's image likelihood: every pixel that the object covers at a pose, occlusion marginalised per particle.
#pragma once

#include "depth_object_tracker/filter/occlusion_memory.h"
#include "depth_object_tracker/filter/pose_likelihood.h"
#include "depth_object_tracker/filter/worker_pool.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"
#include "depth_object_tracker/model/measured_image.h"
#include "depth_object_tracker/render/soft_outline.h"

#include <vector>

namespace depth_object_tracker {

/// How well one pose explains the frame, pixel by pixel.
struct PoseAssessment {
  int covered_pixels = 0;
  int measured_pixels = 0;      ///< ... of which with a depth reading
  double visible_pixels = 0.0;  ///< expected number of measured pixels where the object is visible
  double log_likelihood = 0.0;  ///< [nat]
  double achieved = 0.0;        ///< log ratio [nat] summed with the pixels' probability not to be occluded
  double expected = 0.0;        ///< ... and what the sensor model expects of it at the true pose
};

class DepthLikelihood : public PoseLikelihood {
 public:
  /// @param centre_object [m] point of the object frame that poses are about.
  DepthLikelihood(const TriangleMesh& mesh, const Eigen::Vector3d& centre_object, const PixelModelConfig& pixel_config,
                  const OcclusionChainConfig& occlusion_config, int num_particles, int num_threads);

  /// A new frame, dt_s >= 0 after the last one. A grid other than the last one's carries the beliefs over; a camera
  /// other than the last one's forgets them. The view must stay valid until the next call.
  void setImage(const DepthImageView& view, const SamplingGrid& grid, double dt_s);

  /// Forgets all beliefs about occlusion.
  void resetOcclusion() { memory_.reset(); }

  void prepare(const std::vector<Pose>& T_camera_centre) override;
  double logLikelihood(const Pose& T_camera_centre, int thread) override;
  double broadLogLikelihood(const Pose& T_camera_centre, double extra_stddev_m, int thread) override;
  Linearisation linearise(const Pose& T_camera_centre, double extra_stddev_m, int thread) override;
  void update(const std::vector<Pose>& T_camera_centre, std::vector<double>& log_likelihoods) override;
  void resample(const std::vector<int>& source) override;
  int numThreads() const override { return pool_.numThreads(); }

  PoseAssessment assess(const Pose& T_camera_centre, int thread);

  /// sum_l w_l p_l / sum_l w_l over the particles that cover a pixel; NaN where they weigh under 0.5. Whole grid,
  /// row-major.
  void occlusionMap(const std::vector<Pose>& T_camera_centre, const std::vector<double>& weights,
                    std::vector<float>& map);

  /// Weights for the mean belief of the next frame.
  void setWeights(const std::vector<double>& weights) { weights_ = weights; }

  const MeasuredImage& image() const { return image_; }
  OcclusionMemory& memory() { return memory_; }
  WorkerPool& pool() { return pool_; }
  double radius() const { return radius_; }

  /// Cells that the object can cover at a pose: its bounding sphere, projected.
  CellBox boundingBox(const Pose& T_camera_centre) const;

 private:
  const std::vector<SoftPixel>& render(const Pose& T_camera_centre, int thread);
  double edgeStddev() const;
  float meanBelief(int row, int col) const;
  double updateParticle(int index, const Pose& T_camera_centre, int thread);

  TriangleMesh mesh_;
  Eigen::Vector3d centre_object_;
  double radius_;  // of the bounding sphere about the centre [m]
  std::vector<Eigen::Vector3f> normals_object_;
  MeasuredImage image_;
  OcclusionMemory memory_;
  std::vector<float> mean_belief_;  // stored values over the memory's region
  std::vector<double> weights_;
  WorkerPool pool_;
  std::vector<DepthRenderer> renderers_;  // one per thread
  std::vector<SoftOutline> outlines_;     // one per thread
  double edge_stddev_px_ = 0.0;           // full resolution
};

}  // namespace depth_object_tracker
