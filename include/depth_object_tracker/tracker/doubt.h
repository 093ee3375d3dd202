// SPDX-License-Identifier: BSD-3-Clause
// When an estimate is to be compared with other poses of the image, which costs more than a frame: at once where it has
// gone wrong, ever more rarely where it merely fits less than it could.
#pragma once

#include <limits>

namespace depth_object_tracker {

class Doubt {
 public:
  enum class Look { kNowhere, kAround, kEverywhere };

  /// No doubt about a pose that was given.
  void restart() { *this = Doubt(); }

  /// One image. @param score 1 = as well as the object usually does. @param visible_fraction of the object. @param dt_s
  /// since the last image.
  void update(double score, double visible_fraction, bool is_seen, double dt_s);

  /// What the next image asks for.
  Look look() const;
  /// Whether the next image is worth comparing with poses nearby if it fits badly: from time to time only where the
  /// last ones fitted as badly, which may be the mesh.
  bool mayHaveJumped() const;
  /// What was found may have been something else, and the object itself may come into view later.
  void found();
  /// @param log_odds [nat] that what is followed is the object, by the image alone.
  void judged(double log_odds);
  /// Found, and never surely seen since.
  bool isUnproven() const { return is_unproven_; }
  /// Tells that the image was looked at, in vain.
  void looked(Look look);
  /// What is seen fits worse than the sensor model expects: perhaps a neighbouring mode.
  bool isPoor() const { return is_poor_; }
  /// Since the fit was good [s].
  double poorSince() const { return poor_s_; }

 private:
  bool isOdd() const { return is_unproven_ && is_odd_; }

  bool is_poor_ = false, is_mediocre_ = false;  // fits less than it could although it is in plain sight
  bool is_seen_ = false;
  bool is_unproven_ = false, is_odd_ = false;
  double poor_s_ = 0.0;
  double shaken_s_ = 1e6;        // since the image contradicted the pose
  double level_ = 1.0;           // of the score, lately
  double since_poor_s_ = 1e6;    // the fit was poor, seen or not
  double since_fall_s_ = 1e6;    // the score fell
  double since_nearby_s_ = 1e6;  // mayHaveJumped() was true
  double since_around_s_ = 1e6;  // any look
  double since_look_s_ = 1e6;
  double since_found_s_ = 1e6;
  double next_check_s_ = std::numeric_limits<double>::infinity();  // after a find
  double interval_s_ = 0.3;
};

}  // namespace depth_object_tracker
