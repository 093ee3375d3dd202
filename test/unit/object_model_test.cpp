// SPDX-License-Identifier: BSD-3-Clause
// Object YAML files: what they mean and what users are told about bad ones.
#include "depth_object_tracker/tracker/object_model.h"

#include "mesh_files.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace depth_object_tracker {
namespace {

class ObjectFile : public testing::Test {
 protected:
  ObjectDescription read(const std::string& content) {
    return loadObjectDescription(folder_.write("object.yaml", content));
  }
  /// The complaint about a file; it must name the file.
  std::string complaint(const std::string& content) {
    const std::string message = messageOf<std::invalid_argument>([&] { read(content); });
    EXPECT_NE(message.find("object.yaml: "), std::string::npos) << message;
    return message;
  }
  void expectComplaint(const std::string& content, const std::string& expected) {
    const std::string message = complaint(content);
    EXPECT_NE(message.find(expected), std::string::npos) << message;
  }
  TemporaryFolder folder_;
};

const std::string kMinimal = "name: cup\nmesh: /meshes/cup.stl\n";

TEST_F(ObjectFile, MinimalFileHasDefaults) {
  const ObjectDescription description = read(kMinimal);
  EXPECT_EQ(description.name, "cup");
  EXPECT_EQ(description.mesh, "/meshes/cup.stl");
  EXPECT_EQ(description.mesh_scale, 1.0);
  EXPECT_TRUE(description.symmetries.empty());
}

TEST_F(ObjectFile, SymmetriesComeOutInMetresAndNormalised) {
  const ObjectDescription description = read(kMinimal + R"(mesh_scale: 0.001
symmetries:
  continuous:
    - {axis: [0, 0, 2], offset: [10, 20, 30]}
    - axis: [1, 0, 0]
  discrete:
    - [-1, 0, 0, 5,  0, -1, 0, 6,  0, 0, 1, 7,  0, 0, 0, 1]
)");
  ASSERT_EQ(description.symmetries.continuous.size(), 2u);
  EXPECT_EQ(description.symmetries.continuous[0].axis, Eigen::Vector3d::UnitZ());
  EXPECT_LT((description.symmetries.continuous[0].offset - Eigen::Vector3d(0.01, 0.02, 0.03)).norm(), 1e-15);
  EXPECT_EQ(description.symmetries.continuous[1].offset, Eigen::Vector3d::Zero());
  ASSERT_EQ(description.symmetries.discrete.size(), 1u);
  const Pose& T_object_object = description.symmetries.discrete[0];
  EXPECT_LT((T_object_object.translation() - Eigen::Vector3d(0.005, 0.006, 0.007)).norm(), 1e-15);
  EXPECT_LT((T_object_object.linear() - Eigen::Vector3d(-1, -1, 1).asDiagonal().toDenseMatrix()).norm(), 1e-15);
}

TEST_F(ObjectFile, RoundedRotationsAreRepaired) {
  const ObjectDescription description =
      read(kMinimal + "symmetries: {discrete: [[0.5, -0.866, 0, 0, 0.866, 0.5, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]]}");
  EXPECT_TRUE(isValidPose(description.symmetries.discrete.at(0)));
}

TEST_F(ObjectFile, EmptySymmetriesAreNone) {
  EXPECT_TRUE(read(kMinimal + "symmetries:\n").symmetries.empty());
  EXPECT_TRUE(read(kMinimal + "symmetries: {continuous: , discrete: []}\n").symmetries.empty());
}

TEST_F(ObjectFile, RelativeMeshesAreFoundFromTheFile) {
  std::filesystem::create_directory(folder_.path() / "meshes");
  folder_.write("meshes/cup.obj", tetrahedronObj(1000.0));
  const ObjectModel object = loadObject(read("name: cup\nmesh: ./meshes/cup.obj\nmesh_scale: 0.001\n"));
  EXPECT_EQ(object.name, "cup");
  EXPECT_EQ(object.mesh.triangles.size(), 4u);
  EXPECT_NEAR(diameter(object.mesh), 0.3606, 1e-4);
}

TEST_F(ObjectFile, PackageMeshesNeedAResolver) {
  folder_.write("cup.obj", tetrahedronObj());
  const ObjectDescription description = read("name: cup\nmesh: package://cups/cup.obj\n");
  EXPECT_EQ(description.mesh, "package://cups/cup.obj");
  EXPECT_EQ(loadObject(description, [&](const std::string&) { return folder_.path().string(); }).mesh.triangles.size(),
            4u);
  EXPECT_THROW(loadObject(description), MeshError);
}

TEST_F(ObjectFile, MissingOrBrokenFilesAreExplained) {
  EXPECT_NE(messageOf<std::invalid_argument>([] {
              loadObjectDescription("/none.yaml");
            }).find("/none.yaml: there is no such object file"),
            std::string::npos);
  expectComplaint("name: [cup\n", "not valid YAML");
  expectComplaint("", "must be a map");
  expectComplaint("- name\n", "must be a map");
  expectComplaint("mesh: a.obj\n", "`name` is missing");
  expectComplaint("name: cup\n", "`mesh` is missing");
  expectComplaint("name: cup\nmesh: ''\n", "`mesh` must be a text that is not empty");
  expectComplaint("name: [a]\nmesh: a.obj\n", "`name` must be a text");
  expectComplaint("name: my cup\nmesh: a.obj\n", "names a tf frame");
  expectComplaint(kMinimal + "scale: 2\n", "`scale` is not a known key; known are name, mesh, mesh_scale, symmetries");
}

TEST_F(ObjectFile, BadScalesAreExplained) {
  for (const char* value : {"0", "-1", "big", ".nan", ".inf", "[1]"}) {
    expectComplaint(kMinimal + "mesh_scale: " + value + "\n", "`mesh_scale` must be");
  }
}

TEST_F(ObjectFile, BadSymmetriesAreExplained) {
  const auto symmetry = [](const std::string& text) { return kMinimal + "symmetries: " + text + "\n"; };
  expectComplaint(symmetry("[1, 2]"), "`symmetries` must be a map");
  expectComplaint(symmetry("{discreet: []}"), "`symmetries.discreet` is not a known key");
  expectComplaint(symmetry("{continuous: 1}"), "`symmetries.continuous` must be a list");
  expectComplaint(symmetry("{continuous: [1]}"), "`symmetries.continuous[0]` must be a map");
  expectComplaint(symmetry("{continuous: [{offset: [0, 0, 0]}]}"), "`symmetries.continuous[0].axis` is missing");
  expectComplaint(symmetry("{continuous: [{axis: [0, 0, 0]}]}"), "`symmetries.continuous[0].axis` must not be zero");
  expectComplaint(symmetry("{continuous: [{axis: [0, 1]}]}"), "must be a list of 3 numbers");
  expectComplaint(symmetry("{continuous: [{axis: [0, 1, .nan]}]}"),
                  "`symmetries.continuous[0].axis[2]` must be finite");
  expectComplaint(symmetry("{discrete: [[1, 0, 0]]}"), "`symmetries.discrete[0]` must be a list of 16 numbers");
  expectComplaint(symmetry("{discrete: [[2,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]]}"), "not orthonormal");
  expectComplaint(symmetry("{discrete: [[-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]]}"), "it is a reflection");
  expectComplaint(symmetry("{discrete: [[1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1]]}"), "row 0 0 0 1");
}

TEST(ShippedObjects, AllLoad) {
  const auto resolver = [](const std::string& package) {
    return package == "depth_object_tracker" ? std::string(PROJECT_SOURCE_FOLDER) : std::string();
  };
  int num_objects = 0;
  for (const auto& entry : std::filesystem::directory_iterator(PROJECT_SOURCE_FOLDER "/config/objects")) {
    if (entry.path().extension() != ".yaml") continue;
    const ObjectModel object = loadObject(loadObjectDescription(entry.path().string()), resolver);
    EXPECT_EQ(object.name, entry.path().stem().string());
    EXPECT_FALSE(object.mesh.triangles.empty());
    ++num_objects;
  }
  EXPECT_GE(num_objects, 6);
}

/// A declared symmetry must map the shape onto itself: every vertex lands on a vertex (discrete) or keeps its distance
/// (continuous).
TEST(ShippedObjects, SymmetriesAreTrue) {
  const auto resolver = [](const std::string&) { return std::string(PROJECT_SOURCE_FOLDER); };
  const ObjectModel box = loadObject(loadObjectDescription(PROJECT_SOURCE_FOLDER "/config/objects/box.yaml"), resolver);
  ASSERT_EQ(box.symmetries.discrete.size(), 3u);
  for (const Pose& T_object_object : box.symmetries.discrete) {
    for (const Eigen::Vector3f& vertex : box.mesh.vertices) {
      const Eigen::Vector3f moved = (T_object_object * vertex.cast<double>()).cast<float>();
      float nearest = 1.0f;
      for (const Eigen::Vector3f& other : box.mesh.vertices) nearest = std::min(nearest, (moved - other).norm());
      ASSERT_LT(nearest, 2e-6f);
    }
  }
  const ObjectModel bottle =
      loadObject(loadObjectDescription(PROJECT_SOURCE_FOLDER "/config/objects/bottle.yaml"), resolver);
  ASSERT_EQ(bottle.symmetries.continuous.size(), 1u);
  // 60 facets: turned by one facet, the bottle is itself up to the file's rounding.
  const Eigen::Matrix3f R = expSo3(2.0 * M_PI / 60.0 * bottle.symmetries.continuous[0].axis).cast<float>();
  for (const Eigen::Vector3f& vertex : bottle.mesh.vertices) {
    float nearest = 1.0f;
    for (const Eigen::Vector3f& other : bottle.mesh.vertices) nearest = std::min(nearest, (R * vertex - other).norm());
    ASSERT_LT(nearest, 2e-6f);
  }
}

}  // namespace
}  // namespace depth_object_tracker
