// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/camera/openni2_device.h"

#include "device_finder.h"
#include "openni2_runtime.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <thread>

namespace depth_object_tracker {
namespace {

constexpr float kPlayFrameByFrame = -1.0f;  // OpenNI's: the next image of a recording is read when it is waited for

std::vector<DeviceDescription> listConnected() {
  openni::Array<openni::DeviceInfo> infos;
  openni::OpenNI::enumerateDevices(&infos);
  std::vector<DeviceDescription> devices;
  for (int i = 0; i < infos.getSize(); ++i) {
    const std::string uri = infos[i].getUri();
    // OpenNI counts recordings that were opened once as connected from then on.
    if (isRecording(uri)) continue;
    devices.push_back({uri, std::string(infos[i].getVendor()) + " " + infos[i].getName(), ""});
  }
  return devices;
}

std::string serialOf(openni::Device& device) {
  std::array<char, 256> serial{};
  auto size = static_cast<int>(serial.size());
  const bool is_known =
      device.getProperty(ONI_DEVICE_PROPERTY_SERIAL_NUMBER, serial.data(), &size) == openni::STATUS_OK;
  serial.back() = '\0';
  return is_known ? serial.data() : "";
}

std::string serialOfUri(const std::string& uri) {
  openni::Device device;
  return device.open(uri.c_str()) == openni::STATUS_OK ? serialOf(device) : "";
}

DepthMode modeOf(const openni::VideoMode& video_mode) {
  return {video_mode.getResolutionX(), video_mode.getResolutionY(), video_mode.getFps()};
}

int unitsPerMm(const openni::VideoMode& video_mode) {
  switch (video_mode.getPixelFormat()) {
    case openni::PIXEL_FORMAT_DEPTH_1_MM:
      return 1;
    case openni::PIXEL_FORMAT_DEPTH_100_UM:
      return 10;
    default:
      return 0;
  }
}

/// The depth sensor's modes, those in millimetres before the same ones in tenths.
std::vector<openni::VideoMode> supportedModes(const openni::SensorInfo& sensor) {
  std::vector<openni::VideoMode> modes;
  const auto& all = sensor.getSupportedVideoModes();
  for (const int units : {1, 10}) {
    for (int i = 0; i < all.getSize(); ++i) {
      if (unitsPerMm(all[i]) == units) modes.push_back(all[i]);
    }
  }
  return modes;
}

std::string listModes(const std::vector<DepthMode>& modes) {
  std::string text;
  for (auto mode = modes.begin(); mode != modes.end(); ++mode) {
    if (std::find(modes.begin(), mode, *mode) == mode) text += (text.empty() ? "" : ", ") + toString(*mode);
  }
  return text;
}

}  // namespace

/// In the order of dependence: what is below uses what is above, and goes first.
struct OpenNI2Device::Handles {
  OpenNI2Runtime runtime;
  std::unique_ptr<DeviceWatcher> watcher;
  openni::Device device;
  openni::VideoStream stream;
  openni::VideoFrameRef frame;

  ~Handles() {
    frame.release();
    const bool is_file = device.isValid() && device.isFile();
    stream.stop();
    // OpenNI's player goes through its streams without a lock, all the time: let it notice that none is started any
    // more, and sleep, before one is taken away from under it.
    constexpr std::chrono::milliseconds kPlayerComesToRest(50);
    if (is_file) std::this_thread::sleep_for(kPlayerComesToRest);
    stream.destroy();
    device.close();
  }
};

OpenNI2Device::OpenNI2Device(const DepthCameraOptions& options, const std::string& known_serial)
    : is_recording_(depth_object_tracker::isRecording(options.device)) {
  // A file first: OpenNI would only say that no driver knows it.
  if (is_recording_ && !std::ifstream(options.device).good())
    throw CameraError("the recording '" + options.device + "' does not exist or cannot be read");
  handles_ = std::make_unique<Handles>();
  openDevice(options, known_serial);
  openStream(options);
}

OpenNI2Device::~OpenNI2Device() = default;

void OpenNI2Device::openDevice(const DepthCameraOptions& options, const std::string& known_serial) {
  std::string uri = options.device;
  const auto devices = listConnected();
  if (!is_recording_) {
    const std::string found = findDeviceUri(devices, options.device, known_serial, serialOfUri);
    // Drivers may know devices that they do not list, by name or network address.
    if (!found.empty()) uri = found;
    if (uri.empty() || uri.front() == '#') throw CameraError(noSuchDevice(devices, options.device));
  }
  handles_->watcher = std::make_unique<DeviceWatcher>(uri);  // before the device, which may vanish at once
  if (handles_->device.open(uri.c_str()) != openni::STATUS_OK) {
    if (is_recording_) throw CameraError("'" + uri + "' is no .oni recording that OpenNI can play; " + openniError());
    const bool is_listed = std::any_of(devices.begin(), devices.end(), [&](const auto& d) { return d.uri == uri; });
    if (!is_listed) throw CameraError(noSuchDevice(devices, options.device));
    throw CameraError("depth camera '" + uri + "' cannot be opened; does another program use it? " + openniError());
  }
  const openni::DeviceInfo& info = handles_->device.getDeviceInfo();
  description_ = {uri, std::string(info.getVendor()) + " " + info.getName(), serialOf(handles_->device)};
}

void OpenNI2Device::openStream(const DepthCameraOptions& options) {
  const std::string name = "'" + description_.uri + "' (" + description_.name + ")";
  openni::VideoStream& stream = handles_->stream;
  if (!handles_->device.hasSensor(openni::SENSOR_DEPTH)) throw CameraError(name + " has no depth in it");
  if (stream.create(handles_->device, openni::SENSOR_DEPTH) != openni::STATUS_OK)
    throw CameraError("the depth stream of " + name + " cannot be opened; " + openniError());
  if (is_recording_) {
    setUpRecording(options);
  } else {
    setMode(options);
    setRegistration(options.registration);
    if (stream.isCroppingSupported()) stream.resetCropping();
    stream.setMirroringEnabled(false);
  }
  const openni::VideoMode video_mode = stream.getVideoMode();
  mode_ = modeOf(video_mode);
  if (unitsPerMm(video_mode) == 0) throw CameraError("the depth of " + name + " comes in a unit that is not known");
  if (!is_registered_) horizontal_fov_rad_ = static_cast<double>(stream.getHorizontalFieldOfView());
}

void OpenNI2Device::setMode(const DepthCameraOptions& options) {
  const auto video_modes = supportedModes(*handles_->device.getSensorInfo(openni::SENSOR_DEPTH));
  if (video_modes.empty()) return;  // it has but one
  std::vector<DepthMode> modes;
  modes.reserve(video_modes.size());
  for (const openni::VideoMode& video_mode : video_modes) modes.push_back(modeOf(video_mode));
  const DepthMode chosen = nearestMode(modes, options.mode);
  if (!(chosen == options.mode)) {
    notes_.push_back(toString(options.mode) + " is not a mode of '" + description_.uri + "', taking " +
                     toString(chosen) + "; it has " + listModes(modes));
  }
  const auto index = std::find(modes.begin(), modes.end(), chosen) - modes.begin();
  // Devices with a single mode need not be able to set it.
  if (modes.size() > 1 &&
      handles_->stream.setVideoMode(video_modes[static_cast<std::size_t>(index)]) != openni::STATUS_OK)
    notes_.push_back("the mode " + toString(chosen) + " cannot be set; " + openniError());
}

void OpenNI2Device::setRegistration(bool is_wanted) {
  openni::Device& device = handles_->device;
  const auto mode = is_wanted ? openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR : openni::IMAGE_REGISTRATION_OFF;
  is_registered_ = is_wanted && device.isImageRegistrationModeSupported(mode);
  if (is_wanted && !is_registered_) {
    notes_.push_back("'" + description_.uri + "' cannot register depth to its colour camera");
    return;
  }
  if (!device.isImageRegistrationModeSupported(mode)) return;
  if (device.setImageRegistrationMode(mode) != openni::STATUS_OK && is_wanted) {
    is_registered_ = false;
    notes_.push_back("depth of '" + description_.uri + "' cannot be registered; " + openniError());
  }
  if (!is_registered_) return;
  openni::VideoStream color;  // the image is then the colour camera's
  if (color.create(device, openni::SENSOR_COLOR) != openni::STATUS_OK) return;
  horizontal_fov_rad_ = static_cast<double>(color.getHorizontalFieldOfView());
  color.destroy();
}

void OpenNI2Device::setUpRecording(const DepthCameraOptions& options) {
  is_registered_ = handles_->device.getImageRegistrationMode() == openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR;
  openni::PlaybackControl* playback = handles_->device.getPlaybackControl();
  if (playback == nullptr) return;
  playback->setSpeed(kPlayFrameByFrame);
  playback->setRepeatEnabled(options.loop);
}

void OpenNI2Device::start() {
  if (is_started_) return;
  if (handles_->stream.start() != openni::STATUS_OK)
    throw CameraError("the depth stream of '" + description_.uri + "' does not start; " + openniError());
  is_started_ = true;
}

void OpenNI2Device::stop() {
  if (!is_started_) return;
  handles_->frame.release();
  handles_->stream.stop();
  is_started_ = false;
}

std::optional<DepthFrame> OpenNI2Device::read(std::chrono::milliseconds timeout) {
  openni::VideoStream* stream = &handles_->stream;
  int ready = -1;
  if (openni::OpenNI::waitForAnyStream(&stream, 1, &ready, static_cast<int>(timeout.count())) != openni::STATUS_OK)
    return std::nullopt;
  openni::VideoFrameRef& image = handles_->frame;
  if (stream->readFrame(&image) != openni::STATUS_OK || !image.isValid()) return std::nullopt;
  DepthFrame frame;
  frame.data = static_cast<const std::uint16_t*>(image.getData());
  frame.width = image.getWidth();
  frame.height = image.getHeight();
  frame.stride_px = image.getStrideInBytes() / 2;
  frame.units_per_mm = unitsPerMm(image.getVideoMode());
  frame.is_mirrored = stream->getMirroringEnabled();
  frame.full_width = image.getVideoMode().getResolutionX();
  frame.full_height = image.getVideoMode().getResolutionY();
  frame.column_offset = image.getCroppingEnabled() ? image.getCropOriginX() : 0;
  frame.row_offset = image.getCroppingEnabled() ? image.getCropOriginY() : 0;
  frame.timestamp_s = 1e-6 * static_cast<double>(image.getTimestamp());
  frame.horizontal_fov_rad = horizontal_fov_rad_;
  frame.is_registered = is_registered_;
  const bool is_complete = frame.data != nullptr && frame.units_per_mm > 0 && frame.stride_px >= frame.width &&
                           image.getDataSize() >= 2 * frame.stride_px * (frame.height - 1) + 2 * frame.width;
  if (!is_complete) return std::nullopt;
  return frame;
}

bool OpenNI2Device::isConnected() const {
  return handles_->watcher->isConnected();
}

bool OpenNI2Device::isAtEnd() const {
  return handles_->watcher->isAtEnd();
}

std::shared_ptr<void> holdOpenNI2() {
  return std::make_shared<OpenNI2Runtime>();
}

std::vector<DeviceDescription> listDevices() {
  const OpenNI2Runtime runtime;
  return listConnected();
}

}  // namespace depth_object_tracker
