// SPDX-License-Identifier: BSD-3-Clause
// All parameters of the tracker, their names and their valid ranges.
#pragma once

#include "depth_object_tracker/filter/filter_config.h"
#include "depth_object_tracker/model/pixel_model_config.h"
#include "depth_object_tracker/model/process_config.h"
#include "depth_object_tracker/model/slip_config.h"

#include <string>

namespace depth_object_tracker {

struct ResolutionConfig {
  int downsampling = 0;            ///< fixed sub-sampling factor; 0 = chosen from the object's projected size
  int target_model_pixels = 1500;  ///< automatic: covered pixels aimed at
};

struct InitialisationConfig {
  double position_stddev_m = 0.01;    ///< prior of an initial pose that comes without covariance
  double rotation_stddev_rad = 0.15;  ///< prior of an initial pose that comes without covariance
};

struct StatusConfig {
  double occluded_below_visible_fraction = 0.12;  ///< OCCLUDED when less of the object is believed visible
  double lost_below_score = 0.25;                 ///< LOST when the fit stays below this for lost_after_s
  double lost_after_s = 0.3;
};

struct BudgetConfig {
  double frame_budget_s = 0.03;  ///< the nodelet uses fewer particles and pixels when frames take longer; 0 = never
};

/// Defaults live here and nowhere else; config/tracker.yaml repeats them and a test compares.
struct TrackerConfig {
  PixelModelConfig pixel;
  OcclusionChainConfig occlusion;
  ProcessConfig process;
  SlipConfig slip;
  FilterConfig filter;
  ResolutionConfig resolution;
  InitialisationConfig initialisation;
  StatusConfig status;
  BudgetConfig budget;
};

}  // namespace depth_object_tracker
