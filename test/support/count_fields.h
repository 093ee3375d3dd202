// SPDX-License-Identifier: BSD-3-Clause
// Number of members of a plain struct, to notice one that a table forgot.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

namespace depth_object_tracker {
namespace count_fields_detail {

struct AnyValue {
  template <typename T>
  operator T() const;  // declared only: used in unevaluated expressions
};

template <typename Struct, typename Indices, typename = void>
struct IsBraceConstructible : std::false_type {};

template <std::size_t>
using AnyValueAt = AnyValue;

template <typename Struct, std::size_t... kIndices>
struct IsBraceConstructible<Struct, std::index_sequence<kIndices...>,
                            std::void_t<decltype(Struct{AnyValueAt<kIndices>()...})>> : std::true_type {};

}  // namespace count_fields_detail

/// Members of an aggregate whose members are scalars.
template <typename Struct, std::size_t kCount = 1>
constexpr std::size_t countFields() {
  if constexpr (count_fields_detail::IsBraceConstructible<Struct, std::make_index_sequence<kCount>>::value) {
    return countFields<Struct, kCount + 1>();
  } else {
    return kCount - 1;
  }
}

}  // namespace depth_object_tracker
