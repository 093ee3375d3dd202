// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/parameter_loader.h"

#include <gtest/gtest.h>

namespace depth_object_tracker {
namespace {

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(ParameterLoader, WithoutParametersGivesTheDefaults) {
  const auto parameters = loadTrackerParameters(XmlRpc::XmlRpcValue(), "/tracker/tracker");
  EXPECT_TRUE(parameters.problems.empty());
  EXPECT_EQ(parameters.config.filter.num_particles, FilterConfig().num_particles);
}

TEST(ParameterLoader, SetsEveryKindOfValue) {
  XmlRpc::XmlRpcValue map;
  map["num_particles"] = 33;
  map["tail_weight"] = 0.02;
  map["object_noise_stddev_m"] = 0.005;
  map["proposal"] = std::string("process");
  map["max_depth_m"] = 4;  // an int where a double is meant
  const auto parameters = loadTrackerParameters(map, "/tracker/tracker");
  for (const auto& problem : parameters.problems) ADD_FAILURE() << problem;
  EXPECT_EQ(parameters.config.filter.num_particles, 33);
  EXPECT_EQ(parameters.config.filter.proposal, Proposal::kProcess);
}

TEST(ParameterLoader, ReadsFilesThatHaveTheirOwnTrackerKey) {
  XmlRpc::XmlRpcValue map;
  map["tracker"]["num_particles"] = 33;
  map["tracker"]["seed"] = 5;
  map["num_particles"] = 44;  // set by hand beside the file: wins
  const auto parameters = loadTrackerParameters(map, "/tracker/tracker");
  for (const auto& problem : parameters.problems) ADD_FAILURE() << problem;
  EXPECT_EQ(parameters.config.filter.num_particles, 44);
  EXPECT_EQ(parameters.config.filter.seed, 5u);
}

TEST(ParameterLoader, NamesEveryProblem) {
  XmlRpc::XmlRpcValue map;
  map["num_partcles"] = 33;
  map["num_particles"] = -4;
  map["proposal"] = 2;
  map["seed"][0] = 1;
  const auto parameters = loadTrackerParameters(map, "/tracker/tracker");
  ASSERT_EQ(parameters.problems.size(), 4u);
  std::string all;
  for (const auto& problem : parameters.problems) all += problem + "\n";
  EXPECT_TRUE(mentions(all, "num_partcles")) << all;
  EXPECT_TRUE(mentions(all, "num_particles")) << all;  // the nearest key, and the one out of range
  EXPECT_TRUE(mentions(all, "-4")) << all;
  EXPECT_TRUE(mentions(all, "/tracker/tracker/seed")) << all;
}

TEST(ParameterLoader, RefusesSomethingElseThanAMap) {
  EXPECT_EQ(loadTrackerParameters(XmlRpc::XmlRpcValue(3), "/x/tracker").problems.size(), 1u);
}

}  // namespace
}  // namespace depth_object_tracker
