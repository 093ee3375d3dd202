// SPDX-License-Identifier: BSD-3-Clause
// p(occluded) per particle and pixel in small tiles that particles with a common past share until one of them writes.
#pragma once

#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/model/occlusion_chain.h"
#include "depth_object_tracker/render/depth_tile.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace depth_object_tracker {

/// Values of one tile, row-major.
struct alignas(64) OcclusionTile {
  float values[kTileCells];
};

/// Reference-counted tiles in chunks that never move. A handle is a number >= 1.
///
/// Every thread takes from and gives back to a short list of its own and, a batch at a time, exchanges it with a common
/// list, so that tiles do not pile up at the thread that frees most of them. Memory grows when more tiles are in use
/// than ever before and is kept until the end.
class TilePool {
 public:
  explicit TilePool(int num_threads);

  float* values(std::uint32_t handle) { return chunks_[handle / kChunkTiles]->tiles[handle % kChunkTiles].values; }
  const float* values(std::uint32_t handle) const {
    return chunks_[handle / kChunkTiles]->tiles[handle % kChunkTiles].values;
  }

  /// Asks for the values to be brought near the processor.
  void prefetch(std::uint32_t handle) const {
    const float* begin = values(handle);
    for (int i = 0; i < kTileCells; i += 16) __builtin_prefetch(begin + i);  // lines of 64 bytes
  }

  /// A tile with one reference; its values are undefined. Any threads may call it at the same time.
  std::uint32_t take(int thread);

  /// Whether somebody else refers to the tile too. Only a holder of a reference may ask: after "no" it may write, since
  /// nobody else can come to refer to the tile until the next serial call.
  bool isShared(std::uint32_t handle) const { return count(handle).load(std::memory_order_acquire) > 1; }

  /// Gives one reference up. Any threads may call it at the same time.
  void release(std::uint32_t handle, int thread);

  /// Adds (or removes) references; with none left the tile is free. Serial: not at the same time as any other call.
  void changeReferences(std::uint32_t handle, int change);

  /// Multiplies the values of all tiles in use, each once. Serial.
  void scale(float factor);

  std::size_t tilesInUse() const;
  std::size_t memoryBytes() const;

 private:
  static constexpr std::uint32_t kChunkTiles = 4096;  // 1 MB
  static constexpr std::size_t kMaxChunks = 8192;     // 8.6 GB: nobody gets there
  static constexpr std::size_t kBatch = 128;          // tiles that a thread exchanges at once

  struct Chunk {
    alignas(64) OcclusionTile tiles[kChunkTiles];  // not initialised, so that memory never used is never touched
    std::atomic<std::uint32_t> counts[kChunkTiles] = {};
  };
  struct alignas(64) FreeList {
    std::vector<std::uint32_t> handles;
  };

  std::atomic<std::uint32_t>& count(std::uint32_t handle) {
    return chunks_[handle / kChunkTiles]->counts[handle % kChunkTiles];
  }
  const std::atomic<std::uint32_t>& count(std::uint32_t handle) const {
    return chunks_[handle / kChunkTiles]->counts[handle % kChunkTiles];
  }
  void addChunk();
  void refill(std::vector<std::uint32_t>& list);
  void handBack(std::vector<std::uint32_t>& list);

  // Its size is fixed, so that threads may look tiles up while another one adds a chunk.
  std::vector<std::unique_ptr<Chunk>> chunks_;
  std::size_t num_chunks_ = 0;
  std::vector<FreeList> thread_free_;
  std::mutex mutex_;                 // guards num_chunks_ and free_ while threads work
  std::vector<std::uint32_t> free_;  // has room for every tile
};

/// Beliefs of all particles on a grid of cells, cut into aligned tiles of 8 x 8. Resampling copies handles of tiles
/// only; a tile is copied when it is written while shared. A tile that a particle never wrote holds no memory for it.
///
/// Values are deviations from the chain's stationary value divided by the decay since the start, so that time moves on
/// for all cells of all particles by changing one number. Cells of border tiles outside of the image hold any finite
/// number.
///
/// Only tile(), writableTile() and the constant conversions may be called by several threads at a time, and then every
/// particle by one of them only. What they return does not depend on the number of threads. Nothing is allocated when
/// no more particles, tiles and places with tiles are in use than ever before, resampleGrid() and setGrid() aside.
class OcclusionTiles {
 public:
  /// @param num_threads >= 1: `thread` of writableTile() lies in [0, num_threads).
  OcclusionTiles(const OcclusionChainConfig& config, int num_particles, int num_threads);

  /// Forgets everything: every pixel starts from p(o_0 = 1). Keeps the grid.
  void reset();

  /// Sets the size of the grid in cells; forgets everything when it differs from the last one.
  void setGrid(int rows, int cols);

  /// Carries the beliefs over to another sampling of the same image (nearest cell); the grid is that of `to`
  /// afterwards. There is no mean until the next updateMean(). Everything is forgotten if the grid was not that of
  /// `from`.
  void resampleGrid(const SamplingGrid& from, const SamplingGrid& to);

  /// Moves all beliefs dt_s >= 0 forward.
  void advance(double dt_s);

  /// Forgets tiles whose nearest cell is farther from `box` than half the box's size (per axis) and 8 cells. An empty
  /// box changes nothing.
  void keepAround(const CellBox& box);

  int numParticles() const { return num_particles_; }
  int tileRows() const { return tile_rows_; }
  int tileCols() const { return tile_cols_; }

  /// Stored values of a particle's tile, row-major 8 x 8, 64-byte aligned; nullptr = never measured.
  /// @param tile_index tile row * tileCols() + tile column. @return valid until the particle's tile is asked for
  /// writing or a function is called that is not const.
  const float* tile(int particle, int tile_index) const {
    const std::uint32_t* column = columns_[static_cast<std::size_t>(tile_index)].load(std::memory_order_acquire);
    const std::uint32_t handle = column != nullptr ? column[particle] : 0;
    return handle != 0 ? pool_.values(handle) : nullptr;
  }

  /// The same to write to, the particle's own; filled with unmeasured() where it was never measured. Valid until a
  /// function other than writableTile() is called that is not const. @param thread the caller's; two threads may not
  /// use the same number, or ask for the same particle, at the same time.
  float* writableTile(int particle, int tile_index, int thread) {
    std::uint32_t* column = columns_[static_cast<std::size_t>(tile_index)].load(std::memory_order_acquire);
    if (column == nullptr) column = addColumn(tile_index);
    std::uint32_t& handle = column[particle];
    if (handle == 0 || pool_.isShared(handle)) makeOwn(handle, thread);
    return pool_.values(handle);
  }

  /// Slot i continues from particle source[i]; there are source.size() particles afterwards.
  void resample(const std::vector<int>& source);

  /// Weighted mean over the particles of the stored values (linear, hence of the probabilities too). Particles without
  /// a tile count with unmeasured(). @param weights one per particle; their sum is 1.
  void updateMean(const std::vector<double>& weights);

  /// The last mean, as tile(); nullptr = no particle had measured there, or it was forgotten since.
  const float* meanTile(int tile_index) const {
    const int slot = mean_slots_[static_cast<std::size_t>(tile_index)];
    return slot != kNoMean ? mean_[static_cast<std::size_t>(slot)].values : nullptr;
  }

  /// Probability per unit of stored value, about the stationary probability.
  float scale() const { return scale_; }
  float probability(float stored) const { return stationary_ + scale_ * stored; }
  float stored(float probability) const { return (probability - stationary_) * inverse_scale_; }
  /// Stored value of a pixel that was never measured.
  float unmeasured() const { return unmeasured_; }

  /// Tiles that any particle refers to, shared ones counted once.
  std::size_t tilesInUse() const { return pool_.tilesInUse(); }
  /// All memory held, whether in use or not [bytes].
  std::size_t memoryBytes() const;

 private:
  // Handles of one place in the grid, one per particle. Tables are stored by place, so that places that nobody measures
  // cost no memory, and resampling and means run through contiguous memory.
  using Columns = std::vector<std::atomic<std::uint32_t*>>;
  static constexpr int kNoMean = -1;

  std::uint32_t* column(int tile_index) { return columns_[static_cast<std::size_t>(tile_index)].load(); }
  std::uint32_t* addColumn(int tile_index);
  std::uint32_t* newColumn();
  std::uint32_t* newColumnMemory();
  void stockColumns();
  void makeOwn(std::uint32_t& handle, int thread);
  void resizeGrid(int rows, int cols);
  void releaseColumn(std::uint32_t* column);
  void growColumns(int num_particles);
  void setScale(double scale);
  void countOffspring(const std::vector<int>& source);
  bool gather(const std::vector<int>& source, std::uint32_t* column);
  void addMean(int tile_index, const std::vector<double>& weights);

  /// Takes over one tile of a new grid from the columns of the last one.
  struct TileSources;
  void carryOver(int tile_index, const TileSources& sources);

  OcclusionChain chain_;
  float stationary_;
  float initial_deviation_;
  int num_particles_;
  int rows_ = 0, cols_ = 0, tile_rows_ = 0, tile_cols_ = 0;
  double exact_scale_ = 1.0;
  float scale_ = 1.0f, inverse_scale_ = 1.0f, unmeasured_ = 0.0f;

  TilePool pool_;
  Columns columns_;           // per place; nullptr = no particle has a tile
  std::mutex columns_mutex_;  // guards what follows while threads write
  std::vector<int> active_;   // places with a column, in no particular order
  std::vector<std::unique_ptr<std::uint32_t[]>> column_memory_;
  std::vector<std::uint32_t*> free_columns_;  // all zero
  int column_size_;                           // particles a column has room for, those without a particle are zero

  struct ReferenceChange {
    int particle, change;
  };
  std::vector<int> offspring_;
  std::vector<ReferenceChange> reference_changes_;
  std::vector<std::uint32_t> gathered_;
  std::vector<OcclusionTile> mean_;
  std::vector<int> mean_slots_;  // per place
};

}  // namespace depth_object_tracker
