// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/tracker_nodelet.h"

#include <image_transport/camera_common.h>
#include <ros/master.h>
#include <ros/this_node.h>

#include <exception>
#include <utility>

namespace depth_object_tracker {
namespace {

constexpr std::uint64_t kImagesUntilTfIsThere = 60;  // static transforms may come a little later than images

constexpr double kSilenceUntilTopicsAreListedS = 3.0;

/// Topics that may be meant when no image comes. Asks the master, which takes a moment. Not by
/// ros::master::getTopics(): that waits for ever for a master that is gone.
std::string listDepthTopics() {
  XmlRpc::XmlRpcValue arguments, response, topics;
  arguments[0] = ros::this_node::getName();
  arguments[1] = "";
  if (!ros::master::execute("getPublishedTopics", arguments, response, topics, false)) {
    return "the master does not answer; what is connected goes on";
  }
  std::string names;
  for (int i = 0; topics.getType() == XmlRpc::XmlRpcValue::TypeArray && i < topics.size(); ++i) {
    const std::string name = topics[i][0], type = topics[i][1];
    const bool is_depth = type == "sensor_msgs/Image" && name.find("depth") != std::string::npos;
    if (is_depth) names += (names.empty() ? "" : ", ") + name;
  }
  return names.empty() ? "nobody publishes an image topic with 'depth' in its name"
                       : "depth images there are: " + names;
}

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
  for (auto* subscriber : {&info_subscriber_, &initial_pose_subscriber_, &detected_pose_subscriber_, &grasp_subscriber_,
                           &twist_subscriber_, &joint_subscriber_, &command_subscriber_}) {
    subscriber->shutdown();
  }
  services_.reset();
  live_.reset();
  save_timer_.stop();
  if (worker_) worker_->stop();
  marker_.reset();  // its thread speaks to the worker
  savePose();
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
  for (const std::string& warning : options.warnings) NODELET_WARN_STREAM(getName() << ": " << warning);
  const std::string image_topic = getNodeHandle().resolveName(siblingName(getName(), "depth/image"));
  const std::string info_topic = findInfoTopic(image_topic);
  tf_ = std::make_unique<TransformFeed>();

  TrackerSession session(getName(), image_topic, info_topic, tf_->buffer());
  session.setFrames(options.frames);
  if (options.share_estimates) session.share(EstimateBoard::forImages(image_topic));
  const BuiltTracker built = buildFromParameters(options);
  session.setTracker(built);
  bool has_last_pose = false;
  if (!options.last_pose_file.empty()) {
    pose_memory_ = std::make_unique<PoseMemory>(options.last_pose_file);
    has_last_pose = recallLastPose(options.last_pose_file, built.name, session);
  }
  const RobotOptions robot = loadRobotOptions(private_node);
  session.setRobot(buildRobot(robot, private_node, tf_->buffer()));
  if (options.init_file == kSearch) {
    if (!has_last_pose) session.initialiseAnywhere(nullptr);
  } else if (!options.init_file.empty()) {
    applyInitFile(options.init_file, session);
  }
  worker_ = std::make_unique<TrackerWorker>(getName(), std::move(session), ResultPublisher(private_node, options),
                                            options.control_wait_s);
  if (options.publish_diagnostics)
    diagnostics_ = std::make_unique<TrackerDiagnostics>(getNodeHandle(), private_node, getName(), image_topic);
  if (options.interactive_marker) {
    marker_ = std::make_unique<InitialPoseMarker>(getName(), [this](const geometry_msgs::PoseStamped& pose) {
      geometry_msgs::PoseWithCovarianceStamped message;
      message.header = pose.header;
      message.pose.pose = pose.pose;
      startAt(message, "the pose of ~initial_pose_marker");
    });
  }
  worker_->setObserver(
      [this](const DiagnosticSnapshot& snapshot, const TrackerSession& current) { observe(snapshot, current); });
  services_ =
      std::make_unique<TrackerServices>(private_node, *worker_, tf_->buffer(),
                                        accessForServices(options.object_folders, options.object, built.mesh_file));
  if (marker_) services_->offerMarker(*marker_);
  services_->setLoadedCallback([this](const TrackerConfig& config) { offerLiveParameters(config); });
  worker_->start();
  if (pose_memory_) {
    save_timer_ =
        private_node.createWallTimer(ros::WallDuration(2.0), [this](const ros::WallTimerEvent&) { savePose(); });
  }
  if (built.tracker) offerLiveParameters(built.config);
  subscribeCommands();
  if (robot.enabled) subscribeJoints();
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

/// Once there are parameters that are all good: those that are not stay as they are, for the user to see.
void TrackerNodelet::offerLiveParameters(const TrackerConfig& config) {
  const std::lock_guard<std::mutex> lock(live_mutex_);
  if (live_) return;
  live_ = std::make_unique<LiveReconfigure>(getPrivateNodeHandle(), config, [this](const TrackerConfig& changed) {
    worker_->post([changed](TrackerSession& session) { session.setLiveParameters(changed); }, false);
  });
}

void TrackerNodelet::observe(const DiagnosticSnapshot& snapshot, const TrackerSession& session) {
  if (diagnostics_) diagnostics_->setSnapshot(snapshot);
  const bool is_silent = snapshot.seconds_without_image > kSilenceUntilTopicsAreListedS && !snapshot.status.paused;
  if (is_silent && !topics_told_) NODELET_WARN_STREAM(getName() << ": " << listDepthTopics());
  topics_told_ = is_silent;
  if (!frame_note_told_ && !snapshot.frame_note.empty() && snapshot.status.frames_received > kImagesUntilTfIsThere) {
    frame_note_told_ = true;
    NODELET_INFO_STREAM(getName() << ": " << snapshot.frame_note);
  }
  if (marker_) marker_->update(session.object(), session.lastResult(), session.cameraFrame());
  if (pose_memory_) pose_memory_->note(session.lastResult(), session.object().name);
}

/// Starts where the object was last time, if that is known; ~init_file, where given, comes after and wins.
bool TrackerNodelet::recallLastPose(const std::string& file, const std::string& object_name, TrackerSession& session) {
  std::string problem;
  InitialPose pose;
  const auto recalled = recallPose(file, object_name, problem);
  if (!problem.empty()) session.refuseInitialPose(problem);
  if (!recalled) return false;
  pose.T_frame_object = *recalled;
  session.initialise(pose, nullptr);
  NODELET_INFO_STREAM(getName() << ": starting from the last pose of '" << object_name << "' in " << file);
  return true;
}

void TrackerNodelet::savePose() {
  if (!pose_memory_) return;
  const std::string problem = pose_memory_->save();
  if (!problem.empty()) NODELET_ERROR_STREAM_THROTTLE(60.0, getName() << ": " << problem);
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
  std::string remapped = node.resolveName(by_name);
  if (remapped != by_name) return remapped;
  return node.resolveName(image_transport::getCameraInfoTopic(image_topic));
}

void TrackerNodelet::subscribeCommands() {
  ros::NodeHandle& node = getNodeHandle();
  initial_pose_subscriber_ = getPrivateNodeHandle().subscribe("initial_pose", 1, &TrackerNodelet::onInitialPose, this);
  detected_pose_subscriber_ =
      getPrivateNodeHandle().subscribe("detected_pose", 1, &TrackerNodelet::onDetectedPose, this);
  grasp_subscriber_ = node.subscribe(siblingName(getName(), "grasp"), 10, &TrackerNodelet::onGrasp, this);
  twist_subscriber_ = node.subscribe<geometry_msgs::TwistStamped>(
      siblingName(getName(), "control_twist"), 100,
      [this](const geometry_msgs::TwistStampedConstPtr& twist) {
        worker_->post([twist](TrackerSession& session) { session.addTwist(*twist); }, false);
      },
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
}

void TrackerNodelet::subscribeJoints() {
  const auto subscribe_to = [this](const char* topic, void (TrackerSession::*take)(const sensor_msgs::JointState&)) {
    return getNodeHandle().subscribe<sensor_msgs::JointState>(
        siblingName(getName(), topic), 500,
        [this, take](const sensor_msgs::JointStateConstPtr& joints) {
          worker_->post([take, joints](TrackerSession& session) { (session.*take)(*joints); }, false);
        },
        ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  };
  joint_subscriber_ = subscribe_to("joint_states", &TrackerSession::addJointStates);
  command_subscriber_ = subscribe_to("joint_commands", &TrackerSession::addCommands);
}

void TrackerNodelet::subscribe(const std::string& image_topic, const std::string& info_topic,
                               const std::string& transport) {
  matcher_.emplace([this](CameraFrame frame) { worker_->postFrame(std::move(frame)); });
  info_subscriber_ = getNodeHandle().subscribe<sensor_msgs::CameraInfo>(
      info_topic, 4, [this](const sensor_msgs::CameraInfoConstPtr& info) { matcher_->addInfo(info); });
  const auto on_image = [this](const sensor_msgs::ImageConstPtr& image) { matcher_->addImage(image); };
  image_transport::ImageTransport images(getNodeHandle());
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  const auto subscribe_with = [&](const std::string& name) {
    return images.subscribe(image_topic, 1, on_image, ros::VoidPtr(), image_transport::TransportHints(name, no_delay));
  };
  try {
    image_subscriber_ = subscribe_with(transport);
  } catch (const image_transport::Exception& error) {
    NODELET_ERROR_STREAM(getName() << ": ~image_transport '" << transport
                                   << "' cannot be used, taking 'raw': " << error.what());
    image_subscriber_ = subscribe_with("raw");
  }
  NODELET_INFO_STREAM(getName() << ": depth from '" << image_topic << "', camera_info from '" << info_topic << "'");
}

void TrackerNodelet::onInitialPose(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message) {
  startAt(*message, "~initial_pose");
}

void TrackerNodelet::startAt(const geometry_msgs::PoseWithCovarianceStamped& message, const std::string& source) {
  const CheckedInitialPose checked = checkInitialPose(message);
  worker_->post([checked, source](TrackerSession& session) {
    if (checked.problem.empty()) {
      session.initialise(checked.pose, nullptr);
    } else {
      session.refuseInitialPose(source + " refused: " + checked.problem);
    }
  });
}

/// A detector goes on publishing: only a tracker that has nothing to lose listens.
void TrackerNodelet::onDetectedPose(const geometry_msgs::PoseStampedConstPtr& message) {
  geometry_msgs::PoseWithCovarianceStamped pose;
  pose.header = message->header;
  pose.pose.pose = message->pose;
  const CheckedInitialPose checked = checkInitialPose(pose);
  worker_->post(
      [checked](TrackerSession& session) {
        if (!session.needsPose()) return;
        if (checked.problem.empty()) {
          session.initialise(checked.pose, nullptr);
        } else {
          session.refuseInitialPose("~detected_pose refused: " + checked.problem);
        }
      },
      false);
}

void TrackerNodelet::onGrasp(const GraspConstPtr& message) {
  worker_->post([message](TrackerSession& session) {
    if (!message->object_name.empty() && message->object_name != session.object().name) return;
    session.setGrasp(message->grasped, message->link);
  });
}

}  // namespace depth_object_tracker
