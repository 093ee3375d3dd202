// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/estimate_board.h"

namespace depth_object_tracker {

std::shared_ptr<EstimateBoard> EstimateBoard::forImages(const std::string& images) {
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<EstimateBoard>> boards;
  const std::lock_guard<std::mutex> lock(mutex);
  for (auto it = boards.begin(); it != boards.end();) it = it->second.expired() ? boards.erase(it) : std::next(it);
  std::shared_ptr<EstimateBoard> board = boards[images].lock();
  if (!board) boards[images] = board = std::make_shared<EstimateBoard>();
  return board;
}

EstimateBoard::Member EstimateBoard::join() {
  const std::lock_guard<std::mutex> lock(mutex_);
  entries_.emplace(next_member_, Entry());
  return next_member_++;
}

void EstimateBoard::leave(Member member) {
  const std::lock_guard<std::mutex> lock(mutex_);
  entries_.erase(member);
}

void EstimateBoard::tell(Member member, const std::string& camera_frame, const TrackerResult& result,
                         std::shared_ptr<const TriangleMesh> mesh) {
  const bool has_track = result.state == TrackerState::kTracking || result.state == TrackerState::kOccluded;
  std::optional<ObjectEstimate> estimate = tellOthers(result, std::move(mesh));
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto entry = entries_.find(member);
  if (entry == entries_.end()) return;
  if (!has_track) entry->second.track.reset();
  if (has_track && !entry->second.track) entry->second.track = next_track_++;
  entry->second.camera_frame = camera_frame;
  entry->second.estimate = std::move(estimate);
}

std::vector<ObjectEstimate> EstimateBoard::heardBy(Member member, const std::string& camera_frame) const {
  std::vector<ObjectEstimate> heard;
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto own = entries_.find(member);
  for (const auto& [other, entry] : entries_) {
    if (other == member || !entry.estimate || entry.camera_frame != camera_frame) continue;
    heard.push_back(*entry.estimate);
    const bool is_younger =
        own != entries_.end() && own->second.track && entry.track && *own->second.track < *entry.track;
    if (is_younger) heard.back().is_seen = false;
  }
  return heard;
}

std::size_t EstimateBoard::numMembers() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return entries_.size();
}

}  // namespace depth_object_tracker
