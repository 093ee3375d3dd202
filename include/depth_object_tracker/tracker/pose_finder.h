// SPDX-License-Identifier: BSD-3-Clause
// Looks for the object in one image: many hypotheses on few pixels, the best of them climbed on ever more.
#pragma once

#include "depth_object_tracker/filter/depth_likelihood.h"
#include "depth_object_tracker/filter/likelihood_climb.h"
#include "depth_object_tracker/filter/random.h"
#include "depth_object_tracker/render/known_occluders.h"
#include "depth_object_tracker/tracker/image_draws.h"
#include "depth_object_tracker/tracker/plane_finder.h"
#include "depth_object_tracker/tracker/pose_sampler.h"
#include "depth_object_tracker/tracker/sparse_fit.h"
#include "depth_object_tracker/tracker/table_draws.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace depth_object_tracker {

/// A pose that explains the image in its neighbourhood best.
struct FoundPose {
  Pose T_camera_centre = Pose::Identity();
  PoseAssessment assessment;
  double quality = 0.0;   ///< see findQuality()
  double evidence = 0.0;  ///< how much of the image it explains, and how well: between poses, more is likelier
};

/// How sure one can be that the object, rather than something else, is seen at a pose: 1 when all of it is visible,
/// fits as the sensor model expects and stands out from what is beside it. Image alone, nothing of the past.
double findQuality(const PoseAssessment& assessment);

/// How many poses go into each stage of the search.
struct SearchEffort {
  int references = 0;  ///< points of the image that its other points vote about
  int drawn = 0;       ///< compared with the image at a few points
  int rendered = 0;    ///< of which rendered on few pixels
  int climbed = 0;     ///< of which climbed
  int refined = 0;     ///< of which climbed on more pixels
  /// The ones that are refined lie this far apart, however they are turned; 0 = they differ, but one place may hold
  /// several.
  double apart_m = 0.0;
};

class PoseFinder {
 public:
  PoseFinder(const ObjectShape& shape, const TriangleMesh& mesh, double diameter_m, const PixelModelConfig& config,
             std::uint64_t seed, std::shared_ptr<WorkerPool> pool);

  /// A new image; the view must stay valid until the last search in it. @param distance_m at which the object is
  /// expected, for the resolutions. @param occluders null = none are known; used only during the call.
  void setImage(const DepthImageView& depth, const PinholeCamera& camera, double distance_m,
                KnownOccluders* occluders = nullptr);

  /// Looks everywhere in the image. The pose with most evidence first.
  std::vector<FoundPose> searchEverywhere(const SearchEffort& effort);

  /// Looks for the object resting on a plane that the image shows. The pose with most evidence first.
  std::vector<FoundPose> searchOnTable(const SearchEffort& effort);

  /// The plane of the last searchOnTable(); nullopt when the image shows none.
  std::optional<ImagePlane> table() const { return table_draws_.table(); }

  /// Looks around poses. The best fit first. @param variances [m^2, rad^2] of the displacement, see perturb().
  std::vector<FoundPose> searchAround(const std::vector<Pose>& T_camera_centre, const Vector6d& variances,
                                      const SearchEffort& effort);

  /// The same pose, moved to where the prior has it along directions that the image leaves free.
  FoundPose settle(const FoundPose& found, const Pose& T_camera_centre_prior, const Vector6d& variances);

  /// How surely the object is at a given pose.
  FoundPose judge(const Pose& T_camera_centre);

  /// The pose about a given one at which a value of what is seen there is highest: see PoseSampler. Takes longer than
  /// searchAround(), and finds what that misses: a pose that something beside it outdoes by the likelihood.
  /// @param value called from several threads; outlines of what is hidden are not part of the assessment.
  FoundPose sampleAround(const Pose& T_camera_centre, const Vector6d& variances,
                         const std::function<double(const FoundPose&)>& value);

 private:
  struct Ranked {
    Pose pose;
    double quality;
  };
  DepthImageView withoutTaken(KnownOccluders& occluders);
  void findBackground();
  std::vector<OrientedPoint> pointsBesideBackground() const;
  template <typename Draw>
  std::vector<Pose> drawBest(const SearchEffort& effort, const Draw& draw);
  template <typename Judge>
  std::vector<Ranked> rank(const std::vector<Pose>& poses, const Judge& judge) const;
  std::vector<Pose> distinctBest(const std::vector<Ranked>& ranked, int count, double apart_m) const;
  static std::vector<Pose> bestOfPlaces(const std::vector<Ranked>& ranked, int count, double apart_m);
  /// Appends where the poses climb to. They themselves stay: with a broad view, a hand beside the object pulls it away.
  void climbAll(DepthLikelihood& likelihood, const ClimbSchedule& schedule, std::vector<Pose>& poses) const;
  std::vector<FoundPose> climbBest(const std::vector<Pose>& poses, const SearchEffort& effort, bool by_evidence);

  double diameter_m_, feature_m_;
  double radius_m_;
  double max_depth_m_;
  CounterRandom random_;
  std::shared_ptr<WorkerPool> pool_;
  ImageDraws image_draws_;
  SparseFit sparse_;
  TableDraws table_draws_;
  PoseSampler sampler_;
  DepthLikelihood coarse_, fine_;
  DepthImageView depth_;
  std::vector<float> free_depth_m_;  // where something else is seen there is no reading
  PixelModelConfig pixel_config_;
  PinholeCamera camera_;
  int step_px_ = 1;
  bool has_background_ = false;
  std::vector<ImagePlane> planes_;      // of the image, once has_background_
  std::vector<ImagePlane> background_;  // those of them that no face of the object can be
  std::uint64_t drawn_ = 0;
  std::vector<Ranked> draws_;  // scratch
};

}  // namespace depth_object_tracker
