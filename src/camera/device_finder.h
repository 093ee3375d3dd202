// SPDX-License-Identifier: BSD-3-Clause
// From what a user writes to the device that is meant.
#pragma once

#include "depth_object_tracker/camera/openni2_device.h"

#include <functional>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// URI of the device that `device` means ("", "#2", URI, "bus@address", serial number); empty when none of those that
/// are there. @param serial_of asks a device, which costs opening it: only done where nothing else fits.
std::string findDeviceUri(const std::vector<DeviceDescription>& devices, const std::string& device,
                          const std::string& known_serial,
                          const std::function<std::string(const std::string& uri)>& serial_of);

/// "no device '...'; connected: ..." and what to try.
std::string noSuchDevice(const std::vector<DeviceDescription>& devices, const std::string& device);

}  // namespace depth_object_tracker
