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

}  // namespace depth_object_tracker
