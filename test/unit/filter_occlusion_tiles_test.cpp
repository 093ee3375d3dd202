// SPDX-License-Identifier: BSD-3-Clause
// Shared tiles behave like one dense table per particle, on any number of threads, and none is lost.
#include "depth_object_tracker/filter/occlusion_tiles.h"
#include "depth_object_tracker/filter/resampling.h"
#include "depth_object_tracker/filter/worker_pool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

namespace depth_object_tracker {
namespace {

OcclusionChainConfig unusualStart() {
  OcclusionChainConfig config;
  config.initial_p_occluded = 0.6;
  return config;
}

PinholeCamera cameraOf(int width, int height) {
  PinholeCamera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = 525.0;
  return camera;
}

int tileOf(const OcclusionTiles& tiles, int row, int col) {
  return row / kTileSize * tiles.tileCols() + col / kTileSize;
}

int cellOf(int row, int col) {
  return row % kTileSize * kTileSize + col % kTileSize;
}

float belief(const OcclusionTiles& tiles, int particle, int row, int col) {
  const float* values = tiles.tile(particle, tileOf(tiles, row, col));
  return tiles.probability(values != nullptr ? values[cellOf(row, col)] : tiles.unmeasured());
}

void believe(OcclusionTiles& tiles, int particle, int row, int col, float probability) {
  tiles.writableTile(particle, tileOf(tiles, row, col), 0)[cellOf(row, col)] = tiles.stored(probability);
}

/// Different tiles that particles refer to.
std::size_t distinctTiles(const OcclusionTiles& tiles) {
  std::vector<const float*> found;
  for (int tile_index = 0; tile_index < tiles.tileRows() * tiles.tileCols(); ++tile_index) {
    for (int particle = 0; particle < tiles.numParticles(); ++particle) {
      if (const float* values = tiles.tile(particle, tile_index)) found.push_back(values);
    }
  }
  std::sort(found.begin(), found.end());
  return static_cast<std::size_t>(std::unique(found.begin(), found.end()) - found.begin());
}

bool isAligned(const float* values) {
  return reinterpret_cast<std::uintptr_t>(values) % 32 == 0;
}

TEST(TilePool, TheLastOfTwoWhoBothSawAnotherFreesATile) {
  TilePool pool(2);
  const std::uint32_t handle = pool.take(0);
  EXPECT_FALSE(pool.isShared(handle));
  pool.changeReferences(handle, 1);
  EXPECT_TRUE(pool.isShared(handle));
  pool.release(handle, 0);
  EXPECT_FALSE(pool.isShared(handle));
  EXPECT_EQ(pool.tilesInUse(), 1u);
  pool.release(handle, 1);
  EXPECT_EQ(pool.tilesInUse(), 0u);
}

TEST(TilePool, TilesComeBackFromTheThreadThatFreesThem) {
  TilePool pool(2);
  std::size_t warm = 0;
  for (int round = 0; round < 30; ++round) {
    std::set<std::uint32_t> handles;
    for (int k = 0; k < 1000; ++k) handles.insert(pool.take(0));
    ASSERT_EQ(handles.size(), 1000u) << "no tile twice";
    ASSERT_EQ(handles.count(0), 0u);
    EXPECT_EQ(pool.tilesInUse(), 1000u);
    for (const std::uint32_t handle : handles) pool.release(handle, 1);
    EXPECT_EQ(pool.tilesInUse(), 0u);
    if (round == 0) warm = pool.memoryBytes();
  }
  EXPECT_EQ(pool.memoryBytes(), warm);
}

TEST(OcclusionTiles, WithoutMemoryEveryImageStartsFromTheSameProbability) {
  OcclusionChainConfig config;
  config.p_visible_given_visible = config.p_visible_given_occluded = 0.75;
  OcclusionTiles tiles(config, 2, 1);
  tiles.setGrid(16, 16);
  for (int image = 0; image < 3; ++image) {
    tiles.advance(1.0 / 30.0);
    EXPECT_NEAR(tiles.probability(tiles.unmeasured()), 0.25, 1e-6);
    float* values = tiles.writableTile(1, 2, 0);
    for (int cell = 0; cell < kTileCells; ++cell) {
      EXPECT_NEAR(tiles.probability(values[cell]), 0.25, 1e-6);
      values[cell] = tiles.stored(0.9f);
      EXPECT_NEAR(tiles.probability(values[cell]), 0.9, 1e-6);
    }
  }
}

/// Every particle's probabilities in full, in double precision.
class DenseBeliefs {
 public:
  DenseBeliefs(const OcclusionChainConfig& config, int num_particles)
      : chain_(config),
        initial_(config.initial_p_occluded),
        unmeasured_(initial_),
        particles_(static_cast<std::size_t>(num_particles)) {}

  void setGrid(int rows, int cols) {
    rows_ = rows;
    cols_ = cols;
    reset();
  }
  void reset() {
    unmeasured_ = initial_;
    for (Particle& particle : particles_) particle = unmeasuredParticle();
  }
  void advance(double dt_s) {
    unmeasured_ = chain_.predict(unmeasured_, dt_s);
    for (Particle& particle : particles_) {
      for (double& p : particle.occluded) p = chain_.predict(p, dt_s);
    }
  }
  void write(int particle, int row, int col, double probability) {
    particles_[static_cast<std::size_t>(particle)].occluded[cell(row, col)] = probability;
  }
  void touch(int particle, int row, int col) {
    particles_[static_cast<std::size_t>(particle)].known[tile(row, col)] = 1;
  }
  void resample(const std::vector<int>& source) {
    std::vector<Particle> next;
    for (const int parent : source) next.push_back(particles_[static_cast<std::size_t>(parent)]);
    particles_ = next;
  }
  void keepAround(const CellBox& box) {
    if (box.empty()) return;
    for (int row = 0; row < rows_; ++row) {
      for (int col = 0; col < cols_; ++col) {
        if (distanceToTile(box.row_begin, box.row_end, row) <= box.rows() / 2 + 8 &&
            distanceToTile(box.col_begin, box.col_end, col) <= box.cols() / 2 + 8) {
          continue;
        }
        for (Particle& particle : particles_) {
          particle.occluded[cell(row, col)] = unmeasured_;
          particle.known[tile(row, col)] = 0;
        }
      }
    }
  }
  void resampleGrid(const SamplingGrid& from, const SamplingGrid& to) {
    DenseBeliefs next(*this);
    next.rows_ = to.camera.height;
    next.cols_ = to.camera.width;
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      next.particles_[i] = next.unmeasuredParticle();
      for (int row = 0; row < next.rows_; ++row) {
        for (int col = 0; col < next.cols_; ++col) {
          const int from_row = nearest(from, to.fullRow(row), rows_), from_col = nearest(from, to.fullCol(col), cols_);
          if (particles_[i].known[tile(from_row, from_col)] == 0) continue;
          next.particles_[i].known[next.tile(row, col)] = 1;
          next.particles_[i].occluded[next.cell(row, col)] = particles_[i].occluded[cell(from_row, from_col)];
        }
      }
    }
    *this = next;
  }

  int numParticles() const { return static_cast<int>(particles_.size()); }
  double unmeasured() const { return unmeasured_; }
  double probability(int particle, int row, int col) const {
    return particles_[static_cast<std::size_t>(particle)].occluded[cell(row, col)];
  }
  bool known(int particle, int row, int col) const {
    return particles_[static_cast<std::size_t>(particle)].known[tile(row, col)] != 0;
  }

 private:
  struct Particle {
    std::vector<double> occluded;
    std::vector<char> known;  // per tile
  };
  Particle unmeasuredParticle() const {
    return {std::vector<double>(static_cast<std::size_t>(rows_ * cols_), unmeasured_),
            std::vector<char>(static_cast<std::size_t>((rows_ + 7) / 8 * ((cols_ + 7) / 8)), 0)};
  }
  std::size_t cell(int row, int col) const { return static_cast<std::size_t>(row * cols_ + col); }
  std::size_t tile(int row, int col) const { return static_cast<std::size_t>(row / 8 * ((cols_ + 7) / 8) + col / 8); }

  /// Cells from [begin, end) to the nearest cell of the tile that holds `cell`; 1 = next to it.
  static int distanceToTile(int begin, int end, int cell) {
    const int first = cell / 8 * 8, last = first + 7;
    if (last < begin) return begin - last;
    return std::max(0, first - (end - 1));
  }
  /// Of `size` rows or columns of cells the one nearest to a pixel of the full image, the later one of two.
  static int nearest(const SamplingGrid& grid, int full_pixel, int size) {
    int best = 0;
    for (int i = 1; i < size; ++i) {
      if (std::abs(grid.fullRow(i) - full_pixel) <= std::abs(grid.fullRow(best) - full_pixel)) best = i;
    }
    return best;
  }

  OcclusionChain chain_;
  double initial_, unmeasured_;
  int rows_ = 0, cols_ = 0;
  std::vector<Particle> particles_;
};

class RandomSteps {
 public:
  explicit RandomSteps(unsigned seed) : generator_(seed) {}
  int below(int end) { return std::uniform_int_distribution<int>(0, end - 1)(generator_); }
  double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(generator_); }
  std::vector<int> source(int size, int num_particles) {
    std::vector<int> result(static_cast<std::size_t>(size));
    for (int& parent : result) parent = below(num_particles);
    return result;
  }
  CellBox box(int rows, int cols) {
    const int row = below(rows), col = below(cols);
    return {row, row + 1 + below(20), col, col + 1 + below(20)};
  }
  std::vector<double> weights(int count) {
    std::vector<double> result(static_cast<std::size_t>(count));
    double sum = 0.0;
    for (double& weight : result) sum += weight = below(4) == 0 ? 0.0 : uniform();
    for (double& weight : result) weight /= sum > 0.0 ? sum : 1.0;
    if (sum == 0.0) result[0] = 1.0;
    return result;
  }

 private:
  std::mt19937 generator_;
};

/// The same steps with the class under test and in full.
class BothWays {
 public:
  BothWays(unsigned seed, int num_particles)
      : steps_(seed), tiles_(unusualStart(), num_particles, 1), dense_(unusualStart(), num_particles) {
    setGrid();
  }

  void step() {
    const int kind = steps_.below(100);
    if (kind < 50) {
      write();
    } else if (kind < 70) {
      advance(0.1 * steps_.uniform());
    } else if (kind < 85) {
      const int count = kind < 78 ? dense_.numParticles() : 1 + steps_.below(12);
      const std::vector<int> source = steps_.source(count, dense_.numParticles());
      tiles_.resample(source);
      dense_.resample(source);
    } else if (kind < 93) {
      const CellBox box = steps_.box(grid_.camera.height, grid_.camera.width);
      tiles_.keepAround(box);
      dense_.keepAround(box);
    } else if (kind < 97) {
      const SamplingGrid last = grid_;
      grid_ = makeSamplingGrid(camera_, 2 + steps_.below(5));
      tiles_.resampleGrid(last, grid_);
      dense_.resampleGrid(last, grid_);
    } else if (kind < 99) {
      advance(40.0 * steps_.uniform());
    } else {
      tiles_.reset();
      dense_.reset();
    }
  }

  void expectSame() const {
    ASSERT_EQ(tiles_.numParticles(), dense_.numParticles());
    ASSERT_NEAR(tiles_.probability(tiles_.unmeasured()), dense_.unmeasured(), 1e-6);
    for (int particle = 0; particle < dense_.numParticles(); ++particle) {
      for (int row = 0; row < grid_.camera.height; ++row) {
        for (int col = 0; col < grid_.camera.width; ++col) {
          ASSERT_EQ(tiles_.tile(particle, tileOf(tiles_, row, col)) != nullptr, dense_.known(particle, row, col))
              << particle << ": " << row << ", " << col;
          ASSERT_NEAR(belief(tiles_, particle, row, col), dense_.probability(particle, row, col), 2e-6)
              << particle << ": " << row << ", " << col;
        }
      }
    }
    ASSERT_EQ(tiles_.tilesInUse(), distinctTiles(tiles_));
  }

  void expectSameMean() {
    const std::vector<double> weights = steps_.weights(dense_.numParticles());
    tiles_.updateMean(weights);
    for (int row = 0; row < grid_.camera.height; ++row) {
      for (int col = 0; col < grid_.camera.width; ++col) {
        double expected = 0.0;
        bool known = false;
        for (int particle = 0; particle < dense_.numParticles(); ++particle) {
          expected += weights[static_cast<std::size_t>(particle)] * dense_.probability(particle, row, col);
          known = known || dense_.known(particle, row, col);
        }
        const float* mean = tiles_.meanTile(tileOf(tiles_, row, col));
        ASSERT_EQ(mean != nullptr, known) << row << ", " << col;
        if (mean == nullptr) continue;
        ASSERT_TRUE(isAligned(mean));
        ASSERT_NEAR(tiles_.probability(mean[cellOf(row, col)]), expected, 3e-6) << row << ", " << col;
      }
    }
  }

 private:
  // Neither a multiple of a tile nor of any factor.
  const PinholeCamera camera_ = cameraOf(131, 101);

  void setGrid() {
    grid_ = makeSamplingGrid(camera_, 3);
    tiles_.setGrid(grid_.camera.height, grid_.camera.width);
    dense_.setGrid(grid_.camera.height, grid_.camera.width);
  }
  void advance(double dt_s) {
    tiles_.advance(dt_s);
    dense_.advance(dt_s);
  }
  /// Some cells of one tile of one particle.
  void write() {
    const int particle = steps_.below(dense_.numParticles());
    const int row = steps_.below(grid_.camera.height), col = steps_.below(grid_.camera.width);
    float* values = tiles_.writableTile(particle, tileOf(tiles_, row, col), 0);
    ASSERT_TRUE(isAligned(values));
    for (int i = 0; i < kTileCells; ++i) ASSERT_TRUE(std::isfinite(values[i]));
    dense_.touch(particle, row, col);
    for (int k = 0; k < 10; ++k) {
      const int cell_row = std::min(row / 8 * 8 + steps_.below(8), grid_.camera.height - 1);
      const int cell_col = std::min(col / 8 * 8 + steps_.below(8), grid_.camera.width - 1);
      const double probability = steps_.uniform();
      values[cellOf(cell_row, cell_col)] = tiles_.stored(static_cast<float>(probability));
      dense_.write(particle, cell_row, cell_col, probability);
    }
  }

  RandomSteps steps_;
  OcclusionTiles tiles_;
  DenseBeliefs dense_;
  SamplingGrid grid_;
};

TEST(OcclusionTiles, HoldTheBeliefsOfADenseTable) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    BothWays both(seed, 6);
    for (int k = 0; k < 1000; ++k) {
      both.step();
      if (k % 5 == 0) both.expectSame();
      if (HasFatalFailure()) FAIL() << "seed " << seed << ", step " << k;
    }
  }
}

TEST(OcclusionTiles, MeanIsThatOfADenseTable) {
  for (unsigned seed = 11; seed <= 13; ++seed) {
    BothWays both(seed, 8);
    for (int k = 0; k < 600; ++k) {
      both.step();
      if (k % 5 == 0) both.expectSameMean();
      if (HasFatalFailure()) FAIL() << "seed " << seed << ", step " << k;
    }
  }
}

TEST(OcclusionTiles, NothingIsKnownAtFirst) {
  OcclusionTiles tiles(unusualStart(), 3, 1);
  tiles.resampleGrid(makeSamplingGrid(cameraOf(64, 48), 2), makeSamplingGrid(cameraOf(64, 48), 4));
  EXPECT_EQ(tiles.tileRows(), 2);
  EXPECT_EQ(tiles.tileCols(), 2);
  tiles.setGrid(17, 24);
  EXPECT_EQ(tiles.tileRows(), 3);
  EXPECT_EQ(tiles.tileCols(), 3);
  tiles.updateMean({0.5, 0.5, 0.0});
  for (int tile_index = 0; tile_index < 9; ++tile_index) {
    for (int particle = 0; particle < 3; ++particle) EXPECT_EQ(tiles.tile(particle, tile_index), nullptr);
    EXPECT_EQ(tiles.meanTile(tile_index), nullptr);
  }
  EXPECT_NEAR(tiles.probability(tiles.unmeasured()), 0.6, 1e-6);
  EXPECT_EQ(tiles.tilesInUse(), 0u);
}

TEST(OcclusionTiles, StoredIsTheInverseOfProbability) {
  OcclusionTiles tiles(unusualStart(), 1, 1);
  tiles.advance(0.7);
  for (const float p : {0.0f, 0.1f, 0.25f, 0.6f, 1.0f}) EXPECT_NEAR(tiles.probability(tiles.stored(p)), p, 1e-6f);
}

TEST(OcclusionTiles, ANewTileKnowsHowLateItIs) {
  OcclusionTiles tiles(unusualStart(), 1, 1);
  tiles.setGrid(16, 16);
  tiles.advance(0.5);
  believe(tiles, 0, 9, 9, 0.1f);
  EXPECT_NEAR(belief(tiles, 0, 9, 9), 0.1f, 1e-6f);
  EXPECT_NEAR(belief(tiles, 0, 9, 10), 0.25 + 0.35 * std::pow(0.6, 0.5), 1e-6);
}

TEST(OcclusionTiles, AreSharedUntilOneParticleWrites) {
  OcclusionTiles tiles(unusualStart(), 3, 1);
  tiles.setGrid(16, 16);
  believe(tiles, 2, 3, 3, 0.9f);
  believe(tiles, 2, 12, 12, 0.8f);
  tiles.resample({2, 2, 2});
  EXPECT_EQ(tiles.tile(0, 0), tiles.tile(2, 0));
  EXPECT_EQ(tiles.tilesInUse(), 2u);
  believe(tiles, 1, 3, 3, 0.2f);
  EXPECT_NEAR(belief(tiles, 0, 3, 3), 0.9f, 1e-6f);
  EXPECT_NEAR(belief(tiles, 1, 3, 3), 0.2f, 1e-6f);
  EXPECT_NEAR(belief(tiles, 2, 3, 3), 0.9f, 1e-6f);
  EXPECT_EQ(tiles.tile(0, 3), tiles.tile(1, 3)) << "the other tile was not written";
  EXPECT_EQ(tiles.tilesInUse(), 3u);
  const float* own = tiles.tile(1, 0);
  EXPECT_EQ(tiles.writableTile(1, 0, 0), own) << "nobody else has it: no copy";
  tiles.resample({1});
  EXPECT_EQ(tiles.numParticles(), 1);
  EXPECT_EQ(tiles.tilesInUse(), 2u) << "tiles of the dead are free";
  EXPECT_NEAR(belief(tiles, 0, 3, 3), 0.2f, 1e-6f);
  tiles.reset();
  EXPECT_EQ(tiles.tilesInUse(), 0u);
}

TEST(OcclusionTiles, KeepsHalfABoxAndEightCellsAroundIt) {
  OcclusionTiles tiles(unusualStart(), 1, 1);
  tiles.setGrid(96, 128);
  for (int tile_index = 0; tile_index < 12 * 16; ++tile_index) tiles.writableTile(0, tile_index, 0);
  tiles.updateMean({1.0});
  tiles.keepAround({40, 40, 0, 128});
  EXPECT_EQ(tiles.tilesInUse(), 192u) << "an empty box changes nothing";
  // Rows 40 - 12 = 28 to 60: tile rows 3 to 7. Columns 60 - 18 = 42 to 98: tile columns 5 to 12.
  tiles.keepAround({40, 48, 60, 80});
  for (int row = 0; row < 12; ++row) {
    for (int col = 0; col < 16; ++col) {
      const bool kept = row >= 3 && row <= 7 && col >= 5 && col <= 12;
      EXPECT_EQ(tiles.tile(0, row * 16 + col) != nullptr, kept) << row << ", " << col;
      EXPECT_EQ(tiles.meanTile(row * 16 + col) != nullptr, kept) << row << ", " << col;
    }
  }
  EXPECT_EQ(tiles.tilesInUse(), 40u);
}

TEST(OcclusionTiles, OnlyAnotherSizeForgets) {
  OcclusionTiles tiles(unusualStart(), 1, 1);
  tiles.setGrid(16, 24);
  believe(tiles, 0, 1, 1, 0.9f);
  tiles.setGrid(16, 24);
  EXPECT_NEAR(belief(tiles, 0, 1, 1), 0.9f, 1e-6f);
  tiles.advance(1.0);
  tiles.setGrid(24, 16);
  EXPECT_EQ(tiles.tilesInUse(), 0u);
  EXPECT_NEAR(belief(tiles, 0, 1, 1), 0.6f, 1e-6f);
}

TEST(OcclusionTiles, AnotherSamplingOfTheImageKeepsTilesShared) {
  const SamplingGrid fine = makeSamplingGrid(cameraOf(640, 480), 4), coarse = makeSamplingGrid(cameraOf(640, 480), 5);
  constexpr int kParticles = 50;
  OcclusionTiles tiles(unusualStart(), kParticles, 1);
  tiles.setGrid(coarse.camera.height, coarse.camera.width);
  for (int row = 24; row < 48; ++row) {
    for (int col = 40; col < 64; ++col) {
      for (const int particle : {0, 1}) believe(tiles, particle, row, col, coarse.fullCol(col) < 260 ? 0.9f : 0.1f);
    }
  }
  std::vector<int> source(kParticles);
  for (int i = 0; i < kParticles; ++i) source[static_cast<std::size_t>(i)] = i % 2;
  tiles.resample(source);
  tiles.resampleGrid(coarse, fine);
  for (int row = 0; row < fine.camera.height; ++row) {
    for (int col = 0; col < fine.camera.width; ++col) {
      const int full_row = fine.fullRow(row), full_col = fine.fullCol(col);
      if (full_row < 130 || full_row > 230 || full_col < 210 || full_col > 310 || std::abs(full_col - 260) < 9)
        continue;
      for (const int particle : {0, 1, 48, 49}) {
        ASSERT_NEAR(belief(tiles, particle, row, col), full_col < 260 ? 0.9f : 0.1f, 1e-6f) << full_row << full_col;
      }
    }
  }
  // 24 coarse cells are 30 fine ones, which lie in at most 5 tiles per axis; two different histories.
  EXPECT_LE(tiles.tilesInUse(), 2u * 25u);
  EXPECT_EQ(tiles.tilesInUse(), distinctTiles(tiles));
  tiles.resampleGrid(coarse, fine);
  EXPECT_EQ(tiles.tilesInUse(), 0u) << "the grid was not the coarse one";
}

TEST(OcclusionTiles, AThousandSecondsNeitherUnderflowNorBlowUp) {
  for (const double step : {1.0 / 30.0, 0.7, 13.0, 1000.0}) {
    OcclusionTiles tiles(unusualStart(), 3, 1);
    tiles.setGrid(8, 16);
    believe(tiles, 0, 1, 1, 0.95f);
    tiles.resample({0, 0, 0});  // a shared tile must not age three times
    believe(tiles, 2, 1, 9, 0.05f);
    tiles.updateMean({0.25, 0.25, 0.5});
    double since_written = 0.0;
    for (double t = 0.0; t < 1000.0; t += step) {
      tiles.advance(step);
      since_written += step;
      const double left = std::pow(0.6, since_written);
      ASSERT_NEAR(belief(tiles, 1, 1, 1), 0.25 + 0.7 * left, 2e-6) << "after " << t << " s in steps of " << step;
      ASSERT_NEAR(belief(tiles, 2, 1, 9), 0.25 - 0.2 * left, 2e-6) << "after " << t << " s in steps of " << step;
      ASSERT_NEAR(tiles.probability(tiles.meanTile(0)[cellOf(1, 1)]), 0.25 + 0.7 * left, 2e-6) << "means age too";
      ASSERT_NEAR(belief(tiles, 0, 5, 5), 0.25 + 0.35 * std::pow(0.6, t + step), 2e-6);
      for (const float value : {tiles.unmeasured(), tiles.tile(0, 0)[0], tiles.meanTile(0)[0]}) {
        ASSERT_TRUE(value == 0.0f || std::isnormal(value)) << "denormal numbers are slow: " << value;
      }
      if (since_written > 40.0) {
        believe(tiles, 1, 1, 1, 0.95f);
        believe(tiles, 2, 1, 9, 0.05f);
        tiles.updateMean({0.0, 1.0, 0.0});
        since_written = 0.0;
      }
    }
  }
}

TEST(OcclusionTiles, ManySmallStepsAreOneLargeStep) {
  OcclusionTiles tiles(unusualStart(), 1, 1);
  tiles.setGrid(8, 8);
  believe(tiles, 0, 1, 1, 1.0f);
  for (int k = 0; k < 100000; ++k) tiles.advance(1e-5);
  EXPECT_NEAR(belief(tiles, 0, 1, 1), 0.25 + 0.75 * 0.6, 1e-6);
}

TEST(OcclusionTiles, NoOrNegativeTimeChangesNothing) {
  OcclusionTiles tiles(unusualStart(), 1, 1);
  tiles.setGrid(8, 8);
  believe(tiles, 0, 1, 1, 0.9f);
  tiles.advance(0.0);
  tiles.advance(-5.0);
  EXPECT_NEAR(belief(tiles, 0, 1, 1), 0.9f, 1e-6f);
}

constexpr int kCrowd = 400;
constexpr int kCrowdTiles = 5 * 6;

/// Frames of writing, after each of which a few particles have all the offspring, so that all tiles are shared when
/// the next writing begins; the last ones leave one particle.
void track(OcclusionTiles& tiles, WorkerPool& pool, int frames) {
  RandomSteps steps(5);
  for (int frame = 0; frame < frames; ++frame) {
    pool.run(kCrowd, [&](int particle, int thread) {
      for (int k = 0; k < 20; ++k) {
        const int tile_index = (k + particle % 3 + frame) % kCrowdTiles;
        const float* before = tiles.tile(particle, tile_index);
        const float first = before != nullptr ? before[0] : tiles.unmeasured();
        float* values = tiles.writableTile(particle, tile_index, thread);
        for (int i = 0; i < kTileCells; ++i) {
          values[i] = 0.5f * (values[i] + first) + 1e-3f * static_cast<float>((particle + 7 * i + 3 * frame) % 101);
        }
      }
    });
    ASSERT_EQ(tiles.tilesInUse(), distinctTiles(tiles)) << "frame " << frame;
    std::vector<int> source = steps.source(kCrowd, 3 + frame % 5);
    for (int& parent : source) parent = parent * 53 % kCrowd;
    tiles.resample(source);
    ASSERT_EQ(tiles.tilesInUse(), distinctTiles(tiles)) << "frame " << frame;
    tiles.advance(0.03);
    tiles.updateMean(std::vector<double>(kCrowd, 1.0 / kCrowd));
  }
}

TEST(OcclusionTiles, ThreadsChangeNothing) {
  OcclusionTiles serial(unusualStart(), kCrowd, 1), parallel(unusualStart(), kCrowd, 4);
  WorkerPool one(1), four(4);
  for (OcclusionTiles* tiles : {&serial, &parallel}) tiles->setGrid(40, 48);
  track(serial, one, 15);
  track(parallel, four, 15);
  std::set<float> different;
  for (int tile_index = 0; tile_index < kCrowdTiles; ++tile_index) {
    for (int i = 0; i < kTileCells; ++i) {
      ASSERT_EQ(serial.meanTile(tile_index)[i], parallel.meanTile(tile_index)[i]) << tile_index;
      for (int particle = 0; particle < kCrowd; ++particle) {
        ASSERT_EQ(serial.tile(particle, tile_index)[i], parallel.tile(particle, tile_index)[i]) << particle;
        different.insert(serial.tile(particle, tile_index)[i]);
      }
    }
  }
  EXPECT_GT(different.size(), 1000u) << "too little happened";
  EXPECT_EQ(serial.tilesInUse(), parallel.tilesInUse());
}

TEST(OcclusionTiles, NoTileIsLostBetweenThreads) {
  OcclusionTiles tiles(unusualStart(), kCrowd, 4);
  WorkerPool pool(4);
  tiles.setGrid(40, 48);
  track(tiles, pool, 10);
  const std::size_t warm = tiles.memoryBytes();
  for (int k = 0; k < 4; ++k) {
    tiles.reset();
    EXPECT_EQ(tiles.tilesInUse(), 0u);
    track(tiles, pool, 10);
  }
  EXPECT_LE(tiles.memoryBytes(), warm + (1u << 21)) << "threads may hold some hundred tiles more than before";
}

TEST(OcclusionTiles, MemoryStaysTheSameWhenTheSameHappensAgain) {
  OcclusionTiles tiles(unusualStart(), kCrowd, 1);
  WorkerPool pool(1);
  tiles.setGrid(40, 48);
  track(tiles, pool, 10);
  const std::size_t warm = tiles.memoryBytes();
  for (int k = 0; k < 4; ++k) {
    tiles.reset();
    track(tiles, pool, 10);
    EXPECT_EQ(tiles.memoryBytes(), warm);
  }
}

TEST(OcclusionTiles, TwoThousandParticlesNeedLittleMemory) {
  constexpr int kParticles = 2000;
  RandomSteps steps(3);
  OcclusionTiles tiles(unusualStart(), kParticles, 2);
  tiles.setGrid(96, 128);
  std::size_t peak = 0;
  double row = 40.0, col = 50.0;  // upper left corner of the object, 21 x 21 cells
  for (int frame = 0; frame < 100; ++frame) {
    row = std::clamp(row + 6.0 * steps.uniform() - 3.0, 0.0, 74.0);
    col = std::clamp(col + 8.0 * steps.uniform() - 4.0, 0.0, 106.0);
    for (int particle = 0; particle < kParticles; ++particle) {
      const int tile_row = std::clamp(static_cast<int>(row) / 8 + steps.below(3) - 1, 0, 12 - 5);
      const int tile_col = std::clamp(static_cast<int>(col) / 8 + steps.below(3) - 1, 0, 16 - 5);
      for (int k = 0; k < 25; ++k)
        tiles.writableTile(particle, (tile_row + k / 5) * 16 + tile_col + k % 5, 0)[k] = 0.0f;
    }
    ASSERT_GE(tiles.tilesInUse(), 25u * kParticles) << "every particle has its own";
    tiles.resample(resampleSystematic(steps.weights(kParticles), steps.uniform()));
    const int box_row = static_cast<int>(row), box_col = static_cast<int>(col);
    tiles.keepAround({box_row, box_row + 21, box_col, box_col + 21});
    peak = std::max(peak, tiles.memoryBytes());
  }
  EXPECT_EQ(tiles.tilesInUse(), distinctTiles(tiles));
  EXPECT_LT(peak, 40u << 20);
  RecordProperty("peak_bytes", std::to_string(peak));
}

}  // namespace
}  // namespace depth_object_tracker
