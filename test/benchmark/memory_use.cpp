// SPDX-License-Identifier: BSD-3-Clause
#include "memory_use.h"

#include "filter_frames.h"
#include "update_timing.h"

#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>
#include <string>

namespace depth_object_tracker {
namespace {

constexpr double kMib = 1024.0 * 1024.0;

double peakMib() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kib = 0.0;
    if (word == "VmHWM:" && status >> kib) return kib / 1024.0;
  }
  return 0.0;
}

MemoryUse runFrames(const TriangleMesh& mesh, int num_particles) {
  MemoryUse use;
  use.particles = num_particles;
  const PixelModelConfig config;
  const UpdateCase defaults;
  const BenchmarkScene scene(mesh, defaults.factor, defaults.covered_pixels);
  FilterFrames frames(scene, num_particles);
  use.without_mib = peakMib();
  DepthLikelihood likelihood(mesh, scene.centreObject(), config, OcclusionChainConfig(), num_particles, 1);
  std::vector<double> log_likelihoods;
  for (int i = 0; i < FilterFrames::kWarmUp; ++i) likelihood.update(frames.next(likelihood), log_likelihoods);
  use.peak_mib = peakMib();
  use.beliefs_mib = static_cast<double>(likelihood.memory().memoryBytes()) / kMib;
  use.tiles_in_use = static_cast<int>(likelihood.memory().tilesInUse());
  return use;
}

}  // namespace

MemoryUse measureMemory(const TriangleMesh& mesh, int num_particles) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("cannot make a pipe");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("cannot start a process");
  if (child == 0) {
    ssize_t written = -1;
    try {
      const MemoryUse use = runFrames(mesh, num_particles);
      written = write(ends[1], &use, sizeof(use));
    } catch (const std::exception&) {
    }
    _exit(written > 0 ? 0 : 1);
  }
  close(ends[1]);
  MemoryUse use;
  const ssize_t received = read(ends[0], &use, sizeof(use));
  close(ends[0]);
  waitpid(child, nullptr, 0);
  if (received != static_cast<ssize_t>(sizeof(use)))
    throw std::runtime_error("the process that measures memory failed");
  return use;
}

}  // namespace depth_object_tracker
