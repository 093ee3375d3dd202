// SPDX-License-Identifier: BSD-3-Clause
#include "tracker/pose_evidence.h"

#include "depth_object_tracker/tracker/pose_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depth_object_tracker {

double fitQuality(const TileFit& fit) {
  constexpr int kLeastCells = 15;
  constexpr double kPerContinuedShare = 1.5;
  if (fit.measured() < kLeastCells) return -std::numeric_limits<double>::infinity();
  const double continued = static_cast<double>(fit.continued) / std::max(1, fit.beside);
  return static_cast<double>(fit.matching - fit.through) / fit.measured() - kPerContinuedShare * continued;
}

double findQuality(const PoseAssessment& assessment) {
  constexpr int kLeastCells = 10;
  constexpr double kPerContinuedShare = 1.4;
  if (assessment.measured_pixels < kLeastCells || !(assessment.expected > 0.0)) return 0.0;
  const double visible = assessment.visibleShare();
  const double score = std::min(1.0, assessment.achieved / assessment.expected);
  const double continued =
      static_cast<double>(assessment.continued_pixels) / std::max(1, assessment.surrounding_pixels);
  return std::max(0.0, visible * score * std::abs(score)) * std::max(0.0, 1.0 - kPerContinuedShare * continued);
}

double findEvidence(const PoseAssessment& assessment) {
  constexpr double kThroughAtOutline = 0.12, kPerShare = 6.0;
  if (!(assessment.expected > 0.0)) return 0.0;
  const double through = static_cast<double>(assessment.through_pixels) / std::max(1, assessment.surrounding_pixels);
  const double fit = findQuality(assessment) * std::min(1.0, assessment.achieved / assessment.expected);
  return fit * fit * std::exp(-kPerShare * std::max(0.0, through - kThroughAtOutline)) *
         std::max(0.0, assessment.log_likelihood);
}

namespace {

/// Evidence [nat] against a pose whose hidden parts would be behind the same surface as its seen ones. Fingers and a
/// surface that they touch merge, too, in places.
double againstMerging(const PoseAssessment& assessment) {
  constexpr double kFewEdges = 15.0, kUsualShare = 0.45, kPerShare = 12.0;
  const double share = assessment.merging_edges / (assessment.hidden_edges + kFewEdges);
  return kPerShare * std::max(0.0, share - kUsualShare);
}

constexpr double kPerLogScore = 32.2, kLeastLogScore = -0.35;

double logScore(const PoseAssessment& assessment, double usual_score) {
  constexpr double kNone = 0.02;
  return std::log(std::max(kNone, assessment.achieved / assessment.expected / usual_score));
}

}  // namespace

double findLogOdds(const PoseAssessment& assessment, double usual_score) {
  // Logistic regression on 50,000 poses found in images of 80 simulated scenes of 11 objects, some of them while the
  // object is hidden, and on a real mug. Scores of the simulated ones were lowered by 3 % (one standard deviation):
  // real meshes fit differently from view to view.
  constexpr double kConstant = -13.84, kPerContinuedShare = -16.8, kPerBoth = -76.6;
  constexpr double kPerLogBeyond = 2.01, kPerLogCells = 3.67;
  constexpr double kMostContinuedForBoth = 0.3, kLeastBeyond = 0.03;
  constexpr double kUsualCells = 800.0;  // something large near the camera has more cells, but is no likelier
  // More in view makes the object no surer: most of what is taken for it is large and in full view.
  constexpr double kEnoughVisible = 0.3;
  if (!(assessment.expected > 0.0)) return -std::numeric_limits<double>::infinity();
  const double log_score = std::clamp(logScore(assessment, usual_score), kLeastLogScore, 0.0);
  const double around = std::max(1, assessment.surrounding_pixels);
  const double continued = assessment.continued_pixels / around, beyond = assessment.beyond_pixels / around;
  const double cells = assessment.measured_pixels * std::min(1.0, kUsualCells / std::max(1, assessment.covered_pixels));
  return kConstant + kPerLogScore * log_score + kPerContinuedShare * continued +
         kPerBoth * log_score * std::min(continued, kMostContinuedForBoth) +
         kPerLogBeyond * std::log(kLeastBeyond + beyond) +
         kPerLogCells * std::log(std::max(1.0, cells * std::min(kEnoughVisible, assessment.visibleShare()))) -
         againstMerging(assessment);
}

double slopeOfPoorFits(const PoseAssessment& assessment, double usual_score) {
  if (!(assessment.expected > 0.0)) return 0.0;
  return kPerLogScore * std::min(0.0, logScore(assessment, usual_score) - kLeastLogScore);
}

namespace {

double between(double near, double far, double remoteness) {
  return near + (far - near) * remoteness;
}

}  // namespace

double neededEvidence(bool is_hidden, double remoteness) {
  constexpr double kMoreIfHidden = 1.5;
  return between(0.6, 1.8 + (is_hidden ? kMoreIfHidden : 0.0), remoteness);
}

double worthFollowing(bool is_hidden, double remoteness, const PoseAssessment& assessment, double usual_score,
                      double usual_nat) {
  constexpr double kMoreIfHidden = 0.5, kLessIfItFits = 2.5, kFits = 0.97, kFitsNot = 0.94, kNear = 0.3;
  constexpr double kLittle = 0.3, kMuch = 0.6;
  const double score = assessment.achieved / std::max(1e-9, assessment.expected) / usual_score;
  const double fit = std::clamp((score - kFitsNot) / (kFits - kFitsNot), 0.0, 1.0) *
                     std::clamp((assessment.visibleShare() - kLittle) / (kMuch - kLittle), 0.0, 1.0);
  const double nearness = std::max(0.0, 1.0 - remoteness / kNear);
  constexpr double kUsualNear = 0.3, kLeastNear = -1.5, kLessThanUsual = 2.0;
  const double near = std::clamp(usual_nat - kLessThanUsual, kLeastNear, kUsualNear);
  return between(near, 1.2 + (is_hidden ? kMoreIfHidden : 0.0), remoteness) -
         std::max(0.0, kLessIfItFits * fit * nearness - againstMerging(assessment));
}

double outlineEvidence(DepthLikelihood& likelihood, const Pose& pose, const Pose& now) {
  constexpr double kContinuedNat = 0.5;  // each cell of the outline
  return kContinuedNat * (likelihood.assess(now, 0).continued_pixels - likelihood.assess(pose, 0).continued_pixels);
}

}  // namespace depth_object_tracker
