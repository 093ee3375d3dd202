// SPDX-License-Identifier: BSD-3-Clause
// Where the trackers of one process that look at the same images tell each other what they hold.
#pragma once

#include "depth_object_tracker/tracker/other_objects.h"

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// Thread-safe.
class EstimateBoard {
 public:
  /// The one board of this process for these images; it is gone with the last who holds it.
  /// @param images any name, such as the topic's.
  static std::shared_ptr<EstimateBoard> forImages(const std::string& images);

  using Member = std::uint64_t;
  Member join();
  void leave(Member member);

  /// Replaces what the member told before. @param camera_frame only who sees with the same camera hears of it.
  void tell(Member member, const std::string& camera_frame, const TrackerResult& result,
            std::shared_ptr<const TriangleMesh> mesh);

  /// What the others told last. Where two hold the same thing, it belongs to whoever has tracked for longer: a younger
  /// track's estimate is no more than an occluder.
  std::vector<ObjectEstimate> heardBy(Member member, const std::string& camera_frame) const;

  std::size_t numMembers() const;

 private:
  struct Entry {
    std::string camera_frame;
    std::optional<ObjectEstimate> estimate;
    std::optional<std::uint64_t> track;  // number of the present track, the oldest has the lowest; none while searching
  };
  mutable std::mutex mutex_;
  std::map<Member, Entry> entries_;
  Member next_member_ = 0;
  std::uint64_t next_track_ = 0;
};

/// A member for as long as it lives.
class BoardMembership {
 public:
  explicit BoardMembership(std::shared_ptr<EstimateBoard> board) : board_(std::move(board)), member_(board_->join()) {}
  ~BoardMembership() { board_->leave(member_); }
  BoardMembership(const BoardMembership&) = delete;
  BoardMembership& operator=(const BoardMembership&) = delete;

  void tell(const std::string& camera_frame, const TrackerResult& result, std::shared_ptr<const TriangleMesh> mesh) {
    board_->tell(member_, camera_frame, result, std::move(mesh));
  }
  std::vector<ObjectEstimate> hear(const std::string& camera_frame) const {
    return board_->heardBy(member_, camera_frame);
  }

 private:
  std::shared_ptr<EstimateBoard> board_;
  EstimateBoard::Member member_;
};

}  // namespace depth_object_tracker
