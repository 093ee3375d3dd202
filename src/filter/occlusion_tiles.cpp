// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/occlusion_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

// Below this the stored values would lose range in single precision: about 27 s with the default chain.
constexpr double kSmallestScale = 1e-6;
// Deviations this small mean nothing; left alone they would become denormal numbers, which are slow.
constexpr float kSmallestDeviation = 1e-20f;
constexpr int kKeptMargin = 8;  // cells
constexpr std::size_t kStockedColumns = 512;
// Tiles of one place lie anywhere in memory: asking for them this many particles ahead hides most of the waiting.
constexpr int kPrefetchedParticles = 12;

float scaled(float value, float factor) {
  const float product = value * factor;
  return std::abs(product) < kSmallestDeviation ? 0.0f : product;
}

int tilesFor(int cells) {
  return (std::max(0, cells) + kTileSize - 1) / kTileSize;
}

bool isIdentity(const std::vector<int>& source, int num_particles) {
  if (static_cast<int>(source.size()) != num_particles) return false;
  for (int slot = 0; slot < num_particles; ++slot) {
    if (source[static_cast<std::size_t>(slot)] != slot) return false;
  }
  return true;
}

template <typename T>
std::size_t bytesOf(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

}  // namespace

TilePool::TilePool(int num_threads)
    : chunks_(kMaxChunks), thread_free_(static_cast<std::size_t>(std::max(1, num_threads))) {
  for (FreeList& list : thread_free_) list.handles.reserve(2 * kBatch);
}

std::uint32_t TilePool::take(int thread) {
  std::vector<std::uint32_t>& list = thread_free_[static_cast<std::size_t>(thread)].handles;
  if (list.empty()) refill(list);
  const std::uint32_t handle = list.back();
  list.pop_back();
  count(handle).store(1, std::memory_order_relaxed);
  return handle;
}

void TilePool::release(std::uint32_t handle, int thread) {
  // Release: this thread has done reading before another one finds itself the only owner. Acquire: the others have,
  // too, before the tile is used anew.
  if (count(handle).fetch_sub(1, std::memory_order_acq_rel) != 1) return;
  std::vector<std::uint32_t>& list = thread_free_[static_cast<std::size_t>(thread)].handles;
  if (list.size() == 2 * kBatch) handBack(list);
  list.push_back(handle);
}

void TilePool::changeReferences(std::uint32_t handle, int change) {
  std::atomic<std::uint32_t>& references = count(handle);
  const std::uint32_t changed = references.load(std::memory_order_relaxed) + static_cast<std::uint32_t>(change);
  references.store(changed, std::memory_order_relaxed);  // serial: a plain store is cheaper than an atomic addition
  if (changed == 0) free_.push_back(handle);
}

void TilePool::refill(std::vector<std::uint32_t>& list) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (free_.empty()) addChunk();
  const auto begin = free_.end() - static_cast<std::ptrdiff_t>(std::min(kBatch, free_.size()));
  list.insert(list.end(), begin, free_.end());
  free_.erase(begin, free_.end());
}

void TilePool::handBack(std::vector<std::uint32_t>& list) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto begin = list.end() - static_cast<std::ptrdiff_t>(kBatch);
  free_.insert(free_.end(), begin, list.end());
  list.erase(begin, list.end());
}

void TilePool::addChunk() {
  if (num_chunks_ == kMaxChunks) throw std::length_error("occlusion beliefs need more than 8 GB; use fewer particles");
  chunks_[num_chunks_].reset(new Chunk);  // make_unique would write zeros to all of it
  const auto begin = static_cast<std::uint32_t>(num_chunks_ * kChunkTiles);
  ++num_chunks_;
  free_.reserve(num_chunks_ * kChunkTiles);
  for (std::uint32_t i = kChunkTiles; i-- > 0;) {
    if (begin + i != 0) free_.push_back(begin + i);  // 0 means no tile
  }
}

void TilePool::scale(float factor) {
  for (std::size_t chunk_index = 0; chunk_index < num_chunks_; ++chunk_index) {
    Chunk& chunk = *chunks_[chunk_index];
    for (std::uint32_t i = 0; i < kChunkTiles; ++i) {
      if (chunk.counts[i].load(std::memory_order_relaxed) == 0) continue;
      for (float& value : chunk.tiles[i].values) value = scaled(value, factor);
    }
  }
}

std::size_t TilePool::tilesInUse() const {
  std::size_t idle = free_.size() + (num_chunks_ > 0 ? 1 : 0);
  for (const FreeList& list : thread_free_) idle += list.handles.size();
  return num_chunks_ * kChunkTiles - idle;
}

std::size_t TilePool::memoryBytes() const {
  std::size_t bytes = num_chunks_ * sizeof(Chunk) + bytesOf(chunks_) + bytesOf(free_) + bytesOf(thread_free_);
  for (const FreeList& list : thread_free_) bytes += bytesOf(list.handles);
  return bytes;
}

OcclusionTiles::OcclusionTiles(const OcclusionChainConfig& config, int num_particles, int num_threads)
    : chain_(config),
      stationary_(static_cast<float>(chain_.stationary())),
      initial_deviation_(static_cast<float>(config.initial_p_occluded - chain_.stationary())),
      num_particles_(num_particles),
      unmeasured_(initial_deviation_),
      pool_(num_threads),
      column_size_(num_particles) {}

void OcclusionTiles::reset() {
  for (const int tile_index : active_) {
    releaseColumn(column(tile_index));
    columns_[static_cast<std::size_t>(tile_index)].store(nullptr);
  }
  active_.clear();
  std::fill(mean_slots_.begin(), mean_slots_.end(), kNoMean);
  setScale(1.0);
  unmeasured_ = initial_deviation_;
}

void OcclusionTiles::setGrid(int rows, int cols) {
  if (rows == rows_ && cols == cols_) return;
  reset();
  resizeGrid(rows, cols);
}

void OcclusionTiles::resizeGrid(int rows, int cols) {
  rows_ = rows;
  cols_ = cols;
  tile_rows_ = tilesFor(rows);
  tile_cols_ = tilesFor(cols);
  const std::size_t num_tiles = static_cast<std::size_t>(tile_rows_) * static_cast<std::size_t>(tile_cols_);
  columns_ = Columns(num_tiles);
  for (auto& column : columns_) column.store(nullptr);
  active_.reserve(num_tiles);
  mean_slots_.assign(num_tiles, kNoMean);
  stockColumns();
}

/// Particles that try a sudden motion reach dozens of new places in one frame: those must not each ask the heap.
void OcclusionTiles::stockColumns() {
  const std::size_t wanted = std::min(columns_.size(), kStockedColumns);
  column_memory_.reserve(columns_.size());
  free_columns_.reserve(columns_.size());
  mean_.reserve(wanted);
  while (column_memory_.size() < wanted) releaseColumn(newColumnMemory());
}

void OcclusionTiles::setScale(double scale) {
  exact_scale_ = scale;
  scale_ = static_cast<float>(scale);
  inverse_scale_ = static_cast<float>(1.0 / scale);
}

void OcclusionTiles::advance(double dt_s) {
  const double scale = exact_scale_ * chain_.decay(std::max(0.0, dt_s));
  if (scale > kSmallestScale) return setScale(scale);
  const auto factor = static_cast<float>(scale);
  pool_.scale(factor);
  for (OcclusionTile& tile : mean_) {
    for (float& value : tile.values) value = scaled(value, factor);
  }
  unmeasured_ = scaled(unmeasured_, factor);
  setScale(1.0);
}

void OcclusionTiles::keepAround(const CellBox& box) {
  if (box.empty()) return;
  const int row_margin = box.rows() / 2 + kKeptMargin, col_margin = box.cols() / 2 + kKeptMargin;
  const CellBox kept{box.row_begin - row_margin, box.row_end + row_margin, box.col_begin - col_margin,
                     box.col_end + col_margin};
  const auto is_forgotten = [&](int tile_index) {
    const int row = tile_index / tile_cols_ * kTileSize, col = tile_index % tile_cols_ * kTileSize;
    if (!intersect(kept, {row, row + kTileSize, col, col + kTileSize}).empty()) return false;
    releaseColumn(column(tile_index));
    columns_[static_cast<std::size_t>(tile_index)].store(nullptr);
    mean_slots_[static_cast<std::size_t>(tile_index)] = kNoMean;
    return true;
  };
  active_.erase(std::remove_if(active_.begin(), active_.end(), is_forgotten), active_.end());
}

std::uint32_t* OcclusionTiles::addColumn(int tile_index) {
  const std::lock_guard<std::mutex> lock(columns_mutex_);
  std::atomic<std::uint32_t*>& place = columns_[static_cast<std::size_t>(tile_index)];
  if (place.load(std::memory_order_relaxed) == nullptr) {  // else another thread was faster
    place.store(newColumn(), std::memory_order_release);
    active_.push_back(tile_index);
  }
  return place.load(std::memory_order_relaxed);
}

std::uint32_t* OcclusionTiles::newColumn() {
  if (free_columns_.empty()) return newColumnMemory();
  std::uint32_t* column = free_columns_.back();
  free_columns_.pop_back();
  return column;
}

std::uint32_t* OcclusionTiles::newColumnMemory() {
  column_memory_.push_back(std::make_unique<std::uint32_t[]>(static_cast<std::size_t>(column_size_)));
  free_columns_.reserve(column_memory_.size());
  return column_memory_.back().get();
}

void OcclusionTiles::releaseColumn(std::uint32_t* column) {
  for (int particle = 0; particle < num_particles_; ++particle) {
    if (column[particle] != 0) pool_.changeReferences(column[particle], -1);
    column[particle] = 0;
  }
  free_columns_.push_back(column);
}

void OcclusionTiles::growColumns(int num_particles) {
  const std::vector<std::unique_ptr<std::uint32_t[]>> last = std::move(column_memory_);
  column_memory_.clear();
  free_columns_.clear();
  column_size_ = num_particles;
  for (const int tile_index : active_) {
    std::uint32_t* column = newColumn();
    std::atomic<std::uint32_t*>& place = columns_[static_cast<std::size_t>(tile_index)];
    std::copy(place.load(), place.load() + num_particles_, column);
    place.store(column);
  }
  stockColumns();
}

void OcclusionTiles::makeOwn(std::uint32_t& handle, int thread) {
  const std::uint32_t own = pool_.take(thread);
  float* values = pool_.values(own);
  if (handle == 0) {
    std::fill(values, values + kTileCells, unmeasured_);
  } else {
    const float* shared = pool_.values(handle);
    std::copy(shared, shared + kTileCells, values);
    pool_.release(handle, thread);
  }
  handle = own;
}

void OcclusionTiles::resample(const std::vector<int>& source) {
  if (isIdentity(source, num_particles_)) return;
  countOffspring(source);
  for (const int tile_index : active_) {
    const std::uint32_t* handles = column(tile_index);
    for (const auto& [particle, change] : reference_changes_) {
      if (handles[particle] != 0) pool_.changeReferences(handles[particle], change);
    }
  }
  const auto count = static_cast<int>(source.size());
  if (count > column_size_) growColumns(count);
  gathered_.resize(source.size());
  const auto is_forgotten = [&](int tile_index) {
    if (gather(source, column(tile_index))) return false;
    free_columns_.push_back(column(tile_index));
    columns_[static_cast<std::size_t>(tile_index)].store(nullptr);
    return true;
  };
  active_.erase(std::remove_if(active_.begin(), active_.end(), is_forgotten), active_.end());
  num_particles_ = count;
}

/// Those with more references first: then no tile looks free while a particle is still to come that shares it, and the
/// processor rarely guesses wrong.
void OcclusionTiles::countOffspring(const std::vector<int>& source) {
  offspring_.assign(static_cast<std::size_t>(num_particles_), 0);
  for (const int parent : source) ++offspring_[static_cast<std::size_t>(parent)];
  reference_changes_.clear();
  reference_changes_.reserve(static_cast<std::size_t>(num_particles_));  // never more, and not in a later frame
  for (int particle = 0; particle < num_particles_; ++particle) {
    const int offspring = offspring_[static_cast<std::size_t>(particle)];
    if (offspring > 1) reference_changes_.push_back({particle, offspring - 1});
  }
  for (int particle = 0; particle < num_particles_; ++particle) {
    if (offspring_[static_cast<std::size_t>(particle)] == 0) reference_changes_.push_back({particle, -1});
  }
}

/// @return false when no particle has a tile any more.
bool OcclusionTiles::gather(const std::vector<int>& source, std::uint32_t* column) {
  std::uint32_t any = 0;
  for (std::size_t slot = 0; slot < source.size(); ++slot) {
    gathered_[slot] = column[source[slot]];
    any |= gathered_[slot];
  }
  std::copy(gathered_.begin(), gathered_.end(), column);
  if (static_cast<int>(source.size()) < num_particles_) std::fill(column + source.size(), column + num_particles_, 0u);
  return any != 0;
}

void OcclusionTiles::updateMean(const std::vector<double>& weights) {
  std::fill(mean_slots_.begin(), mean_slots_.end(), kNoMean);
  mean_.clear();
  for (const int tile_index : active_) addMean(tile_index, weights);
}

void OcclusionTiles::addMean(int tile_index, const std::vector<double>& weights) {
  const std::uint32_t* handles = column(tile_index);
  OcclusionTile sum{};
  double weight_unmeasured = 0.0;
  for (int particle = 0; particle < num_particles_; ++particle) {
    const int ahead = particle + kPrefetchedParticles;
    if (ahead < num_particles_ && handles[ahead] != 0) pool_.prefetch(handles[ahead]);
    const double weight = weights[static_cast<std::size_t>(particle)];
    if (weight <= 0.0) continue;
    if (handles[particle] == 0) {
      weight_unmeasured += weight;
      continue;
    }
    const auto factor = static_cast<float>(weight);
    const float* __restrict values = pool_.values(handles[particle]);
    for (int i = 0; i < kTileCells; ++i) sum.values[i] += factor * values[i];
  }
  const float unmeasured_share = static_cast<float>(weight_unmeasured) * unmeasured_;
  for (float& value : sum.values) value += unmeasured_share;
  mean_slots_[static_cast<std::size_t>(tile_index)] = static_cast<int>(mean_.size());
  mean_.push_back(sum);
}

/// Where the cells of one tile of the new grid come from.
struct OcclusionTiles::TileSources {
  static constexpr int kNowhere = -1;

  /// @param last places of the grid `from`, of `tile_cols` columns.
  TileSources(const SamplingGrid& from, const SamplingGrid& to, int row_begin, int col_begin, const Columns& last,
              int tile_cols);

  std::vector<const std::uint32_t*> columns;  ///< columns of the last grid that some cell comes from
  std::array<int, kTileCells> column_of;      ///< per cell: index of such a column, or kNowhere
  std::array<int, kTileCells> cell_of;        ///< per cell: its cell in the tile there
};

OcclusionTiles::TileSources::TileSources(const SamplingGrid& from, const SamplingGrid& to, int row_begin, int col_begin,
                                         const Columns& last, int tile_cols) {
  column_of.fill(kNowhere);
  cell_of.fill(0);
  // Beyond the last cell of `from` the image may go on for less than a cell.
  const auto nearest = [&](int full_pixel, int size) {
    return std::min((full_pixel - from.offset() + from.factor / 2) / from.factor, size - 1);
  };
  for (int i = 0; i < kTileCells; ++i) {
    const int row = row_begin + i / kTileSize, col = col_begin + i % kTileSize;
    if (row >= to.camera.height || col >= to.camera.width) continue;
    const int from_row = nearest(to.fullRow(row), from.camera.height);
    const int from_col = nearest(to.fullCol(col), from.camera.width);
    const int place = from_row / kTileSize * tile_cols + from_col / kTileSize;
    const std::uint32_t* column = last[static_cast<std::size_t>(place)].load();
    if (column == nullptr) continue;
    const auto known = std::find(columns.begin(), columns.end(), column);
    column_of[static_cast<std::size_t>(i)] = static_cast<int>(known - columns.begin());
    cell_of[static_cast<std::size_t>(i)] = from_row % kTileSize * kTileSize + from_col % kTileSize;
    if (known == columns.end()) columns.push_back(column);
  }
}

void OcclusionTiles::resampleGrid(const SamplingGrid& from, const SamplingGrid& to) {
  if (from.camera.height != rows_ || from.camera.width != cols_) {
    reset();
    return resizeGrid(to.camera.height, to.camera.width);
  }
  const Columns last = std::move(columns_);
  std::vector<int> last_active;
  last_active.swap(active_);
  const int last_tile_cols = tile_cols_;
  resizeGrid(to.camera.height, to.camera.width);
  for (int tile_index = 0; tile_index < tile_rows_ * tile_cols_ && !last_active.empty(); ++tile_index) {
    const TileSources sources(from, to, tile_index / tile_cols_ * kTileSize, tile_index % tile_cols_ * kTileSize, last,
                              last_tile_cols);
    if (!sources.columns.empty()) carryOver(tile_index, sources);
  }
  for (const int tile_index : last_active) releaseColumn(last[static_cast<std::size_t>(tile_index)].load());
}

/// Particles that share all tiles that a new one comes from share the new one too: sorting brings them together.
void OcclusionTiles::carryOver(int tile_index, const TileSources& sources) {
  const auto compare = [&](int a, int b) {
    for (const std::uint32_t* column : sources.columns) {
      if (column[a] != column[b]) return column[a] < column[b] ? -1 : 1;
    }
    return 0;
  };
  const auto has_any = [&](int particle) {
    return std::any_of(sources.columns.begin(), sources.columns.end(),
                       [&](const std::uint32_t* column) { return column[particle] != 0; });
  };
  std::vector<int> particles;
  for (int particle = 0; particle < num_particles_; ++particle) {
    if (has_any(particle)) particles.push_back(particle);
  }
  std::sort(particles.begin(), particles.end(), [&](int a, int b) { return compare(a, b) < 0; });
  for (std::size_t k = 0; k < particles.size(); ++k) {
    std::uint32_t* column = addColumn(tile_index);
    const int particle = particles[k];
    if (k > 0 && compare(particles[k - 1], particle) == 0) {
      column[particle] = column[particles[k - 1]];
      pool_.changeReferences(column[particle], 1);
      continue;
    }
    float* values = writableTile(particle, tile_index, 0);
    for (std::size_t i = 0; i < kTileCells; ++i) {
      if (sources.column_of[i] == TileSources::kNowhere) continue;
      const std::uint32_t handle = sources.columns[static_cast<std::size_t>(sources.column_of[i])][particle];
      if (handle != 0) values[i] = pool_.values(handle)[sources.cell_of[i]];
    }
  }
}

std::size_t OcclusionTiles::memoryBytes() const {
  return pool_.memoryBytes() + bytesOf(columns_) + bytesOf(active_) + bytesOf(column_memory_) + bytesOf(free_columns_) +
         column_memory_.size() * static_cast<std::size_t>(column_size_) * sizeof(std::uint32_t) + bytesOf(offspring_) +
         bytesOf(reference_changes_) + bytesOf(gathered_) + bytesOf(mean_) + bytesOf(mean_slots_);
}

}  // namespace depth_object_tracker
