// SPDX-License-Identifier: BSD-3-Clause
// Before any Highway header: fewer instruction sets than it could, for build time.
#pragma once

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
