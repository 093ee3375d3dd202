// SPDX-License-Identifier: BSD-3-Clause
#include "camera/device_finder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace depth_object_tracker {
namespace {

using testing::HasSubstr;

const std::vector<DeviceDescription> kDevices{{"1d27/0601@1/5", "PrimeSense PS1080", ""},
                                              {"1d27/0609@2/15", "ASUS Xtion", ""}};

std::string serialOf(const std::string& uri) {
  return uri == kDevices[0].uri ? "1206120016" : "S2";
}

std::string find(const std::string& device, const std::string& known_serial = "") {
  return findDeviceUri(kDevices, device, known_serial, serialOf);
}

TEST(DeviceFinder, TheFirstTheNthByUriByPlaceOnTheBusBySerialNumber) {
  EXPECT_EQ(find(""), kDevices[0].uri);
  EXPECT_EQ(find("#2"), kDevices[1].uri);
  EXPECT_EQ(find("1d27/0609@2/15"), kDevices[1].uri);
  EXPECT_EQ(find("1@5"), kDevices[0].uri);
  EXPECT_EQ(find("2/15"), "");
  EXPECT_EQ(find("S2"), kDevices[1].uri);
}

TEST(DeviceFinder, NothingFits) {
  for (const char* device : {"#0", "#3", "#x", "5", "1@55", "2@5", "no such serial", "1d27/0601@1/6"}) {
    EXPECT_EQ(find(device), "") << device;
  }
  EXPECT_EQ(findDeviceUri({}, "", "S2", serialOf), "");
}

TEST(DeviceFinder, AReplacedPlugIsTheSameDevice) {
  EXPECT_EQ(find("", "S2"), kDevices[1].uri);
  EXPECT_EQ(find("1d27/0609@2/14", "S2"), kDevices[1].uri);  // its old address
  EXPECT_EQ(find("1d27/0601@1/5", "S2"), kDevices[0].uri);   // asked for by its address
}

TEST(DeviceFinder, SaysWhatThereIs) {
  EXPECT_THAT(noSuchDevice(kDevices, "#3"), HasSubstr("'1d27/0609@2/15' (ASUS Xtion)"));
  EXPECT_THAT(noSuchDevice({}, ""), HasSubstr("plugged in"));
}

TEST(DepthMode, TheNearestIsTaken) {
  const std::vector<DepthMode> modes{{320, 240, 30}, {320, 240, 60}, {640, 480, 30}};
  EXPECT_EQ(nearestMode(modes, {640, 480, 60}), (DepthMode{640, 480, 30}));
  EXPECT_EQ(nearestMode(modes, {320, 240, 50}), (DepthMode{320, 240, 60}));
  EXPECT_EQ(nearestMode(modes, {160, 120, 25}), (DepthMode{320, 240, 30}));
}

TEST(Recording, IsToldByItsEnding) {
  EXPECT_TRUE(isRecording("/tmp/a.oni"));
  EXPECT_TRUE(isRecording("A.ONI"));
  EXPECT_FALSE(isRecording(""));
  EXPECT_FALSE(isRecording(".oni"));
  EXPECT_FALSE(isRecording("1d27/0601@1/5"));
}

}  // namespace
}  // namespace depth_object_tracker
