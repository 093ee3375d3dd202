// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/tracker_services.h"

#include <cmath>
#include <future>
#include <memory>
#include <thread>
#include <utility>

namespace depth_object_tracker {
namespace {

using Clock = std::chrono::steady_clock;
// One may wait for an initialisation (a newer one ends its waiting) while the other answers.
constexpr std::uint32_t kNumThreads = 2;
constexpr double kMaxTimeoutS = 3600.0;
constexpr std::chrono::milliseconds kTransformWait{500};
constexpr std::chrono::milliseconds kPollPeriod{10};
constexpr std::chrono::seconds kWorkerWait{10};
constexpr const char* kStopped = "the tracker is shutting down or hopelessly behind";

Clock::time_point after(double seconds) {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

template <typename Type>
using Promise = std::shared_ptr<std::promise<Type>>;

bool answer(const InitialisationOutcome& outcome, InitializeTracker::Response& response) {
  response.success = outcome.success;
  response.message = outcome.message;
  response.pose = outcome.pose;
  return true;
}

}  // namespace

TrackerServices::TrackerServices(const ros::NodeHandle& private_node, TrackerWorker& worker, const tf2::BufferCore& tf,
                                 FileAccess access)
    : node_(private_node), worker_(worker), tf_(tf), access_(std::move(access)), spinner_(kNumThreads, &queue_) {
  node_.setCallbackQueue(&queue_);
  servers_.push_back(node_.advertiseService("initialize", &TrackerServices::initialize, this));
  servers_.push_back(node_.advertiseService("load_object", &TrackerServices::loadObject, this));
  servers_.push_back(node_.advertiseService("set_grasp", &TrackerServices::setGrasp, this));
  servers_.push_back(node_.advertiseService("reset", &TrackerServices::reset, this));
  servers_.push_back(node_.advertiseService("pause", &TrackerServices::pause, this));
  spinner_.start();
}

TrackerServices::~TrackerServices() {
  stopping_ = true;
  for (ros::ServiceServer& server : servers_) server.shutdown();
  spinner_.stop();
}

void TrackerServices::setLoadedCallback(LoadedCallback callback) {
  const std::lock_guard<std::mutex> lock(callback_mutex_);
  loaded_callback_ = std::move(callback);
}

void TrackerServices::offerMarker(const InitialPoseMarker& marker) {
  marker_ = &marker;
  const boost::function<bool(std_srvs::Trigger::Request&, std_srvs::Trigger::Response&)> answer =
      [this](std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
        return initializeAtMarker(response);
      };
  servers_.push_back(node_.advertiseService("initialize_at_marker", answer));
}

bool TrackerServices::initializeAtMarker(std_srvs::Trigger::Response& response) {
  InitializeTracker::Request request;
  const auto pose = marker_->pose();
  if (!pose) {
    response.message =
        "the marker is not shown: there is no image yet, or the object is tracked; call ~reset to place it anew";
    return true;
  }
  request.mode = InitializeTracker::Request::FROM_POSE;
  request.pose.header = pose->header;
  request.pose.pose.pose = pose->pose;
  InitializeTracker::Response outcome;
  initialize(request, outcome);
  response.success = outcome.success;
  response.message = outcome.message;
  return true;
}

bool TrackerServices::initialize(InitializeTracker::Request& request, InitializeTracker::Response& response) {
  using Mode = InitializeTracker::Request;
  if (request.mode > Mode::GLOBAL) {
    response.message = "mode " + std::to_string(request.mode) + " is not available; use FROM_POSE (" +
                       std::to_string(Mode::FROM_POSE) + "), ON_TABLE (" + std::to_string(Mode::ON_TABLE) +
                       "), IN_HAND (" + std::to_string(Mode::IN_HAND) + ") or GLOBAL (" + std::to_string(Mode::GLOBAL) +
                       ")";
    return true;
  }
  if (!std::isfinite(request.timeout_s) || request.timeout_s < 0.0 || request.timeout_s > kMaxTimeoutS) {
    response.message = "timeout_s is " + std::to_string(request.timeout_s) + "; it must be in [0, 3600]";
    return true;
  }
  if (request.mode == Mode::GLOBAL || request.mode == Mode::ON_TABLE) return search(request, response);
  if (request.mode == Mode::IN_HAND) {
    if (request.link.empty()) {
      response.message = "IN_HAND needs `link`, the frame of the hand, and `pose`, the object's pose in it";
      return true;
    }
    request.pose.header.frame_id = request.link;
  }
  const CheckedInitialPose checked = checkInitialPose(request.pose);
  const std::string problem = checked.problem.empty() ? findObstacle(checked.pose) : checked.problem;
  if (!problem.empty()) {
    worker_.post([problem](TrackerSession& session) { session.refuseInitialPose("~initialize refused: " + problem); });
    response.message = problem;
    return true;
  }
  const auto start = [pose = checked.pose](TrackerSession& session, InitialisationCallback callback) {
    session.initialise(pose, std::move(callback));
  };
  return answer(startAndWait(start, request.timeout_s, "initial pose accepted; tracking starts with the next image"),
                response);
}

/// Starts without a pose.
bool TrackerServices::search(const InitializeTracker::Request& request, InitializeTracker::Response& response) {
  const bool on_table = request.mode == InitializeTracker::Request::ON_TABLE;
  const auto start = [on_table](TrackerSession& session, InitialisationCallback callback) {
    if (on_table) return session.initialiseOnTable(std::move(callback));
    session.initialiseAnywhere(std::move(callback));
  };
  return answer(startAndWait(start, request.timeout_s,
                             on_table ? "what stands on a plane of the image is searched, from the next one on"
                                      : "the whole image is searched, from the next one on"),
                response);
}

/// Why the pose cannot be used: no object, or a frame that tf does not know. Gives tf a moment, by wall clock:
/// simulated time may stand still.
std::string TrackerServices::findObstacle(const InitialPose& pose) const {
  struct Answer {
    std::string problem;
    std::string camera_frame;
  };
  const auto promise = std::make_shared<std::promise<Answer>>();
  const bool posted = worker_.post(
      [promise](TrackerSession& session) {
        promise->set_value({session.object().problem, session.cameraFrame()});
      },
      false);
  auto future = promise->get_future();
  if (!posted || future.wait_for(kWorkerWait) != std::future_status::ready) return kStopped;
  const Answer answer = future.get();
  if (!answer.problem.empty()) return "there is no object to track: " + answer.problem;
  if (answer.camera_frame.empty()) return "";  // no image yet: told when one comes

  const auto deadline = Clock::now() + kTransformWait;
  std::string problem = resolveInitialPose(pose, answer.camera_frame, tf_).problem;
  while (!problem.empty() && Clock::now() < deadline && !stopping_) {
    std::this_thread::sleep_for(kPollPeriod);
    problem = resolveInitialPose(pose, answer.camera_frame, tf_).problem;
  }
  return problem;
}

InitialisationOutcome TrackerServices::startAndWait(const Start& start, double timeout_s, const std::string& accepted) {
  const auto promise = std::make_shared<std::promise<InitialisationOutcome>>();
  const bool waits = timeout_s > 0.0;
  InitialisationCallback callback;
  if (waits) callback = [promise](const InitialisationOutcome& outcome) { promise->set_value(outcome); };
  InitialisationOutcome outcome;
  if (!worker_.post([start, callback](TrackerSession& session) { start(session, callback); })) {
    outcome.message = kStopped;
    return outcome;
  }
  if (!waits) {
    outcome.success = true;
    outcome.message = accepted;
    return outcome;
  }
  auto future = promise->get_future();
  const auto deadline = after(timeout_s);
  while (!stopping_ && Clock::now() < deadline) {
    if (future.wait_for(kPollPeriod) == std::future_status::ready) return future.get();
  }
  outcome.message =
      "not tracking within " + std::to_string(timeout_s) + " s; see ~status for the reason. The tracker goes on trying";
  return outcome;
}

ObjectSource TrackerServices::sourceFor(const LoadObject::Request& request) const {
  ObjectSource source;
  if (request.object_file.empty() && request.mesh.empty()) {
    source = loadNodeletOptions(node_).object;
  } else {
    source.object_file = request.object_file;
    source.mesh = request.mesh;
    source.mesh_scale = request.mesh_scale == 0.0 ? 1.0 : request.mesh_scale;
  }
  if (!request.name.empty()) source.name = request.name;
  return source;
}

/// Reads and builds on the service's thread: the old object is tracked until the new one is there.
bool TrackerServices::loadObject(LoadObject::Request& request, LoadObject::Response& response) {
  XmlRpc::XmlRpcValue value;
  node_.getParam("tracker", value);
  const TrackerParameters parameters = loadTrackerParameters(value, node_.resolveName("tracker"));
  if (!parameters.problems.empty()) {
    response.message = parameters.problems.front();
    return true;
  }
  const BuiltTracker built = buildTracker(sourceFor(request), parameters.config, access_);
  if (!built.tracker) {
    response.message = built.problem;
    return true;
  }
  response.diameter_m = built.tracker->diameterM();
  response.num_triangles = static_cast<std::uint32_t>(built.tracker->object().mesh.triangles.size());
  response.success = worker_.postTracker(built);
  const std::lock_guard<std::mutex> lock(callback_mutex_);
  if (response.success && loaded_callback_) loaded_callback_(built.config);
  response.message = response.success ? "loaded '" + built.name + "'; it needs an initial pose" : kStopped;
  return true;
}

/// A link that cannot be followed is refused and changes nothing.
bool TrackerServices::setGrasp(SetGrasp::Request& request, SetGrasp::Response& response) {
  const auto promise = std::make_shared<std::promise<std::string>>();
  const bool posted = worker_.post([request, promise](TrackerSession& session) {
    const std::string problem = request.grasped ? session.findLinkProblem(request.link) : "";
    if (problem.empty()) session.setGrasp(request.grasped, request.link);
    promise->set_value(problem);
  });
  auto future = promise->get_future();
  if (!posted || future.wait_for(kWorkerWait) != std::future_status::ready) {
    response.message = kStopped;
    return true;
  }
  const std::string problem = future.get();
  response.success = problem.empty();
  response.message = !problem.empty()       ? problem
                     : !request.grasped     ? "not held"
                     : request.link.empty() ? "held; its motion comes from control_twist"
                                            : "held by link '" + request.link + "'";
  return true;
}

bool TrackerServices::reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  response.success = worker_.post([](TrackerSession& session) { session.reset(); });
  response.message = response.success ? "reset; waiting for an initial pose" : kStopped;
  return true;
}

bool TrackerServices::pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
  const bool paused = request.data;
  response.success = worker_.post([paused](TrackerSession& session) { session.setPaused(paused); });
  response.message = !response.success ? kStopped : paused ? "paused" : "running";
  return true;
}

}  // namespace depth_object_tracker
