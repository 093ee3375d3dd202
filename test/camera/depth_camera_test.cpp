// SPDX-License-Identifier: BSD-3-Clause
// A depth camera through OpenNI2 itself: the virtual device of test/camera, and recordings of it.
#include "recorded_camera.h"
#include "temporary_folder.h"

#include <gmock/gmock.h>

#include <set>

namespace depth_object_tracker {
namespace {

constexpr int kRecordedFrames = 40;

DepthCameraOptions smallMode(const std::string& device = kVirtualDeviceUri) {
  DepthCameraOptions options;
  options.device = device;
  options.mode = {320, 240, 30};
  return options;
}

/// All pixels are those of the scene at the time that the image carries.
void expectTrueImage(const CameraLog::Image& image) {
  const int width = image.frame.width, height = image.frame.height;
  const std::uint64_t time_us = virtualTime(image.pixels());
  VirtualScene scene;
  std::vector<std::uint16_t> expected(static_cast<std::size_t>(width) * height);
  scene.render(time_us, width, height, expected.data());
  ASSERT_EQ(image.millimetres.size(), 2 * expected.size());
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), image.pixels())) << "at " << time_us;
}

class VirtualCamera : public testing::Test {
 protected:
  void SetUp() override { plugIn(); }
  CameraLog log_;
};

TEST_F(VirtualCamera, HandsOutImagesUnmirroredWithTheirModel) {
  DepthCamera camera(smallMode(), log_.events());
  camera.setWanted(true);
  ASSERT_TRUE(waitFor([&] { return log_.size() >= 5; }));
  double last_s = -1.0;
  for (const auto& image : log_.images()) {
    expectTrueImage(image);
    EXPECT_GT(image.frame.timestamp_s, last_s);
    EXPECT_NEAR(factoryFocalLengthPx(image.frame), virtualCamera(320, 240).fx, 1e-3);
    EXPECT_FALSE(image.frame.is_registered);
    last_s = image.frame.timestamp_s;
  }
}

TEST_F(VirtualCamera, IsFoundByAnyOfItsNames) {
  for (const char* device : {"", "#1", kVirtualDeviceUri, kVirtualDeviceSerial}) {
    CameraLog log;
    DepthCamera camera(smallMode(device), log.events());
    camera.setWanted(true);
    EXPECT_TRUE(waitFor([&] { return log.size() >= 1; })) << device;
  }
  EXPECT_EQ(listDevices().at(0).uri, kVirtualDeviceUri);
}

TEST_F(VirtualCamera, DoesNotStreamUntilSomebodyWantsImages) {
  DepthCamera camera(smallMode(), log_.events());
  ASSERT_TRUE(waitFor([&] { return log_.count("[open]") == 1; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(log_.size(), 0u);
  camera.setWanted(true);
  ASSERT_TRUE(waitFor([&] { return log_.size() >= 2; }));
  camera.setWanted(false);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const auto size = log_.size();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(log_.size(), size);
  camera.setWanted(true);
  EXPECT_TRUE(waitFor([&] { return log_.size() > size; }));
}

TEST_F(VirtualCamera, ChangesItsModeWhileItRuns) {
  DepthCamera camera(smallMode(), log_.events());
  camera.setWanted(true);
  ASSERT_TRUE(waitFor([&] { return log_.size() >= 1; }));
  DepthCameraOptions large = smallMode();
  large.mode = {640, 480, 30};
  camera.setOptions(large);
  ASSERT_TRUE(waitFor([&] { return log_.images().back().frame.width == 640; }));
  expectTrueImage(log_.images().back());
}

TEST_F(VirtualCamera, AModeThatItLacksIsSaidAndTheNearestTaken) {
  DepthCameraOptions options = smallMode();
  options.mode = {330, 250, 60};
  options.registration = true;
  DepthCamera camera(options, log_.events());
  camera.setWanted(true);
  ASSERT_TRUE(waitFor([&] { return log_.size() >= 1; }));
  EXPECT_EQ(log_.images().front().frame.width, 320);
  EXPECT_EQ(log_.count("330x250 at 60 Hz is not a mode"), 1);
  EXPECT_EQ(log_.count("it has 640x480 at 30 Hz, 320x240 at 30 Hz, 320x240 at 60 Hz"), 1);
  EXPECT_EQ(log_.count("cannot register depth"), 1);
}

TEST_F(VirtualCamera, RegistersDepthWhereItCanAndIsAskedTo) {
  plugIn(kPlugWithColor);
  DepthCameraOptions options = smallMode();
  options.registration = true;
  DepthCamera camera(options, log_.events());
  camera.setWanted(true);
  ASSERT_TRUE(waitFor([&] { return log_.size() >= 1; }));
  EXPECT_TRUE(log_.images().front().frame.is_registered);
  EXPECT_EQ(log_.count("register"), 0);
  camera.setOptions(smallMode());
  EXPECT_TRUE(waitFor([&] { return !log_.images().back().frame.is_registered; }));
}

TEST_F(VirtualCamera, ComesBackAfterItWasUnplugged) {
  DepthCamera camera(smallMode(), log_.events());
  camera.setWanted(true);
  ASSERT_TRUE(waitFor([&] { return log_.size() >= 3; }));
  for (int i = 1; i <= 3; ++i) {
    unplug();
    ASSERT_TRUE(waitFor([&] { return log_.count("was unplugged") == i; }));
    ASSERT_TRUE(waitFor([&] { return log_.count("no depth camera") == i; }));
    const auto size = log_.size();
    plugIn();
    ASSERT_TRUE(waitFor([&] { return log_.count("[open]") == i + 1 && log_.size() >= size + 3; }));
    expectTrueImage(log_.images().back());
  }
}

TEST_F(VirtualCamera, WaitsForADeviceThatIsNotThereYet) {
  unplug();
  DepthCamera camera(smallMode(""), log_.events());
  camera.setWanted(true);
  ASSERT_TRUE(waitFor([&] { return log_.count("no depth camera") == 1; }));
  plugIn();
  EXPECT_TRUE(waitFor([&] { return log_.size() >= 1; }));
}

TEST_F(VirtualCamera, AWrongNameIsAnsweredWithWhatThereIs) {
  DepthCamera camera(smallMode("1d27/0601@9/9"), log_.events());
  ASSERT_TRUE(waitFor([&] { return log_.count("no depth camera '1d27/0601@9/9'") == 1; }));
  EXPECT_EQ(log_.count(std::string("connected: '") + kVirtualDeviceUri + "' (Test virtual depth camera)"), 1);
  camera.setOptions(smallMode());
  camera.setWanted(true);
  EXPECT_TRUE(waitFor([&] { return log_.size() >= 1; }));
}

TEST_F(VirtualCamera, EndsAtOnceWhileItWaits) {
  unplug();
  for (int i = 0; i < 5; ++i) DepthCamera camera(smallMode(), log_.events());
  plugIn();
  for (int i = 0; i < 5; ++i) {
    DepthCamera camera(smallMode(), log_.events());
    camera.setWanted(true);
  }
}

class Recording : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    plugIn();
    folder_ = new TemporaryFolder;
    recordVirtualCamera(plain(), kRecordedFrames, false);
    recordVirtualCamera(mirrored(), 5, true);
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static std::string plain() { return (folder_->path() / "plain.oni").string(); }
  static std::string mirrored() { return (folder_->path() / "mirrored.oni").string(); }

  static DepthCameraOptions fast(const std::string& file) {
    DepthCameraOptions options;
    options.device = file;
    options.playback_speed = 0.0;
    return options;
  }

  /// @return the device's times of the images [us], in their order.
  static std::vector<std::uint64_t> imagesPlayedOnce() {
    CameraLog log;
    DepthCamera camera(fast(plain()), log.events());
    camera.setWanted(true);
    EXPECT_TRUE(waitFor([&] { return log.count("has ended") == 1; }));
    std::vector<std::uint64_t> times;
    for (const auto& image : log.images()) times.push_back(virtualTime(image.pixels()));
    return times;
  }

  CameraLog log_;
  static TemporaryFolder* folder_;
};
TemporaryFolder* Recording::folder_ = nullptr;

TEST_F(Recording, IsPlayedOnceEveryImageInItsPlace) {
  DepthCamera camera(fast(plain()), log_.events());
  camera.setWanted(true);
  ASSERT_TRUE(waitFor([&] { return log_.count("has ended") == 1; }));
  const auto images = log_.images();
  EXPECT_GE(images.size(), static_cast<std::size_t>(kRecordedFrames - 2));
  for (std::size_t i = 0; i < images.size(); ++i) {
    expectTrueImage(images[i]);
    EXPECT_NEAR(factoryFocalLengthPx(images[i].frame), virtualCamera(320, 240).fx, 0.01);
    if (i == 0) continue;
    const double truth_s =
        1e-6 * static_cast<double>(virtualTime(images[i].pixels()) - virtualTime(images[i - 1].pixels()));
    EXPECT_NEAR(images[i].frame.timestamp_s - images[i - 1].frame.timestamp_s, truth_s, 1e-5) << i;
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(log_.size(), images.size());
}

TEST_F(Recording, PlaysTheSameImagesEachTime) {
  EXPECT_EQ(imagesPlayedOnce(), imagesPlayedOnce());
}

TEST_F(Recording, Loops) {
  const std::vector<std::uint64_t> once = imagesPlayedOnce();  // a busy machine records more than it was asked to
  DepthCameraOptions options = fast(plain());
  options.loop = true;
  DepthCamera camera(options, log_.events());
  camera.setWanted(true);
  ASSERT_TRUE(waitFor([&] { return log_.size() >= 3 * once.size(); }));
  std::set<std::uint64_t> times;
  for (const auto& image : log_.images()) times.insert(virtualTime(image.pixels()));
  EXPECT_EQ(times, std::set<std::uint64_t>(once.begin(), once.end()));
  EXPECT_EQ(log_.count("has ended"), 0);
}

TEST_F(Recording, KeepsItsPaceInRealTime) {
  DepthCameraOptions options = fast(plain());
  options.playback_speed = 1.0;
  DepthCamera camera(options, log_.events());
  const auto begin = std::chrono::steady_clock::now();
  camera.setWanted(true);
  ASSERT_TRUE(waitFor([&] { return log_.count("has ended") == 1; }));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  const auto images = log_.images();
  ASSERT_GE(images.size(), 2u);
  EXPECT_GE(took.count(), images.back().frame.timestamp_s - images.front().frame.timestamp_s);
}

TEST_F(Recording, WaitsWhereItIsWhileNobodyWantsImages) {
  DepthCameraOptions options = fast(plain());
  options.playback_speed = 1.0;
  DepthCamera camera(options, log_.events());
  ASSERT_TRUE(waitFor([&] { return log_.count("[open]") == 1; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  camera.setWanted(true);
  ASSERT_TRUE(waitFor([&] { return log_.size() >= 5; }));
  camera.setWanted(false);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  camera.setWanted(true);
  ASSERT_TRUE(waitFor([&] { return log_.count("has ended") == 1; }));
  EXPECT_GE(log_.size(), static_cast<std::size_t>(kRecordedFrames - 6));
}

TEST_F(Recording, MadeByAMirroringViewerIsTurnedBack) {
  DepthCamera camera(fast(mirrored()), log_.events());
  camera.setWanted(true);
  ASSERT_TRUE(waitFor([&] { return log_.count("has ended") == 1; }));
  ASSERT_GE(log_.size(), 3u);
  for (const auto& image : log_.images()) expectTrueImage(image);
}

TEST_F(Recording, FilesThatAreNone) {
  {
    DepthCamera camera(fast("/no/such/file.oni"), log_.events());
    EXPECT_TRUE(waitFor([&] { return log_.count("'/no/such/file.oni' does not exist") == 1; }));
  }
  std::ofstream((folder_->path() / "text.oni").string()) << "hello";
  DepthCamera camera(fast((folder_->path() / "text.oni").string()), log_.events());
  EXPECT_TRUE(waitFor([&] { return log_.count("no .oni recording that OpenNI can play") == 1; }));
}

}  // namespace
}  // namespace depth_object_tracker
