// SPDX-License-Identifier: BSD-3-Clause
// The program track_bag from the outside, on small bags made here: a regression test of the whole pipeline.
#include "small_scene.h"

#include <depth_object_tracker/TrackerStatus.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <fstream>
#include <iterator>

namespace depth_object_tracker {
namespace {

using testing::HasSubstr;

/// A simulated scene of the drill as a bag; made once for all tests.
class DrillBag {
 public:
  DrillBag() {
    const ProgramRun made = runProgram(
        SIMULATE_SCENE, {"--object", mesh(), "--speed", "medium", "--frames", std::to_string(kFrames), file("scene")});
    const ProgramRun converted = runProgram(SCENE_TO_BAG, {file("scene"), file("scene.bag")});
    problem = made.err + converted.err;
    if (made.exit_code == 0 && converted.exit_code == 0) problem.clear();
  }
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
  static std::string mesh() { return std::string(PROJECT_SOURCE_FOLDER) + "/meshes/drill.obj"; }

  static constexpr int kFrames = 45;
  std::string problem;

 private:
  TemporaryFolder folder_;
};

const DrillBag& drillBag() {
  static const DrillBag bag;
  return bag;
}

std::string bytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Estimates without the column of times.
std::vector<std::string> estimatesOf(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line.substr(0, line.rfind(',')));
  return lines;
}

template <typename Message>
std::vector<boost::shared_ptr<Message>> messagesOf(const std::string& bag_path, const std::string& topic) {
  rosbag::Bag bag(bag_path, rosbag::bagmode::Read);
  std::vector<boost::shared_ptr<Message>> messages;
  for (const rosbag::MessageInstance& instance : rosbag::View(bag, rosbag::TopicQuery(topic))) {
    messages.push_back(instance.instantiate<Message>());
  }
  return messages;
}

ProgramRun track(const std::string& name, std::vector<std::string> options) {
  const DrillBag& bag = drillBag();
  options.insert(options.begin(), {bag.file("scene.bag"), "--object", DrillBag::mesh(), "--output",
                                   bag.file(name + ".csv"), "--output-bag", bag.file(name + ".bag")});
  return runProgram(TRACK_BAG, options);
}

class TrackBag : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(drillBag().problem, ""); }
};

TEST_F(TrackBag, SameBytesEveryTimeOnAnyNumberOfThreads) {
  ASSERT_EQ(track("once", {"--num-threads", "1"}).exit_code, 0);
  ASSERT_EQ(track("again", {"--num-threads", "1"}).exit_code, 0);
  ASSERT_EQ(track("threads", {"--num-threads", "3"}).exit_code, 0);
  ASSERT_EQ(track("seed", {"--num-threads", "1", "--seed", "7"}).exit_code, 0);
  const std::string once = bytesOf(drillBag().file("once.bag"));
  ASSERT_GT(once.size(), 10000u);
  EXPECT_TRUE(once == bytesOf(drillBag().file("again.bag"))) << "a repeated run differs";
  EXPECT_TRUE(once == bytesOf(drillBag().file("threads.bag"))) << "three threads differ from one";
  EXPECT_FALSE(once == bytesOf(drillBag().file("seed.bag"))) << "the seed must matter, else this test shows nothing";
  const std::vector<std::string> estimates = estimatesOf(drillBag().file("once.csv"));
  ASSERT_EQ(estimates.size(), 1u + DrillBag::kFrames);
  EXPECT_EQ(estimates, estimatesOf(drillBag().file("again.csv")));
  EXPECT_EQ(estimates, estimatesOf(drillBag().file("threads.csv")));
}

TEST_F(TrackBag, FollowsTheGroundTruth) {
  const ProgramRun run = track("accuracy", {});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");  // no progress bar in a pipe
  EXPECT_THAT(run.out, HasSubstr("ADD [mm]"));
  const auto truths = messagesOf<geometry_msgs::PoseStamped>(drillBag().file("scene.bag"), "/ground_truth/pose");
  const auto poses =
      messagesOf<geometry_msgs::PoseWithCovarianceStamped>(drillBag().file("accuracy.bag"), "/tracker/pose");
  ASSERT_EQ(poses.size(), truths.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    ASSERT_EQ(poses[k]->header.stamp, truths[k]->header.stamp);
    const auto &p = poses[k]->pose.pose.position, &t = truths[k]->pose.position;
    EXPECT_LT(Eigen::Vector3d(p.x - t.x, p.y - t.y, p.z - t.z).norm(), 0.004) << "image " << k;
  }
  const auto statuses = messagesOf<TrackerStatus>(drillBag().file("accuracy.bag"), "/tracker/status");
  ASSERT_EQ(statuses.size(), truths.size());
  EXPECT_EQ(statuses.back()->state, TrackerStatus::TRACKING) << statuses.back()->reason;
  EXPECT_EQ(statuses.back()->frames_processed, truths.size());
}

TEST_F(TrackBag, SaysTheSameAsTrackSequence) {
  ASSERT_EQ(track("bag", {"--init", drillBag().file("scene/init.json"), "--num-threads", "1"}).exit_code, 0);
  ASSERT_EQ(runProgram(TRACK_SEQUENCE, {drillBag().file("scene"), "--mesh", DrillBag::mesh(), "--output",
                                        drillBag().file("sequence.csv"), "--init", drillBag().file("scene/init.json")})
                .exit_code,
            0);
  const auto position = [](const std::string& row) {
    const std::string t = row.substr(row.rfind(',') + 1);
    Eigen::Vector3d p;
    std::istringstream(t) >> p.x() >> p.y() >> p.z();
    return p;
  };
  const auto bag = estimatesOf(drillBag().file("bag.csv")), sequence = estimatesOf(drillBag().file("sequence.csv"));
  ASSERT_EQ(bag.size(), sequence.size());
  // Stamps of a bag are whole nanoseconds, and its initial pose has the nodelet's covariance: not the same bytes.
  for (std::size_t k = 5; k < bag.size(); ++k) {
    EXPECT_LT((position(bag[k]) - position(sequence[k])).norm(), 1.0) << "image " << k - 1 << " [mm]";
  }
}

TEST_F(TrackBag, FindsTheObjectWithoutAnInitialPose) {
  ASSERT_EQ(track("found", {"--find"}).exit_code, 0);
  const auto statuses = messagesOf<TrackerStatus>(drillBag().file("found.bag"), "/tracker/status");
  ASSERT_FALSE(statuses.empty());
  EXPECT_EQ(statuses.back()->state, TrackerStatus::TRACKING) << statuses.back()->reason;
}

TEST_F(TrackBag, BadInputEndsWithOneLine) {
  const std::string bag = drillBag().file("scene.bag"), csv = drillBag().file("bad.csv");
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--output", csv});
    return runProgram(TRACK_BAG, arguments);
  };
  ProgramRun bad = run({"/no/such.bag", "--object", DrillBag::mesh()});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(bad.err, HasSubstr("error: cannot read /no/such.bag"));
  bad = run({DrillBag::mesh(), "--object", DrillBag::mesh()});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(bad.err, HasSubstr("as a rosbag"));
  bad = run({bag, "--object", DrillBag::mesh(), "--image-topic", "/no/such"});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(bad.err, HasSubstr("/camera/depth/image_raw"));
  bad = run({bag, "--object", "/no/mesh.obj"});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(bad.err, HasSubstr("/no/mesh.obj"));
  EXPECT_EQ(run({bag}).exit_code, 2);
  // Cut off in the middle, as by a full disk.
  const std::string cut = drillBag().file("cut.bag"), whole = bytesOf(bag);
  std::ofstream(cut, std::ios::binary) << whole.substr(0, whole.size() / 2);
  bad = run({cut, "--object", DrillBag::mesh()});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(bad.err, HasSubstr("error: "));
}

}  // namespace
}  // namespace depth_object_tracker
