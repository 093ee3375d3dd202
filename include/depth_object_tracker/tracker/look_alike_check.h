// SPDX-License-Identifier: BSD-3-Clause
// An estimate against the turns after which its object looks almost the same: what is seen may not tell them apart for
// a while, and a tracker that took the wrong one must notice when it does.
#pragma once

#include "depth_object_tracker/filter/depth_likelihood.h"
#include "depth_object_tracker/tracker/illusions.h"
#include "depth_object_tracker/tracker/look_alikes.h"

#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace depth_object_tracker {

/// What is known of an estimate's rotation beside the image.
struct TurnPrior {
  /// From a pose that was right: the farther a turn, the surer it must be (a finger makes a fine handle where the mug's
  /// own is hidden).
  bool was_followed = true;
  /// How far from the estimate the rotation may be [rad]; infinite = any is as likely.
  double stddev_rad = std::numeric_limits<double>::infinity();
};

/// Compares an estimate with its look-alikes, a few in every image.
class LookAlikeCheck {
 public:
  explicit LookAlikeCheck(LookAlikes look_alikes) : look_alikes_(std::move(look_alikes)) {}

  /// @param exponent gamma of the filter. @param dt_s since the last image. @return a pose of the centre that explains
  /// the last images surely better.
  std::optional<Pose> findBetter(DepthLikelihood& likelihood, const Pose& T_camera_centre, double exponent,
                                 const TurnPrior& prior, double dt_s);

  /// Forgets what earlier images said.
  void restart() {
    pending_.reset();
    illusions_.clear();
  }

  /// The estimate was turned by a motion in the centre's axes.
  void moved(const Pose& T_before_now) { illusions_.moved(T_before_now); }

  const LookAlikes& lookAlikes() const { return look_alikes_; }

 private:
  struct Pending {
    Pose T_centre_centre;
    double evidence;  ///< for it and against the estimate, tempered [nat]
  };

  struct Candidate {
    double broad;  ///< log likelihood with wide noise
    Pose pose;
  };

  /// The next few look-alikes, the most promising first.
  void rankCandidates(DepthLikelihood& likelihood, const Pose& T_camera_centre);
  std::optional<Pose> findNearby(DepthLikelihood& likelihood, const Pose& T_camera_centre, double exponent);
  std::optional<Pose> followPending(DepthLikelihood& likelihood, const Pose& T_camera_centre, const TurnPrior& prior,
                                    const std::function<double(const Pose&)>& evidence, double dt_s);

  /// @param nat evidence of the last image.
  void learnIllusion(const Pose& T_centre_centre, double nat, const TurnPrior& prior, double dt_s);

  LookAlikes look_alikes_;
  Illusions illusions_;
  std::vector<Candidate> candidates_;  // of this image
  std::vector<Pose> poses_;            // scratch
  std::optional<Pending> pending_;
  std::size_t next_ = 0;
};

}  // namespace depth_object_tracker
