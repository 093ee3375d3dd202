// SPDX-License-Identifier: BSD-3-Clause
// PCL's KLD-adaptive particle filter tracker with the settings of its tutorial.
#include "particle_filter_tracker.h"

#include "mesh_samples.h"

#include <pcl/filters/approximate_voxel_grid.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/tracking/approx_nearest_pair_point_cloud_coherence.h>
#include <pcl/tracking/distance_coherence.h>
#include <pcl/tracking/kld_adaptive_particle_filter_omp.h>

#include <pcl/tracking/impl/approx_nearest_pair_point_cloud_coherence.hpp>
#include <pcl/tracking/impl/distance_coherence.hpp>
#include <pcl/tracking/impl/kld_adaptive_particle_filter.hpp>
#include <pcl/tracking/impl/kld_adaptive_particle_filter_omp.hpp>
#include <pcl/tracking/impl/nearest_pair_point_cloud_coherence.hpp>
#include <pcl/tracking/impl/particle_filter.hpp>
#include <pcl/tracking/impl/tracking.hpp>

#include <vector>

namespace depth_object_tracker {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
using State = pcl::tracking::ParticleXYZRPY;
using Filter = pcl::tracking::KLDAdaptiveParticleFilterOMPTracker<Point, State>;

class PclTracker : public PeerTracker {
 public:
  PclTracker(const TriangleMesh& mesh, unsigned num_threads, const PclTrackerConfig& config)
      : config_(config), filter_(new Filter(num_threads)), samples_(sampleSurface(mesh, config.num_model_points)) {
    const BoundingBox box = boundingBox(mesh);
    centre_object_ = 0.5 * (box.min + box.max);
    radius_m_ = 0.5 * box.size().norm();
    configureFilter();
    filter_->setCloudCoherence(makeCoherence());
  }

  void initialise(const Pose& T_camera_object, const PinholeCamera&) override;
  PeerEstimate update(const DepthImageView& depth, const PinholeCamera& camera) override;

 private:
  void configureFilter();
  pcl::tracking::ApproxNearestPairPointCloudCoherence<Point>::Ptr makeCoherence() const;
  Cloud::Ptr measuredCloud(const DepthImageView& depth, const PinholeCamera& camera) const;

  PclTrackerConfig config_;
  Filter::Ptr filter_;
  std::vector<Eigen::Vector3f> samples_;
  Eigen::Vector3d centre_object_;
  double radius_m_ = 0.0;
  /// The filter's own object frame: origin in the object's centre, turned so that its roll, pitch and yaw start at 0,
  /// far from where averaging of angles fails.
  Pose T_object_filter_ = Pose::Identity();
  Pose T_camera_object_ = Pose::Identity();
};

void PclTracker::configureFilter() {
  const double step_variance = config_.step_stddev_m * config_.step_stddev_m;
  std::vector<double> step(6, step_variance);
  for (std::size_t k = 3; k < 6; ++k) step[k] *= config_.rotation_variance_ratio;
  const float bin = static_cast<float>(config_.bin_size);
  filter_->setMaximumParticleNum(static_cast<unsigned>(config_.max_particles));
  filter_->setParticleNum(config_.num_particles);
  filter_->setDelta(config_.kld_delta);
  filter_->setEpsilon(config_.kld_epsilon);
  filter_->setBinSize({bin, bin, bin, bin, bin, bin});
  filter_->setStepNoiseCovariance(step);
  filter_->setInitialNoiseCovariance(std::vector<double>(6, config_.initial_variance));
  filter_->setInitialNoiseMean(std::vector<double>(6, 0.0));
  filter_->setIterationNum(1);
  filter_->setResampleLikelihoodThr(0.0);
  filter_->setUseNormal(false);
}

pcl::tracking::ApproxNearestPairPointCloudCoherence<Point>::Ptr PclTracker::makeCoherence() const {
  using pcl::tracking::ApproxNearestPairPointCloudCoherence;
  using pcl::tracking::DistanceCoherence;
  ApproxNearestPairPointCloudCoherence<Point>::Ptr coherence(new ApproxNearestPairPointCloudCoherence<Point>);
  coherence->addPointCoherence(DistanceCoherence<Point>::Ptr(new DistanceCoherence<Point>));
  coherence->setSearchMethod(
      pcl::search::Octree<Point>::Ptr(new pcl::search::Octree<Point>(config_.search_resolution_m)));
  coherence->setMaximumDistance(config_.max_distance_m);
  return coherence;
}

void PclTracker::initialise(const Pose& T_camera_object, const PinholeCamera&) {
  T_camera_object_ = T_camera_object;
  T_object_filter_.linear() = T_camera_object.linear().transpose();
  T_object_filter_.translation() = centre_object_;
  const Eigen::Isometry3f T_filter_object = T_object_filter_.inverse().cast<float>();
  const Cloud::Ptr reference(new Cloud);
  for (const Eigen::Vector3f& p_object : samples_) {
    const Eigen::Vector3f p = T_filter_object * p_object;
    reference->push_back({p.x(), p.y(), p.z()});
  }
  filter_->setReferenceCloud(reference);
  filter_->setTrans(Eigen::Affine3f((T_camera_object * T_object_filter_).cast<float>().matrix()));
  filter_->resetTracking();
}

Cloud::Ptr PclTracker::measuredCloud(const DepthImageView& depth, const PinholeCamera& camera) const {
  const Eigen::Vector3d centre = T_camera_object_ * centre_object_;
  const double radius_m = radius_m_ + config_.crop_margin_m;
  const Cloud::Ptr inside(new Cloud);
  for (int row = 0; row < camera.height; ++row) {
    for (int col = 0; col < camera.width; ++col) {
      const Eigen::Vector3d p = static_cast<double>(depth.at(row, col)) * camera.ray(col, row);
      if (!((p - centre).norm() <= radius_m)) continue;  // false for NaN
      inside->push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    }
  }
  pcl::ApproximateVoxelGrid<Point> grid;
  grid.setLeafSize(config_.grid_m, config_.grid_m, config_.grid_m);
  grid.setInputCloud(inside);
  Cloud::Ptr thinned(new Cloud);
  grid.filter(*thinned);
  return thinned;
}

PeerEstimate PclTracker::update(const DepthImageView& depth, const PinholeCamera& camera) {
  const Cloud::Ptr measured = measuredCloud(depth, camera);
  if (measured->empty()) return {T_camera_object_, 0.0};
  filter_->setInputCloud(measured);
  filter_->compute();
  Pose T_camera_filter = Pose::Identity();
  T_camera_filter.matrix() = filter_->toEigenMatrix(filter_->getResult()).matrix().cast<double>();
  if (!T_camera_filter.matrix().allFinite()) return {T_camera_object_, 0.0};
  T_camera_object_ = T_camera_filter * T_object_filter_.inverse();
  T_camera_object_.linear() = Eigen::Quaterniond(T_camera_object_.linear()).normalized().toRotationMatrix();
  return {T_camera_object_, 1.0};
}

}  // namespace

std::unique_ptr<PeerTracker> makePclTracker(const TriangleMesh& mesh, unsigned num_threads,
                                            const PclTrackerConfig& config) {
  return std::make_unique<PclTracker>(mesh, num_threads, config);
}

}  // namespace depth_object_tracker
