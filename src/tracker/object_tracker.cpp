// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/object_tracker.h"

#include "tracker/tracker_implementation.h"

#include "depth_object_tracker/render/depth_renderer.h"
#include "depth_object_tracker/tracker/live_parameters.h"
#include "depth_object_tracker/tracker/tracker_parameters.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

constexpr double kUsualDistanceM = 0.8;
constexpr int kLeastParticles = 24;  // that a late frame is not cut below

Symmetries aboutCentre(Symmetries symmetries, const Eigen::Vector3d& centre_object) {
  for (SymmetryAxis& axis : symmetries.continuous) axis.offset -= centre_object;
  for (Pose& pose : symmetries.discrete) {
    pose.translation() += pose.linear() * centre_object - centre_object;
  }
  return symmetries;
}

double objectRadius(const TriangleMesh& mesh, const Eigen::Vector3d& centre) {
  double sum = 0.0;
  for (const Eigen::Vector3f& vertex : mesh.vertices) sum += (vertex.cast<double>() - centre).squaredNorm();
  return std::sqrt(sum / static_cast<double>(mesh.vertices.size()));
}

/// Throws when the object cannot be tracked, before anything is built from it.
const ObjectModel& checked(const ObjectModel& object) {
  if (object.mesh.triangles.empty())
    throw std::invalid_argument("object '" + object.name + "' has a mesh without triangles");
  return object;
}

const TrackerConfig& checked(const TrackerConfig& config) {
  validateTrackerConfig(config);
  return config;
}

}  // namespace

ObjectTracker::Implementation::Implementation(ObjectModel object_model, const TrackerConfig& tracker_config)
    : object(std::move(object_model)),
      config(checked(tracker_config)),
      centre_object(surfaceCentroid(checked(object).mesh)),
      diameter_m(diameter(object.mesh)),
      shape(object.mesh, centre_object),
      pool(std::make_shared<WorkerPool>(config.filter.num_threads)),
      likelihood(shape, config.pixel, config.occlusion, config.filter.num_particles, pool),
      filter(config.filter, objectRadius(object.mesh, centre_object), aboutCentre(object.symmetries, centre_object)),
      symmetries(aboutCentre(object.symmetries, centre_object)),
      resolution(config.resolution),
      status(config.status),
      slip(config.slip),
      search(config.filter.seed),
      held_view(object.mesh),
      look_alikes(findLookAlikes(object.mesh, centre_object, aboutCentre(object.symmetries, centre_object))),
      free_turn(look_alikes.lookAlikes().axes),
      reacquisition(
          std::make_unique<PoseFinder>(shape, object.mesh, diameter_m, config.pixel, config.filter.seed, pool),
          Distractors(object.mesh, centre_object), symmetries) {}

ObjectTracker::ObjectTracker(ObjectModel object, const TrackerConfig& config)
    : implementation_(std::make_unique<Implementation>(std::move(object), config)) {}
ObjectTracker::~ObjectTracker() = default;
ObjectTracker::ObjectTracker(ObjectTracker&&) noexcept = default;
ObjectTracker& ObjectTracker::operator=(ObjectTracker&&) noexcept = default;

void ObjectTracker::initialise(const Pose& T_camera_object, const Matrix6d& covariance) {
  Implementation& self = *implementation_;
  const Pose T_camera_centre = self.toCentre(T_camera_object);
  self.initial_variances = defaultInitialVariances(self.config.initialisation);
  if (covariance.diagonal().cwiseAbs().maxCoeff() > 0.0) {
    const Eigen::Vector3d centre_from_origin = T_camera_object.linear() * self.centre_object;
    self.initial_variances = transportCovariance(covariance, centre_from_origin).diagonal();
  }
  self.is_given = true;
  self.around_given.clear();
  self.filter.initialise(T_camera_centre);
  self.smoother.restart();
  self.last_mean = PoseStatistics();
  self.last_mean.mean = T_camera_centre;
  self.is_seen = false;
  self.seen_s = self.unseen_s = 0.0;
  self.doubt.restart();
  self.before_find.reset();
  self.initialising_s = 0.0;
  self.is_blind = self.is_anywhere = self.is_on_table = false;
  self.reacquired_s = self.moved_s = self.since_sure_s = self.since_fitted_s = Implementation::kLongAgoS;
  self.calibration.restart();
  self.look_alikes.restart();
  self.free_turn.restart(std::sqrt(self.initial_variances->tail<3>().maxCoeff()));
  self.reacquisition.restart();
  self.reacquisition.forgetScene();
  self.since_remembered_s = Implementation::kLongAgoS;
  self.follows_hand = false;
  self.slip.reset();
  self.hand_velocity.setZero();
  self.likelihood.resetOcclusion();
  self.clock.reset();
  self.status.restart();
  self.resolution.reset();
  self.full_resolution_pixels = 0.0;
  self.result = TrackerResult();
  self.result.state = self.status.state();
  self.result.reason = self.status.reason();
}

void ObjectTracker::initialiseAnywhere() {
  Implementation& self = *implementation_;
  Pose T_camera_object = Pose::Identity();
  T_camera_object.translation().z() = kUsualDistanceM;
  initialise(T_camera_object);
  self.initial_variances.reset();
  self.is_given = false;
  self.is_blind = self.is_anywhere = true;
  self.result.reason = self.status.reason();
}

void ObjectTracker::initialiseOnTable() {
  initialiseAnywhere();
  implementation_->is_on_table = true;
}

std::optional<ImagePlane> ObjectTracker::table() const {
  return implementation_->reacquisition.table();
}

void ObjectTracker::reset() {
  implementation_->status.reset();
  implementation_->result = TrackerResult();
}

void ObjectTracker::moveCamera(const Pose& T_now_before) {
  Implementation& self = *implementation_;
  const Eigen::Matrix3d R_now_before = T_now_before.linear();
  self.filter.moveCamera(T_now_before);
  self.smoother.moveCamera(T_now_before);
  self.hand_velocity = rotated(self.hand_velocity, R_now_before);
  if (self.hidden_start) self.hidden_start->T_camera_centre = T_now_before * self.hidden_start->T_camera_centre;
  self.last_mean.mean = T_now_before * self.last_mean.mean;
  self.fitted_pose = T_now_before * self.fitted_pose;
  self.last_velocity = rotated(self.last_velocity, R_now_before);
  self.seen_velocity = rotated(self.seen_velocity, R_now_before);
  if (self.grasp_memory.pose()) self.grasp_memory.moved(T_now_before * *self.grasp_memory.pose());
  if (self.before_find) {
    self.before_find->mean.mean = T_now_before * self.before_find->mean.mean;
    self.before_find->mean.covariance = rotated(self.before_find->mean.covariance, R_now_before);
    self.before_find->seen_velocity = rotated(self.before_find->seen_velocity, R_now_before);
  }
  self.reacquisition.moveCamera(T_now_before);
  self.last_mean.covariance = rotated(self.last_mean.covariance, R_now_before);
  self.result.T_camera_object = T_now_before * self.result.T_camera_object;
  self.result.covariance = rotated(self.result.covariance, R_now_before);
  self.result.twist = rotated(self.result.twist, R_now_before);
  self.result.twist_covariance = rotated(self.result.twist_covariance, R_now_before);
}

void ObjectTracker::setEffort(double effort) {
  Implementation& self = *implementation_;
  self.effort = std::clamp(effort, 1e-3, 1.0);
  const int wanted = static_cast<int>(std::lround(std::sqrt(self.effort) * self.config.filter.num_particles));
  self.filter.setNumParticles(std::max({1, wanted, std::min(kLeastParticles, self.config.filter.num_particles)}));
}

void ObjectTracker::setLiveParameters(const TrackerConfig& changed) {
  Implementation& self = *implementation_;
  self.config = withLiveParameters(self.config, changed);
  self.status.setConfig(self.config.status);
  self.resolution.setConfig(self.config.resolution);
  setEffort(self.effort);
}

TrackerResult ObjectTracker::update(const DepthImageView& depth, const PinholeCamera& camera, double stamp_s,
                                    const std::optional<ControlInput>& control, KnownOccluders* occluders) {
  return implementation_->update(depth, camera, stamp_s, control, occluders);
}

ParticlePoses ObjectTracker::particles() const {
  ParticlePoses particles;
  if (!implementation_->result.has_pose) return particles;
  for (const Pose& pose : implementation_->filter.poses())
    particles.T_camera_object.push_back(implementation_->toObject(pose));
  for (double weight : implementation_->filter.weights()) particles.weights.push_back(static_cast<float>(weight));
  return particles;
}

OcclusionMap ObjectTracker::occlusionMap() const {
  OcclusionMap map;
  if (!implementation_->result.has_pose) return map;
  map.grid = implementation_->likelihood.image().grid();
  implementation_->likelihood.occlusionMap(implementation_->filter.poses(), implementation_->filter.weights(),
                                           map.p_occluded);
  return map;
}

std::vector<float> ObjectTracker::renderEstimate() const {
  const PinholeCamera& camera = implementation_->camera_in_use;
  std::vector<float> depth(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height), 0.0f);
  if (!implementation_->result.has_pose) return depth;
  DepthRenderer renderer(implementation_->object.mesh);
  for (const CoveredPixel& pixel : renderer.render(implementation_->result.T_camera_object, camera)) {
    depth[static_cast<std::size_t>(pixel.row) * static_cast<std::size_t>(camera.width) + pixel.col] = pixel.depth;
  }
  return depth;
}

const ObjectModel& ObjectTracker::object() const {
  return implementation_->object;
}
const TrackerConfig& ObjectTracker::config() const {
  return implementation_->config;
}
double ObjectTracker::diameterM() const {
  return implementation_->diameter_m;
}

}  // namespace depth_object_tracker
