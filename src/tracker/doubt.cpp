// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/doubt.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr double kPoorScore = 0.85, kMediocreScore = 0.92;
constexpr double kPlainSight = 0.6;
constexpr double kBadScore = 0.8, kBriefS = 0.05;
// After the object was gone from where it was, what fits next may be something else beside it.
constexpr double kShakingScore = 0.6, kSomethingVisible = 0.04, kShakenForS = 0.6, kLooksWhileShakenS = 0.2;
constexpr double kPoorScoreOfLittle = 0.8, kPoorForS = 0.2;  // little that is seen often fits a little worse
constexpr double kLookAroundForS = 2.0;                      // often; in vain: from time to time
constexpr double kFirstCheckS = 0.2, kLastCheckS = 3.0;      // after a find, each twice as late as the one before
constexpr double kFall = 0.1, kLevelOverS = 0.5, kNewForS = 0.3, kOldEveryS = 0.1;
constexpr double kOddNat = -2.5, kProvenNat = 2.0;
constexpr double kLongestIntervalIfOddS = 1.0;
constexpr double kShortestIntervalS = 0.3, kLongestIntervalS = 8.0;

}  // namespace

void Doubt::update(double score, double visible_fraction, bool is_seen, double dt_s) {
  since_nearby_s_ = mayHaveJumped() ? dt_s : since_nearby_s_ + dt_s;
  since_poor_s_ = score < kPoorScore ? 0.0 : since_poor_s_ + dt_s;
  const bool falls = score < level_ - kFall;
  since_fall_s_ = falls ? 0.0 : since_fall_s_ + dt_s;
  level_ = falls ? score : level_ + (1.0 - std::exp(-dt_s / kLevelOverS)) * (score - level_);
  since_around_s_ += dt_s;
  poor_s_ = is_seen && score >= kPoorScore ? 0.0 : poor_s_ + dt_s;
  const bool little_fits = !is_seen && score < kPoorScoreOfLittle && poor_s_ > kPoorForS;
  is_poor_ = (is_seen && score < kPoorScore) || little_fits;
  // What is half hidden may fit badly and be right, and the image is full of arms.
  const bool in_plain_sight = visible_fraction > kPlainSight && score < kMediocreScore;
  const bool is_bad = poor_s_ > kBriefS && score < kBadScore;
  is_mediocre_ = (is_seen && (in_plain_sight || is_bad)) || little_fits;
  const bool is_contradicted = score < kShakingScore && visible_fraction > kSomethingVisible;
  shaken_s_ = is_contradicted ? 0.0 : shaken_s_ + dt_s;
  is_seen_ = is_seen;
  since_look_s_ += dt_s;
  since_found_s_ += dt_s;
  if (!is_mediocre_ && !isOdd()) interval_s_ = std::max(kShortestIntervalS, interval_s_ * std::exp2(-dt_s));
}

Doubt::Look Doubt::look() const {
  const bool is_due = since_look_s_ > interval_s_;
  if (is_seen_ && since_found_s_ > next_check_s_) return Look::kEverywhere;
  if ((is_mediocre_ || (is_seen_ && isOdd())) && is_due) return Look::kEverywhere;
  if (is_seen_ && shaken_s_ < kShakenForS && since_look_s_ > kLooksWhileShakenS) return Look::kEverywhere;
  const bool is_new = since_fall_s_ < kNewForS || (poor_s_ < kLookAroundForS && since_around_s_ > kOldEveryS);
  const bool is_old_and_due = is_due && poor_s_ >= kLookAroundForS;
  return is_poor_ && (is_old_and_due || is_new) ? Look::kAround : Look::kNowhere;
}

void Doubt::found() {
  since_found_s_ = 0.0;
  next_check_s_ = kFirstCheckS;
  is_unproven_ = true;
  is_odd_ = false;
}

void Doubt::judged(double log_odds) {
  is_odd_ = log_odds < kOddNat;
  if (log_odds > kProvenNat) is_unproven_ = false;
}

bool Doubt::mayHaveJumped() const {
  return since_poor_s_ > kNewForS || since_fall_s_ < kNewForS || since_nearby_s_ > kOldEveryS;
}

void Doubt::looked(Look look) {
  if (look != Look::kNowhere) since_around_s_ = 0.0;
  if (look == Look::kEverywhere && since_found_s_ > next_check_s_) {
    next_check_s_ = next_check_s_ < kLastCheckS ? 2.0 * next_check_s_ : std::numeric_limits<double>::infinity();
  }
  if (look == Look::kNowhere || (look == Look::kAround && poor_s_ < kLookAroundForS)) return;
  since_look_s_ = 0.0;
  interval_s_ = std::min(isOdd() ? kLongestIntervalIfOddS : kLongestIntervalS, 2.0 * interval_s_);
}

}  // namespace depth_object_tracker
