// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/simulator/robot_arm.h"

#include "depth_object_tracker/robot/link_meshes.h"
#include "depth_object_tracker/simulator/finger_closer.h"
#include "depth_object_tracker/simulator/joint_trajectory.h"
#include "depth_object_tracker/simulator/random_source.h"
#include "depth_object_tracker/simulator/ray_cast.h"
#include "depth_object_tracker/simulator/static_world.h"

#include <urdf_model/model.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

constexpr std::uint64_t kStream = 111;
constexpr int kGraspAttempts = 60;
constexpr int kStartAttempts = 12;
constexpr double kWindowS = 12.0;  // of the path that a grasp is tried on
constexpr double kTryStepS = 0.3;
constexpr double kPalmM = 0.078;  // from the hand's origin to its palm
constexpr double kPushRad = 0.02;
constexpr float kReflectance = 0.3f;
constexpr double kPushPeriodS = 2.3;
constexpr double kPushS = 0.9;
const Eigen::Vector3d kBasesWorld[] = {{0.85, 0.75, -0.1}, {0.95, -0.75, -0.1}, {1.2, 0.5, -0.1}, {1.15, -0.5, -0.1}};

Eigen::VectorXd neutral() {
  return (Eigen::VectorXd(7) << 0.0, 0.6, 0.0, 1.6, 0.0, 0.6, 0.0).finished();
}

}  // namespace

class RobotArm::Implementation {
 public:
  Implementation(const TriangleMesh& object, const SimulationConfig& config, std::function<Pose(double)> wanted,
                 bool pushed);

  Pose held(double t_s) { return objectAt(truePositions(t_s)); }
  Pose believed(double t_s) { return objectAt(motorPositions(t_s)); }
  SimulatedJoints joints(double t_s);
  void draw(double t_s, const View& view, const DrawSurface& surface);

  std::mutex mutex;
  RobotModel model;
  Pose T_world_base = Pose::Identity();

 private:
  struct Grasp {
    Pose T_object_hand;
    FingerPositions fingers;
  };
  struct Link {
    LinkChain chain;
    DepthRenderer renderer;
  };
  Pose objectAt(const Eigen::VectorXd& joints) const {
    return T_camera_base_ * hand_.pose(joints) * grasp_.T_object_hand.inverse();
  }
  Pose wantedHand(double t_s) const { return T_camera_base_.inverse() * wanted_(t_s) * grasp_.T_object_hand; }
  Eigen::VectorXd stretch(const Eigen::VectorXd& positions) {
    return compliance_ * solver_.gravityTorques(positions).cwiseProduct(softness_);
  }
  Eigen::VectorXd push(double t_s) const;
  Eigen::VectorXd truePositions(double t_s) { return nominal_->positions(t_s) + push(t_s); }
  Eigen::VectorXd motorPositions(double t_s) {
    const Eigen::VectorXd nominal = nominal_->positions(t_s);
    return nominal - stretch(nominal);
  }
  std::optional<Grasp> randomGrasp(const TriangleMesh& object, RandomSource& random) const;
  std::optional<Eigen::VectorXd> findStart(RandomSource& random);
  bool followsPath(const Eigen::VectorXd& start);
  bool isWithinLimits(const Eigen::VectorXd& positions) const;
  void chooseGrasp(const TriangleMesh& object, const SimulationConfig& config);
  void calibrateStretch();

  LinkChain hand_;
  ArmSolver solver_;
  std::function<Pose(double)> wanted_;
  bool pushed_;
  std::uint64_t seed_;
  Eigen::VectorXd lower_, upper_;
  Eigen::VectorXd softness_ = (Eigen::VectorXd(7) << 1.0, 1.0, 1.0, 1.5, 3.0, 3.0, 3.0).finished();
  double compliance_ = 1e-3;  // [rad/Nm]
  Pose T_camera_base_ = Pose::Identity();
  Grasp grasp_;
  std::optional<JointTrajectory> nominal_;
  std::vector<Link> links_;
};

RobotArm::Implementation::Implementation(const TriangleMesh& object, const SimulationConfig& config,
                                         std::function<Pose(double)> wanted, bool pushed)
    : model(RobotModel::fromFile(config.robot_urdf)),
      hand_(model.chainTo(kHandLink)),
      solver_(model.solverFor(kHandLink)),
      wanted_(std::move(wanted)),
      pushed_(pushed),
      seed_(config.seed) {
  const double unlimited = std::numeric_limits<double>::infinity();
  const auto count = static_cast<Eigen::Index>(hand_.joints().size());
  if (count != neutral().size()) throw std::runtime_error("the simulated arm must have 7 joints up to 'hand_link'");
  lower_ = Eigen::VectorXd::Constant(count, -unlimited);
  upper_ = -lower_;
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto joint = model.description().getJoint(hand_.joints()[static_cast<std::size_t>(k)]);
    if (joint->type == urdf::Joint::CONTINUOUS || !joint->limits) continue;
    lower_[k] = joint->limits->lower;
    upper_[k] = joint->limits->upper;
  }
  chooseGrasp(object, config);
  calibrateStretch();
  for (LinkMesh& link : loadLinkMeshes(model, LinkShapes::kVisual).links) {
    links_.push_back({model.chainTo(link.link), DepthRenderer(link.mesh)});
  }
}

bool RobotArm::Implementation::isWithinLimits(const Eigen::VectorXd& positions) const {
  return (positions.array() >= lower_.array()).all() && (positions.array() <= upper_.array()).all();
}

std::optional<RobotArm::Implementation::Grasp> RobotArm::Implementation::randomGrasp(const TriangleMesh& object,
                                                                                     RandomSource& random) const {
  const Pose T_object_base = wanted_(0.0).inverse() * T_camera_base_;
  const Eigen::Vector3d centroid = surfaceCentroid(object);
  const auto& vertex = object.vertices[random.bits() % object.vertices.size()];
  const Eigen::Vector3d aim = centroid + random.uniform(0.0, 0.6) * (vertex.cast<double>() - centroid);
  const Eigen::Vector3d shoulder = T_object_base * Eigen::Vector3d(0.0, 0.0, 0.35);
  // The palm comes from the shoulder's side.
  const Eigen::Vector3d approach = ((shoulder - aim).normalized() + 0.8 * random.unitVector()).normalized();
  constexpr double kOutside = 0.5;
  const auto entry = castRay(object, aim + kOutside * approach, -approach);
  if (!entry) return std::nullopt;
  const Eigen::Vector3d surface = aim + (kOutside - *entry) * approach;
  Grasp grasp;
  const Eigen::Vector3d z = -approach, x = z.cross(random.unitVector()).normalized();
  grasp.T_object_hand = Pose::Identity();
  grasp.T_object_hand.linear() << x, z.cross(x), z;
  grasp.T_object_hand.translation() = surface + (kPalmM + random.uniform(0.01, 0.05)) * approach;
  const auto fingers = closeFingers(model, object, grasp.T_object_hand);
  if (!fingers) return std::nullopt;
  grasp.fingers = *fingers;
  return grasp;
}

std::optional<Eigen::VectorXd> RobotArm::Implementation::findStart(RandomSource& random) {
  for (int attempt = 0; attempt < kStartAttempts; ++attempt) {
    Eigen::VectorXd start = neutral();
    for (Eigen::Index k = 0; k < start.size(); ++k) start[k] += random.uniform(-1.0, 1.0) * (attempt > 0 ? 1.2 : 0.1);
    auto solved = solver_.solve(wantedHand(0.0), start);
    if (solved && isWithinLimits(*solved)) return solved;
  }
  return std::nullopt;
}

bool RobotArm::Implementation::followsPath(const Eigen::VectorXd& start) {
  Eigen::VectorXd positions = start;
  for (double t_s = 0.0; t_s < kWindowS; t_s += kTryStepS) {
    const auto next = solver_.solve(wantedHand(t_s), positions);
    if (!next || !isWithinLimits(*next) || (*next - positions).cwiseAbs().maxCoeff() > 1.0) return false;
    positions = *next;
  }
  return true;
}

void RobotArm::Implementation::chooseGrasp(const TriangleMesh& object, const SimulationConfig& config) {
  RandomSource random(config.seed, kStream);
  const Pose T_world_camera = makeCameraMount(config).T_world_camera();
  for (int attempt = 0; attempt < kGraspAttempts; ++attempt) {
    T_world_base.translation() = kBasesWorld[static_cast<std::size_t>(attempt) % std::size(kBasesWorld)];
    const Eigen::Vector3d ahead = T_world_camera * wanted_(0.0).translation() - T_world_base.translation();
    T_world_base.linear() = expSo3(std::atan2(ahead.y(), ahead.x()) * Eigen::Vector3d::UnitZ());
    T_camera_base_ = T_world_camera.inverse() * T_world_base;
    const auto grasp = randomGrasp(object, random);
    if (!grasp) continue;
    grasp_ = *grasp;
    const auto start = findStart(random);
    if (!start || !followsPath(*start)) continue;
    nominal_.emplace([this](double t_s, const Eigen::VectorXd& near) { return solver_.solve(wantedHand(t_s), near); },
                     *start);
    return;
  }
  throw std::runtime_error(
      "the simulated arm finds no grasp with which it can move this object; try another seed or object");
}

/// Scales the compliance until the mean error at the hand over some seconds is what it should be.
void RobotArm::Implementation::calibrateStretch() {
  for (int round = 0; round < 3; ++round) {
    double sum = 0.0;
    int count = 0;
    for (double t_s = 0.0; t_s < kWindowS; t_s += 0.5, ++count) {
      const Eigen::VectorXd positions = nominal_->positions(t_s);
      const Pose T_true = hand_.pose(positions), T_believed = hand_.pose(positions - stretch(positions));
      sum += (T_true.translation() - T_believed.translation()).norm();
    }
    compliance_ *= kMeanStretchM / std::max(sum / count, 1e-6);
  }
}

/// A push every now and then, on other joints each time; smooth, and back to nothing.
Eigen::VectorXd RobotArm::Implementation::push(double t_s) const {
  Eigen::VectorXd joints = Eigen::VectorXd::Zero(neutral().size());
  const double phase_s = t_s - kPushPeriodS * std::floor(t_s / kPushPeriodS) - 1.0;
  if (!pushed_ || phase_s <= 0.0 || phase_s >= kPushS) return joints;
  RandomSource random(seed_ + static_cast<std::uint64_t>(t_s / kPushPeriodS), kStream + 1);
  const double share = std::pow(std::sin(M_PI * phase_s / kPushS), 2.0);
  for (Eigen::Index k = 0; k < 4; ++k) joints[k] = share * kPushRad * random.uniform(-1.0, 1.0);
  return joints;
}

SimulatedJoints RobotArm::Implementation::joints(double t_s) {
  constexpr double kStepS = 1e-3;
  const Eigen::VectorXd positions = motorPositions(t_s);
  const Eigen::VectorXd velocities = (motorPositions(t_s + kStepS) - motorPositions(std::max(0.0, t_s - kStepS))) /
                                     (t_s > kStepS ? 2.0 * kStepS : kStepS);
  SimulatedJoints joints;
  joints.names = hand_.joints();
  for (Eigen::Index k = 0; k < positions.size(); ++k) {
    joints.positions.push_back(positions[k]);
    joints.velocities.push_back(velocities[k]);
    joints.commands.push_back(velocities[k]);
  }
  for (const auto& [name, position] : grasp_.fingers) {
    joints.names.push_back(name);
    joints.positions.push_back(position);
    joints.velocities.push_back(0.0);
    joints.commands.push_back(0.0);
  }
  return joints;
}

void RobotArm::Implementation::draw(double t_s, const View& view, const DrawSurface& surface) {
  const Eigen::VectorXd arm = truePositions(t_s);
  for (Link& link : links_) {
    const std::vector<std::string>& names = link.chain.joints();
    Eigen::VectorXd positions(static_cast<Eigen::Index>(names.size()));
    for (std::size_t k = 0; k < names.size(); ++k) {
      const auto finger = grasp_.fingers.find(names[k]);
      const auto in_arm = std::find(hand_.joints().begin(), hand_.joints().end(), names[k]) - hand_.joints().begin();
      const double other = in_arm < arm.size() ? arm[in_arm] : 0.0;  // joints beside the arm, such as a head's, rest
      positions[static_cast<Eigen::Index>(k)] = finger != grasp_.fingers.end() ? finger->second : other;
    }
    const Pose T_view_link = view.T_view_camera * T_camera_base_ * link.chain.pose(positions);
    surface(link.renderer.render(T_view_link, view.camera), kReflectance);
  }
}

RobotArm::RobotArm(const TriangleMesh& object, const SimulationConfig& config, std::function<Pose(double)> wanted,
                   bool pushed)
    : implementation_(std::make_unique<Implementation>(object, config, std::move(wanted), pushed)) {}
RobotArm::~RobotArm() = default;

Pose RobotArm::held(double t_s) {
  const std::lock_guard<std::mutex> lock(implementation_->mutex);
  return implementation_->held(t_s);
}
Pose RobotArm::believed(double t_s) {
  const std::lock_guard<std::mutex> lock(implementation_->mutex);
  return implementation_->believed(t_s);
}
SimulatedJoints RobotArm::joints(double t_s) {
  const std::lock_guard<std::mutex> lock(implementation_->mutex);
  return implementation_->joints(t_s);
}
Pose RobotArm::T_world_base() const {
  return implementation_->T_world_base;
}
const std::string& RobotArm::rootLink() const {
  return implementation_->model.rootLink();
}
void RobotArm::draw(double t_s, const View& view, const DrawSurface& surface) {
  const std::lock_guard<std::mutex> lock(implementation_->mutex);
  implementation_->draw(t_s, view, surface);
}

}  // namespace depth_object_tracker
