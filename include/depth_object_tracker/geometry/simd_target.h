// SPDX-License-Identifier: BSD-3-Clause
// Which instruction set the hot loops use. Chosen at run time; every choice gives the same bytes.
#pragma once

#include <string>
#include <vector>

namespace depth_object_tracker {

/// Name of the instruction set in use: "scalar" (plain C++, the reference), or Highway's name ("SSE2", "SSE4", "AVX2",
/// "AVX3" = AVX-512, "NEON", ...).
std::string simdTarget();

/// True when the hot loops run the plain C++ reference.
bool simdIsScalar();

/// All names that this machine and this build can run, slowest first.
std::vector<std::string> availableSimdTargets();

/// Restricts the hot loops to one instruction set, for tests and comparisons. Not thread-safe: before trackers run.
/// "auto" = the best one. Without a call the environment variable DEPTH_OBJECT_TRACKER_SIMD decides, if set.
/// @return false, and nothing changes, when the name is not available.
bool selectSimdTarget(const std::string& name);

}  // namespace depth_object_tracker
