// SPDX-License-Identifier: BSD-3-Clause
// Meshes read in a process of their own: the same result, the same sentences, and whatever becomes of that process.
#include "depth_object_tracker/geometry/isolated_mesh_loader.h"

#include "geometry/mesh_reply.h"
#include "mesh_files.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <future>
#include <limits>
#include <string>
#include <vector>

namespace depth_object_tracker {
namespace {

namespace fs = std::filesystem;

class IsolatedMesh : public testing::Test {
 protected:
  /// A program that takes mesh_reader's place.
  std::string writeProgram(const std::string& script) {
    const std::string program = folder_.write("program", "#!/bin/bash\n" + script + "\n");
    fs::permissions(program, fs::perms::owner_all);
    return program;
  }
  std::string messageWith(const std::string& script, double wall_s = 60.0) {
    MeshProcessLimits limits;
    limits.reply_mib = 8;
    limits.wall_s = wall_s;
    const IsolatedMeshLoader load({}, {}, limits, writeProgram(script));
    return messageOf<MeshError>([&] { load(folder_.write("a.obj", tetrahedronObj())); });
  }
  std::string messageFor(const std::string& name, const std::string& content, const MeshProcessLimits& limits = {}) {
    const IsolatedMeshLoader load({}, {}, limits);
    return messageOf<MeshError>([&] { load(folder_.write(name, content)); });
  }
  TemporaryFolder folder_;
};

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(IsolatedMesh, ReadsEveryFormatLikeTheLoaderInThisProcess) {
  const std::vector<std::array<std::string, 2>> files = {{"a.obj", tetrahedronObj()},
                                                         {"b.stl", tetrahedronStlAscii()},
                                                         {"c.STL", tetrahedronStlBinary("")},
                                                         {"d.ply", tetrahedronPlyBinary()},
                                                         {"e.dae", tetrahedronDae("1", "Z_UP", "")}};
  for (const auto& [name, content] : files) {
    const std::string file = folder_.write(name, content);
    const TriangleMesh here = loadMesh(file), there = IsolatedMeshLoader()(file);
    EXPECT_EQ(here.vertices, there.vertices) << name;
    EXPECT_EQ(here.triangles, there.triangles) << name;
  }
}

TEST_F(IsolatedMesh, TellsWhatIsWrongLikeTheLoaderInThisProcess) {
  for (const std::string& content :
       {std::string("v 0 0 0\n# nothing else\n"), std::string("ply"), tetrahedronObj(1000.0)}) {
    for (const char* name : {"a.obj", "a.ply", "a.step"}) {
      const std::string file = folder_.write(name, content);
      EXPECT_EQ(messageFor(name, content), messageOf<MeshError>([&] { loadMesh(file); }));
    }
  }
}

TEST_F(IsolatedMesh, ObeysTheAllowedPlaces) {
  const std::string file = folder_.write("a.obj", tetrahedronObj());
  EXPECT_EQ(IsolatedMeshLoader({}, FileAccess::only({folder_.path().string()}))(file).triangles.size(), 4u);
  EXPECT_THROW(IsolatedMeshLoader({}, FileAccess::only({"/usr"}))(file), MeshError);
  const auto find = [&](const std::string& package) { return package == "parts" ? folder_.path().string() : ""; };
  const IsolatedMeshLoader of_packages(find, FileAccess::only({}));
  EXPECT_EQ(of_packages("package://parts/a.obj").triangles.size(), 4u);
  EXPECT_THROW(of_packages(file), MeshError);
  EXPECT_TRUE(mentions(messageOf<MeshError>([&] { of_packages("package://parts/../a.obj"); }), "'..' is not accepted"));
  EXPECT_TRUE(
      mentions(messageOf<MeshError>([&] { of_packages("package://-q parts/a.obj"); }), "is not the name of a package"));
}

TEST_F(IsolatedMesh, AProcessThatCrashesIsAnError) {
  EXPECT_TRUE(mentions(messageWith("kill -SEGV $$"), "was stopped by signal 11"));
  EXPECT_TRUE(mentions(messageWith("kill -ABRT $$"), "was stopped by signal 6"));
}

TEST_F(IsolatedMesh, AProcessThatHangsIsKilled) {
  EXPECT_TRUE(mentions(messageWith("while :; do :; done", 0.3), "took longer than 0.3"));
  // It closes its output and stays.
  EXPECT_TRUE(mentions(messageWith("exec 1>&-; exec sleep 1000"), "was stopped by signal 9"));
}

TEST_F(IsolatedMesh, AnAnswerThatNeverEndsIsCutOff) {
  EXPECT_TRUE(mentions(messageWith("exec cat /dev/zero"), "more triangles than are accepted"));
}

TEST_F(IsolatedMesh, AnAnswerOfNonsenseIsAnError) {
  EXPECT_TRUE(mentions(messageWith("true"), "it is too short"));
  EXPECT_TRUE(mentions(messageWith("echo this is not a mesh at all"), "not of this version"));
}

#if __GLIBC_PREREQ(2, 34)  // before, the program itself has to close what it inherits
TEST_F(IsolatedMesh, TheProgramGetsNoShellAndNothingOfThisProcess) {
  // Arguments are words, not a command line; only the three standard files are open.
  EXPECT_EQ(messageOf<MeshError>([&] {
              IsolatedMeshLoader({}, {}, {},
                                 writeProgram("ls /proc/self/fd | wc -l >" + folder_.path().string() + "/files"))(
                  folder_.write("$(touch x);.obj", tetrahedronObj()));
            }).find("mesh " + folder_.path().string() + "/$(touch x);.obj"),
            0u);
  std::ifstream files(folder_.path() / "files");
  int num_files = 0;
  files >> num_files;
  EXPECT_LE(num_files, 4);  // ls has the folder open too
}
#endif

TEST_F(IsolatedMesh, AMissingProgramIsNamed) {
  const IsolatedMeshLoader load({}, {}, {}, "/no/such/mesh_reader");
  const std::string message = messageOf<MeshError>([&] { load(folder_.write("a.obj", tetrahedronObj())); });
  EXPECT_TRUE(mentions(message, "'mesh_reader'")) << message;
  EXPECT_TRUE(mentions(message, "/no/such/mesh_reader")) << message;
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(IsolatedMesh, MemoryIsLimited) {
  MeshProcessLimits limits;
  limits.memory_mib = 256;
  std::string obj = tetrahedronObj();
  for (int i = 0; i < 1000000; ++i)
    obj += "v 0 0 " + std::to_string(i % 100) + "\nf 1 2 " + std::to_string(i + 5) + "\n";
  const std::string message = messageFor("a.obj", obj, limits);
  EXPECT_TRUE(mentions(message, "not enough memory") || mentions(message, "was stopped by signal")) << message;
}
#endif

TEST_F(IsolatedMesh, ProcessorTimeIsLimited) {
  MeshProcessLimits limits;
  limits.cpu_s = 1;
  // The reader joins the vertices of a million faces; a second is not enough for this many.
  std::string obj = tetrahedronObj();
  for (int i = 0; i < 4000000; ++i) obj += "f 1 2 3\nf 1 2 4\n";
  EXPECT_TRUE(mentions(messageFor("a.obj", obj, limits), "more than 1 s of processor time"));
}

TEST_F(IsolatedMesh, ManyMayReadAtOnce) {
  const std::string file = folder_.write("a.obj", tetrahedronObj());
  std::vector<std::future<std::size_t>> results;
  for (int i = 0; i < 8; ++i) {
    results.push_back(std::async(std::launch::async, [&] { return IsolatedMeshLoader()(file).triangles.size(); }));
  }
  for (auto& result : results) EXPECT_EQ(result.get(), 4u);
}

/// A reply with one of its 32-bit words changed.
std::string changed(std::string reply, std::size_t word, std::uint32_t value) {
  std::memcpy(&reply[4 * word], &value, 4);
  return reply;
}

std::string refusalOf(const std::string& reply) {
  return messageOf<MeshError>([&] { decodeReply(reply); });
}

TEST(MeshReply, ArrivesAsItWasSent) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {2, 1, 0}};
  const TriangleMesh arrived = decodeReply(encodeMeshReply(mesh));
  EXPECT_EQ(arrived.vertices, mesh.vertices);
  EXPECT_EQ(arrived.triangles, mesh.triangles);
  EXPECT_EQ(refusalOf(encodeErrorReply("this is\nwrong\x1b[2J")), "this is wrong [2J");
  EXPECT_EQ(refusalOf(encodeErrorReply(std::string(5000, 'x'))).size(), kMaxReplyText);
}

TEST(MeshReply, LiesAreFound) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const std::string good = encodeMeshReply(mesh);
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_NE(refusalOf(good.substr(0, size)), "nothing was thrown");
  EXPECT_TRUE(mentions(refusalOf(good + "x"), "not complete"));
  EXPECT_TRUE(mentions(refusalOf(changed(good, 2, 0xffffffffu)), "not complete"));
  EXPECT_TRUE(mentions(refusalOf(changed(good, 3, 0xffffffffu)), "not complete"));
  EXPECT_TRUE(mentions(refusalOf(changed(good, 1, 7)), "not complete"));
  EXPECT_TRUE(mentions(refusalOf(changed(good, 4, 0x7fc00000u)), "not finite"));
  EXPECT_TRUE(mentions(refusalOf(changed(good, 13, 3)), "does not exist"));
}

}  // namespace
}  // namespace depth_object_tracker
