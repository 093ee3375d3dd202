// SPDX-License-Identifier: BSD-3-Clause
// What is asked of a depth camera: which device, which mode, how a recording is played.
#pragma once

#include <string>
#include <vector>

namespace depth_object_tracker {

/// Size and rate of a depth stream.
struct DepthMode {
  int width = 640;   ///< [px]
  int height = 480;  ///< [px]
  int fps = 30;      ///< [Hz]

  bool operator==(const DepthMode& other) const {
    return width == other.width && height == other.height && fps == other.fps;
  }
};

/// "640x480 at 30 Hz"
std::string toString(const DepthMode& mode);

/// The mode nearest to what was asked for: the size first, then the rate; of equals the first.
/// @param supported not empty
DepthMode nearestMode(const std::vector<DepthMode>& supported, const DepthMode& wished);

struct DepthCameraOptions {
  /// "" = the first device, "#2" = the second, an OpenNI URI ("1d27/0601@1/5"), bus and address on it ("1@5"), a serial
  /// number, or the path of an .oni recording.
  std::string device;
  DepthMode mode;             ///< of live devices; recordings have their own
  bool registration = false;  ///< the device re-projects depth into its colour camera's view
  bool loop = false;          ///< recordings: start again at the end
  double playback_speed = 1;  ///< recordings: factor on the recorded pace; 0 = as fast as frames are taken
};

/// True when `device` names a recording.
bool isRecording(const std::string& device);

}  // namespace depth_object_tracker
