// SPDX-License-Identifier: BSD-3-Clause
// By what the poses of a search are told apart, from the first look to the last.
#pragma once

#include "depth_object_tracker/filter/depth_likelihood.h"

namespace depth_object_tracker {

/// 1 when all of the object is seen where it should be and stands out all around; at most that.
double fitQuality(const TileFit& fit);

/// How much of the image the object explains, and how well; >= 0. Between poses, more is likelier.
/// A small part of the image fits something by chance sooner than a large one. Through a rigid object nothing is seen
/// but beside its outline: an arm that is taken for a can gives itself away.
double findEvidence(const PoseAssessment& assessment);

/// Log odds [nat] that a pose which a search ended at is the object's and not one where something else fits by chance,
/// if both were as frequent. @param usual_score that the object has where it is surely seen: what fits worse than it
/// usually does is something else, and a mesh that fits badly fits badly everywhere.
double findLogOdds(const PoseAssessment& assessment, double usual_score);

/// Evidence [nat], <= 0, by which fits differ that are too poor for findLogOdds() to tell them apart: a search needs a
/// slope to climb.
double slopeOfPoorFits(const PoseAssessment& assessment, double usual_score);

/// Evidence [nat], gathered over images, that a pose needs to be taken for the object's.
/// @param remoteness 0 where the object is expected, 1 far from it. @param is_hidden most likely it is still behind
/// what hides it.
double neededEvidence(bool is_hidden, double remoteness);

/// What fits by chance does so in the next image, too: only what is better than this adds up. What fits as well as the
/// object does, where it is expected, is hardly anything else, unless it is what hides the object.
/// @param usual_score that the object has where it is surely seen. @param usual_nat its log odds there: a can in a fist
/// never has many.
double worthFollowing(bool is_hidden, double remoteness, const PoseAssessment& assessment, double usual_score,
                      double usual_nat);

/// What a finger that passes for a handle gives away: its surface goes on where the object's ends.
/// @return [nat] for a pose and against the present one, both T_camera_centre.
double outlineEvidence(DepthLikelihood& likelihood, const Pose& pose, const Pose& now);

}  // namespace depth_object_tracker
