// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/reacquisition.h"

#include "tracker/pose_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr SearchEffort kAround{0, 3000, 400, 60, 16};
constexpr SearchEffort kEverywhere{200, 2000, 200, 100, 16};
constexpr SearchEffort kOfDistractors{200, 2000, 400, 200, 24, 0.06};
constexpr SearchEffort kEverywhereAtTheStart{1000, 20000, 2000, 800, 40};
constexpr SearchEffort kOnTable{0, 20000, 2000, 400, 24};
constexpr SearchEffort kOfSurvivors{0, 60, 60, 20, 10};
constexpr std::size_t kSurvivors = 6;
constexpr double kSameM = 0.05, kSameRad = 0.5;  // from image to image
constexpr double kExplainsMore = 1.1;            // likelihood, of a better pose
constexpr double kSurerInHandNat = 2.0;          // than what the hand is thought to hold
constexpr double kSureNat = 5.0;                 // log odds of an object that stands out
constexpr double kPlacesToHide = 0.25;           // of those where the object may be
constexpr double kLeastOfDistractors = -12.0;    // log odds [nat] in full view; half hidden, they look more alike

Vector6d survivorVariances() {
  return poseVariances(0.012, 0.12);
}

/// Of poses that fit about as well as the first, and are about as sure, the one nearest to what is expected.
/// @param margin [nat] of a pose: how much surer it is than it must be.
template <typename Margin>
const FoundPose& likeliestOfTheBest(const std::vector<FoundPose>& found, const SearchRegion& region,
                                    const Margin& margin) {
  constexpr double kAboutAsWell = 0.06, kLessSure = 2.0;
  const FoundPose* likeliest = &found.front();
  for (const FoundPose& one : found) {
    if (one.quality < found.front().quality - kAboutAsWell || margin(one) < margin(found.front()) - kLessSure) continue;
    if (squaredDistance(one.T_camera_centre, region) < squaredDistance(likeliest->T_camera_centre, region)) {
      likeliest = &one;
    }
  }
  return *likeliest;
}

/// Of poses that fit about as well as the first, the one that explains most of the image: a mug whose handle is seen
/// fits with the handle behind it, too, but then the handle is left over.
const FoundPose& mostExplaining(const std::vector<FoundPose>& found) {
  constexpr double kAboutAsWell = 0.15;
  const FoundPose* most = &found.front();
  for (const FoundPose& one : found) {
    if (one.quality < found.front().quality - kAboutAsWell) continue;
    if (one.assessment.log_likelihood > most->assessment.log_likelihood) most = &one;
  }
  return *most;
}

/// Evidence [nat] against a pose to which an object that was surely followed could hardly have moved; no more than that
/// it was something else that was followed.
double unreachable(const FoundPose& one, const Pose& T_camera_centre, const OtherPoses& others) {
  constexpr double kMostNat = 1.5;
  if (!others.reach) return 0.0;
  const Eigen::Vector3d moved = one.T_camera_centre.translation() - T_camera_centre.translation();
  return std::min(kMostNat, 0.5 * moved.cwiseAbs2().cwiseQuotient(*others.reach).sum());
}

double fitOfWhatIsSeen(const PoseAssessment& assessment) {
  const double visible = assessment.visible_pixels / std::max(1, assessment.measured_pixels);
  return findQuality(assessment) / std::max(0.05, visible);
}

}  // namespace

std::vector<Pose> Reacquisition::survivorPoses() const {
  std::vector<Pose> poses;
  for (const Survivor& one : survivors_) poses.push_back(one.T_camera_centre);
  return poses;
}

double Reacquisition::evidenceBefore(const Pose& T_camera_centre) const {
  constexpr double kMostNat = 5.0;  // many images of one arm say no more than a few
  double most = 0.0;
  for (const Survivor& other : survivors_) {
    const double moved_m = (other.T_camera_centre.translation() - T_camera_centre.translation()).norm();
    if (moved_m < kSameM) most = std::max(most, other.evidence);
  }
  return std::min(most, kMostNat);
}

std::optional<Pose> Reacquisition::search(const DepthImageView& depth, const PinholeCamera& camera,
                                          const SearchRegion& region) {
  if (region.is_known) findDistractors();
  const double expected_m = std::max(0.2, region.T_camera_centre.translation().z());
  finder_->setImage(depth, camera, std::clamp(region.seen_distance_m, expected_m, 2.0 * expected_m), region.occluders);
  found_.clear();
  if (!region.is_known) return searchAnywhere(region);
  const bool everywhere_instead = !region.everywhere && ++images_ % 3 == 0;
  if (!everywhere_instead) found_ = finder_->searchAround({region.T_camera_centre}, region.variances, kAround);
  const auto add = [this](const std::vector<FoundPose>& more) {
    found_.insert(found_.end(), more.begin(), more.end());
  };
  add(finder_->searchAround(survivorPoses(), survivorVariances(), kOfSurvivors));
  if (region.everywhere || everywhere_instead) add(finder_->searchEverywhere(kEverywhere));

  const bool is_hidden =
      !region.everywhere || (region.was_followed && hiddenShare(region, depth, camera) > kPlacesToHide);
  // An object that was never seen may be another one, or have another size.
  const auto remote = [&](const FoundPose& one) {
    return usual_score_ ? remoteness(one.T_camera_centre, region) : 1.0;
  };
  const auto evidence = [&](const FoundPose& one) {
    return evidenceBefore(one.T_camera_centre) + logOdds(one) -
           distractors_.against(one.T_camera_centre, region.T_camera_centre, region.memory_s) -
           worthFollowing(is_hidden, remote(one), one.assessment, usualScore(), usual_log_odds_.value_or(kSureNat));
  };
  const auto margin = [&](const FoundPose& one) {
    const double out_of_reach = is_hidden && region.was_followed ? outOfReach(one.T_camera_centre, region) : 0.0;
    return evidence(one) - neededEvidence(is_hidden, remote(one)) - out_of_reach;
  };
  std::stable_sort(found_.begin(), found_.end(),
                   [&](const FoundPose& a, const FoundPose& b) { return margin(a) > margin(b); });
  const bool is_sure = !found_.empty() && margin(found_.front()) > 0.0;
  std::vector<Survivor> survivors;
  for (const FoundPose& one : found_) {
    if (survivors.size() < kSurvivors) survivors.push_back({one.T_camera_centre, evidence(one)});
  }
  survivors_ = std::move(survivors);
  if (!is_sure) return std::nullopt;
  return finder_->settle(likeliestOfTheBest(found_, region, margin), region.T_camera_centre, region.variances)
      .T_camera_centre;
}

/// Takes some time, once after each time that the object was in view.
void Reacquisition::findDistractors() {
  const std::optional<Distractors::Scene> scene = distractors_.unsearched();
  if (!scene) return;
  finder_->setImage(scene->depth, scene->camera, std::max(0.2, scene->T_camera_centre.translation().z()));
  std::vector<Pose> poses;
  for (const FoundPose& one : finder_->searchEverywhere(kOfDistractors)) {
    if (logOdds(one) > kLeastOfDistractors) poses.push_back(one.T_camera_centre);
  }
  distractors_.found(poses);
}

double Reacquisition::logOdds(const FoundPose& found) const {
  return findLogOdds(found.assessment, usualScore()) - outOfHand(found.T_camera_centre);
}

double Reacquisition::outOfHand(const Pose& T_camera_centre) const {
  // It may have slipped, or have been dropped without the robot's noticing.
  constexpr double kStddevM = 0.02, kStddevRad = 0.4, kMostNat = 6.0;
  if (!in_hand_) return 0.0;
  const Vector6d apart = difference(foldOntoReference(T_camera_centre, *in_hand_, symmetries_), *in_hand_);
  const double squared =
      apart.head<3>().squaredNorm() / (kStddevM * kStddevM) + apart.tail<3>().squaredNorm() / (kStddevRad * kStddevRad);
  return std::min(kMostNat, 0.5 * squared);
}

double Reacquisition::learn(const DepthImageView& depth, const PinholeCamera& camera, const Pose& T_camera_centre) {
  constexpr double kUp = 0.3, kDown = 0.1;  // parts may be hidden, or seen from a side where the mesh is worse
  constexpr double kOfLogOdds = 0.2;
  finder_->setImage(depth, camera, std::max(0.2, T_camera_centre.translation().z()));
  const PoseAssessment assessment = finder_->judge(T_camera_centre).assessment;
  if (!(assessment.expected > 0.0)) return -std::numeric_limits<double>::infinity();
  const double score = std::clamp(assessment.achieved / assessment.expected, 0.5, 1.0);
  if (!usual_score_) usual_score_ = score;
  *usual_score_ += (score > *usual_score_ ? kUp : kDown) * (score - *usual_score_);
  const double log_odds = findLogOdds(assessment, *usual_score_);
  usual_log_odds_ = usual_log_odds_.value_or(log_odds) + kOfLogOdds * (log_odds - usual_log_odds_.value_or(log_odds));
  return log_odds;
}

double Reacquisition::judge(const DepthImageView& depth, const PinholeCamera& camera, const Pose& T_camera_centre) {
  finder_->setImage(depth, camera, std::max(0.2, T_camera_centre.translation().z()));
  return logOdds(finder_->judge(T_camera_centre));
}

std::optional<Pose> Reacquisition::findGiven(const DepthImageView& depth, const PinholeCamera& camera,
                                             const Pose& T_camera_centre, const Pose& given, const Vector6d& variances,
                                             int samplings) {
  constexpr double kSurerNat = 1.0, kLeastNat = -2.5, kLeastInHandNat = -7.0;
  constexpr double kBetterInHandNat = 3.0;  // where little is seen, that little may be the hand
  constexpr std::array<double, 3> kShares = {0.1, 0.3, 1.0};
  finder_->setImage(depth, camera, std::max(0.2, given.translation().z()));
  const auto log_posterior = [&](const FoundPose& one) {
    return logOdds(one) - 0.5 * difference(one.T_camera_centre, given).cwiseAbs2().cwiseQuotient(variances).sum();
  };
  const auto sampled_value = [&](const FoundPose& one) {
    return log_posterior(one) + slopeOfPoorFits(one.assessment, usualScore());
  };
  const FoundPose now = finder_->judge(T_camera_centre);
  const double enough = std::max(in_hand_ ? kLeastInHandNat : kLeastNat, logOdds(now) + kSurerNat);
  std::optional<Pose> best;
  double most = log_posterior(now) + (in_hand_ ? kBetterInHandNat : kSurerNat);
  found_ = finder_->searchAround({given}, variances, kAround);
  // Something beside it may draw all others away.
  const FoundPose there = finder_->judge(given);
  found_.push_back(there);
  for (const double share : kShares) found_.push_back(finder_->settle(there, given, share * share * variances));
  for (int i = 0; i < samplings; ++i) found_.push_back(finder_->sampleAround(given, variances, sampled_value));
  for (const FoundPose& one : found_) {
    if (log_posterior(one) <= most || logOdds(one) <= enough) continue;
    most = log_posterior(one);
    best = one.T_camera_centre;
  }
  return best;
}

void Reacquisition::countSameWinner(const Pose& T_camera_centre) {
  const Vector6d moved = difference(T_camera_centre, winner_);
  same_winner_ = moved.head<3>().norm() < kSameM && moved.tail<3>().norm() < kSameRad ? same_winner_ + 1 : 0;
  winner_ = T_camera_centre;
}

/// With nothing known a wrong pose may be met before the right one: the winner must be better than the others and stay
/// so over some images, for which each search offers it new rivals.
std::optional<Pose> Reacquisition::searchAnywhere(const SearchRegion& region) {
  constexpr double kElsewhereM = 0.04;
  constexpr double kNeeded = 0.72, kLessPerImage = 0.08, kLeastNeeded = 0.40, kClearly = 1.6, kMoreIfNotClear = 0.15;
  found_ = region.on_table ? finder_->searchOnTable(kOnTable) : finder_->searchEverywhere(kEverywhereAtTheStart);
  const std::vector<FoundPose> again = finder_->searchAround(survivorPoses(), survivorVariances(), kOfSurvivors);
  found_.insert(found_.end(), again.begin(), again.end());
  std::stable_sort(found_.begin(), found_.end(),
                   [](const FoundPose& a, const FoundPose& b) { return a.evidence > b.evidence; });
  survivors_.clear();
  if (found_.empty()) return std::nullopt;
  const FoundPose& best = found_.front();
  countSameWinner(best.T_camera_centre);
  double rival = 0.0;
  std::vector<FoundPose> same_place;
  for (const FoundPose& one : found_) {
    const bool is_elsewhere = (one.T_camera_centre.translation() - winner_.translation()).norm() > kElsewhereM;
    if (is_elsewhere) rival = std::max(rival, one.evidence);
    if (!is_elsewhere) same_place.push_back(one);
    if (survivors_.size() < kSurvivors) survivors_.push_back({one.T_camera_centre, 0.0});
  }
  const double needed = std::max(kLeastNeeded, kNeeded - kLessPerImage * same_winner_) +
                        (best.evidence > kClearly * rival ? 0.0 : kMoreIfNotClear);
  if (best.quality < needed) return std::nullopt;
  return mostExplaining(same_place).T_camera_centre;
}

std::vector<Pose> Reacquisition::lookAround(const DepthImageView& depth, const PinholeCamera& camera,
                                            const Pose& T_camera_centre, const Vector6d& variances) {
  finder_->setImage(depth, camera, std::max(0.2, T_camera_centre.translation().z()));
  constexpr double kLeastLogOdds = 1.0;  // some part of a mesh that is far too large fits anywhere
  std::vector<Pose> poses;
  for (const FoundPose& one : finder_->searchAround({T_camera_centre}, variances, kAround)) {
    if (logOdds(one) > kLeastLogOdds) poses.push_back(one.T_camera_centre);
  }
  return poses;
}

std::optional<Pose> Reacquisition::findBetter(const DepthImageView& depth, const PinholeCamera& camera,
                                              const Pose& T_camera_centre, const OtherPoses& others) {
  finder_->setImage(depth, camera, std::max(0.2, T_camera_centre.translation().z()), others.occluders);
  found_ = finder_->searchAround({T_camera_centre}, others.variances, kAround);
  if (others.everywhere) {
    const std::vector<FoundPose> more = finder_->searchEverywhere(kEverywhere);
    found_.insert(found_.end(), more.begin(), more.end());
    std::stable_sort(found_.begin(), found_.end(),
                     [](const FoundPose& a, const FoundPose& b) { return a.quality > b.quality; });
  }
  const FoundPose now = finder_->judge(T_camera_centre);
  log_odds_now_ = logOdds(now);
  if (found_.empty()) return std::nullopt;
  if (others.everywhere) return surerThan(now, others);
  return others.by_likelihood ? explainingMoreThan(now) : fittingBetterThan(now, others);
}

std::optional<Pose> Reacquisition::surerThan(const FoundPose& now, const OtherPoses& others) const {
  constexpr double kMuchLikelier = 2.0, kSureByItself = 2.0, kLikelier = 1.0, kFarLikelier = 6.0;
  constexpr double kTurnedRad = 1.0;
  constexpr double kOddNat = -2.5, kLikelyByItself = 0.5, kLikelierThanOdd = 4.0;
  const auto surer = [&](const FoundPose& one) {
    return logOdds(one) - distractors_.against(one.T_camera_centre, now.T_camera_centre, others.memory_s);
  };
  const auto best = std::max_element(found_.begin(), found_.end(),
                                     [&surer](const FoundPose& a, const FoundPose& b) { return surer(a) < surer(b); });
  const Vector6d moved = difference(best->T_camera_centre, now.T_camera_centre);
  const bool is_here = moved.head<3>().norm() < kSameM;
  const bool is_nearly_here = is_here && moved.tail<3>().norm() < kTurnedRad;
  const double more = best->assessment.log_likelihood / std::max(1.0, now.assessment.log_likelihood);
  const double odds = surer(*best) - (is_here ? 0.0 : unreachable(*best, now.T_camera_centre, others));
  const double odds_now = logOdds(now);
  const bool is_odd = others.is_unproven && odds_now < kOddNat;
  const bool explains_more =
      more > (is_here ? 1.0 : kExplainsMore) || odds > odds_now + (is_odd ? kLikelierThanOdd : kFarLikelier);
  const double needed =
      std::max(is_odd ? kLikelyByItself : kSureByItself, odds_now + (is_nearly_here ? kLikelier : kMuchLikelier));
  if (!explains_more || odds <= needed) return std::nullopt;
  return best->T_camera_centre;
}

std::optional<Pose> Reacquisition::explainingMoreThan(const FoundPose& now) const {
  constexpr double kLeastNat = -3.0;
  const FoundPose& most = mostExplaining(found_);
  const double least_nat = in_hand_ ? logOdds(now) + kSurerInHandNat : std::min(kLeastNat, logOdds(now));
  const bool is_better = most.quality > now.quality && logOdds(most) > least_nat &&
                         most.assessment.log_likelihood > kExplainsMore * now.assessment.log_likelihood;
  if (!is_better) return std::nullopt;
  return most.T_camera_centre;
}

/// How much is hidden does not matter here: a mug whose handle is behind it hides less than one with it in the hand.
std::optional<Pose> Reacquisition::fittingBetterThan(const FoundPose& now, const OtherPoses& others) {
  constexpr double kSurer = 0.08, kElsewhereM = 0.01, kElsewhereRad = 0.2, kLeastInHandNat = -5.0;
  const FoundPose& best = found_.front();
  if (fitOfWhatIsSeen(best.assessment) < fitOfWhatIsSeen(now.assessment) + kSurer) return std::nullopt;
  if (best.assessment.log_likelihood < now.assessment.log_likelihood) return std::nullopt;
  if (in_hand_ && logOdds(best) < std::max(kLeastInHandNat, logOdds(now) + kSurerInHandNat)) return std::nullopt;
  const Vector6d moved = difference(best.T_camera_centre, now.T_camera_centre);
  if (moved.head<3>().norm() < kElsewhereM && moved.tail<3>().norm() < kElsewhereRad) return std::nullopt;
  return finder_->settle(best, now.T_camera_centre, others.variances).T_camera_centre;
}

}  // namespace depth_object_tracker
