// SPDX-License-Identifier: BSD-3-Clause
// Single-precision functions of the hot loops. The SIMD code repeats them operation by operation (no fused
// multiply-add), so that every instruction set gives the same bytes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace depth_object_tracker {

/// Coefficients shared by the scalar and the SIMD versions (Cephes expf and logf; Abramowitz & Stegun 26.2.17).
namespace fast_math {
constexpr float kLeastExponent = -87.0f;
constexpr float kRounder = 12582912.0f;  // 1.5 * 2^23: adding it leaves no room for a fraction
constexpr float kLog2E = 1.44269504f, kLn2High = 0.693359375f, kLn2Low = -2.12194440e-4f;
constexpr float kExp[6] = {1.9875691500e-4f, 1.3981999507e-3f, 8.3334519073e-3f,
                           4.1665795894e-2f, 1.6666665459e-1f, 5.0000001201e-1f};
constexpr float kLog[9] = {7.0376836292e-2f,  -1.1514610310e-1f, 1.1676998740e-1f,  -1.2420140846e-1f, 1.4249322787e-1f,
                           -1.6668057665e-1f, 2.0000714765e-1f,  -2.4999993993e-1f, 3.3333331174e-1f};
constexpr float kSqrtHalf = 0.707106781f;
constexpr float kTail[5] = {1.330274429f, -1.821255978f, 1.781477937f, -0.356563782f, 0.319381530f};
constexpr float kTailScale = 0.2316419f;
constexpr float kInverseSqrt2Pi = 0.398942280f;
}  // namespace fast_math

/// exp(x), relative error below 3e-7, for x <= 88; exp(-87) below -87.
inline float fastExp(float x) {
  using namespace fast_math;
  x = x > kLeastExponent ? x : kLeastExponent;
  const float n = (x * kLog2E + kRounder) - kRounder;  // nearest integer
  const float r = (x - n * kLn2High) - n * kLn2Low;
  float p = kExp[0];
  for (int k = 1; k < 6; ++k) p = p * r + kExp[k];
  const float mantissa = (p * (r * r) + r) + 1.0f;
  const std::int32_t bits = (static_cast<std::int32_t>(n) + 127) * (1 << 23);
  float power;
  std::memcpy(&power, &bits, sizeof power);
  return mantissa * power;
}

/// Natural logarithm of a positive normal number, relative error below 2e-7.
inline float fastLog(float x) {
  using namespace fast_math;
  std::int32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  float exponent = static_cast<float>((bits >> 23) - 126);
  bits = (bits & 0x007fffff) | 0x3f000000;
  float m;
  std::memcpy(&m, &bits, sizeof m);  // [0.5, 1)
  const bool low = m < kSqrtHalf;
  exponent = low ? exponent - 1.0f : exponent;
  m = (low ? m + m : m) - 1.0f;
  const float z = m * m;
  float p = kLog[0];
  for (int k = 1; k < 9; ++k) p = p * m + kLog[k];
  const float y = ((p * m) * z + exponent * kLn2Low) - 0.5f * z;
  return (m + y) + exponent * kLn2High;
}

/// Upper tail 1 - Phi(x) of the normal distribution, x >= 0; absolute error below 3e-7.
/// @param bell exp(-x^2 / 2)
inline float fastNormalTail(float x, float bell) {
  using namespace fast_math;
  const float k = 1.0f / (1.0f + kTailScale * x);
  float p = kTail[0];
  for (int i = 1; i < 5; ++i) p = p * k + kTail[i];
  return (p * k) * (bell * kInverseSqrt2Pi);
}

}  // namespace depth_object_tracker
