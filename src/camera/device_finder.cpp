// SPDX-License-Identifier: BSD-3-Clause
#include "device_finder.h"

#include <cstdlib>

namespace depth_object_tracker {
namespace {

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string findBySerial(const std::vector<DeviceDescription>& devices, const std::string& serial,
                         const std::function<std::string(const std::string& uri)>& serial_of) {
  if (serial.empty()) return "";
  for (const DeviceDescription& device : devices) {
    if (serial_of(device.uri) == serial) return device.uri;
  }
  return "";
}

}  // namespace

std::string findDeviceUri(const std::vector<DeviceDescription>& devices, const std::string& device,
                          const std::string& known_serial,
                          const std::function<std::string(const std::string& uri)>& serial_of) {
  for (const DeviceDescription& candidate : devices) {
    if (candidate.uri == device) return candidate.uri;
  }
  // Where no particular device is asked for, the one that was unplugged comes before others.
  std::string same = findBySerial(devices, known_serial, serial_of);
  if (!same.empty()) return same;
  if (device.empty()) return devices.empty() ? "" : devices.front().uri;
  if (device.front() == '#') {
    const auto number = std::strtoul(device.c_str() + 1, nullptr, 10);
    return number >= 1 && number <= devices.size() ? devices[number - 1].uri : "";
  }
  if (device.find('@') != std::string::npos) {
    for (const DeviceDescription& candidate : devices) {
      if (endsWith(candidate.uri, "@" + device) || endsWith(candidate.uri, "/" + device)) return candidate.uri;
      // PrimeSense's URIs are vendor/product@bus/address.
      std::string bus_and_address = device;
      bus_and_address[bus_and_address.find('@')] = '/';
      if (endsWith(candidate.uri, "@" + bus_and_address)) return candidate.uri;
    }
  }
  return findBySerial(devices, device, serial_of);
}

std::string noSuchDevice(const std::vector<DeviceDescription>& devices, const std::string& device) {
  std::string text = device.empty() ? "no depth camera" : "no depth camera '" + device + "'";
  if (devices.empty()) {
    return text +
           "; none is connected, or none that this user may open: is it plugged in, and does its USB port give enough "
           "power?";
  }
  text += "; connected:";
  for (const DeviceDescription& candidate : devices) text += " '" + candidate.uri + "' (" + candidate.name + ")";
  return text;
}

}  // namespace depth_object_tracker
