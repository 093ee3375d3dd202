// SPDX-License-Identifier: BSD-3-Clause
// Puts the scene together: static world once, moving things every frame, then the sensor.
#include "depth_object_tracker/simulator/scene_simulator.h"

#include "depth_object_tracker/render/depth_renderer.h"
#include "depth_object_tracker/simulator/depth_sensor.h"
#include "depth_object_tracker/simulator/hand_and_arm.h"
#include "depth_object_tracker/simulator/object_motion.h"
#include "depth_object_tracker/simulator/passing_occluders.h"
#include "depth_object_tracker/simulator/pixel_index.h"
#ifdef DEPTH_OBJECT_TRACKER_HAVE_ROBOT
#include "depth_object_tracker/robot/hand_motion.h"
#include "depth_object_tracker/simulator/robot_arm.h"
#endif
#ifdef DEPTH_OBJECT_TRACKER_HAVE_FIDUCIALS
#include "depth_object_tracker/simulator/stereo_pair.h"
#endif
#include "depth_object_tracker/simulator/robot_signals.h"

#include <algorithm>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

constexpr float kNothingM = 20.0f;      // where no surface is: out of the sensor's range
constexpr double kGraspWindowS = 20.0;  // over so much of the motion a grasp is judged
constexpr std::uint64_t kInitialPoseStream = 110;
constexpr std::uint64_t kPusherSeedOffset = 7777;
const Eigen::Vector3d kHumanShoulderWorld(0.8, -0.95, 0.3);
constexpr float kObjectReflectance = 0.55f, kOccluderReflectance = 0.45f;
const Eigen::Vector3d kRobotShoulderWorld(0.8, 0.9, 0.75);

TriangleMesh checked(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) throw std::invalid_argument("the object's mesh has no triangle");
  return mesh;
}

}  // namespace

class SceneSimulator::Implementation {
 public:
  Implementation(const TriangleMesh& object, const SimulationConfig& config);

  const SimulatedFrame& render(double stamp_s);
  Pose truth(double stamp_s) { return held(stamp_s) * motion_.slipped(stamp_s); }
  Pose roughInitialPose(double error_m, double error_rad);
  const SimulationConfig& config() const { return config_; }
  RobotArm* robotArm();
  void setStereo(bool enabled) { stereo_enabled_ = enabled; }

 private:
  Pose held(double stamp_s);
  void makeRobot();
  void believe(double stamp_s);
  HandAndArm makeHolder(HandKind kind, std::uint64_t seed);
  void drawObject();
  void mergeNearest(const std::vector<CoveredPixel>& pixels);
  void drawHands(double stamp_s, const View& view, const DrawSurface& surface);
  void placeOccluder(double stamp_s);
  void drawOccluder(const View& view, const DrawSurface& surface);
  void finishMask();
  void makeStereo(const TriangleMesh& world);
  void renderStereo(double stamp_s);

  SimulationConfig config_;
  TriangleMesh object_;
  ObjectMotion motion_;
  PassingOccluders occluders_;
  DepthSensor sensor_;
  RobotSignals robot_;
  DepthRenderer object_renderer_;
#ifdef DEPTH_OBJECT_TRACKER_HAVE_ROBOT
  struct Belief {
    double stamp_s;
    Pose T_camera_object;  // by the robot's kinematics, of an object that has not slipped
  };
  std::unique_ptr<RobotArm> arm_;
  std::optional<Belief> first_belief_, last_belief_;
#endif
#ifdef DEPTH_OBJECT_TRACKER_HAVE_FIDUCIALS
  std::optional<StereoPair> stereo_;
#endif
  std::optional<HandAndArm> holder_, pusher_;
  std::optional<DepthRenderer> occluder_renderer_;
  std::optional<Pose> T_camera_occluder_;
  std::size_t occluder_number_ = 0;
  std::vector<float> background_m_, depth_m_;
  std::vector<CoveredPixel> object_pixels_;
  std::uint64_t frame_number_ = 0;
  bool stereo_enabled_ = true;
  SimulatedFrame frame_;
};

SceneSimulator::Implementation::Implementation(const TriangleMesh& object, const SimulationConfig& config)
    : config_(config),
      object_(checked(object)),
      motion_(object, config),
      occluders_(config, object),
      sensor_(config.sensor, config.camera, config.seed),
      robot_(config.seed),
      object_renderer_(object) {
  const std::size_t num_pixels = static_cast<std::size_t>(config.camera.width) * config.camera.height;
  background_m_.assign(num_pixels, kNothingM);
  const TriangleMesh world_mesh = makeStaticWorld(config);
  DepthRenderer world(world_mesh);
  for (const CoveredPixel& pixel : world.render(Pose::Identity(), config.camera)) {
    background_m_[pixelIndex(pixel, config.camera)] = pixel.depth;
  }
  frame_.depth_mm.assign(num_pixels, 0);
  frame_.occlusion.assign(num_pixels, 0);
  const bool robot = config.scenario == Scenario::kRobot || config.scenario == Scenario::kSlip;
  if (config.scenario == Scenario::kHuman) holder_ = makeHolder(HandKind::kHuman, config.seed);
  if (robot && !config.robot_urdf.empty()) makeRobot();
  if (robot && config.robot_urdf.empty()) holder_ = makeHolder(HandKind::kGripper, config.seed);
  if (config.scenario == Scenario::kSlip) pusher_ = makeHolder(HandKind::kHuman, config.seed + kPusherSeedOffset);
  if (!config.fiducials_file.empty()) makeStereo(world_mesh);
}

HandAndArm SceneSimulator::Implementation::makeHolder(HandKind kind, std::uint64_t seed) {
  RandomSource random(seed, kInitialPoseStream + 1);
  const Pose T_camera_world = makeCameraMount(config_).T_world_camera().inverse();
  GraspRequest request;
  request.kind = kind;
  for (const double share : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
    request.T_camera_object.push_back(motion_.held(share * std::min(config_.duration_s, kGraspWindowS)));
  }
  request.camera = config_.camera;
  request.seed = seed;
  request.wanted_coverage = kind == HandKind::kHuman ? random.uniform(0.1, 0.25) : random.uniform(0.05, 0.15);
  if (config_.hand_coverage >= 0.0) request.wanted_coverage = config_.hand_coverage;
  request.arm.shoulder_camera = T_camera_world * (kind == HandKind::kHuman ? kHumanShoulderWorld : kRobotShoulderWorld);
  if (kind == HandKind::kGripper) {
    request.arm.wrist_radius_m = 0.042;
    request.arm.elbow_radius_m = 0.055;
    request.arm.forearm_m = 0.22;
  }
  return HandAndArm(object_, request);
}

const SimulatedFrame& SceneSimulator::Implementation::render(double stamp_s) {
  frame_.stamp_s = stamp_s;
  frame_.T_camera_object = truth(stamp_s);
  frame_.slipping = motion_.isSlipping(stamp_s);
  frame_.T_camera_object_kinematics = frame_.T_camera_object;
  if (config_.scenario == Scenario::kRobot || config_.scenario == Scenario::kSlip) believe(stamp_s);
  depth_m_ = background_m_;
  drawObject();
  const View view{config_.camera, Pose::Identity()};
  const auto merge = [this](const std::vector<CoveredPixel>& pixels, float) { mergeNearest(pixels); };
  drawHands(stamp_s, view, merge);
  placeOccluder(stamp_s);
  drawOccluder(view, merge);
  finishMask();
  renderStereo(stamp_s);
  sensor_.measure(depth_m_, frame_number_++, frame_.depth_mm.data());
  return frame_;
}

#ifdef DEPTH_OBJECT_TRACKER_HAVE_ROBOT
void SceneSimulator::Implementation::makeRobot() {
  const bool pushed = config_.scenario == Scenario::kRobot;  // in the other one it is the object that is pushed
  arm_ = std::make_unique<RobotArm>(
      object_, config_, [this](double t_s) { return motion_.held(t_s); }, pushed);
}

Pose SceneSimulator::Implementation::held(double stamp_s) {
  return arm_ ? arm_->held(stamp_s) : motion_.held(stamp_s);
}

RobotArm* SceneSimulator::Implementation::robotArm() {
  return arm_.get();
}

/// What the robot says of the object's motion, and where it thinks that it is.
void SceneSimulator::Implementation::believe(double stamp_s) {
  if (!arm_) {
    frame_.control = robot_.control(stamp_s, held(stamp_s), frame_.T_camera_object);
    frame_.T_camera_object_kinematics = robot_.kinematics(held(stamp_s));
    return;
  }
  const Belief belief{stamp_s, arm_->believed(stamp_s)};
  if (!first_belief_) first_belief_ = last_belief_ = belief;
  frame_.control = carryWithHand(last_belief_->T_camera_object, belief.T_camera_object, truth(last_belief_->stamp_s),
                                 stamp_s - last_belief_->stamp_s);
  // The grasp's offset is what it was in the first image.
  frame_.T_camera_object_kinematics =
      belief.T_camera_object * first_belief_->T_camera_object.inverse() * held(first_belief_->stamp_s);
  last_belief_ = belief;
}
#else
void SceneSimulator::Implementation::makeRobot() {
  throw std::invalid_argument("robot_urdf is set, but this was built without robot kinematics");
}

Pose SceneSimulator::Implementation::held(double stamp_s) {
  return motion_.held(stamp_s);
}

RobotArm* SceneSimulator::Implementation::robotArm() {
  return nullptr;
}

void SceneSimulator::Implementation::believe(double stamp_s) {
  frame_.control = robot_.control(stamp_s, held(stamp_s), frame_.T_camera_object);
  frame_.T_camera_object_kinematics = robot_.kinematics(held(stamp_s));
}
#endif

void SceneSimulator::Implementation::drawObject() {
  object_pixels_ = object_renderer_.render(frame_.T_camera_object, config_.camera);
  std::fill(frame_.occlusion.begin(), frame_.occlusion.end(), std::uint8_t{0});
  mergeNearest(object_pixels_);
}

void SceneSimulator::Implementation::mergeNearest(const std::vector<CoveredPixel>& pixels) {
  for (const CoveredPixel& pixel : pixels) {
    float& depth = depth_m_[pixelIndex(pixel, config_.camera)];
    depth = std::min(depth, pixel.depth);
  }
}

void SceneSimulator::Implementation::drawHands(double stamp_s, const View& view, const DrawSurface& surface) {
#ifdef DEPTH_OBJECT_TRACKER_HAVE_ROBOT
  if (arm_) arm_->draw(stamp_s, view, surface);
#endif
  if (holder_) holder_->draw(held(stamp_s), view, surface);
  const double presence = pusher_ ? motion_.pusherPresence(stamp_s) : 0.0;
  if (presence <= 0.0) return;
  // The pushing hand comes from its shoulder's side and goes back there.
  const Pose T_camera_world = makeCameraMount(config_).T_world_camera().inverse();
  const Eigen::Vector3d to_shoulder = T_camera_world * kHumanShoulderWorld - frame_.T_camera_object.translation();
  Pose T_camera_pusher = frame_.T_camera_object;
  T_camera_pusher.translation() += 0.7 * (1.0 - presence) * to_shoulder;
  pusher_->draw(T_camera_pusher, view, surface);
}

void SceneSimulator::Implementation::placeOccluder(double stamp_s) {
  T_camera_occluder_.reset();
  const auto placed = occluders_.at(stamp_s, frame_.T_camera_object);
  if (!placed) return;
  if (placed->number != occluder_number_) {
    occluder_renderer_.emplace(occluders_.mesh());
    occluder_number_ = placed->number;
  }
  T_camera_occluder_ = placed->T_camera_occluder;
}

void SceneSimulator::Implementation::drawOccluder(const View& view, const DrawSurface& surface) {
  if (!T_camera_occluder_) return;
  surface(occluder_renderer_->render(view.T_view_camera * *T_camera_occluder_, view.camera), kOccluderReflectance);
}

#ifdef DEPTH_OBJECT_TRACKER_HAVE_FIDUCIALS
void SceneSimulator::Implementation::makeStereo(const TriangleMesh& world) {
  stereo_.emplace(config_.stereo, world, loadFiducialMap(config_.fiducials_file), config_.seed);
}

void SceneSimulator::Implementation::renderStereo(double stamp_s) {
  frame_.left.clear();
  frame_.right.clear();
  if (!stereo_ || !stereo_enabled_) return;
  const auto draw_scene = [&](const View& view, const DrawSurface& surface) {
    surface(object_renderer_.render(view.T_view_camera * frame_.T_camera_object, view.camera), kObjectReflectance);
    drawHands(stamp_s, view, surface);
    drawOccluder(view, surface);
  };
  stereo_->render(draw_scene, frame_.T_camera_object, frame_number_, frame_.left, frame_.right);
}
#else
void SceneSimulator::Implementation::makeStereo(const TriangleMesh&) {
  throw std::invalid_argument("fiducials_file is set, but this was built without fiducials (libapriltag-dev)");
}

void SceneSimulator::Implementation::renderStereo(double) {}
#endif

void SceneSimulator::Implementation::finishMask() {
  frame_.object_pixels = static_cast<int>(object_pixels_.size());
  frame_.visible_pixels = 0;
  for (const CoveredPixel& pixel : object_pixels_) {
    const std::size_t index = pixelIndex(pixel, config_.camera);
    const bool visible = depth_m_[index] >= pixel.depth;
    frame_.visible_pixels += visible ? 1 : 0;
    frame_.occlusion[index] = visible ? 255 : 128;
  }
}

Pose SceneSimulator::Implementation::roughInitialPose(double error_m, double error_rad) {
  RandomSource random(config_.seed, kInitialPoseStream);
  Pose about_centre = Pose::Identity();
  const Eigen::Vector3d centroid = surfaceCentroid(object_);
  about_centre.linear() = expSo3(error_rad * random.unitVector());
  about_centre.translation() = centroid - about_centre.linear() * centroid + error_m * random.unitVector();
  return truth(0.0) * about_centre;
}

SceneSimulator::SceneSimulator(const TriangleMesh& object, const SimulationConfig& config)
    : implementation_(std::make_unique<Implementation>(object, config)) {}
SceneSimulator::~SceneSimulator() = default;
const SimulatedFrame& SceneSimulator::render(double stamp_s) {
  return implementation_->render(stamp_s);
}
Pose SceneSimulator::truth(double stamp_s) {
  return implementation_->truth(stamp_s);
}
Pose SceneSimulator::roughInitialPose(double error_m, double error_rad) {
  return implementation_->roughInitialPose(error_m, error_rad);
}
void SceneSimulator::setStereo(bool enabled) {
  implementation_->setStereo(enabled);
}
RobotArm* SceneSimulator::robot() {
  return implementation_->robotArm();
}
const SimulationConfig& SceneSimulator::config() const {
  return implementation_->config();
}

}  // namespace depth_object_tracker
