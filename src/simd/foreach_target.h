// SPDX-License-Identifier: BSD-3-Clause
// Highway compiles the including file once for every instruction set. No include guard: see hwy/foreach_target.h.
#include "simd/disabled_targets.h"

#include <hwy/foreach_target.h>
