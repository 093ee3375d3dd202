// SPDX-License-Identifier: BSD-3-Clause
// Writes one JSON object per frame with all that the tracker says.
#include "depth_object_tracker/tools/trace_writer.h"

#include "depth_object_tracker/geometry/simd_target.h"
#include "depth_object_tracker/tools/input_error.h"

#include <nlohmann/json.hpp>

namespace depth_object_tracker {
namespace {

using Json = nlohmann::ordered_json;  // dumps what is not finite as null

template <typename Matrix>
Json rowMajor(const Matrix& matrix) {
  Json numbers = Json::array();
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index col = 0; col < matrix.cols(); ++col) numbers.push_back(matrix(row, col));
  }
  return numbers;
}

Json times(const StageTimes& time) {
  return {{"total", time.total_s},
          {"proposal", time.proposal_s},
          {"render_likelihood", time.render_likelihood_s},
          {"resample", time.resample_s}};
}

Json slipJson(const SlipEstimate& slip) {
  return {
      {"relative_twist", rowMajor(slip.relative_twist)}, {"statistic", slip.statistic}, {"slipping", slip.slipping}};
}

}  // namespace

TraceWriter::TraceWriter(const std::string& path) : path_(path), file_(path) {
  if (!file_) throw InputError("cannot write " + path + ": check that its folder exists and is writable");
}

void TraceWriter::write(int frame, const TrackerResult& result) {
  Json line;
  line["frame"] = frame;
  line["stamp"] = result.stamp_s;
  line["status"] = stateName(result.state);
  line["reason"] = result.reason;
  line["T_camera_object"] = rowMajor(result.T_camera_object.matrix());
  line["covariance"] = rowMajor(result.covariance);
  line["twist"] = rowMajor(result.twist);
  line["grasped"] = result.grasped;
  if (result.slip) line["slip"] = slipJson(*result.slip);
  line["effective_sample_size"] = result.effective_sample_size;
  line["num_particles"] = result.num_particles;
  line["visible_fraction"] = result.visible_fraction;
  line["score"] = result.score;
  line["log_likelihood"] = result.log_likelihood;
  line["valid_pixel_fraction"] = result.valid_pixel_fraction;
  line["downsampling"] = result.downsampling;
  line["pixels"] = result.pixels;
  line["pose_evaluations"] = result.pose_evaluations;
  line["simd_target"] = simdTarget();
  line["time_s"] = times(result.time);
  file_ << line.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
}

void TraceWriter::close() {
  file_.close();
  if (!file_) throw InputError("could not write all of " + path_ + ": is the disk full?");
}

}  // namespace depth_object_tracker
