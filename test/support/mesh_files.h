// SPDX-License-Identifier: BSD-3-Clause
// The same tetrahedron, corners (0,0,0) (.1,0,0) (0,.2,0) (0,0,.3), as a file of every supported format.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>

namespace depth_object_tracker {

constexpr std::array<std::array<float, 3>, 4> kTetrahedronCorners = {
    {{0, 0, 0}, {0.1f, 0, 0}, {0, 0.2f, 0}, {0, 0, 0.3f}}};
constexpr std::array<std::array<int, 3>, 4> kTetrahedronFaces = {{{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};

inline std::string tetrahedronObj(double factor = 1.0) {
  std::ostringstream text;
  for (const auto& p : kTetrahedronCorners)
    text << "v " << factor * p[0] << " " << factor * p[1] << " " << factor * p[2] << "\n";
  for (const auto& f : kTetrahedronFaces) text << "f " << f[0] + 1 << " " << f[1] + 1 << " " << f[2] + 1 << "\n";
  return text.str();
}

inline std::string tetrahedronStlAscii() {
  std::ostringstream text;
  text << "solid tetrahedron\n";
  for (const auto& f : kTetrahedronFaces) {
    text << " facet normal 0 0 0\n  outer loop\n";
    for (const int i : f) {
      const auto& p = kTetrahedronCorners[static_cast<std::size_t>(i)];
      text << "   vertex " << p[0] << " " << p[1] << " " << p[2] << "\n";
    }
    text << "  endloop\n endfacet\n";
  }
  text << "endsolid tetrahedron\n";
  return text.str();
}

/// Bytes of a value on this (little-endian) machine.
template <typename Value>
std::string rawBytes(const Value& value) {
  std::string bytes(sizeof(Value), '\0');
  std::memcpy(bytes.data(), &value, sizeof(Value));
  return bytes;
}

inline std::string tetrahedronStlBinary(std::string header, double factor = 1.0) {
  header.resize(80, ' ');
  std::string bytes = header + rawBytes(std::uint32_t{4});
  for (const auto& f : kTetrahedronFaces) {
    bytes += std::string(12, '\0');
    for (const int i : f) {
      for (const float c : kTetrahedronCorners[static_cast<std::size_t>(i)])
        bytes += rawBytes(static_cast<float>(factor * c));
    }
    bytes += std::string(2, '\0');
  }
  return bytes;
}

inline std::string plyHeader(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
}

inline std::string tetrahedronPlyAscii() {
  std::ostringstream text;
  text << plyHeader("ascii");
  for (const auto& p : kTetrahedronCorners) text << p[0] << " " << p[1] << " " << p[2] << "\n";
  for (const auto& f : kTetrahedronFaces) text << "3 " << f[0] << " " << f[1] << " " << f[2] << "\n";
  return text.str();
}

inline std::string tetrahedronPlyBinary() {
  std::string bytes = plyHeader("binary_little_endian");
  for (const auto& p : kTetrahedronCorners) bytes += rawBytes(p);
  for (const auto& f : kTetrahedronFaces) bytes += '\3' + rawBytes(f);
  return bytes;
}

/// @param transform elements of the node that shows the tetrahedron.
inline std::string tetrahedronDae(const std::string& metres_per_unit, const std::string& up_axis,
                                  const std::string& transform) {
  std::ostringstream text;
  text
      << "<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">\n"
      << "<asset><unit meter=\"" << metres_per_unit << "\" name=\"unit\"/><up_axis>" << up_axis
      << "</up_axis></asset>\n"
      << "<library_geometries><geometry id=\"g\"><mesh>\n<source id=\"p\"><float_array id=\"pa\" count=\"12\">";
  for (const auto& p : kTetrahedronCorners) text << p[0] << " " << p[1] << " " << p[2] << " ";
  text
      << "</float_array><technique_common><accessor source=\"#pa\" count=\"4\" stride=\"3\"><param name=\"X\" "
         "type=\"float\"/>"
      << "<param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor></technique_common></source>\n"
      << "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>\n"
      << "<triangles count=\"4\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>";
  for (const auto& f : kTetrahedronFaces) text << f[0] << " " << f[1] << " " << f[2] << " ";
  text << "</p></triangles></mesh></geometry></library_geometries>\n<library_visual_scenes><visual_scene "
          "id=\"s\"><node id=\"n\">"
       << transform << "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes>\n"
       << "<scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>\n";
  return text.str();
}

}  // namespace depth_object_tracker
