// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/tracker_worker.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <exception>
#include <utility>

namespace depth_object_tracker {
namespace {

constexpr std::chrono::duration<double> kIdlePeriod{1.0};

double secondsSince(std::chrono::steady_clock::time_point time) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - time).count();
}

/// Building a tracker takes some 20 MB for a moment, on whatever thread serves the call; glibc would keep them for each
/// of those threads.
void returnUnusedMemory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace

TrackerWorker::TrackerWorker(const std::string& name, TrackerSession session, ResultPublisher publisher,
                             double control_wait_s)
    : log_(name), session_(std::move(session)), publisher_(std::move(publisher)), control_wait_(control_wait_s) {
  publisher_.setObject(session_.object());
}

TrackerWorker::~TrackerWorker() {
  stop();
}

void TrackerWorker::start() {
  publishStatus(session_.idleResult(0.0));
  thread_ = std::thread([this] { run(); });
}

void TrackerWorker::stop() {
  inbox_.stop();
  if (thread_.joinable()) thread_.join();
  session_.abandon("the tracker is shutting down");
}

bool TrackerWorker::post(SessionCommand command, bool announce) {
  return inbox_.postCommand([this, command = std::move(command), announce] {
    command(session_);
    announce_ = announce_ || announce;
  });
}

bool TrackerWorker::postTracker(BuiltTracker built) {
  return post([this, built = std::move(built)](TrackerSession& session) {
    session.setTracker(built);
    publisher_.setObject(built);
    returnUnusedMemory();
  });
}

void TrackerWorker::run() {
  while (auto delivery = inbox_.wait(kIdlePeriod)) {
    try {
      carryOut(delivery->commands);
      if (delivery->frame) handleFrame(*delivery->frame);
      reportIdle();
    } catch (const std::exception& error) {  // a crash would take the camera driver in the same process with it
      log_.error(std::string("internal error, please report it: ") + error.what());
    }
  }
}

void TrackerWorker::carryOut(std::deque<FrameInbox::Command>& commands) {
  for (const FrameInbox::Command& command : commands) command();
}

void TrackerWorker::handleFrame(const CameraFrame& frame) {
  last_image_at_ = Clock::now();
  idle_reported_ = false;
  const FrameInbox::Counters counters = inbox_.counters();
  statistics_.input_rate.update(counters.received, last_image_at_);
  watchStamp(frame.image->header.stamp);
  if (session_.paused()) return;
  waitForControl(frame);
  const FrameOutcome outcome = session_.process(frame);
  publisher_.publishImageAddress(outcome.depth.data);
  publisher_.publish(outcome, session_.object());
  if (outcome.processed) ++statistics_.processed;
  if (outcome.is_new_estimate) ++statistics_.published;
  statistics_.output_rate.update(statistics_.published, Clock::now());
  statistics_.latency_s = secondsSince(frame.received_at);
  const std::string advice =
      drop_watch_.update(counters.received, counters.dropped, outcome.result.time.total_s, last_image_at_);
  if (!advice.empty()) log_.warn(advice);
  publishStatus(outcome.result);
}

/// Tells an odd stamp once, until stamps have been good again.
void TrackerWorker::watchStamp(const ros::Time& stamp) {
  if (!ros::Time::isValid()) return;  // no simulated time yet
  stamp_age_s_ = (ros::Time::now() - stamp).toSec();
  const std::string problem = findStampProblem(*stamp_age_s_);
  if (!problem.empty() && !stamp_problem_told_) log_.warn(problem);
  stamp_problem_told_ = !problem.empty();
}

/// Twist and joints up to the image's stamp often arrive just after the image.
void TrackerWorker::waitForControl(const CameraFrame& frame) {
  const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(control_wait_);
  while (session_.awaitsControl(frame.image->header.stamp) && Clock::now() < deadline) {
    auto delivery = inbox_.waitForCommands(deadline - Clock::now());
    if (!delivery) return;
    carryOut(delivery->commands);
  }
}

/// A status after a command, and once a second while no image leads to one.
void TrackerWorker::reportIdle() {
  const bool is_idle = secondsSince(last_status_at_) > 0.95 * kIdlePeriod.count();
  if (!announce_ && !is_idle) return;
  if (is_idle) statistics_.input_rate.update(inbox_.counters().received, Clock::now());
  if (is_idle) statistics_.output_rate.update(statistics_.published, Clock::now());
  const TrackerResult result = session_.idleResult(secondsSince(last_image_at_));
  if (is_idle && !idle_reported_ && !session_.paused() && !result.reason.empty()) {
    log_.warn(result.reason);
    idle_reported_ = true;
  }
  publishStatus(result);
}

void TrackerWorker::publishStatus(const TrackerResult& result) {
  StatusContext context;
  context.header = session_.lastHeader();
  context.object_name = session_.object().name;
  context.paused = session_.paused();
  context.grasped = session_.grasped();
  const TrackerStatus status = buildStatus(result, context, statistics_, inbox_.counters());
  publisher_.publishStatus(status);
  tellObserver(status);
  last_status_at_ = Clock::now();
  announce_ = false;
}

void TrackerWorker::tellObserver(const TrackerStatus& status) const {
  if (!observer_) return;
  DiagnosticSnapshot snapshot;
  snapshot.status = status;
  snapshot.stage_times = session_.lastResult().time;
  snapshot.seconds_without_image = secondsSince(last_image_at_);
  snapshot.stamp_age_s = stamp_age_s_;
  snapshot.dropped_share = drop_watch_.droppedShare();
  snapshot.findings = session_.findings();
  snapshot.frame_note = session_.missingParent();
  observer_(snapshot, session_);
}

}  // namespace depth_object_tracker
