// SPDX-License-Identifier: BSD-3-Clause
// PLY headers that would have assimp write behind the end of its arrays.
#include "depth_object_tracker/geometry/mesh_loader.h"
#include "mesh_files.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <string>

namespace depth_object_tracker {
namespace {

const std::string kVertices = "\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kCorners = "\nproperty list uchar int vertex_indices\n";

std::string refusal(const std::string& elements) {
  std::string content = "ply\nformat ascii 1.0\n" + elements + "end_header\n";
  for (int i = 0; i < 3000; ++i) content += "1 2 3\n";
  const TemporaryFolder folder;
  const std::string path = folder.write("a.ply", content);
  return messageOf<MeshError>([&] { loadMesh(path); });
}

TEST(MeshPlyHeader, ElementsThatShareAnArrayAreRefused) {
  const std::string vertices = "element vertex 1" + kVertices;
  EXPECT_NE(refusal(vertices + "element vertex 2000" + kVertices).find("element 'vertex' twice"), std::string::npos);
  const std::string strips = "element tristrips 1" + kCorners, faces = "element face 900" + kCorners;
  EXPECT_NE(refusal(vertices + strips + faces).find("'face' twice"), std::string::npos);
  EXPECT_NE(refusal(vertices + faces + strips).find("'tristrips' twice"), std::string::npos);
}

TEST(MeshPlyHeader, LinesThatEndWithinAreRefused) {
  const std::string vertices = "element vertex 1" + kVertices, many = "element vertex 2000" + kVertices;
  for (const std::string& end : {std::string("\r"), std::string("\f"), std::string(1, '\0')}) {
    EXPECT_NE(refusal(vertices + "comment " + end + many).find("control character"), std::string::npos);
    EXPECT_NE(refusal(vertices + "obj_info " + end + many).find("control character"), std::string::npos);
  }
}

}  // namespace
}  // namespace depth_object_tracker
