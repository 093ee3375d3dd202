// SPDX-License-Identifier: BSD-3-Clause
// How much longer a test waits where a sanitizer makes everything slow.
#pragma once

namespace depth_object_tracker {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double kSlowness = 5.0;
#else
constexpr double kSlowness = 1.0;
#endif

}  // namespace depth_object_tracker
