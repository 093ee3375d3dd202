// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/fiducial_tracker_nodelet.h"

#include "depth_object_tracker/ros/camera_conversions.h"
#include "depth_object_tracker/ros/gray_conversions.h"
#include "depth_object_tracker/ros/image_conversions.h"
#include "depth_object_tracker/ros/message_conversions.h"
#include "depth_object_tracker/ros/object_source.h"

#include <depth_object_tracker/TrackerStatus.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <boost/make_shared.hpp>

#include <cmath>
#include <exception>

namespace depth_object_tracker {
namespace {

constexpr int kQueueSize = 2;

}  // namespace

void FiducialTrackerNodelet::onInit() {
  try {
    start();
  } catch (const std::exception& error) {
    NODELET_FATAL_STREAM(getName() << ": cannot start: " << error.what());
  }
}

void FiducialTrackerNodelet::start() {
  log_.emplace(getName());
  options_ = loadFiducialOptions(getPrivateNodeHandle());
  for (const std::string& problem : options_.problems) {
    NODELET_FATAL_STREAM(getName() << ": " << problem << ". Nothing is tracked; correct it and start again");
  }
  if (!options_.problems.empty()) return;
  tracker_ = std::make_unique<FiducialTracker>(loadFiducialMap(resolveMeshUri(options_.fiducials_file, findPackage)),
                                               options_.tracker);
  tf_ = std::make_unique<TransformFeed>();
  tf_broadcaster_ = std::make_unique<tf2_ros::TransformBroadcaster>();
  pose_ = getPrivateNodeHandle().advertise<geometry_msgs::PoseWithCovarianceStamped>("pose", 10);
  status_ = getPrivateNodeHandle().advertise<TrackerStatus>("status", 1, true);
  subscribeMotion();
  if (options_.input == FiducialInput::kStereo) {
    subscribeStereo();
  } else {
    subscribeRgbd();
  }
}

/// Beside the nodelet, in whatever namespace its manager is.
std::string FiducialTrackerNodelet::topic(const std::string& name) const {
  return getNodeHandle().resolveName(ros::names::append(ros::names::parentNamespace(getName()), name));
}

void FiducialTrackerNodelet::subscribeStereo() {
  image_transport::ImageTransport images(getNodeHandle());
  stereo_ = std::make_unique<message_filters::Synchronizer<StereoPolicy>>(StereoPolicy(kQueueSize), first_image_,
                                                                          first_info_, second_image_, second_info_);
  stereo_->registerCallback(&FiducialTrackerNodelet::onStereo, this);
  first_image_.subscribe(images, topic("left/image_rect"), kQueueSize);
  first_info_.subscribe(getNodeHandle(), topic("left/camera_info"), kQueueSize);
  second_image_.subscribe(images, topic("right/image_rect"), kQueueSize);
  second_info_.subscribe(getNodeHandle(), topic("right/camera_info"), kQueueSize);
  log_->info("stereo pair from '" + topic("left/image_rect") + "' and '" + topic("right/image_rect") + "'");
}

void FiducialTrackerNodelet::subscribeRgbd() {
  image_transport::ImageTransport images(getNodeHandle());
  rgbd_ = std::make_unique<message_filters::Synchronizer<RgbdPolicy>>(RgbdPolicy(4 * kQueueSize), first_image_,
                                                                      first_info_, second_image_);
  rgbd_->registerCallback(&FiducialTrackerNodelet::onRgbd, this);
  first_image_.subscribe(images, topic("rgb/image_rect"), kQueueSize);
  first_info_.subscribe(getNodeHandle(), topic("rgb/camera_info"), kQueueSize);
  second_image_.subscribe(images, topic("depth_registered/image_rect"), kQueueSize);
  log_->info("pictures from '" + topic("rgb/image_rect") + "', depth from '" + topic("depth_registered/image_rect") +
             "'");
}

void FiducialTrackerNodelet::subscribeMotion() {
  const RobotOptions robot = loadRobotOptions(getPrivateNodeHandle());
  BuiltRobot built = buildRobot(robot, getPrivateNodeHandle(), tf_->buffer());
  if (!built.problem.empty()) log_->error(built.problem);
  held_motion_.setRobot(std::move(built));
  grasp_subscriber_ = getNodeHandle().subscribe<Grasp>(topic("grasp"), 10, [this](const GraspConstPtr& grasp) {
    if (!grasp->object_name.empty() && grasp->object_name != options_.object_name) return;
    held_motion_.setGrasp(grasp->grasped, grasp->link);
  });
  twist_subscriber_ = getNodeHandle().subscribe<geometry_msgs::TwistStamped>(
      topic("control_twist"), 100, [this](const geometry_msgs::TwistStampedConstPtr& twist) {
        const std::string problem = held_motion_.addTwist(*twist, camera_frame_, tf_->buffer());
        if (!problem.empty()) log_->warn(problem);
      });
  if (held_motion_.robot() == nullptr) return;
  const auto subscribe_to = [this](const char* name,
                                   std::string (RobotConnection::*take)(const sensor_msgs::JointState&)) {
    return getNodeHandle().subscribe<sensor_msgs::JointState>(
        topic(name), 500, [this, take](const sensor_msgs::JointStateConstPtr& joints) {
          const std::string problem = (held_motion_.robot()->*take)(*joints);
          if (!problem.empty()) log_->warn(problem);
        });
  };
  joint_subscriber_ = subscribe_to("joint_states", &RobotConnection::addJointStates);
  command_subscriber_ = subscribe_to("joint_commands", &RobotConnection::addCommands);
}

void FiducialTrackerNodelet::onStereo(const sensor_msgs::ImageConstPtr& left,
                                      const sensor_msgs::CameraInfoConstPtr& left_info,
                                      const sensor_msgs::ImageConstPtr& right,
                                      const sensor_msgs::CameraInfoConstPtr& right_info) {
  try {
    publish(left->header, trackStereo(*left, *left_info, *right, *right_info));
  } catch (const std::exception& error) {  // a crash would take the whole manager with it
    log_->error(std::string("internal error, please report it: ") + error.what());
  }
}

void FiducialTrackerNodelet::onRgbd(const sensor_msgs::ImageConstPtr& image,
                                    const sensor_msgs::CameraInfoConstPtr& info,
                                    const sensor_msgs::ImageConstPtr& depth) {
  try {
    publish(image->header, trackRgbd(*image, *info, *depth));
  } catch (const std::exception& error) {
    log_->error(std::string("internal error, please report it: ") + error.what());
  }
}

/// @return empty, or why the pictures cannot be used.
std::string FiducialTrackerNodelet::trackStereo(const Image& left, const Info& left_info, const Image& right,
                                                const Info& right_info) {
  const GrayImage left_gray(left), right_gray(right);
  for (const GrayImage* image : {&left_gray, &right_gray}) {
    if (!image->problem().empty()) return image->problem();
  }
  if (left_gray.view().width != right_gray.view().width || left_gray.view().height != right_gray.view().height) {
    return "the left and the right picture have different sizes";
  }
  const StereoCameraResult camera =
      stereoCameraFromInfos(left_info, right_info, left_gray.view().width, left_gray.view().height);
  if (!camera.problem.empty()) return camera.problem;
  const auto control = controlFor(left.header);
  tracker_->updateStereo(left_gray.view(), right_gray.view(), camera.camera, left.header.stamp.toSec(), control);
  return "";
}

std::string FiducialTrackerNodelet::trackRgbd(const Image& image, const Info& info, const Image& depth) {
  const GrayImage gray(image);
  if (!gray.problem().empty()) return gray.problem();
  const ImageViewResult depth_view = viewDepthImage(depth);
  if (!depth_view.problem.empty()) return depth_view.problem;
  if (depth_view.view.width != gray.view().width || depth_view.view.height != gray.view().height) {
    return "picture and depth have different sizes: the depth must be registered to the picture";
  }
  const CameraResult camera = cameraFromInfo(info, Intrinsics::kRectified, gray.view().width, gray.view().height);
  if (!camera.problem.empty()) return camera.problem;
  const auto control = controlFor(image.header);
  tracker_->updateRgbd(gray.view(), depth_view.view, camera.camera, image.header.stamp.toSec(), control);
  return "";
}

/// How the robot has moved the object since the last picture.
std::optional<ControlInput> FiducialTrackerNodelet::controlFor(const std_msgs::Header& header) {
  const double stamp_s = header.stamp.toSec();
  camera_frame_ = header.frame_id;
  if (last_stamp_s_ && stamp_s < *last_stamp_s_) held_motion_.forget();
  const double from_s = last_stamp_s_ && stamp_s >= *last_stamp_s_ ? *last_stamp_s_ : stamp_s;
  last_stamp_s_ = stamp_s;
  const HeldControl held =
      held_motion_.control(from_s, stamp_s, camera_frame_, tracker_->estimate().T_camera_object, Pose::Identity());
  if (!held.problem.empty()) log_->warn("the object is held, but how it moves is not known: " + held.problem);
  return held.control;
}

void FiducialTrackerNodelet::publish(const std_msgs::Header& header, const std::string& problem) {
  if (!problem.empty()) log_->warn("a picture is not used: " + problem);
  if (problem.empty() && tracker_->estimate().hasPose()) publishPose(header);
  publishStatus(header, problem);
}

void FiducialTrackerNodelet::publishPose(const std_msgs::Header& header) {
  const FiducialEstimate& estimate = tracker_->estimate();
  geometry_msgs::PoseWithCovarianceStamped pose;
  pose.header = header;
  pose.pose = toPoseMessage(estimate.T_camera_object, estimate.covariance);
  pose_.publish(pose);
  if (!options_.publish_tf || header.frame_id.empty()) return;
  geometry_msgs::TransformStamped transform;
  transform.header = header;
  transform.child_frame_id = options_.object_name + "_fiducials";
  transform.transform = toTransformMessage(estimate.T_camera_object);
  tf_broadcaster_->sendTransform(transform);
}

void FiducialTrackerNodelet::publishStatus(const std_msgs::Header& header, const std::string& problem) {
  const FiducialEstimate& estimate = tracker_->estimate();
  TrackerStatus status;
  status.header = header;
  status.object_name = options_.object_name;
  status.grasped = held_motion_.isGrasped();
  switch (estimate.state) {
    case FiducialState::kUninitialized:
      status.state = TrackerStatus::UNINITIALIZED;
      break;
    case FiducialState::kTracking:
      status.state = TrackerStatus::TRACKING;
      break;
    case FiducialState::kHidden:
      status.state = TrackerStatus::OCCLUDED;
      break;
    case FiducialState::kLost:
      status.state = TrackerStatus::LOST;
      break;
  }
  if (status.state != TrackerStatus::TRACKING) {
    status.reason =
        "no tag of '" + options_.fiducials_file + "' is seen: hidden, too small, blurred, or of another family?";
  }
  if (!problem.empty()) status.reason = problem;
  status.position_stddev_m = static_cast<float>(std::sqrt(estimate.covariance.diagonal().head<3>().maxCoeff()));
  status.rotation_stddev_rad = static_cast<float>(std::sqrt(estimate.covariance.diagonal().tail<3>().maxCoeff()));
  status_.publish(status);
}

}  // namespace depth_object_tracker
