// SPDX-License-Identifier: BSD-3-Clause
// Files that others name: only regular ones, only in the places that are allowed, whatever the name looks like.
#include "depth_object_tracker/geometry/file_access.h"

#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace depth_object_tracker {
namespace {

namespace fs = std::filesystem;

class FileAccessTest : public testing::Test {
 protected:
  FileAccessTest() {
    fs::create_directories(open_ / "below");
    fs::create_directories(closed_);
    write(open_ / "a.obj");
    write(open_ / "below/b.obj");
    write(closed_ / "secret.obj");
  }
  void write(const fs::path& file) { folder_.write(fs::relative(file, folder_.path()).string(), "content"); }

  /// What the file holds, or why it is refused.
  std::string read(const fs::path& path) {
    try {
      return InputFile(path, 100, access()).read();
    } catch (const FileError& error) {
      return error.what();
    }
  }
  FileAccess access() const { return FileAccess::only({open_.string()}, "; ask for more"); }

  TemporaryFolder folder_;
  const fs::path open_ = folder_.path() / "open", closed_ = folder_.path() / "open_not";
};

constexpr const char* kOutside =
    "it lies outside of the folders that may be read, or leads out of them by a link; ask for more";

TEST_F(FileAccessTest, ReadsWhatLiesInAnAllowedFolder) {
  EXPECT_EQ(read(open_ / "a.obj"), "content");
  EXPECT_EQ(read(open_ / "below/b.obj"), "content");
  EXPECT_EQ(read(open_ / "./below//b.obj"), "content");
}

TEST_F(FileAccessTest, RefusesWhatLiesOutside) {
  EXPECT_EQ(read(closed_ / "secret.obj"), kOutside);  // whose folder's name begins like the allowed one's
  EXPECT_EQ(read("/etc/passwd"), kOutside);
  EXPECT_EQ(read("relative.obj"), kOutside);
  EXPECT_EQ(read("/no/such/file.obj"), kOutside) << "a refusal must not tell what exists";
}

TEST_F(FileAccessTest, RefusesDotsEvenWhereTheyLeadInside) {
  for (const char* path : {"../open_not/secret.obj", "below/../../open_not/secret.obj", "below/../a.obj"}) {
    EXPECT_EQ(read(open_ / path), "a path with '..' is not accepted") << path;
  }
}

TEST_F(FileAccessTest, RefusesLinksThatLeadOut) {
  fs::create_symlink(closed_ / "secret.obj", open_ / "link.obj");
  fs::create_symlink("../open_not/secret.obj", open_ / "relative_link.obj");
  fs::create_directory_symlink(closed_, open_ / "linked_folder");
  fs::create_symlink("link.obj", open_ / "link_to_link.obj");
  for (const char* path : {"link.obj", "relative_link.obj", "linked_folder/secret.obj", "link_to_link.obj"}) {
    EXPECT_EQ(read(open_ / path), kOutside) << path;
  }
}

TEST_F(FileAccessTest, FollowsLinksThatStayInside) {
  fs::create_symlink("below/b.obj", open_ / "link.obj");
  EXPECT_EQ(read(open_ / "link.obj"), "content");
}

TEST_F(FileAccessTest, AnAllowedFolderMayBeALinkItself) {
  fs::create_directory_symlink(open_, folder_.path() / "workspace");
  const FileAccess by_link = FileAccess::only({(folder_.path() / "workspace").string() + "/"});
  EXPECT_EQ(InputFile(folder_.path() / "workspace/a.obj", 100, by_link).read(), "content");
  EXPECT_EQ(InputFile(open_ / "a.obj", 100, by_link).read(), "content");
}

TEST_F(FileAccessTest, ASingleFileMayBeAllowed) {
  const FileAccess one = FileAccess::only({}).with((open_ / "a.obj").string());
  EXPECT_EQ(InputFile(open_ / "a.obj", 100, one).read(), "content");
  EXPECT_THROW(InputFile(open_ / "below/b.obj", 100, one), FileError);
}

TEST_F(FileAccessTest, NothingIsAllowedByAnEmptyList) {
  EXPECT_THROW(InputFile(open_ / "a.obj", 100, FileAccess::only({})), FileError);
  EXPECT_THROW(InputFile(open_ / "a.obj", 100, FileAccess::only({""})), FileError);
}

TEST_F(FileAccessTest, WhatIsNoFileIsRefusedAtOnce) {
  const fs::path pipe = open_ / "pipe.obj", device = open_ / "device.obj", socket_file = open_ / "socket.obj";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);  // opening it would wait for a writer for ever
  EXPECT_EQ(read(pipe), "is not a regular file");
  const int socket_end = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  socket_file.string().copy(address.sun_path, sizeof(address.sun_path) - 1);
  ASSERT_EQ(bind(socket_end, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  EXPECT_EQ(read(socket_file), "is not a regular file");
  close(socket_end);
  EXPECT_EQ(read(open_), "is a folder; give the path of the file in it");
  EXPECT_EQ(read(open_ / "none.obj"), "the file does not exist");
  EXPECT_EQ(read(open_ / "a.obj/none.obj"), "the file does not exist");
  EXPECT_THROW(InputFile("/dev/zero", 100), FileError);
}

TEST_F(FileAccessTest, AFileThatIsReplacedAfterTheCheckIsNotRead) {
  const InputFile file(open_ / "a.obj", 100, access());
  fs::remove(open_ / "a.obj");
  fs::create_symlink("/etc/passwd", open_ / "a.obj");
  EXPECT_EQ(file.read(), "content");
}

TEST_F(FileAccessTest, SizeIsLimited) {
  fs::resize_file(open_ / "a.obj", 101);
  EXPECT_EQ(read(open_ / "a.obj"), "the file has 101 bytes, more than the 100 bytes that are accepted");
}

}  // namespace
}  // namespace depth_object_tracker
