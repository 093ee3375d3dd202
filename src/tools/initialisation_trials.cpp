// SPDX-License-Identifier: BSD-3-Clause
// Command line: how often the tracker finds an object at the start, for every way of starting it.
#include "tools/initialisation_trial.h"

#include <sys/wait.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>

namespace dot = depth_object_tracker;
using dot::InitialisationMode;

namespace {

constexpr int kTrialsPerScene = 10;  // grasp, arm and clutter stay the same over them
constexpr double kLimitS = 2.0;      // on two cores

struct Options {
  std::vector<std::string> objects, modes{"FROM_POSE", "ON_TABLE", "IN_HAND", "GLOBAL"};
  std::string json;
  int trials = 200, frames = 30, jobs = 2, num_threads = 1;
  std::uint64_t seed = 1;
};

InitialisationMode modeFromName(const std::string& name) {
  for (const InitialisationMode mode : {InitialisationMode::kFromPose, InitialisationMode::kOnTable,
                                        InitialisationMode::kInHand, InitialisationMode::kGlobal}) {
    if (name == dot::modeName(mode)) return mode;
  }
  throw std::invalid_argument("mode '" + name + "' is not one of FROM_POSE, ON_TABLE, IN_HAND, GLOBAL");
}

// A mesh file, or an object YAML whose mesh lies beside the folder "config".
dot::ObjectModel loadAnyObject(const std::string& file) {
  if (file.size() > 5 && file.substr(file.size() - 5) == ".yaml") {
    return dot::loadObject(dot::loadObjectDescription(file), [&](const std::string&) {
      return std::filesystem::absolute(file).parent_path().parent_path().parent_path().string();
    });
  }
  dot::ObjectModel object;
  object.name = file.substr(file.rfind('/') + 1);
  object.mesh = dot::loadMesh(file);
  return object;
}

std::uint64_t trialSeed(const Options& options, int trial) {
  return options.seed * 100003 + static_cast<std::uint64_t>(trial);
}

nlohmann::json toJson(int trial, const dot::TrialOutcome& outcome) {
  return {{"trial", trial},
          {"frames", outcome.frames},
          {"compute_s", outcome.compute_s},
          {"add_m", outcome.add_m},
          {"wrong_frames", outcome.wrong_frames},
          {"undecidable", outcome.undecidable},
          {"plane_found", outcome.plane_found}};
}

/// Every `jobs`th block of trials, from block `job`; a line of JSON for each.
void runBlocks(const Options& options, const dot::ObjectModel& object, InitialisationMode mode, int job, FILE* out) {
  dot::TrackerConfig config;
  config.filter.num_threads = options.num_threads;
  dot::ObjectTracker tracker(object, config);
  const dot::PoseErrorMeter meter(object.mesh, object.symmetries);
  dot::ImageEvidence evidence(object.mesh, config);
  const bool on_table = mode == InitialisationMode::kOnTable;
  const dot::Scenario scenario = mode == InitialisationMode::kInHand ? dot::Scenario::kRobot : dot::Scenario::kHuman;
  for (int first = job * kTrialsPerScene; first < options.trials; first += options.jobs * kTrialsPerScene) {
    std::optional<dot::HeldScenes> held;
    if (!on_table) held.emplace(object, scenario, trialSeed(options, first));
    for (int trial = first; trial < std::min(options.trials, first + kTrialsPerScene); ++trial) {
      const dot::TrialScene scene =
          held ? held->next(options.frames) : dot::makeTableScene(object, options.frames, trialSeed(options, trial));
      const auto outcome = dot::runTrial(tracker, meter, evidence, scene, mode, trialSeed(options, trial));
      std::fprintf(out, "%s\n", toJson(trial, outcome).dump().c_str());
      std::fflush(out);
    }
  }
}

/// All trials of one object and mode, shared out to processes: their processor time is measured.
nlohmann::json runAll(const Options& options, const dot::ObjectModel& object, InitialisationMode mode) {
  std::vector<FILE*> outputs;
  std::vector<pid_t> children;
  for (int job = 0; job < options.jobs; ++job) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe to another process");
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("no other process can be started");
    if (child == 0) {
      close(ends[0]);
      try {
        runBlocks(options, object, mode, job, fdopen(ends[1], "w"));
      } catch (const std::exception& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        _exit(1);
      }
      _exit(0);
    }
    close(ends[1]);
    outputs.push_back(fdopen(ends[0], "r"));
    children.push_back(child);
  }
  std::vector<nlohmann::json> trials;
  for (FILE* output : outputs) {
    char line[1000];
    while (std::fgets(line, sizeof(line), output) != nullptr) trials.push_back(nlohmann::json::parse(line));
    std::fclose(output);
  }
  bool failed = false;
  for (const pid_t child : children) {
    int status = 0;
    waitpid(child, &status, 0);
    failed = failed || status != 0;
  }
  if (failed) throw std::runtime_error("trials of '" + object.name + "' failed");
  std::sort(trials.begin(), trials.end(), [](const auto& a, const auto& b) { return a["trial"] < b["trial"]; });
  return trials;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

nlohmann::json summarise(const nlohmann::json& trials) {
  std::vector<double> frames, seconds;
  int in_time = 0, wrong = 0, planes = 0, undecidable = 0;
  for (const auto& trial : trials) {
    wrong += trial["wrong_frames"] > 0 ? 1 : 0;
    planes += trial["plane_found"] ? 1 : 0;
    undecidable += trial["undecidable"] ? 1 : 0;
    if (trial["frames"] == 0) continue;
    frames.push_back(trial["frames"]);
    seconds.push_back(trial["compute_s"]);
    in_time += seconds.back() < 2.0 * kLimitS ? 1 : 0;
  }
  const double count = std::max<double>(1.0, static_cast<double>(trials.size()));
  return {
      {"trials", trials.size()},
      {"success", static_cast<double>(frames.size()) / count},
      {"success_within_4_processor_seconds", in_time / count},
      {"undecidable", undecidable / count},
      {"success_where_decidable", frames.empty() ? 0.0 : static_cast<double>(frames.size()) / (count - undecidable)},
      {"wrong_for_a_while", wrong / count},
      {"plane_found", planes / count},
      {"frames_median", quantile(frames, 0.5)},
      {"frames_90", quantile(frames, 0.9)},
      {"processor_s_median", quantile(seconds, 0.5)},
      {"processor_s_90", quantile(seconds, 0.9)}};
}

void runTrials(const Options& options) {
  nlohmann::json report;
  std::printf("%-22s %-9s %6s %8s %8s %9s %7s %6s %7s %7s %7s %7s\n", "object", "mode", "trials", "success", "in 4 s",
              "decidable", "wrong", "plane", "frames", "90 %", "proc s", "90 %");
  for (const std::string& file : options.objects) {
    const dot::ObjectModel object = loadAnyObject(file);
    for (const std::string& name : options.modes) {
      const nlohmann::json trials = runAll(options, object, modeFromName(name));
      const nlohmann::json s = summarise(trials);
      const auto percent = [&](const char* key) { return 100.0 * s[key].get<double>(); };
      std::printf("%-22s %-9s %6zu %7.1f%% %7.1f%% %8.1f%% %6.1f%% %5.0f%% %7.0f %7.0f %7.2f %7.2f\n",
                  object.name.c_str(), name.c_str(), trials.size(), percent("success"),
                  percent("success_within_4_processor_seconds"), percent("success_where_decidable"),
                  percent("wrong_for_a_while"), percent("plane_found"), s["frames_median"].get<double>(),
                  s["frames_90"].get<double>(), s["processor_s_median"].get<double>(),
                  s["processor_s_90"].get<double>());
      std::fflush(stdout);
      report.push_back({{"object", object.name}, {"mode", name}, {"summary", s}, {"trials", trials}});
    }
  }
  if (!options.json.empty()) std::ofstream(options.json) << report.dump(1) << '\n';
}

int run(int argc, char** argv) {
  CLI::App app("Starts the tracker again and again on simulated frames and counts how often it finds the object.");
  Options options;
  app.add_option("objects", options.objects, "object YAMLs, or meshes in metres")->required();
  app.add_option("--modes", options.modes, "FROM_POSE, ON_TABLE, IN_HAND, GLOBAL")->delimiter(',');
  app.add_option("--trials", options.trials, "per object and mode")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--frames", options.frames, "that a trial may take")
      ->check(CLI::Range(3, 1000))
      ->capture_default_str();
  app.add_option("--seed", options.seed)->capture_default_str();
  app.add_option("--jobs", options.jobs, "processes")->check(CLI::Range(1, 256))->capture_default_str();
  app.add_option("--num-threads", options.num_threads, "of each tracker")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--json", options.json, "file for all trials");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  runTrials(options);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
}
