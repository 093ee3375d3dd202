// SPDX-License-Identifier: BSD-3-Clause
// Opens files that others name: only regular ones, of a limited size, in places that are allowed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// What is wrong with a file and what to do, without its name: "does not exist".
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Where files may lie. Made by default: everywhere.
class FileAccess {
 public:
  FileAccess() = default;

  /// @param places folders (with all that is below them) and single files; empty strings are left out.
  /// @param advice what to do about a refusal.
  static FileAccess only(const std::vector<std::string>& places, const std::string& advice = "");

  /// One more place; the same where `place` is empty or everything is allowed.
  FileAccess with(const std::string& place) const;

  bool isRestricted() const { return is_restricted_; }

  /// @throws FileError when the path as it is written has a `..` or begins outside of the places. Asks no file system.
  void checkName(const std::filesystem::path& path) const;

  /// @throws FileError when a path without links lies outside of the places.
  void checkRealPath(const std::filesystem::path& real_path) const;

 private:
  struct Place {
    std::filesystem::path given;  ///< absolute
    std::filesystem::path real;   ///< without links
  };
  [[noreturn]] void refuse() const;

  bool is_restricted_ = false;
  std::vector<Place> places_;
  std::string advice_;
};

/// An open regular file. Whatever its name leads to later, this is what was checked.
class InputFile {
 public:
  /// Opens nothing but a regular file: devices, pipes and folders are refused before they are touched.
  /// @throws FileError also when it is larger than `max_bytes`.
  InputFile(const std::filesystem::path& path, std::uintmax_t max_bytes, const FileAccess& access = {});
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  int descriptor() const { return descriptor_; }
  std::uintmax_t size() const { return size_; }

  /// All of it. @throws FileError when it cannot be read.
  std::string read() const;

 private:
  int descriptor_ = -1;
  std::uintmax_t size_ = 0;
};

}  // namespace depth_object_tracker
