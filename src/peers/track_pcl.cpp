// SPDX-License-Identifier: BSD-3-Clause
// Program: track_sequence with PCL's particle filter tracker, for comparison. PCL seeds its random numbers itself:
// --seed has no effect, and no two runs are alike.
#include "particle_filter_tracker.h"

int main(int argc, char** argv) {
  using namespace depth_object_tracker;
  return runPeer(argc, argv, "track_pcl", [](const TriangleMesh& mesh, const TrackSequenceOptions& options) {
    return makePclTracker(mesh, static_cast<unsigned>(options.num_threads.value_or(1)));
  });
}
