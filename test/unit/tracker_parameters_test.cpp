// SPDX-License-Identifier: BSD-3-Clause
// The parameter table against the structs and the shipped files, and each complaint about bad values.
#include "depth_object_tracker/tracker/tracker_parameters.h"

#include "count_fields.h"
#include "parameter_table.h"
#include "parameter_yaml.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace depth_object_tracker {
namespace {

std::map<std::string, ParameterValue> allValues(const TrackerConfig& config) {
  std::map<std::string, ParameterValue> values;
  for (const ParameterInfo& parameter : listTrackerParameters())
    values[parameter.name] = getTrackerParameter(config, parameter.name);
  return values;
}

TEST(TrackerParameters, EveryFieldIsInTheTable) {
  const std::size_t num_fields =
      countFields<PixelModelConfig>() + countFields<OcclusionChainConfig>() + countFields<ProcessConfig>() +
      countFields<SlipConfig>() + countFields<FilterConfig>() + countFields<ResolutionConfig>() +
      countFields<InitialisationConfig>() + countFields<StatusConfig>() + countFields<BudgetConfig>();
  EXPECT_EQ(listTrackerParameters().size(), num_fields)
      << "a field of a config struct has no line in src/tracker/tracker_parameters.cpp";
}

TEST(TrackerParameters, NamesAreUniqueAndDescribed) {
  std::set<std::string> names;
  for (const ParameterInfo& parameter : listTrackerParameters()) {
    EXPECT_TRUE(names.insert(parameter.name).second) << parameter.name;
    EXPECT_FALSE(parameter.description.empty()) << parameter.name;
    EXPECT_FALSE(parameter.valid_range.empty()) << parameter.name;
  }
}

TEST(TrackerParameters, DefaultsAreTheStructs) {
  const TrackerConfig defaults;
  EXPECT_NO_THROW(validateTrackerConfig(defaults));
  for (const ParameterInfo& parameter : listTrackerParameters()) {
    EXPECT_EQ(parameter.default_value, getTrackerParameter(defaults, parameter.name)) << parameter.name;
    // A default can be set again: it is of its own type and range.
    TrackerConfig config;
    EXPECT_NO_THROW(setTrackerParameter(config, parameter.name, parameter.default_value)) << parameter.name;
  }
}

TEST(TrackerParameters, EachParameterChangesOneFieldOfItsOwn) {
  const auto defaults = allValues(TrackerConfig());
  for (const auto& [name, value] : defaults) {
    TrackerConfig config;
    bool was_set = false;
    const std::vector<ParameterValue> others = {
        0.015, 0.5, 0.25, 0.95, 2.0, 3, 60, true, false, std::string("paper"), std::string("process")};
    for (const ParameterValue& other : others) {
      if (was_set || other == value) continue;
      try {
        setTrackerParameter(config, name, other);
        was_set = getTrackerParameter(config, name) != value;
      } catch (const std::invalid_argument&) {
      }
    }
    EXPECT_TRUE(was_set) << name;
    for (const auto& [other_name, other_value] : allValues(config)) {
      if (other_name == name) continue;
      EXPECT_EQ(other_value, defaults.at(other_name)) << name << " changed " << other_name;
    }
  }
}

TEST(TrackerParameters, EnumerationsAreWords) {
  TrackerConfig config;
  setTrackerParameter(config, "proposal", std::string("process"));
  EXPECT_EQ(config.filter.proposal, Proposal::kProcess);
  setTrackerParameter(config, "occluder_model", std::string("paper"));
  EXPECT_EQ(config.pixel.occluder_model, OccluderModel::kPaper);
  EXPECT_EQ(getTrackerParameter(config, "proposal"), ParameterValue(std::string("process")));
}

TEST(TrackerParameters, DownsamplingKnowsAuto) {
  TrackerConfig config;
  setTrackerParameter(config, "downsampling", 5);
  EXPECT_EQ(config.resolution.downsampling, 5);
  setTrackerParameter(config, "downsampling", std::string("auto"));
  EXPECT_EQ(config.resolution.downsampling, 0);
}

TEST(TrackerParameters, IntegersAndNumberTextsServeAsReals) {
  TrackerConfig config;
  setTrackerParameter(config, "max_depth_m", 4);
  EXPECT_EQ(config.pixel.max_depth_m, 4.0);
  setTrackerParameter(config, "tail_weight", std::string("1e-3"));
  EXPECT_EQ(config.pixel.tail_weight, 1e-3);
}

std::string complaint(const std::string& name, const ParameterValue& value) {
  TrackerConfig config;
  const TrackerConfig before = config;
  const std::string message = messageOf<std::invalid_argument>([&] { setTrackerParameter(config, name, value); });
  EXPECT_EQ(allValues(config), allValues(before)) << "a refused value must not be set";
  return message;
}

TEST(TrackerParameters, BadValuesNameKeyValueAndRange) {
  EXPECT_EQ(complaint("num_particles", 0), "parameter `num_particles` is 0; it must be an integer in [1, 100000]");
  EXPECT_EQ(complaint("num_particles", 50.0),
            "parameter `num_particles` is 50.0; it must be an integer in [1, 100000]");
  EXPECT_EQ(complaint("tail_weight", 0.75), "parameter `tail_weight` is 0.75; it must be a number in [1e-06, 0.5]");
  EXPECT_EQ(complaint("tail_weight", std::numeric_limits<double>::quiet_NaN()),
            "parameter `tail_weight` is nan; it must be a number in [1e-06, 0.5]");
  EXPECT_EQ(complaint("max_depth_m", std::numeric_limits<double>::infinity()),
            "parameter `max_depth_m` is inf; it must be a number in [0.1, 100]");
  EXPECT_EQ(complaint("max_depth_m", std::string("far")),
            "parameter `max_depth_m` is 'far'; it must be a number in [0.1, 100]");
  EXPECT_EQ(complaint("max_depth_m", std::string("2.0m")),
            "parameter `max_depth_m` is '2.0m'; it must be a number in [0.1, 100]");
  EXPECT_EQ(complaint("max_depth_m", true), "parameter `max_depth_m` is true; it must be a number in [0.1, 100]");
  EXPECT_EQ(complaint("proposal", std::string("fast")),
            "parameter `proposal` is 'fast'; it must be informed | process");
  EXPECT_EQ(complaint("proposal", 1), "parameter `proposal` is 1; it must be informed | process");
  EXPECT_EQ(complaint("downsampling", -1), "parameter `downsampling` is -1; it must be an integer in [0, 64] | auto");
  EXPECT_EQ(complaint("downsampling", std::string("automatic")),
            "parameter `downsampling` is 'automatic'; it must be an integer in [0, 64] | auto");
  EXPECT_EQ(complaint("seed", -1), "parameter `seed` is -1; it must be an integer in [0, 2147483647]");
}

TEST(TrackerParameters, UnknownNamesGetTheNearestOne) {
  EXPECT_EQ(complaint("num_particle", 1),
            "parameter `num_particle` is unknown; the nearest known one is `num_particles`");
  EXPECT_EQ(complaint("seeds", 1), "parameter `seeds` is unknown; the nearest known one is `seed`");
  EXPECT_EQ(complaint("max_depth", 1), "parameter `max_depth` is unknown; the nearest known one is `max_depth_m`");
  EXPECT_NE(complaint("", 1).find("is unknown"), std::string::npos);
  EXPECT_NE(complaint(std::string(1000000, 'x'), 1).find("is unknown"), std::string::npos);
  EXPECT_THROW(getTrackerParameter(TrackerConfig(), "nothing"), std::invalid_argument);
}

TEST(TrackerParameters, ValidationFindsFieldsSetInCode) {
  TrackerConfig config;
  config.filter.num_particles = -3;
  EXPECT_EQ(messageOf<std::invalid_argument>([&] { validateTrackerConfig(config); }),
            "parameter `num_particles` is -3; it must be an integer in [1, 100000]");
  config = TrackerConfig();
  config.filter.proposal = static_cast<Proposal>(7);
  EXPECT_THROW(validateTrackerConfig(config), std::invalid_argument);
  config = TrackerConfig();
  config.occlusion.p_visible_given_visible = 0.2;
  EXPECT_EQ(messageOf<std::invalid_argument>([&] { validateTrackerConfig(config); }),
            "parameter `p_visible_given_visible` is 0.2; it must be not less than p_visible_given_occluded (0.3)");
}

class ParameterFile : public testing::Test {
 protected:
  TrackerConfig read(const std::string& content) { return loadTrackerConfig(folder_.write("p.yaml", content)); }
  void expectComplaint(const std::string& content, const std::string& expected) {
    const std::string message = messageOf<std::invalid_argument>([&] { read(content); });
    EXPECT_NE(message.find("p.yaml: "), std::string::npos) << message;
    EXPECT_NE(message.find(expected), std::string::npos) << message;
  }
  TemporaryFolder folder_;
};

TEST_F(ParameterFile, FlatAndBelowTracker) {
  for (const char* content : {"num_particles: 7\ntail_weight: 1e-3\nproposal: process\n",
                              "tracker:\n  num_particles: 7\n  tail_weight: 1e-3\n  proposal: 'process'\n"}) {
    const TrackerConfig config = read(content);
    EXPECT_EQ(config.filter.num_particles, 7);
    EXPECT_EQ(config.pixel.tail_weight, 1e-3);
    EXPECT_EQ(config.filter.proposal, Proposal::kProcess);
    EXPECT_EQ(config.filter.prior_share, FilterConfig().prior_share);
  }
}

TEST_F(ParameterFile, EmptyFilesMeanDefaults) {
  for (const char* content : {"", "# nothing\n", "tracker:\n", "{}"})
    EXPECT_EQ(allValues(read(content)), allValues(TrackerConfig()));
}

TEST_F(ParameterFile, ProblemsNameFileAndKey) {
  EXPECT_NE(
      messageOf<std::invalid_argument>([] { loadTrackerConfig("/none.yaml"); }).find("/none.yaml: there is no such"),
      std::string::npos);
  expectComplaint("num_particles: [", "not valid YAML");
  expectComplaint("- 1\n", "expected a map");
  expectComplaint("tracker: 5\n", "expected a map");
  expectComplaint("num_particle: 7\n", "`num_particle` is unknown; the nearest known one is `num_particles`");
  expectComplaint("tracker: {}\nseed: 1\n", "`tracker` is unknown");
  expectComplaint("num_particles: 0\n", "`num_particles` is 0; it must be an integer in [1, 100000]");
  expectComplaint("num_particles: '5'\n", "`num_particles` is '5'; it must be an integer");
  expectComplaint("num_particles: 0x10\n", "`num_particles` is '0x10'; it must be an integer");
  expectComplaint("num_particles: 010\n", "`num_particles` is 10.0; it must be an integer");
  expectComplaint("num_particles: 99999999999\n", "it must be an integer in [1, 100000]");
  expectComplaint("num_particles:\n", "`num_particles` must be a single value");
  expectComplaint("tail_weight: [1, 2]\n", "`tail_weight` must be a single value");
  expectComplaint("tail_weight: .nan\n", "`tail_weight` is ");
  expectComplaint("tail_weight: .inf\n", "`tail_weight` is inf; it must be");
  expectComplaint("seed: 1\nseed: 2\n", "`seed` is given twice");
  expectComplaint("? [a]\n: 1\n", "a key that is not a word");
  expectComplaint("p_visible_given_visible: 0.2\n", "it must be not less than p_visible_given_occluded");
  expectComplaint("&a\ntracker: *a\n", "is unknown");
  expectComplaint(std::string(100000, '['), "not valid YAML");
}

/// UPDATE_TRACKER_YAML=1 in the environment writes the file anew, for who adds or changes a parameter.
TEST(ShippedParameters, TrackerYamlHoldsEveryDefault) {
  const std::string path = PROJECT_SOURCE_FOLDER "/config/tracker.yaml";
  if (std::getenv("UPDATE_TRACKER_YAML") != nullptr) std::ofstream(path) << renderTrackerYaml();
  std::ifstream file(path);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_EQ(text, renderTrackerYaml()) << "run this test once with UPDATE_TRACKER_YAML=1 in the environment";
  // What the file says, read back, is every default and nothing else.
  TrackerConfig config;
  ASSERT_NO_THROW(config = loadTrackerConfig(path));
  for (const auto& [name, value] : allValues(TrackerConfig()))
    EXPECT_EQ(getTrackerParameter(config, name), value) << name;
  std::set<std::string> keys;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.compare(0, 2, "  ") == 0 && line[2] != '#') keys.insert(line.substr(2, line.find(':') - 2));
  }
  for (const ParameterInfo& parameter : listTrackerParameters())
    EXPECT_EQ(keys.count(parameter.name), 1u) << parameter.name;
  EXPECT_EQ(keys.size(), listTrackerParameters().size());
}

TEST(ShippedParameters, BeamYamlRemembersNothing) {
  const TrackerConfig config = loadTrackerConfig(PROJECT_SOURCE_FOLDER "/config/beam.yaml");
  EXPECT_EQ(config.occlusion.p_visible_given_visible, config.occlusion.p_visible_given_occluded);
  EXPECT_EQ(config.occlusion.initial_p_occluded, 1.0 - config.occlusion.p_visible_given_visible);
}

TEST(ShippedParameters, PaperYamlIsThePapersFilter) {
  const TrackerConfig config = loadTrackerConfig(PROJECT_SOURCE_FOLDER "/config/paper.yaml");
  const std::map<std::string, ParameterValue> paper = {{"proposal", std::string("process")},
                                                       {"occluder_model", std::string("paper")},
                                                       {"num_particles", 200},
                                                       {"downsampling", 5},
                                                       {"likelihood_exponent", 1.0},
                                                       {"resampling_threshold", 1.0},
                                                       {"velocity_half_life_s", 0.0},
                                                       {"sudden_motion_share", 0.0},
                                                       {"diffusion_full_above_visible_fraction", 0.0},
                                                       {"edge_stddev_px", 0.0},
                                                       {"object_noise_stddev_m", 0.003},
                                                       {"depth_noise_per_m", 1.425e-3},
                                                       {"tail_weight", 0.01},
                                                       {"max_depth_m", 6.0},
                                                       {"occluder_half_life_m", 1.0},
                                                       {"p_visible_given_visible", 0.9},
                                                       {"p_visible_given_occluded", 0.3},
                                                       {"initial_p_occluded", 0.25}};
  for (const auto& [name, value] : paper) EXPECT_EQ(getTrackerParameter(config, name), value) << name;
  // Whatever a description calls the paper's value is what this file has.
  for (const ParameterInfo& parameter : listTrackerParameters()) {
    const std::size_t mark = parameter.description.find("(the paper)");
    if (mark == std::string::npos) continue;
    const std::size_t equals = parameter.description.rfind(" = ", mark);
    const std::size_t begin = parameter.description.find_last_of(" ;", equals - 1) + 1;
    const std::string expected = parameter.description.substr(begin, equals - begin);
    const std::string value = formatForYaml(getTrackerParameter(config, parameter.name));
    EXPECT_TRUE(value == expected || value == expected + ".0")
        << parameter.name << " is " << value << ", not " << expected;
  }
}

/// UPDATE_PARAMETER_TABLE=1 in the environment writes the table anew.
TEST(ShippedParameters, DocumentationHoldsTheTable) {
  const std::string path = PROJECT_SOURCE_FOLDER "/doc/parameters.md";
  std::ifstream file(path);
  std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::string begin_mark = "<!-- table made from the code, begin -->\n", end_mark = "<!-- end -->\n";
  const std::size_t begin = text.find(begin_mark), end = text.find(end_mark);
  ASSERT_NE(begin, std::string::npos);
  ASSERT_NE(end, std::string::npos);
  const std::size_t first = begin + begin_mark.size();
  if (std::getenv("UPDATE_PARAMETER_TABLE") != nullptr) {
    text.replace(first, end - first, renderParameterTable());
    std::ofstream(path) << text;
    return;
  }
  EXPECT_EQ(text.substr(first, end - first), renderParameterTable())
      << "run this test once with UPDATE_PARAMETER_TABLE=1 in the environment";
}

}  // namespace
}  // namespace depth_object_tracker
