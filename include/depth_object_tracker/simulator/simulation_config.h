// SPDX-License-Identifier: BSD-3-Clause
// What is simulated: scenario, speed, occluders, world, sensor.
#pragma once

#include "depth_object_tracker/geometry/pinhole_camera.h"

#include <cstdint>
#include <string>

namespace depth_object_tracker {

enum class Scenario {
  kHuman,   ///< a person's hand moves the object
  kRobot,   ///< a gripper holds it securely; control twist and wrong forward kinematics are simulated
  kSlip,    ///< a gripper holds it, a person pushes it in the gripper
  kStatic,  ///< it stands on the table
};

enum class Speed { kSlow, kMedium, kFast };

enum class Occluders {
  kNone,
  kPassing,  ///< boards and arms hide up to 70 % of the object now and then
  kFull,     ///< now and then the object is hidden completely for about a second
};

/// Structured-light camera. Depth noise grows as measured by Nguyen, Izadi and Lovell (3DIMPVT 2012) for the Kinect.
struct DepthSensorConfig {
  double baseline_m = 0.075;           ///< projector stands this far to the right of the camera
  double disparity_step_px = 0.125;    ///< 1/8 pixel sub-pixel matching
  double noise_at_nearest_m = 0.0013;  ///< standard deviation at `noise_nearest_m`, before quantisation
  double noise_growth_per_m = 0.0019;  ///< added: this * (z - noise_nearest_m)^2
  double noise_nearest_m = 0.4;
  double correlated_share = 0.4;        ///< share of the noise variance that neighbours have in common
  double correlation_px = 3.0;          ///< standard deviation of the correlation kernel
  double edge_jitter_px = 0.5;          ///< standard deviation of where an edge is seen
  double edge_step_m = 0.03;            ///< depth steps above are edges
  double mixed_probability = 0.2;       ///< an edge pixel lies between the two surfaces
  double edge_drop_probability = 0.12;  ///< an edge pixel has no reading
  double grazing_begin_deg = 74.0;      ///< from here on, seen ever flatter, surfaces lose readings
  double grazing_end_deg = 82.0;        ///< from here on there is no reading
  double shadow_tolerance_px = 1.5;     ///< disparity by which a surface must stand before another to shadow it
  int blobs = 8;                        ///< patches without reading per image
  double blob_radius_px = 4.0;
  double min_range_m = 0.45;
  double max_range_m = 6.0;
};

/// A rectified pair of grey cameras whose axes are parallel to the depth camera's.
struct StereoPairConfig {
  PinholeCamera camera{1024, 768, 840.0, 840.0, 511.5, 383.5};  ///< both
  double baseline_m = 0.12;
  double left_x_m = -0.06;  ///< left camera in the depth camera's frame
  double left_y_m = -0.05;  ///< ... above it
  double left_z_m = 0.0;
  double noise_stddev = 2.0;  ///< grey levels of 255
};

struct SimulationConfig {
  Scenario scenario = Scenario::kHuman;
  Speed speed = Speed::kMedium;
  Occluders occluders = Occluders::kNone;
  std::uint64_t seed = 1;
  double duration_s = 5.0;          ///< peak speeds are reached within; motion goes on, never repeating, after it
  double first_rest_s = 0.3;        ///< before the object starts to move
  double distance_m = 0.74;         ///< camera to the middle of the object's motion
  double amplitude_m = 0.14;        ///< largest displacement from there, reduced where the object would leave the view
  double amplitude_rad = 0.87;      ///< largest rotation about each axis
  double min_depth_m = 0.47;        ///< no part of the object comes nearer
  double max_depth_m = 1.3;         ///< no part of the object goes farther
  double camera_height_m = 0.62;    ///< over the table
  double camera_pitch_rad = 0.436;  ///< down
  PinholeCamera camera{640, 480, 525.0, 525.0, 319.5, 239.5};
  DepthSensorConfig sensor;
  StereoPairConfig stereo;
  std::string fiducials_file;  ///< AprilTags on the object (a file); empty = none, and no grey pictures
  double hand_coverage =
      -1.0;                ///< share of the object that the hand or gripper hides, [0, 1); negative = random, little
  std::string robot_urdf;  ///< robot scenarios: arm that holds the object (a file); empty = a gripper without a robot
};

/// @throws std::invalid_argument naming the value and the allowed ones.
Scenario scenarioFromName(const std::string& name);
Speed speedFromName(const std::string& name);
Occluders occludersFromName(const std::string& name);
const char* scenarioName(Scenario scenario);

/// Peak speed of the object's centre [m/s] and of its rotation [rad/s] for a scenario; 0 when static.
double peakSpeed(Scenario scenario, Speed speed);
double peakAngularSpeed(Scenario scenario, Speed speed);

}  // namespace depth_object_tracker
