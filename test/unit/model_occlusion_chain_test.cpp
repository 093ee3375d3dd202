// SPDX-License-Identifier: BSD-3-Clause
// The occlusion chain over any time step.
#include "depth_object_tracker/model/occlusion_chain.h"

#include <gtest/gtest.h>

#include <cmath>

namespace depth_object_tracker {
namespace {

double inSteps(const OcclusionChain& chain, double p_occluded, double dt_s, int steps) {
  for (int k = 0; k < steps; ++k) p_occluded = chain.predict(p_occluded, dt_s);
  return p_occluded;
}

TEST(OcclusionChain, OneSecondIsTheTransitionMatrix) {
  for (const auto& [visible_visible, visible_occluded] :
       {std::make_pair(0.9, 0.3), std::make_pair(0.8, 0.1), std::make_pair(0.99, 0.5)}) {
    OcclusionChainConfig config;
    config.p_visible_given_visible = visible_visible;
    config.p_visible_given_occluded = visible_occluded;
    const OcclusionChain chain(config);
    for (const double p : {0.0, 0.2, 0.7, 1.0}) {
      const double expected = (1.0 - visible_visible) * (1.0 - p) + (1.0 - visible_occluded) * p;
      EXPECT_NEAR(chain.predict(p, 1.0), expected, 1e-14);
    }
  }
}

TEST(OcclusionChain, AnyDivisionOfASecondAgrees) {
  const OcclusionChain chain{OcclusionChainConfig()};
  for (const double p : {0.0, 0.1, 0.25, 0.5, 1.0}) {
    const double once = chain.predict(p, 1.0);
    EXPECT_NEAR(inSteps(chain, p, 0.5, 2), once, 1e-12);
    EXPECT_NEAR(inSteps(chain, p, 1.0 / 30.0, 30), once, 1e-12);
    EXPECT_NEAR(chain.predict(chain.predict(p, 0.123), 0.877), once, 1e-12);
  }
}

TEST(OcclusionChain, TendsToAQuarterOccluded) {
  const OcclusionChain chain{OcclusionChainConfig()};
  EXPECT_NEAR(chain.stationary(), 0.25, 1e-15);
  EXPECT_NEAR(chain.predict(0.25, 17.0), 0.25, 1e-15);
  for (const double p : {0.0, 1.0}) EXPECT_NEAR(chain.predict(p, 1e4), 0.25, 1e-15);
}

TEST(OcclusionChain, DeviationDecaysBySixTenthsASecond) {
  const OcclusionChain chain{OcclusionChainConfig()};
  EXPECT_NEAR(chain.decay(1.0), 0.6, 1e-15);
  EXPECT_NEAR(chain.decay(0.5), std::sqrt(0.6), 1e-15);
  EXPECT_EQ(chain.decay(0.0), 1.0);
  EXPECT_EQ(chain.predict(0.9, 0.0), 0.9);
}

TEST(OcclusionChain, OfTwoEqualNumbersForgetsAtOnce) {
  OcclusionChainConfig config;
  config.p_visible_given_visible = config.p_visible_given_occluded = 0.75;
  const OcclusionChain chain(config);
  for (const double p : {0.0, 0.25, 1.0}) {
    for (const double dt_s : {1e-3, 1.0 / 30.0, 1.0}) EXPECT_NEAR(chain.predict(p, dt_s), 0.25, 1e-15);
  }
}

}  // namespace
}  // namespace depth_object_tracker
