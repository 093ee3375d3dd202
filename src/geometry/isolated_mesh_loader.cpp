// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/geometry/isolated_mesh_loader.h"

#include "child_process.h"
#include "mesh_reply.h"
#include "mesh_source.h"

#include <dlfcn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <utility>

namespace depth_object_tracker {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "mesh_reader";

const char kAnchor = 0;

/// Folder of the library or program that this code is part of; empty when it cannot be told.
fs::path ownFolder() {
  Dl_info info{};
  if (dladdr(&kAnchor, &info) == 0 || info.dli_fname == nullptr) return {};
  std::error_code error;
  const fs::path file = fs::canonical(info.dli_fname, error);
  return error ? fs::path() : file.parent_path();
}

std::string join(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string findProgram(const std::string& given) {
  const std::vector<std::string> places = given.empty() ? listMeshReaderPlaces() : std::vector<std::string>{given};
  const auto found = std::find_if(places.begin(), places.end(),
                                  [](const std::string& place) { return ::access(place.c_str(), X_OK) == 0; });
  if (found != places.end()) return *found;
  throw MeshError("the program '" + std::string(kProgram) + "', which reads meshes, is not there; looked for " +
                  join(places) + ". Is the installation complete?");
}

std::string text(double number, int digits = 6) {
  std::ostringstream stream;
  stream.precision(digits);
  stream << number;
  return stream.str();
}

/// Why a process gave no answer.
std::string explain(const ChildOutcome& outcome, const MeshProcessLimits& limits) {
  if (!outcome.started)
    return std::string("the program that reads it cannot be started: ") + std::strerror(outcome.status);
  if (outcome.timed_out)
    return "reading it took longer than " + text(limits.wall_s) + " s: the file is damaged or too large";
  if (outcome.wrote_too_much) return "it has more triangles than are accepted; simplify the mesh first";
  if (!WIFSIGNALED(outcome.status)) return "";
  if (WTERMSIG(outcome.status) == SIGXCPU)
    return "reading it took more than " + std::to_string(limits.cpu_s) +
           " s of processor time: the file is damaged or too large";
  return "the process that read it was stopped by signal " + std::to_string(WTERMSIG(outcome.status)) +
         ": the file is damaged";
}

}  // namespace

std::vector<std::string> listMeshReaderPlaces() {
  const fs::path folder = ownFolder();
  if (folder.empty()) return {};
  const std::string package = "depth_object_tracker";
  std::vector<std::string> places;
  for (const fs::path& place :
       {folder / package, folder, folder / ".." / "libexec" / package, folder / ".." / ".." / "libexec" / package,
        folder / ".." / "lib" / package, folder / ".." / package}) {
    places.push_back((place / kProgram).lexically_normal().string());
  }
  return places;
}

IsolatedMeshLoader::IsolatedMeshLoader(PackageResolver resolve_package, FileAccess access, MeshProcessLimits limits,
                                       std::string program)
    : resolve_package_(std::move(resolve_package)),
      access_(std::move(access)),
      limits_(limits),
      program_(std::move(program)) {}

TriangleMesh IsolatedMeshLoader::operator()(const std::string& uri, double scale) const {
  const auto parse = [this](const InputFile& file, const std::string& extension, double file_scale) {
    const std::vector<std::string> command = {findProgram(program_), extension, text(file_scale, 17),
                                              std::to_string(limits_.memory_mib), std::to_string(limits_.cpu_s)};
    const ChildOutcome outcome = runChild(command, file.descriptor(), limits_.wall_s, limits_.reply_mib << 20);
    const std::string problem = explain(outcome, limits_);
    if (!problem.empty()) throw MeshError(problem);
    return decodeReply(outcome.output);
  };
  return loadMeshFrom(uri, scale, access_, resolve_package_, parse);
}

}  // namespace depth_object_tracker
