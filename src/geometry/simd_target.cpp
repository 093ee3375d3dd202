// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/geometry/simd_target.h"

#include <cstdlib>

#ifdef DEPTH_OBJECT_TRACKER_HAVE_HIGHWAY
#include "simd/disabled_targets.h"

#include <hwy/targets.h>
#endif

namespace depth_object_tracker {
namespace {

constexpr const char* kScalar = "scalar";
constexpr const char* kAuto = "auto";

#ifdef DEPTH_OBJECT_TRACKER_HAVE_HIGHWAY

// Highway's own scalar code is slower than ours.
constexpr std::int64_t kCompiledTargets = HWY_TARGETS & ~(HWY_SCALAR | HWY_EMU128);

/// Bit of a target by name; 0 when this machine or build lacks it.
std::int64_t findTarget(const std::string& name) {
  for (std::int64_t rest = hwy::SupportedTargets() & kCompiledTargets; rest != 0; rest &= rest - 1) {
    const std::int64_t target = rest & -rest;
    if (name == hwy::TargetName(target)) return target;
  }
  return 0;
}

#endif

struct Selection {
  Selection() {
    const char* name = std::getenv("DEPTH_OBJECT_TRACKER_SIMD");
    if (name == nullptr || !select(name)) select(kAuto);
  }

  bool select(const std::string& name) {
#ifdef DEPTH_OBJECT_TRACKER_HAVE_HIGHWAY
    if (name == kScalar) {
      scalar = true;
      return true;
    }
    hwy::SetSupportedTargetsForTest(0);  // all of them again
    const std::int64_t target = findTarget(name);
    if (name != kAuto && target == 0) {
      if (!scalar && current != 0) hwy::SetSupportedTargetsForTest(current);
      return false;
    }
    scalar = (hwy::SupportedTargets() & kCompiledTargets) == 0;
    current = name == kAuto ? 0 : target;
    if (current != 0) hwy::SetSupportedTargetsForTest(current);
    return true;
#else
    scalar = true;
    return name == kScalar || name == kAuto;
#endif
  }

  bool scalar = false;
  std::int64_t current = 0;  // 0 = the best
};

Selection& selection() {
  static Selection instance;
  return instance;
}

}  // namespace

bool simdIsScalar() {
  return selection().scalar;
}

bool selectSimdTarget(const std::string& name) {
  return selection().select(name);
}

std::string simdTarget() {
#ifdef DEPTH_OBJECT_TRACKER_HAVE_HIGHWAY
  if (!simdIsScalar()) {
    const std::int64_t usable = hwy::SupportedTargets() & kCompiledTargets;
    return hwy::TargetName(usable & -usable);  // lower bits are better targets
  }
#endif
  return kScalar;
}

std::vector<std::string> availableSimdTargets() {
  std::vector<std::string> names = {kScalar};
#ifdef DEPTH_OBJECT_TRACKER_HAVE_HIGHWAY
  const std::int64_t current = selection().current;
  hwy::SetSupportedTargetsForTest(0);
  for (int bit = 62; bit >= 0; --bit) {
    const std::int64_t target = std::int64_t{1} << bit;
    if ((hwy::SupportedTargets() & kCompiledTargets & target) != 0) names.emplace_back(hwy::TargetName(target));
  }
  if (current != 0) hwy::SetSupportedTargetsForTest(current);
#endif
  return names;
}

}  // namespace depth_object_tracker
