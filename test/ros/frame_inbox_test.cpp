// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/frame_inbox.h"

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include <atomic>
#include <thread>

namespace depth_object_tracker {
namespace {

constexpr std::chrono::duration<double> kNow{0.0};
constexpr std::chrono::duration<double> kLong{60.0};

CameraFrame makeFrame(std::uint32_t seq) {
  auto image = boost::make_shared<sensor_msgs::Image>();
  image->header.seq = seq;
  CameraFrame frame;
  frame.image = image;
  return frame;
}

TEST(FrameInbox, TheNewestFrameWinsAndOthersCountAsDropped) {
  FrameInbox inbox;
  for (std::uint32_t i = 0; i < 5; ++i) inbox.postFrame(makeFrame(i));
  const auto delivery = inbox.wait(kNow);
  ASSERT_TRUE(delivery && delivery->frame);
  EXPECT_EQ(delivery->frame->image->header.seq, 4u);
  EXPECT_EQ(inbox.counters().received, 5u);
  EXPECT_EQ(inbox.counters().dropped, 4u);
  EXPECT_FALSE(inbox.wait(kNow)->frame);
}

TEST(FrameInbox, HoldsNoReferenceToAReplacedFrame) {
  FrameInbox inbox;
  CameraFrame frame = makeFrame(0);
  const sensor_msgs::ImageConstPtr image = frame.image;
  inbox.postFrame(std::move(frame));
  inbox.postFrame(makeFrame(1));
  EXPECT_EQ(image.use_count(), 1);
}

TEST(FrameInbox, DeliversCommandsInOrderAndAll) {
  FrameInbox inbox;
  std::vector<int> order;
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(inbox.postCommand([&order, i] { order.push_back(i); }));
  const auto delivery = inbox.wait(kNow);
  ASSERT_TRUE(delivery);
  for (const auto& command : delivery->commands) command();
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST(FrameInbox, WaitingForCommandsLeavesTheFrame) {
  FrameInbox inbox;
  inbox.postFrame(makeFrame(7));
  EXPECT_FALSE(inbox.waitForCommands(kNow)->frame);
  EXPECT_TRUE(inbox.wait(kNow)->frame);
}

TEST(FrameInbox, RefusesCommandsWithoutEnd) {
  FrameInbox inbox;
  for (std::size_t i = 0; i < FrameInbox::kMaxCommands; ++i) ASSERT_TRUE(inbox.postCommand([] {}));
  EXPECT_FALSE(inbox.postCommand([] {}));
}

TEST(FrameInbox, WakesAWaitingThread) {
  FrameInbox inbox;
  std::thread poster([&] { inbox.postFrame(makeFrame(3)); });
  const auto delivery = inbox.wait(kLong);
  poster.join();
  ASSERT_TRUE(delivery && delivery->frame);
}

TEST(FrameInbox, StopWakesForGoodAndDiscards) {
  FrameInbox inbox;
  inbox.postFrame(makeFrame(3));
  std::thread stopper([&] { inbox.stop(); });
  while (inbox.wait(kLong)) {
  }
  stopper.join();
  EXPECT_FALSE(inbox.postCommand([] {}));
  inbox.postFrame(makeFrame(4));
  EXPECT_FALSE(inbox.wait(kNow));
}

TEST(FrameInbox, CountsEveryFrameOnceUnderLoad) {
  FrameInbox inbox;
  constexpr std::uint64_t kPerThread = 2000;
  std::atomic<int> posting{2};
  const auto post = [&] {
    for (std::uint32_t i = 0; i < kPerThread; ++i) inbox.postFrame(makeFrame(i));
    --posting;
  };
  std::thread first(post), second(post);
  std::uint64_t taken = 0;
  while (posting > 0) taken += inbox.wait(std::chrono::milliseconds(1))->frame ? 1 : 0;
  first.join();
  second.join();
  taken += inbox.wait(kNow)->frame ? 1 : 0;
  EXPECT_EQ(inbox.counters().received, 2 * kPerThread);
  EXPECT_EQ(inbox.counters().dropped + taken, 2 * kPerThread);
}

}  // namespace
}  // namespace depth_object_tracker
