// SPDX-License-Identifier: BSD-3-Clause
// Before any Highway header: fewer instruction sets than it could, for build time.
#pragma once

#if defined(DEPTH_OBJECT_TRACKER_FEW_TARGETS) && defined(__SANITIZE_THREAD__)
// ThreadSanitizer has a slow path for loads and stores of more than 16 bytes.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX2 | HWY_AVX3 | HWY_AVX3_DL)
#elif defined(DEPTH_OBJECT_TRACKER_FEW_TARGETS)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3 | HWY_AVX3_DL)
#else
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#endif
