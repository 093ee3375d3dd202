// SPDX-License-Identifier: BSD-3-Clause
// package:// and file:// to paths.
#include "depth_object_tracker/geometry/mesh_loader.h"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace depth_object_tracker {
namespace {

bool startsWith(const std::string& text, const std::string& prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

/// `%20` -> space, as file URIs demand; anything that is no escape stays as it is.
std::string decodePercent(const std::string& text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_escape = text[i] == '%' && i + 2 < text.size() &&
                           std::isxdigit(static_cast<unsigned char>(text[i + 1])) &&
                           std::isxdigit(static_cast<unsigned char>(text[i + 2]));
    decoded += is_escape ? static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16)) : text[i];
    if (is_escape) i += 2;
  }
  return decoded;
}

/// Package finders take the name for a command line.
bool isPackageName(const std::string& name) {
  const auto is_plain = [](unsigned char letter) {
    return std::isalnum(letter) != 0 || letter == '_' || letter == '-';
  };
  return !name.empty() && name.front() != '-' && std::all_of(name.begin(), name.end(), is_plain);
}

/// NAME of package://NAME/PATH.
std::string packageName(const std::string& uri) {
  const std::size_t begin = std::strlen("package://");
  return uri.substr(begin, std::min(uri.find('/', begin), uri.size()) - begin);
}

std::string resolvePackageUri(const std::string& uri, const PackageResolver& resolve_package) {
  const std::string rest = uri.substr(std::strlen("package://"));
  const std::size_t slash = rest.find('/');
  const std::string package = packageName(uri);
  if (package.empty() || slash == std::string::npos || slash + 1 == rest.size()) {
    throw MeshError("mesh " + uri + ": expected package://NAME/PATH.");
  }
  if (!isPackageName(package)) throw MeshError("mesh " + uri + ": '" + package + "' is not the name of a package.");
  if (!resolve_package) {
    throw MeshError("mesh " + uri + ": package:// names cannot be looked up here; give the file's path.");
  }
  const std::string folder = resolve_package(package);
  if (folder.empty()) {
    throw MeshError("mesh " + uri + ": package '" + package +
                    "' was not found; is its workspace sourced (ROS_PACKAGE_PATH)?");
  }
  return folder + rest.substr(slash);
}

}  // namespace

std::string packageFolder(const std::string& uri, const PackageResolver& resolve_package) {
  if (!startsWith(uri, "package://") || !resolve_package || !isPackageName(packageName(uri))) return "";
  return resolve_package(packageName(uri));
}

std::string resolveMeshUri(const std::string& uri, const PackageResolver& resolve_package) {
  if (uri.empty()) throw MeshError("mesh: the path is empty.");
  if (uri.find('\0') != std::string::npos) throw MeshError("mesh: the path contains a zero byte.");
  if (startsWith(uri, "package://")) return resolvePackageUri(uri, resolve_package);
  if (startsWith(uri, "file://")) {
    std::string path = decodePercent(uri.substr(std::strlen("file://")));
    if (startsWith(path, "localhost/")) path.erase(0, std::strlen("localhost"));
    if (path.empty()) throw MeshError("mesh " + uri + ": expected file://PATH.");
    return path;
  }
  const std::size_t scheme_end = uri.find("://");
  if (scheme_end != std::string::npos) {
    throw MeshError("mesh " + uri + ": '" + uri.substr(0, scheme_end) +
                    "://' is not supported; use package://, file:// or a path.");
  }
  return uri;
}

}  // namespace depth_object_tracker
