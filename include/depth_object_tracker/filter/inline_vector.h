// SPDX-License-Identifier: BSD-3-Clause
// A short list without the heap, for what a frame makes anew.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>

namespace depth_object_tracker {

/// At most `Capacity` elements, which must be default-constructible.
template <typename T, std::size_t Capacity>
class InlineVector {
 public:
  using value_type = T;

  /// @param element the list must not be full.
  void push_back(const T& element) {
    assert(size_ < Capacity);
    elements_[size_++] = element;
  }
  /// @param size at most Capacity. New elements hold any value.
  void resize(std::size_t size) {
    assert(size <= Capacity);
    size_ = size;
  }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  static constexpr std::size_t capacity() { return Capacity; }

  T& operator[](std::size_t index) { return elements_[index]; }
  const T& operator[](std::size_t index) const { return elements_[index]; }
  T* begin() { return elements_.data(); }
  T* end() { return elements_.data() + size_; }
  const T* begin() const { return elements_.data(); }
  const T* end() const { return elements_.data() + size_; }

 private:
  std::array<T, Capacity> elements_{};
  std::size_t size_ = 0;
};

}  // namespace depth_object_tracker
