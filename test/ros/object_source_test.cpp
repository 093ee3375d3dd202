// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/object_source.h"

#include "depth_messages.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace depth_object_tracker {
namespace {

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(ObjectSource, BuildsFromAMesh) {
  ObjectSource source;
  source.mesh = testMeshFile();
  const BuiltTracker built = buildTracker(source, TrackerConfig());
  EXPECT_EQ(built.problem, "");
  ASSERT_TRUE(built.tracker);
  EXPECT_EQ(built.name, "bracket");
  EXPECT_EQ(built.tracker->object().name, "bracket");
}

TEST(ObjectSource, MakesAFrameNameOfTheGivenName) {
  ObjectSource source;
  source.mesh = testMeshFile();
  source.name = "my bracket/2";
  EXPECT_EQ(buildTracker(source, TrackerConfig()).name, "my_bracket_2");
}

TEST(ObjectSource, BuildsFromAnObjectFile) {
  ObjectSource source;
  source.object_file = "file://" + std::string(PROJECT_SOURCE_FOLDER) + "/test/ros/bracket_object.yaml";
  const BuiltTracker built = buildTracker(source, TrackerConfig());
  EXPECT_EQ(built.problem, "");
  EXPECT_EQ(built.name, "test_bracket");
  EXPECT_TRUE(mentions(built.mesh_file, "meshes/bracket.obj")) << built.mesh_file;
}

TEST(ObjectSource, SaysWhatIsWrong) {
  ObjectSource source;
  EXPECT_TRUE(mentions(buildTracker(source, TrackerConfig()).problem, "~object_file"));
  source.mesh = "/no/such/mesh.obj";
  EXPECT_TRUE(mentions(buildTracker(source, TrackerConfig()).problem, "/no/such/mesh.obj"));
  source.mesh = testMeshFile();
  source.mesh_scale = 1000.0;
  EXPECT_TRUE(mentions(buildTracker(source, TrackerConfig()).problem, "bracket.obj"));
  source.mesh_scale = -1.0;
  EXPECT_TRUE(mentions(buildTracker(source, TrackerConfig()).problem, "mesh_scale"));
  source.object_file = "package://no_such_package_here/x.yaml";
  EXPECT_TRUE(mentions(buildTracker(source, TrackerConfig()).problem, "no_such_package_here"));
}

/// What ~load_object of a tracker does that began with `at_start`.
BuiltTracker load(const ObjectSource& source, const std::vector<std::string>& folders,
                  const ObjectSource& at_start = {}, const std::string& mesh_at_start = "") {
  return buildTracker(source, TrackerConfig(), accessForServices(folders, at_start, mesh_at_start));
}

class ServiceAccess : public testing::Test {
 protected:
  ServiceAccess() {
    setenv("ROS_PACKAGE_PATH", PROJECT_SOURCE_FOLDER, 1);  // also where no workspace is sourced
    std::filesystem::create_directory(folder_.path() / "listed");
    std::filesystem::copy_file(testMeshFile(), folder_.path() / "listed/part.obj");
    std::filesystem::copy_file(testMeshFile(), folder_.path() / "elsewhere.obj");
    listed_ = {(folder_.path() / "listed").string()};
  }
  ObjectSource mesh(const std::string& name) const {
    ObjectSource source;
    source.mesh = (folder_.path() / name).string();
    return source;
  }
  ObjectSource objectFile(const std::string& mesh) const {
    ObjectSource source;
    source.object_file = folder_.write("listed/object.yaml", "name: part\nmesh: " + mesh + "\n");
    return source;
  }
  TemporaryFolder folder_;
  std::vector<std::string> listed_;
};

TEST_F(ServiceAccess, ListedFoldersAndPackagesAreRead) {
  EXPECT_EQ(load(mesh("listed/part.obj"), listed_).problem, "");
  EXPECT_EQ(load(objectFile("part.obj"), listed_).problem, "");
  ObjectSource of_package;
  of_package.mesh = "package://depth_object_tracker/meshes/bracket.obj";
  EXPECT_EQ(load(of_package, {}).problem, "");
  of_package.mesh = "";
  of_package.object_file = "package://depth_object_tracker/config/objects/box.yaml";
  EXPECT_EQ(load(of_package, {}).problem, "");
}

TEST_F(ServiceAccess, WhatLiesElsewhereIsRefusedWithAdvice) {
  const std::string problem = load(mesh("elsewhere.obj"), listed_).problem;
  EXPECT_TRUE(mentions(problem, "elsewhere.obj: it lies outside")) << problem;
  EXPECT_TRUE(mentions(problem, "~object_folders")) << problem;
  EXPECT_TRUE(mentions(load(objectFile("../elsewhere.obj"), listed_).problem, "it lies outside"));
  EXPECT_TRUE(mentions(load(mesh("listed/../elsewhere.obj"), listed_).problem, "'..'"));
  ObjectSource of_package;
  of_package.mesh = "package://depth_object_tracker/../elsewhere.obj";
  EXPECT_TRUE(mentions(load(of_package, listed_).problem, "'..'"));
  std::filesystem::create_symlink(folder_.path() / "elsewhere.obj", folder_.path() / "listed/link.obj");
  EXPECT_TRUE(mentions(load(mesh("listed/link.obj"), listed_).problem, "by a link"));
}

TEST_F(ServiceAccess, TheObjectAtStartMayBeReadAgain) {
  const ObjectSource at_start = mesh("elsewhere.obj");
  EXPECT_EQ(load(at_start, {}, at_start, at_start.mesh).problem, "");
  const ObjectSource file = objectFile("part.obj");
  EXPECT_EQ(load(file, {}, file, mesh("listed/part.obj").mesh).problem, "");
}

TEST_F(ServiceAccess, PipesAreRefusedAtOnce) {
  ASSERT_EQ(mkfifo((folder_.path() / "listed/pipe.obj").c_str(), 0600), 0);
  ASSERT_EQ(mkfifo((folder_.path() / "listed/pipe.yaml").c_str(), 0600), 0);
  EXPECT_TRUE(mentions(load(mesh("listed/pipe.obj"), listed_).problem, "is not a regular file"));
  ObjectSource source;
  source.object_file = (folder_.path() / "listed/pipe.yaml").string();
  EXPECT_TRUE(mentions(load(source, listed_).problem, "is not a regular file"));
  EXPECT_TRUE(mentions(loadInitFile((folder_.path() / "listed/pipe.obj").string()).problem, "is not a regular file"));
}

class InitFileTest : public testing::Test {
 protected:
  InitFilePose load(const std::string& text) {
    const std::string path = (folder_.path() / "init.json").string();
    std::ofstream(path) << text;
    return loadInitFile(path);
  }
  TemporaryFolder folder_;
};

TEST_F(InitFileTest, ReadsMillimetresAndRowMajorRotation) {
  const auto init = load(R"({"cam_R_m2c": [0, -1, 0, 1, 0, 0, 0, 0, 1], "cam_t_m2c": [10, -20, 600], "obj_id": 1})");
  EXPECT_EQ(init.problem, "");
  EXPECT_NEAR((init.T_camera_object * Eigen::Vector3d(1.0, 0.0, 0.0) - Eigen::Vector3d(0.01, 0.98, 0.6)).norm(), 0.0,
              1e-9);
}

TEST_F(InitFileTest, SaysWhatIsWrong) {
  EXPECT_TRUE(mentions(loadInitFile("/no/such/init.json").problem, "/no/such/init.json"));
  EXPECT_TRUE(mentions(load("{").problem, "init.json"));
  EXPECT_TRUE(mentions(load(R"({"cam_t_m2c": [1, 2, 3]})").problem, "cam_R_m2c"));
  EXPECT_TRUE(mentions(load(R"({"cam_R_m2c": [1, 0], "cam_t_m2c": [1, 2, 3]})").problem, "9 numbers"));
  EXPECT_TRUE(
      mentions(load(R"({"cam_R_m2c": [2, 0, 0, 0, 1, 0, 0, 0, 1], "cam_t_m2c": [1, 2, 3]})").problem, "rotation"));
  EXPECT_TRUE(
      mentions(load(R"({"cam_R_m2c": [-1, 0, 0, 0, 1, 0, 0, 0, 1], "cam_t_m2c": [1, 2, 3]})").problem, "rotation"));
  EXPECT_NE(load(R"({"cam_R_m2c": "x", "cam_t_m2c": [1, 2, 3]})").problem, "");
}

}  // namespace
}  // namespace depth_object_tracker
