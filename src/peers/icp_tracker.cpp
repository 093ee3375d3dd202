// SPDX-License-Identifier: BSD-3-Clause
// Frame-to-model point-to-plane ICP of PCL at full resolution.
#include "icp_tracker.h"

#include "depth_object_tracker/geometry/triangle_mesh.h"
#include "visible_surface.h"

#include <pcl/features/integral_image_normal.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/registration/correspondence_rejection_surface_normal.h>
#include <pcl/registration/icp.h>

#include <algorithm>

namespace depth_object_tracker {
namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;

/// Pixels that a sphere covers, cut to the image; empty when end <= begin.
struct PixelBox {
  int row_begin, row_end, col_begin, col_end;
};

PixelBox boxAround(const Eigen::Vector3d& centre_camera, double radius_m, const PinholeCamera& camera) {
  if (!(centre_camera.z() > 0.0)) return {0, 0, 0, 0};
  const double nearest = std::max(centre_camera.z() - radius_m, 0.1);
  const double u_radius = camera.fx * radius_m / nearest;
  const double v_radius = camera.fy * radius_m / nearest;
  const Eigen::Vector2d centre = camera.project(centre_camera);
  const auto clamp_to = [](double value, int size) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(size)));
  };
  return {clamp_to(centre.y() - v_radius, camera.height), clamp_to(centre.y() + v_radius + 1.0, camera.height),
          clamp_to(centre.x() - u_radius, camera.width), clamp_to(centre.x() + u_radius + 1.0, camera.width)};
}

class IcpTracker : public PeerTracker {
 public:
  IcpTracker(const TriangleMesh& mesh, const IcpConfig& config) : config_(config), surface_(mesh) {
    const BoundingBox box = boundingBox(mesh);
    centre_object_ = 0.5 * (box.min + box.max);
    radius_m_ = 0.5 * box.size().norm();
  }

  void initialise(const Pose& T_camera_object, const PinholeCamera&) override { T_camera_object_ = T_camera_object; }

  PeerEstimate update(const DepthImageView& depth, const PinholeCamera& camera) override {
    const Cloud::Ptr measured = measuredCloud(depth, camera);
    double matched = 0.0;
    for (const double max_distance_m : config_.max_distances_m) matched = align(measured, camera, max_distance_m);
    return {T_camera_object_, matched};
  }

 private:
  Cloud::Ptr measuredCloud(const DepthImageView& depth, const PinholeCamera& camera) const;
  double align(const Cloud::Ptr& measured, const PinholeCamera& camera, double max_distance_m);

  IcpConfig config_;
  VisibleSurface surface_;
  Eigen::Vector3d centre_object_;
  double radius_m_;
  Pose T_camera_object_ = Pose::Identity();
};

/// Measured points with normals in the sphere around the last pose.
Cloud::Ptr IcpTracker::measuredCloud(const DepthImageView& depth, const PinholeCamera& camera) const {
  Cloud::Ptr inside(new Cloud);
  const Eigen::Vector3d centre = T_camera_object_ * centre_object_;
  const double radius_m = radius_m_ + config_.crop_margin_m;
  const PixelBox box = boxAround(centre, radius_m, camera);
  if (box.row_end <= box.row_begin || box.col_end <= box.col_begin) return inside;

  const pcl::PointCloud<pcl::PointXYZ>::Ptr organised(
      new pcl::PointCloud<pcl::PointXYZ>(static_cast<std::uint32_t>(box.col_end - box.col_begin),
                                         static_cast<std::uint32_t>(box.row_end - box.row_begin)));
  organised->is_dense = false;
  for (int row = box.row_begin; row < box.row_end; ++row) {
    for (int col = box.col_begin; col < box.col_end; ++col) {
      const Eigen::Vector3d p = static_cast<double>(depth.at(row, col)) * camera.ray(col, row);
      organised->at(col - box.col_begin, row - box.row_begin).getVector3fMap() = p.cast<float>();
    }
  }
  pcl::PointCloud<pcl::Normal> normals;
  pcl::IntegralImageNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setNormalEstimationMethod(estimation.COVARIANCE_MATRIX);
  estimation.setMaxDepthChangeFactor(static_cast<float>(config_.max_depth_step));
  estimation.setNormalSmoothingSize(config_.normal_smoothing_px);
  estimation.setInputCloud(organised);
  estimation.compute(normals);

  for (std::size_t i = 0; i < organised->size(); ++i) {
    const Eigen::Vector3f p = (*organised)[i].getVector3fMap();
    const Eigen::Vector3f n = normals[i].getNormalVector3fMap();
    if (!p.allFinite() || !n.allFinite() || (p.cast<double>() - centre).norm() > radius_m) continue;
    pcl::PointNormal point;
    point.getVector3fMap() = p;
    point.getNormalVector3fMap() = n;
    inside->push_back(point);
  }
  return inside;
}

/// One ICP with visible model points as source. @return share of the model points with a correspondence at the end.
double IcpTracker::align(const Cloud::Ptr& measured, const PinholeCamera& camera, double max_distance_m) {
  const std::vector<SurfacePoint> visible = surface_.points(T_camera_object_, camera, config_.num_model_points);
  if (visible.size() < config_.min_correspondences || measured->size() < config_.min_correspondences) return 0.0;
  const Cloud::Ptr model(new Cloud);
  for (const SurfacePoint& surface_point : visible) {
    pcl::PointNormal point;
    point.getVector3fMap() = surface_point.p_camera;
    point.getNormalVector3fMap() = surface_point.normal_camera;
    model->push_back(point);
  }

  const pcl::registration::CorrespondenceRejectorSurfaceNormal::Ptr same_side(
      new pcl::registration::CorrespondenceRejectorSurfaceNormal);
  same_side->setThreshold(config_.min_normal_cosine);
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> icp;
  icp.setUseSymmetricObjective(true);
  icp.setInputSource(model);
  icp.setInputTarget(measured);
  icp.addCorrespondenceRejector(same_side);
  icp.setMaxCorrespondenceDistance(max_distance_m);
  icp.setMaximumIterations(config_.iterations_per_stage);
  icp.setTransformationEpsilon(1e-10);
  icp.setEuclideanFitnessEpsilon(1e-12);
  Cloud aligned;
  icp.align(aligned);
  const std::size_t matched = icp.correspondences_->size();
  if (!icp.hasConverged() || matched < config_.min_correspondences) return 0.0;
  Pose T_moved;
  T_moved.matrix() = icp.getFinalTransformation().cast<double>();
  if (!T_moved.matrix().allFinite()) return 0.0;
  T_camera_object_ = T_moved * T_camera_object_;
  T_camera_object_.linear() = Eigen::Quaterniond(T_camera_object_.linear()).normalized().toRotationMatrix();
  return static_cast<double>(matched) / static_cast<double>(visible.size());
}

}  // namespace

std::unique_ptr<PeerTracker> makeIcpTracker(const TriangleMesh& mesh, const IcpConfig& config) {
  return std::make_unique<IcpTracker>(mesh, config);
}

}  // namespace depth_object_tracker
