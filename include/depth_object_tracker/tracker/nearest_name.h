// SPDX-License-Identifier: BSD-3-Clause
// What somebody who mistyped a name may have meant.
#pragma once

#include <string>
#include <vector>

namespace depth_object_tracker {

/// The name that takes the fewest letters to insert, delete or replace; the first of several. `names` is not empty.
/// Looks at the first 100 letters of `name`.
const std::string& nearestName(const std::string& name, const std::vector<std::string>& names);

}  // namespace depth_object_tracker
