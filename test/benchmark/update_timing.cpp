// SPDX-License-Identifier: BSD-3-Clause
#include "update_timing.h"

#include "allocation_counter.h"
#include "filter_frames.h"
#include "stopwatch_statistics.h"

#include "depth_object_tracker/geometry/simd_target.h"

#include <algorithm>

namespace depth_object_tracker {
namespace {

constexpr std::size_t kMinRepetitions = 5;

DepthLikelihood makeLikelihood(const UpdateCase& given, const TriangleMesh& mesh, const BenchmarkScene& scene) {
  PixelModelConfig config;
  config.edge_stddev_px = given.edge_stddev_px;
  return DepthLikelihood(mesh, scene.centreObject(), config, OcclusionChainConfig(), given.particles, given.threads);
}

struct FrameTimes {
  std::vector<double> seconds, processor_seconds;  ///< of update(), per repetition
  std::int64_t heap_allocations = 0;
};

FrameTimes timeFrames(FilterFrames& frames, DepthLikelihood& likelihood, double min_seconds) {
  FrameTimes times;
  std::vector<double> log_likelihoods;
  for (int i = 0; i < FilterFrames::kWarmUp; ++i) likelihood.update(frames.next(likelihood), log_likelihoods);
  double total = 0.0;
  while (total < min_seconds || times.seconds.size() < kMinRepetitions) {
    const std::int64_t allocated = heapAllocations();
    const std::vector<Pose>& poses = frames.next(likelihood);
    const double processor_begin = processorSeconds();
    const auto begin = BenchmarkClock::now();
    likelihood.update(poses, log_likelihoods);
    const double elapsed = secondsBetween(begin, BenchmarkClock::now());
    const std::int64_t allocated_now = heapAllocations();
    times.processor_seconds.push_back(processorSeconds() - processor_begin);
    times.seconds.push_back(elapsed);
    times.heap_allocations += allocated_now - allocated;
    total += elapsed;
  }
  return times;
}

}  // namespace

UpdateTiming timeUpdate(const UpdateCase& given, const TriangleMesh& mesh, double min_seconds) {
  const int covered_pixels = given.covered_pixels * 25 / (given.factor * given.factor);
  const BenchmarkScene scene(mesh, given.factor, covered_pixels);
  FilterFrames frames(scene, given.particles);
  DepthLikelihood likelihood = makeLikelihood(given, mesh, scene);

  UpdateTiming timing;
  timing.given = given;
  timing.triangles = static_cast<int>(mesh.triangles.size());
  timing.width = scene.grid().camera.width;
  timing.height = scene.grid().camera.height;
  timing.covered_pixels = scene.coveredPixels();
  timing.simd = simdTarget();
  const FrameTimes times = timeFrames(frames, likelihood, min_seconds);
  timing.heap_allocations = times.heap_allocations;
  timing.repetitions = static_cast<int>(times.seconds.size());
  timing.poses_per_s = given.particles / medianOf(times.seconds);
  timing.fastest_poses_per_s = given.particles / *std::min_element(times.seconds.begin(), times.seconds.end());
  timing.processor_us_per_pose = 1e6 * medianOf(times.processor_seconds) / given.particles;
  return timing;
}

}  // namespace depth_object_tracker
