// SPDX-License-Identifier: BSD-3-Clause
// Program: track_sequence with PCL's point-to-plane ICP, for comparison.
#include "icp_tracker.h"

int main(int argc, char** argv) {
  using namespace depth_object_tracker;
  return runPeer(argc, argv, "track_icp",
                 [](const TriangleMesh& mesh, const TrackSequenceOptions&) { return makeIcpTracker(mesh); });
}
