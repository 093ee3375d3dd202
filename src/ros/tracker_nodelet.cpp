// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/tracker_nodelet.h"

#include <image_transport/camera_common.h>

#include <exception>
#include <utility>

namespace depth_object_tracker {
namespace {

std::string join(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += (text.empty() ? "" : "; ") + sentence;
  return text;
}

/// Absolute name of a topic beside the nodelet. A relative one would land in the manager's namespace where the nodelet
/// lives in the root namespace: roscpp takes a node handle's namespace "/" for "not given".
std::string siblingName(const std::string& nodelet_name, const std::string& topic) {
  return ros::names::append(ros::names::parentNamespace(nodelet_name), topic);
}

}  // namespace

TrackerNodelet::~TrackerNodelet() {
  image_subscriber_.shutdown();
  for (auto* subscriber : {&info_subscriber_, &initial_pose_subscriber_, &grasp_subscriber_, &twist_subscriber_}) {
    subscriber->shutdown();
  }
  services_.reset();
  if (worker_) worker_->stop();
}

void TrackerNodelet::onInit() {
  try {
    start();
  } catch (const std::exception& error) {
    NODELET_FATAL_STREAM(getName() << ": cannot start: " << error.what());
  }
}

void TrackerNodelet::start() {
  ros::NodeHandle& private_node = getPrivateNodeHandle();
  const NodeletOptions options = loadNodeletOptions(private_node);
  if (options.robot) {
    NODELET_WARN_STREAM(
        getName() << ": ~robot: joint states are not used yet; publish the held object's twist on control_twist");
  }
  const std::string image_topic = getNodeHandle().resolveName(siblingName(getName(), "depth/image"));
  const std::string info_topic = findInfoTopic(image_topic);
  tf_buffer_ = std::make_unique<tf2_ros::Buffer>();
  tf_listener_ = std::make_unique<tf2_ros::TransformListener>(*tf_buffer_);

  TrackerSession session(getName(), image_topic, info_topic, *tf_buffer_);
  session.setFrames(options.frames);
  session.setTracker(buildFromParameters(options));
  if (!options.init_file.empty()) applyInitFile(options.init_file, session);
  worker_ = std::make_unique<TrackerWorker>(getName(), std::move(session), ResultPublisher(private_node, options),
                                            options.control_wait_s);
  services_ = std::make_unique<TrackerServices>(private_node, *worker_, *tf_buffer_);
  worker_->start();
  subscribeCommands();
  subscribe(image_topic, info_topic, options.image_transport);
}

BuiltTracker TrackerNodelet::buildFromParameters(const NodeletOptions& options) {
  ros::NodeHandle& private_node = getPrivateNodeHandle();
  XmlRpc::XmlRpcValue value;
  private_node.getParam("tracker", value);
  TrackerParameters parameters = loadTrackerParameters(value, private_node.resolveName("tracker"));
  parameters.problems.insert(parameters.problems.begin(), options.problems.begin(), options.problems.end());
  BuiltTracker built;
  if (parameters.problems.empty()) {
    built = buildTracker(options.object, parameters.config);
  } else {
    built.problem = join(parameters.problems) + ". Correct it and call ~load_object, or start again";
  }
  if (built.tracker) {
    NODELET_INFO_STREAM(getName() << ": object '" << built.name << "' from " << built.mesh_file << ", diameter "
                                  << built.tracker->diameterM() << " m, "
                                  << built.tracker->object().mesh.triangles.size() << " triangles");
  } else {
    NODELET_ERROR_STREAM(getName() << ": " << built.problem);
  }
  return built;
}

void TrackerNodelet::applyInitFile(const std::string& init_file, TrackerSession& session) {
  const InitFilePose loaded = loadInitFile(init_file);
  if (!loaded.problem.empty()) {
    session.refuseInitialPose(loaded.problem);
    return;
  }
  InitialPose pose;
  pose.T_frame_object = loaded.T_camera_object;
  session.initialise(pose, nullptr);
}

/// camera_info beside the image, unless the user remapped depth/camera_info.
std::string TrackerNodelet::findInfoTopic(const std::string& image_topic) {
  ros::NodeHandle& node = getNodeHandle();
  const std::string by_name = siblingName(getName(), "depth/camera_info");
  const std::string remapped = node.resolveName(by_name);
  if (remapped != by_name) return remapped;
  return node.resolveName(image_transport::getCameraInfoTopic(image_topic));
}

void TrackerNodelet::subscribeCommands() {
  ros::NodeHandle& node = getNodeHandle();
  initial_pose_subscriber_ = getPrivateNodeHandle().subscribe("initial_pose", 1, &TrackerNodelet::onInitialPose, this);
  grasp_subscriber_ = node.subscribe(siblingName(getName(), "grasp"), 10, &TrackerNodelet::onGrasp, this);
  twist_subscriber_ = node.subscribe<geometry_msgs::TwistStamped>(
      siblingName(getName(), "control_twist"), 100,
      [this](const geometry_msgs::TwistStampedConstPtr& twist) {
        worker_->post([twist](TrackerSession& session) { session.addTwist(*twist); }, false);
      },
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
}

void TrackerNodelet::subscribe(const std::string& image_topic, const std::string& info_topic,
                               const std::string& transport) {
  matcher_.emplace([this](CameraFrame frame) { worker_->postFrame(std::move(frame)); });
  info_subscriber_ = getNodeHandle().subscribe<sensor_msgs::CameraInfo>(
      info_topic, 4, [this](const sensor_msgs::CameraInfoConstPtr& info) { matcher_->addInfo(info); });
  const auto on_image = [this](const sensor_msgs::ImageConstPtr& image) { matcher_->addImage(image); };
  image_transport::ImageTransport images(getNodeHandle());
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  const auto subscribeWith = [&](const std::string& name) {
    return images.subscribe(image_topic, 1, on_image, ros::VoidPtr(), image_transport::TransportHints(name, no_delay));
  };
  try {
    image_subscriber_ = subscribeWith(transport);
  } catch (const image_transport::Exception& error) {
    NODELET_ERROR_STREAM(getName() << ": ~image_transport '" << transport
                                   << "' cannot be used, taking 'raw': " << error.what());
    image_subscriber_ = subscribeWith("raw");
  }
  NODELET_INFO_STREAM(getName() << ": depth from '" << image_topic << "', camera_info from '" << info_topic << "'");
}

void TrackerNodelet::onInitialPose(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message) {
  const CheckedInitialPose checked = checkInitialPose(*message);
  worker_->post([checked](TrackerSession& session) {
    if (checked.problem.empty()) {
      session.initialise(checked.pose, nullptr);
    } else {
      session.refuseInitialPose("~initial_pose refused: " + checked.problem);
    }
  });
}

void TrackerNodelet::onGrasp(const GraspConstPtr& message) {
  worker_->post([message, name = getName()](TrackerSession& session) {
    if (!message->object_name.empty() && message->object_name != session.object().name) return;
    if (message->grasped && !message->link.empty()) {
      ROS_WARN_STREAM(
          name << ": the motion of link '" << message->link
               << "' is not available yet: the object is held by an unknown motion; leave link empty and publish "
                  "control_twist");
    }
    session.setGrasp(message->grasped, message->link);
  });
}

}  // namespace depth_object_tracker
