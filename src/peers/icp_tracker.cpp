// SPDX-License-Identifier: BSD-3-Clause
// Frame-to-model point-to-plane ICP of PCL at full resolution.
#include "icp_tracker.h"

#include "depth_object_tracker/geometry/triangle_mesh.h"
#include "visible_surface.h"

#include <Eigen/Cholesky>

#include <pcl/common/transforms.h>
#include <pcl/features/integral_image_normal.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/registration/correspondence_estimation.h>

#include <algorithm>
#include <utility>

namespace depth_object_tracker {
namespace {

using PointCloud = pcl::PointCloud<pcl::PointNormal>;
using CorrespondenceEstimation = pcl::registration::CorrespondenceEstimation<pcl::PointNormal, pcl::PointNormal>;

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
  const auto clampTo = [](double value, int size) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(size)));
  };
  return {clampTo(centre.y() - v_radius, camera.height), clampTo(centre.y() + v_radius + 1.0, camera.height),
          clampTo(centre.x() - u_radius, camera.width), clampTo(centre.x() + u_radius + 1.0, camera.width)};
}

class IcpTracker : public PeerTracker {
 public:
  IcpTracker(const TriangleMesh& mesh, const IcpConfig& config) : config_(config), surface_(mesh) {
    const BoundingBox box = boundingBox(mesh);
    centre_object_ = 0.5 * (box.min + box.max);
    radius_m_ = 0.5 * box.size().norm();
  }

  void initialise(const Pose& T_camera_object, const PinholeCamera&) override { T_camera_object_ = T_camera_object; }

  PeerEstimate update(const DepthImageView& depth, const PinholeCamera& camera) override;

 private:
  PointCloud::Ptr measuredCloud(const DepthImageView& depth, const PinholeCamera& camera) const;
  PointCloud::Ptr modelCloud(const PinholeCamera& camera);
  void rejectByNormals(const PointCloud& model, const PointCloud& measured, pcl::Correspondences& pairs) const;
  Pose dampedStep(const PointCloud& model, const PointCloud& measured, const pcl::Correspondences& pairs) const;
  double align(PointCloud& model, CorrespondenceEstimation& nearest, double max_distance_m);

  IcpConfig config_;
  VisibleSurface surface_;
  Eigen::Vector3d centre_object_;
  double radius_m_;
  Pose T_camera_object_ = Pose::Identity();
};

/// Measured points of the box, organised as the image is.
pcl::PointCloud<pcl::PointXYZ>::Ptr organisedCloud(const DepthImageView& depth, const PinholeCamera& camera,
                                                   const PixelBox& box) {
  const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(
      new pcl::PointCloud<pcl::PointXYZ>(static_cast<std::uint32_t>(box.col_end - box.col_begin),
                                         static_cast<std::uint32_t>(box.row_end - box.row_begin)));
  cloud->is_dense = false;
  for (int row = box.row_begin; row < box.row_end; ++row) {
    for (int col = box.col_begin; col < box.col_end; ++col) {
      const Eigen::Vector3d p = static_cast<double>(depth.at(row, col)) * camera.ray(col, row);
      cloud->at(col - box.col_begin, row - box.row_begin).getVector3fMap() = p.cast<float>();
    }
  }
  return cloud;
}

/// Measured points with normals in the sphere around the last pose.
PointCloud::Ptr IcpTracker::measuredCloud(const DepthImageView& depth, const PinholeCamera& camera) const {
  const PointCloud::Ptr inside(new PointCloud);
  const Eigen::Vector3d centre = T_camera_object_ * centre_object_;
  const double radius_m = radius_m_ + config_.crop_margin_m;
  const PixelBox box = boxAround(centre, radius_m, camera);
  if (box.row_end <= box.row_begin || box.col_end <= box.col_begin) return inside;

  const pcl::PointCloud<pcl::PointXYZ>::Ptr organised = organisedCloud(depth, camera, box);
  pcl::PointCloud<pcl::Normal> normals;
  pcl::IntegralImageNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setNormalEstimationMethod(estimation.COVARIANCE_MATRIX);
  estimation.setMaxDepthChangeFactor(static_cast<float>(config_.max_depth_step));
  estimation.setNormalSmoothingSize(config_.normal_smoothing_px);
  estimation.setInputCloud(organised);
  estimation.compute(normals);

  for (std::size_t i = 0; i < organised->size(); ++i) {
    pcl::PointNormal point;
    point.getVector3fMap() = (*organised)[i].getVector3fMap();
    point.getNormalVector3fMap() = normals[i].getNormalVector3fMap();
    const bool near = (point.getVector3fMap().cast<double>() - centre).norm() <= radius_m;  // false for NaN
    if (near && point.getNormalVector3fMap().allFinite()) inside->push_back(point);
  }
  return inside;
}

/// Leaves out the pairs whose normals are too far apart: points beside the object, and its other faces.
void IcpTracker::rejectByNormals(const PointCloud& model, const PointCloud& measured,
                                 pcl::Correspondences& pairs) const {
  const auto is_bad = [&](const pcl::Correspondence& pair) {
    const auto& a = model[static_cast<std::size_t>(pair.index_query)].getNormalVector3fMap();
    const auto& b = measured[static_cast<std::size_t>(pair.index_match)].getNormalVector3fMap();
    return a.dot(b) < config_.min_normal_cosine;
  };
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), is_bad), pairs.end());
}

PointCloud::Ptr IcpTracker::modelCloud(const PinholeCamera& camera) {
  const PointCloud::Ptr model(new PointCloud);
  for (const SurfacePoint& surface_point : surface_.points(T_camera_object_, camera, config_.num_model_points)) {
    pcl::PointNormal point;
    point.getVector3fMap() = surface_point.p_camera;
    point.getNormalVector3fMap() = surface_point.normal_camera;
    model->push_back(point);
  }
  return model;
}

/// Motion of the model that brings its planes to the measured points, by least squares on the sum of both normals (the
/// "symmetric objective"). What no plane tells (a box face slides) is damped to rest, where PCL's estimators run away.
Pose IcpTracker::dampedStep(const PointCloud& model, const PointCloud& measured,
                            const pcl::Correspondences& pairs) const {
  const Eigen::Vector3d centre = T_camera_object_ * centre_object_;
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  for (const pcl::Correspondence& pair : pairs) {
    const pcl::PointNormal& on_model = model[static_cast<std::size_t>(pair.index_query)];
    const pcl::PointNormal& on_image = measured[static_cast<std::size_t>(pair.index_match)];
    const Eigen::Vector3d p = on_model.getVector3fMap().cast<double>();
    const Eigen::Vector3d q = on_image.getVector3fMap().cast<double>();
    const Eigen::Vector3f both = on_model.getNormalVector3fMap() + on_image.getNormalVector3fMap();
    const Eigen::Vector3d n = both.normalized().cast<double>();
    Vector6d slope;
    slope << n, (p - centre).cross(n) / radius_m_;  // angles as lengths on the bounding sphere: one damping for both
    information += slope * slope.transpose();
    gradient += slope * n.dot(q - p);
  }
  information.diagonal().array() += config_.damping * static_cast<double>(pairs.size());
  const Vector6d step = information.ldlt().solve(gradient);
  Pose T_moved = Pose::Identity();
  T_moved.linear() = expSo3(step.tail<3>() / radius_m_);
  T_moved.translation() = centre + step.head<3>() - T_moved.linear() * centre;
  return T_moved;
}

/// Some iterations from the visible surface at the pose so far. @return share of its points with a correspondence.
double IcpTracker::align(PointCloud& model, CorrespondenceEstimation& nearest, double max_distance_m) {
  pcl::Correspondences pairs;
  for (int iteration = 0; iteration < config_.iterations_per_stage; ++iteration) {
    nearest.setInputSource(model.makeShared());
    nearest.determineCorrespondences(pairs, max_distance_m);
    rejectByNormals(model, *nearest.getInputTarget(), pairs);
    if (pairs.size() < config_.min_correspondences) return 0.0;
    const Pose T_moved = dampedStep(model, *nearest.getInputTarget(), pairs);
    T_camera_object_ = T_moved * T_camera_object_;
    T_camera_object_.linear() = Eigen::Quaterniond(T_camera_object_.linear()).normalized().toRotationMatrix();
    pcl::transformPointCloudWithNormals(model, model, T_moved.matrix());
    if (T_moved.translation().norm() < config_.converged_m) break;
  }
  return static_cast<double>(pairs.size()) / static_cast<double>(model.size());
}

PeerEstimate IcpTracker::update(const DepthImageView& depth, const PinholeCamera& camera) {
  const PointCloud::Ptr measured = measuredCloud(depth, camera);
  if (measured->size() < config_.min_correspondences) return {T_camera_object_, 0.0};
  CorrespondenceEstimation nearest;
  nearest.setInputTarget(measured);
  double matched = 0.0;
  for (const double max_distance_m : config_.max_distances_m) {
    const PointCloud::Ptr model = modelCloud(camera);
    matched = model->size() < config_.min_correspondences ? 0.0 : align(*model, nearest, max_distance_m);
  }
  return {T_camera_object_, matched};
}

}  // namespace

std::unique_ptr<PeerTracker> makeIcpTracker(const TriangleMesh& mesh, const IcpConfig& config) {
  return std::make_unique<IcpTracker>(mesh, config);
}

}  // namespace depth_object_tracker
