// SPDX-License-Identifier: BSD-3-Clause
// Beliefs about occlusion stay at their place in the image while the region, the grid and time move.
#include "depth_object_tracker/filter/occlusion_memory.h"

#include <gtest/gtest.h>

#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr CellBox kImage{0, 96, 0, 128};

float belief(const OcclusionMemory& memory, int particle, int row, int col) {
  return memory.probability(memory.particle(particle)[memory.cell(row, col)]);
}

void believe(OcclusionMemory& memory, int particle, int row, int col, float probability) {
  memory.particle(particle)[memory.cell(row, col)] = memory.stored(probability);
}

/// A different probability for every cell and particle.
float pattern(int particle, int row, int col) {
  return 0.05f + 0.9f * static_cast<float>((31 * row + 17 * col + 7 * particle) % 101) / 101.0f;
}

void fillWithPattern(OcclusionMemory& memory, int num_particles) {
  const CellBox& box = memory.region();
  for (int i = 0; i < num_particles; ++i) {
    for (int row = box.row_begin; row < box.row_end; ++row) {
      for (int col = box.col_begin; col < box.col_end; ++col) believe(memory, i, row, col, pattern(i, row, col));
    }
  }
}

OcclusionChainConfig unusualStart() {
  OcclusionChainConfig config;
  config.initial_p_occluded = 0.6;
  return config;
}

TEST(OcclusionMemory, UnmeasuredPixelsFollowTheChainFromTheInitialBelief) {
  OcclusionMemory memory(unusualStart(), 2);
  EXPECT_NEAR(memory.probability(memory.unmeasured()), 0.6, 1e-6);
  memory.advance(0.5);
  EXPECT_NEAR(memory.probability(memory.unmeasured()), 0.25 + 0.35 * std::pow(0.6, 0.5), 1e-6);
  memory.cover({10, 20, 10, 20}, kImage);
  EXPECT_NEAR(belief(memory, 1, 15, 15), 0.25 + 0.35 * std::pow(0.6, 0.5), 1e-6) << "new cells know how late it is";
}

TEST(OcclusionMemory, StoredIsTheInverseOfProbability) {
  OcclusionMemory memory(unusualStart(), 1);
  memory.advance(0.7);
  for (const float p : {0.0f, 0.1f, 0.25f, 0.6f, 1.0f}) EXPECT_NEAR(memory.probability(memory.stored(p)), p, 1e-6f);
}

TEST(OcclusionMemory, CoverTakesInTheBoxAndStaysInTheImage) {
  OcclusionMemory memory(OcclusionChainConfig(), 1);
  EXPECT_TRUE(memory.region().empty());
  memory.cover({-20, 5, 120, 400}, kImage);
  EXPECT_TRUE(memory.region().contains({0, 5, 120, 128}));
  EXPECT_TRUE(kImage.contains(memory.region()));
  const CellBox before = memory.region();
  memory.cover({500, 510, 0, 10}, kImage);
  EXPECT_TRUE(memory.region().contains(before) && before.contains(memory.region()))
      << "a box off the image changes nothing";
  EXPECT_TRUE(memory.inRegion(0, 127));
  EXPECT_FALSE(memory.inRegion(-1, 127));
  EXPECT_FALSE(memory.inRegion(0, 128));
}

TEST(OcclusionMemory, BeliefsStayInPlaceWhenTheRegionMoves) {
  constexpr int kParticles = 3;
  OcclusionMemory memory(unusualStart(), kParticles);
  memory.cover({30, 50, 40, 70}, kImage);
  fillWithPattern(memory, kParticles);
  const CellBox before = memory.region();
  memory.cover({40, 70, 60, 100}, kImage);
  const CellBox after = memory.region();
  EXPECT_FALSE(before.contains(after));
  int kept = 0;
  for (int i = 0; i < kParticles; ++i) {
    for (int row = after.row_begin; row < after.row_end; ++row) {
      for (int col = after.col_begin; col < after.col_end; ++col) {
        const bool known =
            row >= before.row_begin && row < before.row_end && col >= before.col_begin && col < before.col_end;
        kept += known ? 1 : 0;
        ASSERT_NEAR(belief(memory, i, row, col), known ? pattern(i, row, col) : 0.6f, 1e-6f) << row << ", " << col;
      }
    }
  }
  EXPECT_GT(kept, 100);
}

TEST(OcclusionMemory, PixelsThatLeaveTheRegionAreForgotten) {
  OcclusionMemory memory(unusualStart(), 1);
  memory.cover({10, 15, 10, 15}, kImage);
  believe(memory, 0, 12, 12, 0.99f);
  memory.cover({80, 90, 100, 120}, kImage);
  ASSERT_FALSE(memory.inRegion(12, 12));
  memory.cover({10, 15, 10, 15}, kImage);
  EXPECT_NEAR(belief(memory, 0, 12, 12), 0.6f, 1e-6f);
}

TEST(OcclusionMemory, BeliefsDecayTowardsTheStationaryValueInAnySteps) {
  OcclusionMemory once(unusualStart(), 1), often(unusualStart(), 1);
  for (OcclusionMemory* memory : {&once, &often}) {
    memory->cover({0, 4, 0, 4}, kImage);
    believe(*memory, 0, 1, 1, 0.95f);
    believe(*memory, 0, 2, 2, 0.0f);
  }
  once.advance(2.0);
  for (int k = 0; k < 60; ++k) often.advance(1.0 / 30.0);
  for (const int i : {1, 2}) {
    const double start = i == 1 ? 0.95 : 0.0;
    const double expected = 0.25 + (start - 0.25) * 0.36;
    EXPECT_NEAR(belief(once, 0, i, i), expected, 1e-6);
    EXPECT_NEAR(belief(often, 0, i, i), expected, 1e-5);
  }
}

TEST(OcclusionMemory, AThousandSecondsNeitherUnderflowNorBlowUp) {
  for (const double step : {1.0 / 30.0, 0.7, 13.0, 1000.0}) {
    OcclusionMemory memory(unusualStart(), 1);
    memory.cover({0, 4, 0, 4}, kImage);
    double expected_here = 0.95;  // written anew from time to time: precision must not be lost on the way
    believe(memory, 0, 1, 1, 0.95f);
    double since_written = 0.0;
    for (double t = 0.0; t < 1000.0; t += step) {
      memory.advance(step);
      since_written += step;
      expected_here = 0.25 + (0.95 - 0.25) * std::pow(0.6, since_written);
      ASSERT_NEAR(belief(memory, 0, 1, 1), expected_here, 2e-5) << "after " << t << " s in steps of " << step;
      const float elsewhere = belief(memory, 0, 3, 3);
      ASSERT_TRUE(elsewhere >= 0.25f - 1e-6f && elsewhere <= 0.6f) << elsewhere;
      if (since_written > 40.0) {
        believe(memory, 0, 1, 1, 0.95f);
        since_written = 0.0;
        ASSERT_NEAR(belief(memory, 0, 1, 1), 0.95f, 1e-5f);
      }
    }
    EXPECT_NEAR(memory.probability(memory.unmeasured()), 0.25, 1e-6);
    EXPECT_NEAR(belief(memory, 0, 3, 3), 0.25, 1e-6);
  }
}

TEST(OcclusionMemory, NoOrNegativeTimeChangesNothing) {
  OcclusionMemory memory(unusualStart(), 1);
  memory.cover({0, 4, 0, 4}, kImage);
  believe(memory, 0, 1, 1, 0.9f);
  memory.advance(0.0);
  memory.advance(-5.0);
  EXPECT_NEAR(belief(memory, 0, 1, 1), 0.9f, 1e-6f);
}

TEST(OcclusionMemory, ResetForgetsEverything) {
  OcclusionMemory memory(unusualStart(), 1);
  memory.cover({0, 4, 0, 4}, kImage);
  believe(memory, 0, 1, 1, 0.9f);
  memory.advance(3.0);
  memory.reset();
  EXPECT_TRUE(memory.region().empty());
  memory.cover({0, 4, 0, 4}, kImage);
  EXPECT_NEAR(belief(memory, 0, 1, 1), 0.6f, 1e-6f);
}

TEST(OcclusionMemory, CopiesBelongToTheirNewParticle) {
  OcclusionMemory memory(unusualStart(), 3);
  memory.cover({0, 8, 0, 8}, kImage);
  fillWithPattern(memory, 3);
  memory.copy(2, 0);
  believe(memory, 2, 3, 3, 0.5f);
  for (int row = 0; row < 8; ++row) {
    for (int col = 0; col < 8; ++col) {
      EXPECT_NEAR(belief(memory, 0, row, col), pattern(2, row, col), 1e-6f) << "a copy, not a reference";
      EXPECT_NEAR(belief(memory, 1, row, col), pattern(1, row, col), 1e-6f);
    }
  }
}

TEST(OcclusionMemory, MeanIsWeighted) {
  OcclusionMemory memory(unusualStart(), 3);
  memory.cover({0, 8, 0, 8}, kImage);
  fillWithPattern(memory, 3);
  memory.advance(0.4);
  std::vector<float> mean;
  memory.mean({0.2, 0.0, 0.8}, mean);
  for (int row = 0; row < 8; ++row) {
    for (int col = 0; col < 8; ++col) {
      const float expected = 0.2f * belief(memory, 0, row, col) + 0.8f * belief(memory, 2, row, col);
      EXPECT_NEAR(memory.probability(mean[memory.cell(row, col)]), expected, 1e-6f);
    }
  }
}

class BetweenFactors : public testing::TestWithParam<std::pair<int, int>> {};
INSTANTIATE_TEST_SUITE_P(OcclusionMemory, BetweenFactors,
                         testing::Values(std::make_pair(5, 4), std::make_pair(4, 5), std::make_pair(3, 6),
                                         std::make_pair(6, 3), std::make_pair(1, 4), std::make_pair(4, 1),
                                         std::make_pair(2, 3)));

TEST_P(BetweenFactors, BeliefsStayAtTheSamePlaceInTheImage) {
  PinholeCamera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 525.0;
  const SamplingGrid from = makeSamplingGrid(camera, GetParam().first),
                     to = makeSamplingGrid(camera, GetParam().second);
  OcclusionMemory memory(unusualStart(), 2);
  // An object at full-resolution rows 100..300, columns 200..420; occluded left of column 310.
  const CellBox from_image{0, from.camera.height, 0, from.camera.width};
  memory.cover({100 / from.factor, 300 / from.factor, 200 / from.factor, 420 / from.factor}, from_image);
  const CellBox before = memory.region();
  for (int row = before.row_begin; row < before.row_end; ++row) {
    for (int col = before.col_begin; col < before.col_end; ++col) {
      believe(memory, 0, row, col, from.fullCol(col) < 310 ? 0.9f : 0.1f);
      believe(memory, 1, row, col, from.fullRow(row) < 200 ? 0.8f : 0.2f);
    }
  }
  memory.resampleGrid(from, to);
  EXPECT_TRUE((CellBox{0, to.camera.height, 0, to.camera.width}).contains(memory.region()));
  const int margin = from.factor + to.factor;
  int checked = 0;
  for (int row = 0; row < to.camera.height; ++row) {
    for (int col = 0; col < to.camera.width; ++col) {
      const int full_row = to.fullRow(row), full_col = to.fullCol(col);
      if (full_row < 100 + margin || full_row > 299 - margin || full_col < 200 + margin || full_col > 419 - margin)
        continue;
      ASSERT_TRUE(memory.inRegion(row, col)) << full_row << ", " << full_col;
      if (std::abs(full_col - 310) > margin) {
        EXPECT_NEAR(belief(memory, 0, row, col), full_col < 310 ? 0.9f : 0.1f, 1e-6f);
      }
      if (std::abs(full_row - 200) > margin) {
        EXPECT_NEAR(belief(memory, 1, row, col), full_row < 200 ? 0.8f : 0.2f, 1e-6f);
      }
      ++checked;
    }
  }
  EXPECT_GT(checked, 500);
}

TEST(OcclusionMemory, ResamplingTheGridOfAnEmptyMemoryIsHarmless) {
  PinholeCamera camera;
  camera.width = 64;
  camera.height = 48;
  camera.fx = camera.fy = 50.0;
  OcclusionMemory memory(unusualStart(), 2);
  memory.resampleGrid(makeSamplingGrid(camera, 2), makeSamplingGrid(camera, 3));
  EXPECT_TRUE(memory.region().empty());
}

}  // namespace
}  // namespace depth_object_tracker
