// SPDX-License-Identifier: BSD-3-Clause
// What is checked is what is opened: every answer comes from a descriptor, never from a name that may change meanwhile.
#include "depth_object_tracker/geometry/file_access.h"

#include <fcntl.h>
#include <limits.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace depth_object_tracker {
namespace {

namespace fs = std::filesystem;

bool isBelow(const fs::path& path, const fs::path& place) {
  const auto [end_of_place, rest] = std::mismatch(place.begin(), place.end(), path.begin(), path.end());
  return end_of_place == place.end();
}

/// Closes what it holds when it goes.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return value_; }
  int release() { return std::exchange(value_, -1); }

 private:
  int value_;
};

/// Looks the file up without opening it: a device or pipe notices nothing.
int lookUp(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_PATH | O_CLOEXEC);
  if (descriptor >= 0) return descriptor;
  if (errno == ENOENT || errno == ENOTDIR) throw FileError("the file does not exist");
  throw FileError(std::string("cannot be looked up: ") + std::strerror(errno));
}

std::string linkOf(int descriptor) {
  return "/proc/self/fd/" + std::to_string(descriptor);
}

fs::path realPath(int descriptor) {
  char path[PATH_MAX];
  const ssize_t length = ::readlink(linkOf(descriptor).c_str(), path, sizeof(path));
  if (length <= 0 || length >= static_cast<ssize_t>(sizeof(path))) throw FileError("its place cannot be found out");
  return std::string(path, static_cast<std::size_t>(length));
}

void checkKind(int descriptor) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) throw FileError("cannot be looked up");
  if (S_ISDIR(status.st_mode)) throw FileError("is a folder; give the path of the file in it");
  if (!S_ISREG(status.st_mode)) throw FileError("is not a regular file");
}

std::uintmax_t checkSize(int descriptor, std::uintmax_t max_bytes) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) throw FileError("its size cannot be read");
  const auto size = static_cast<std::uintmax_t>(status.st_size);
  if (size <= max_bytes) return size;
  const bool in_mib = max_bytes >= (1u << 20);
  const auto format = [in_mib](std::uintmax_t bytes) {
    return in_mib ? std::to_string(bytes >> 20) + " MiB" : std::to_string(bytes) + " bytes";
  };
  throw FileError("the file has " + format(size) + ", more than the " + format(max_bytes) + " that are accepted");
}

}  // namespace

FileAccess FileAccess::only(const std::vector<std::string>& places, const std::string& advice) {
  FileAccess access;
  access.advice_ = advice;
  access.is_restricted_ = true;
  for (const std::string& place : places) access = access.with(place);
  return access;
}

FileAccess FileAccess::with(const std::string& place) const {
  FileAccess more = *this;
  if (place.empty() || !is_restricted_) return more;
  std::error_code error;
  fs::path given = fs::absolute(place, error).lexically_normal();
  if (!given.has_filename()) given = given.parent_path();  // "folder/" -> "folder"
  const fs::path real = fs::canonical(given, error);
  more.places_.push_back({given, error ? given : real});
  return more;
}

void FileAccess::checkName(const fs::path& path) const {
  if (!is_restricted_) return;
  if (std::find(path.begin(), path.end(), "..") != path.end()) throw FileError("a path with '..' is not accepted");
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error).lexically_normal();
  const bool is_allowed = std::any_of(places_.begin(), places_.end(), [&](const Place& place) {
    return isBelow(absolute, place.given) || isBelow(absolute, place.real);
  });
  if (!is_allowed) refuse();
}

void FileAccess::checkRealPath(const fs::path& real_path) const {
  if (!is_restricted_) return;
  const bool is_allowed =
      std::any_of(places_.begin(), places_.end(), [&](const Place& place) { return isBelow(real_path, place.real); });
  if (!is_allowed) refuse();
}

void FileAccess::refuse() const {
  throw FileError("it lies outside of the folders that may be read, or leads out of them by a link" + advice_);
}

InputFile::InputFile(const fs::path& path, std::uintmax_t max_bytes, const FileAccess& access) {
  access.checkName(path);
  const Descriptor place(lookUp(path));
  if (access.isRestricted()) access.checkRealPath(realPath(place.get()));
  checkKind(place.get());
  Descriptor file(::open(linkOf(place.get()).c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  if (file.get() < 0) throw FileError("the file cannot be opened: check its permissions");
  size_ = checkSize(file.get(), max_bytes);
  descriptor_ = file.release();
}

InputFile::~InputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::string InputFile::read() const {
  std::string content(size_, '\0');
  std::size_t done = 0;
  while (done < content.size()) {
    const ssize_t count = ::pread(descriptor_, &content[done], content.size() - done, static_cast<off_t>(done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw FileError(std::string("the file cannot be read: ") + std::strerror(errno));
    if (count == 0) break;  // it has shrunk meanwhile
    done += static_cast<std::size_t>(count);
  }
  content.resize(done);
  return content;
}

}  // namespace depth_object_tracker
