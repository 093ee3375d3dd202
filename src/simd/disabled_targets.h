// SPDX-License-Identifier: BSD-3-Clause
// Before any Highway header: fewer instruction sets than it could, for build time.
#pragma once

#ifdef DEPTH_OBJECT_TRACKER_FEW_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3 | HWY_AVX3_DL)
#else
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#endif
