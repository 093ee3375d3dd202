// SPDX-License-Identifier: BSD-3-Clause
// The paper's image likelihood: every pixel that the object covers at a pose, occlusion marginalised per particle.
#pragma once

#include "depth_object_tracker/filter/object_shape.h"
#include "depth_object_tracker/filter/occlusion_tiles.h"
#include "depth_object_tracker/filter/pose_assessment.h"
#include "depth_object_tracker/filter/pose_likelihood.h"
#include "depth_object_tracker/filter/score_scatter.h"
#include "depth_object_tracker/filter/tile_fit.h"
#include "depth_object_tracker/filter/tile_likelihood.h"
#include "depth_object_tracker/filter/worker_pool.h"
#include "depth_object_tracker/model/measured_image.h"

#include <memory>
#include <vector>

namespace depth_object_tracker {

class DepthLikelihood : public PoseLikelihood {
 public:
  /// @param shape rendered at the coarsest level whose error is small against pixels and noise.
  DepthLikelihood(const ObjectShape& shape, const PixelModelConfig& pixel_config,
                  const OcclusionChainConfig& occlusion_config, int num_particles, std::shared_ptr<WorkerPool> pool);

  /// @param centre_object [m] point of the object frame that poses are about.
  /// @param level_of_detail render the coarsest simplified mesh whose error is small against pixels and noise; false:
  /// always the mesh itself.
  DepthLikelihood(const TriangleMesh& mesh, const Eigen::Vector3d& centre_object, const PixelModelConfig& pixel_config,
                  const OcclusionChainConfig& occlusion_config, int num_particles, int num_threads,
                  bool level_of_detail = true);

  /// A new frame, dt_s >= 0 after the last one. A grid other than the last one's carries the beliefs over; a camera
  /// other than the last one's forgets them. The view must stay valid until the next call.
  void setImage(const DepthImageView& view, const SamplingGrid& grid, double dt_s);

  /// Makes the whole image available, for poses anywhere in it. @param level_error_m [m] of the mesh that is rendered.
  void prepareWholeImage(double level_error_m);

  /// When much of the object has no reading at a pose where it is expected, the camera does not see it (a covered lens,
  /// something too near, glass), and pixels without a reading say little or nothing in this image. After setImage().
  void weighMissingReadings(const Pose& T_camera_centre);
  /// Planes that are there without the object, of what is prepared; see MeasuredImage.
  void setBackground(const std::vector<BackgroundPlane>& planes) { image_.setBackground(planes); }
  /// Known occluders for this image; see MeasuredImage.
  void setOccluders(const std::vector<float>& depth_m) { image_.setOccluders(depth_m); }
  void setTakenSurfaces(const std::vector<float>& depth_m) { image_.setTakenSurfaces(depth_m); }

  /// Forgets all beliefs about occlusion.
  void resetOcclusion() { memory_.reset(); }

  void prepare(const std::vector<Pose>& T_camera_centre) override;
  double logLikelihood(const Pose& T_camera_centre, int thread) override;
  double broadLogLikelihood(const Pose& T_camera_centre, double extra_stddev_m, int thread) override;
  Linearisation linearise(const Pose& T_camera_centre, double extra_stddev_m, int thread) override;
  /// How the parts of the image pull at a pose: all of zero outside of what is prepared. Thread-safe for different
  /// `thread`.
  ScoreScatter scatterOfScores(const Pose& T_camera_centre, int thread);
  void update(const std::vector<Pose>& T_camera_centre, std::vector<double>& log_likelihoods) override;
  void resample(const std::vector<int>& source) override;
  bool explains(const Pose& T_camera_centre) override;
  int numThreads() const override { return pool_->numThreads(); }
  void parallelFor(int count, const WorkerPool::Task& task) override { pool_->run(count, task); }

  /// A reading matches within the pixel's noise and `tolerance_m`. All zero outside of what is prepared. Thread-safe
  /// for different `thread`.
  TileFit countFit(const Pose& T_camera_centre, double tolerance_m, int thread);

  /// @param extra_stddev_m widens the surface noise. Thread-safe for different `thread` where the image is prepared.
  PoseAssessment assess(const Pose& T_camera_centre, int thread, double extra_stddev_m = 0.0);
  /// With the edges of what hides the object, which take as long again.
  PoseAssessment assessWithEdges(const Pose& T_camera_centre, int thread);

  /// sum_l w_l p_l / sum_l w_l over the particles that cover a pixel; NaN where they weigh under 0.5. Whole grid,
  /// row-major.
  void occlusionMap(const std::vector<Pose>& T_camera_centre, const std::vector<double>& weights,
                    std::vector<float>& map);

  /// Weights for the mean belief of the next frame.
  void setWeights(const std::vector<double>& weights) { weights_ = weights; }

  const MeasuredImage& image() const { return image_; }
  OcclusionTiles& memory() { return memory_; }
  double radius() const { return shape_.radius_m; }

  /// Number of triangles rendered for the present image, and of the mesh itself.
  std::size_t renderedTriangles() const { return object_->mesh.triangles.size(); }

  /// Cells that the object can cover at a pose: its bounding sphere, projected.
  CellBox boundingBox(const Pose& T_camera_centre) const;

 private:
  /// Scratch of one thread.
  struct Scratch {
    TileRenderer renderer;
    std::vector<const float*> beliefs;
    std::vector<float*> posteriors;
  };

  Pose toObject(const Pose& T_camera_centre) const;
  const DepthTile& render(const Pose& T_camera_centre, bool for_derivatives, int thread);
  void chooseLevel(const std::vector<Pose>& T_camera_centre);
  CellBox prepareRegion(const std::vector<Pose>& T_camera_centre);
  bool isPrepared(const Pose& T_camera_centre) const;
  const float* const* meanBeliefs(const DepthTile& tile, int thread);
  float* const* ownBeliefs(const DepthTile& tile, int particle, int thread);
  int tileIndex(const DepthTile& tile, int index) const;
  TileLikelihoodInput input() const;
  TileGeometry geometryOf(const Pose& T_camera_centre, const DepthTile& tile) const;
  double updateParticle(int index, const Pose& T_camera_centre, int thread);

  ObjectShape shape_;
  const RenderObject* object_;  // the level that is used for this image; never null
  bool is_level_chosen_ = false;
  double edge_stddev_px_;  // full resolution
  MeasuredImage image_;
  OutlineCoverage outline_;
  std::shared_ptr<WorkerPool> pool_;
  OcclusionTiles memory_;
  std::vector<double> weights_;
  std::vector<Scratch> scratch_;  // one per thread
};

}  // namespace depth_object_tracker
