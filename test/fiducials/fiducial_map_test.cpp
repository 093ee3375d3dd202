// SPDX-License-Identifier: BSD-3-Clause
// Fiducial files: what is written is read again; what is wrong is said.
#include "depth_object_tracker/fiducials/fiducial_map.h"

#include "temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace depth_object_tracker {
namespace {

using testing::HasSubstr;

class FiducialFile : public testing::Test {
 protected:
  std::string complaint(const std::string& text) {
    try {
      loadFiducialMap(folder_.write("tags.yaml", text));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder_;
};

TEST_F(FiducialFile, IsReadAsItWasWritten) {
  FiducialMap map;
  for (int k = 0; k < 3; ++k) {
    Fiducial tag;
    tag.id = 4 + k;
    tag.size_m = 0.02 + 0.01 * k;
    tag.T_object_tag.linear() = expSo3(Eigen::Vector3d(0.3, 1.0 - k, 0.2));
    tag.T_object_tag.translation() = Eigen::Vector3d(0.01 * k, 0.02, -0.03);
    map.tags.push_back(tag);
  }
  const std::string path = (folder_.path() / "tags.yaml").string();
  saveFiducialMap(map, path);
  const FiducialMap read = loadFiducialMap(path);
  ASSERT_EQ(read.tags.size(), map.tags.size());
  EXPECT_EQ(read.family, "tag36h11");
  for (const Fiducial& tag : map.tags) {
    ASSERT_NE(read.find(tag.id), nullptr);
    EXPECT_TRUE(read.find(tag.id)->T_object_tag.isApprox(tag.T_object_tag, 1e-7));
    EXPECT_NEAR(read.find(tag.id)->size_m, tag.size_m, 1e-9);
  }
  EXPECT_EQ(read.find(77), nullptr);
  EXPECT_NEAR((read.centre() - Eigen::Vector3d(0.01, 0.02, -0.03)).norm(), 0.0, 1e-9);
}

TEST_F(FiducialFile, SaysWhatIsWrong) {
  const std::string good = "size_m: 0.03, position: [0, 0, 0], orientation: [0, 0, 0, 1]";
  EXPECT_EQ(complaint("tags: [{id: 1, " + good + "}]"), "");
  EXPECT_THAT(complaint("tags: []"), HasSubstr("at least one tag"));
  EXPECT_THAT(complaint("tags: [{id: 1, " + good + "}, {id: 1, " + good + "}]"), HasSubstr("tag 1 is there twice"));
  EXPECT_THAT(complaint("tags: [{id: 1, colour: red, " + good + "}]"), HasSubstr("`colour` is not a known key"));
  EXPECT_THAT(complaint("tags: [{id: 1, size_m: -1, position: [0, 0, 0], orientation: [0, 0, 0, 1]}]"),
              HasSubstr("`size_m` of tag 1"));
  EXPECT_THAT(complaint("tags: [{id: 1, size_m: 0.03, position: [0, 0], orientation: [0, 0, 0, 1]}]"),
              HasSubstr("`position`"));
  EXPECT_THAT(complaint("tags: [{id: 1, size_m: 0.03, position: [0, 0, 0], orientation: [0, 0, 0, 2]}]"),
              HasSubstr("unit quaternion"));
  EXPECT_THAT(complaint("tags: [{id: one, " + good + "}]"), HasSubstr("tags.yaml"));
  EXPECT_THROW(loadFiducialMap((folder_.path() / "none.yaml").string()), std::invalid_argument);
}

TEST(FiducialFiles, ShippedOnesAreUsable) {
  for (const char* object : {"box", "bracket", "drill", "mug"}) {
    const FiducialMap map =
        loadFiducialMap(std::string(PROJECT_SOURCE_FOLDER) + "/config/fiducials/" + object + ".yaml");
    EXPECT_GE(map.tags.size(), 4U) << object;
  }
}

}  // namespace
}  // namespace depth_object_tracker
