// SPDX-License-Identifier: BSD-3-Clause
// Looks for an object that is hidden or lost, image after image, until it is surely seen again.
#pragma once

#include "depth_object_tracker/geometry/symmetry.h"
#include "depth_object_tracker/tracker/distractors.h"
#include "depth_object_tracker/tracker/pose_finder.h"
#include "depth_object_tracker/tracker/search_region.h"

#include <memory>
#include <optional>
#include <vector>

namespace depth_object_tracker {

/// Which poses an estimate is compared with, and how.
struct OtherPoses {
  Vector6d variances = Vector6d::Ones();  ///< [m^2, rad^2] around the estimate
  bool everywhere = false;                ///< also in the rest of the image
  bool by_likelihood = false;             ///< what explains more of the image is better, not what fits better
  /// Of where the object may be [m^2], about an estimate that was surely followed; none = anywhere.
  std::optional<Eigen::Vector3d> reach;
  bool is_unproven = false;             ///< the estimate was found, and never surely seen since
  double memory_s = 0.0;                ///< since remember()
  KnownOccluders* occluders = nullptr;  ///< the object is not where one of them is seen; null = none
};

class Reacquisition {
 public:
  /// @param symmetries about the centre.
  Reacquisition(std::unique_ptr<PoseFinder> finder, Distractors distractors, Symmetries symmetries)
      : finder_(std::move(finder)), distractors_(std::move(distractors)), symmetries_(std::move(symmetries)) {}

  /// Forgets what was seen in earlier images.
  void restart() {
    survivors_.clear();
    same_winner_ = 0;
  }

  /// One image. @return the pose of the object's centre once it is sure: the farther from the expected place, the
  /// surer it must be.
  std::optional<Pose> search(const DepthImageView& depth, const PinholeCamera& camera, const SearchRegion& region);

  /// @return a pose where the object is more surely seen than at an estimate that may be wrong.
  std::optional<Pose> findBetter(const DepthImageView& depth, const PinholeCamera& camera, const Pose& T_camera_centre,
                                 const OtherPoses& others);

  /// Of the estimate in the last findBetter().
  double logOddsNow() const { return log_odds_now_; }

  /// Poses around a given one at which the object may be; for an image in which it is thought to be near.
  std::vector<Pose> lookAround(const DepthImageView& depth, const PinholeCamera& camera, const Pose& T_camera_centre,
                               const Vector6d& variances);

  /// An image in which the object is surely seen at a pose: how well does it fit? Cheap. @return how much likelier it
  /// is the object than something else [nat].
  double learn(const DepthImageView& depth, const PinholeCamera& camera, const Pose& T_camera_centre);

  /// A pose was given, and the filter found that it fits badly elsewhere. @param samplings times that it is looked for
  /// where something beside it fits as well, each in vain twice of three times. @return where it fits better, and is
  /// expected.
  std::optional<Pose> findGiven(const DepthImageView& depth, const PinholeCamera& camera, const Pose& T_camera_centre,
                                const Pose& given, const Vector6d& variances, int samplings);

  /// How much likelier it is the object than something else [nat] that is seen at a pose.
  double judge(const DepthImageView& depth, const PinholeCamera& camera, const Pose& T_camera_centre);

  /// An image in which the object is surely seen at a pose, and everything else is not the object. Cheap.
  void remember(const DepthImageView& depth, const PinholeCamera& camera, const Pose& T_camera_centre) {
    distractors_.remember(depth, camera, T_camera_centre);
  }
  /// What was followed until now may not have been the object.
  void forgetScene() { distractors_.forget(); }
  /// Where a robot's hand should have the object in this image; nullopt = it is not held.
  void expectInHand(const std::optional<Pose>& T_camera_centre) { in_hand_ = T_camera_centre; }
  /// Images of this size are to be expected.
  void expectImages(const PinholeCamera& camera) { distractors_.expectImages(camera); }
  /// The camera's own motion since the last image.
  void moveCamera(const Pose& T_now_before) { distractors_.moveCamera(T_now_before); }

  /// Score that the object has where it is surely seen, on a search's pixels.
  double usualScore() const { return usual_score_.value_or(kScoreOfAFairMesh); }

  /// The plane on which the object was looked for last; nullopt without one.
  std::optional<ImagePlane> table() const { return finder_->table(); }

  /// What the last search found, surest first.
  const std::vector<FoundPose>& found() const { return found_; }

 private:
  /// A good pose of the image before.
  struct Survivor {
    Pose T_camera_centre;
    double evidence;  ///< that it is the object's [nat], over all images
  };
  std::vector<Pose> survivorPoses() const;
  /// Evidence of earlier images for the place of a pose; the object may look alike from several sides. >= 0
  double evidenceBefore(const Pose& T_camera_centre) const;
  void countSameWinner(const Pose& T_camera_centre);
  std::optional<Pose> searchAnywhere(const SearchRegion& region);

  double logOdds(const FoundPose& found) const;
  /// Evidence [nat] against a pose away from the hand that holds the object.
  double outOfHand(const Pose& T_camera_centre) const;
  void findDistractors();

  /// What was found that is better than the estimate; something was. Anywhere in the image:
  std::optional<Pose> surerThan(const FoundPose& now, const OtherPoses& others) const;
  /// Around the estimate.
  std::optional<Pose> explainingMoreThan(const FoundPose& now) const;
  std::optional<Pose> fittingBetterThan(const FoundPose& now, const OtherPoses& others);

  static constexpr double kScoreOfAFairMesh = 0.92;
  std::unique_ptr<PoseFinder> finder_;
  Distractors distractors_;
  std::optional<double> usual_score_, usual_log_odds_;
  double log_odds_now_ = 0.0;
  Symmetries symmetries_;
  std::optional<Pose> in_hand_;
  std::vector<Survivor> survivors_;
  std::vector<FoundPose> found_;
  Pose winner_ = Pose::Identity();  // of the last search with nothing known
  unsigned images_ = 0;
  int same_winner_ = 0;  // searches in a row that found the winner again
};

}  // namespace depth_object_tracker
