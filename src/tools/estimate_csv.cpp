// SPDX-License-Identifier: BSD-3-Clause
// Writes estimates in BOP's result format.
#include "depth_object_tracker/tools/estimate_csv.h"

#include "depth_object_tracker/tools/input_error.h"

#include <cmath>
#include <cstdio>

namespace depth_object_tracker {
namespace {

/// Ten significant digits: a nanometre at metres, and the same bytes for the same double.
std::string format(double value) {
  char text[40];
  std::snprintf(text, sizeof(text), "%.10g", value == 0.0 ? 0.0 : value);  // no "-0"
  return text;
}

}  // namespace

EstimateCsvWriter::EstimateCsvWriter(const std::string& path, int scene_id, int object_id)
    : path_(path), scene_id_(scene_id), object_id_(object_id), file_(path) {
  if (!file_) throw InputError("cannot write " + path + ": check that its folder exists and is writable");
  file_ << "scene_id,im_id,obj_id,score,R,t,time\n";
}

void EstimateCsvWriter::write(int frame, const TrackerResult& result) {
  constexpr double kMillimetresPerMetre = 1e3;
  const bool usable = result.has_pose && result.state != TrackerState::kLost && std::isfinite(result.score);
  file_ << scene_id_ << ',' << frame << ',' << object_id_ << ',' << format(usable ? result.score : 0.0) << ',';
  const Eigen::Matrix3d R = result.T_camera_object.linear();
  for (int i = 0; i < 9; ++i) file_ << (i ? " " : "") << format(R(i / 3, i % 3));
  file_ << ',';
  for (int i = 0; i < 3; ++i)
    file_ << (i ? " " : "") << format(kMillimetresPerMetre * result.T_camera_object.translation()(i));
  file_ << ',' << format(result.time.total_s) << '\n';
}

void EstimateCsvWriter::close() {
  file_.close();
  if (!file_) throw InputError("could not write all of " + path_ + ": is the disk full?");
}

}  // namespace depth_object_tracker
