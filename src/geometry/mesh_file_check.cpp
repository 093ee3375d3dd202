// SPDX-License-Identifier: BSD-3-Clause
// Damaged, misnamed and hostile files are told apart here, with a sentence for the user.
#include "mesh_file_check.h"

#include "depth_object_tracker/geometry/mesh_loader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <set>
#include <sstream>

namespace depth_object_tracker {
namespace {

constexpr std::size_t kMaxHeaderBytes = 1 << 20;

std::string formatCount(double count) {
  std::ostringstream stream;
  stream.precision(15);
  stream << count;
  return stream.str();
}

/// What a PLY header promises.
struct PlyElements {
  double count = 0.0;
  std::set<std::string> names;
};

/// What is wrong with one line of a PLY header, "" when nothing is. Adds an element to `elements`.
std::string findPlyProblem(const std::string& line, PlyElements& elements) {
  // assimp ends lines at any of these, and so would read elements out of what is a comment here.
  const auto is_control = [](char letter) { return static_cast<unsigned char>(letter) < ' ' && letter != '\t'; };
  if (std::any_of(line.begin(), line.end(), is_control)) return "its header has a control character within a line";
  static const std::set<std::string> kKeywords = {"ply", "format", "comment", "obj_info", "element", "property"};
  std::istringstream words(line);
  std::string keyword, name;
  if (!(words >> keyword) || kKeywords.count(keyword) == 0) return "its header has the line '" + line + "'";
  if (keyword != "element") return "";
  double count = 0.0;
  if (!(words >> name >> count && count >= 0.0)) return "its header has the line '" + line + "'";
  elements.count += count;
  // assimp writes both into one array, which has room for the first of them.
  if (!elements.names.insert(name == "tristrips" ? "face" : name).second) {
    return "its header has the element '" + name + "' twice, or both faces and strips";
  }
  return "";
}

/// assimp's PLY reader does not return from headers that do not end, and trusts their counts with its memory.
void checkPlyHeader(const std::string& content) {
  constexpr int kMaxHeaderLines = 1000;
  const std::string name = "cannot be read as .ply: ";
  std::istringstream file(content.substr(0, kMaxHeaderBytes));
  std::string line;
  PlyElements elements;
  for (int i = 0; i < kMaxHeaderLines && std::getline(file, line); ++i) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (i == 0 && line != "ply") throw MeshError(name + "it does not begin with the line 'ply'");
    if (line == "end_header") {
      // An element takes at least one byte.
      const double num_data_bytes =
          file.eof() ? 0.0 : static_cast<double>(content.size()) - static_cast<double>(file.tellg());
      if (elements.count > 0.0 && elements.count <= num_data_bytes) return;
      throw MeshError(name + "its header promises " + formatCount(elements.count) + " elements, " +
                      formatCount(num_data_bytes) + " bytes follow");
    }
    const std::string problem = findPlyProblem(line, elements);
    if (!problem.empty()) throw MeshError(name + problem);
  }
  throw MeshError(name + "its header has no line 'end_header'");
}

/// Calls `check(attributes, text)` for every element of that name: what stands in its tag, and its text up to the next
/// tag.
template <typename Check>
void forEachElement(const std::string& xml, const std::string& element, const Check& check) {
  const std::string opening = "<" + element;
  for (std::size_t begin = xml.find(opening); begin != std::string::npos; begin = xml.find(opening, begin + 1)) {
    const std::size_t attributes = begin + opening.size();
    const std::size_t end = xml.find('>', attributes);
    if (end == std::string::npos) return;
    if (xml[attributes] != '>' && std::isspace(static_cast<unsigned char>(xml[attributes])) == 0)
      continue;  // a longer name
    const std::size_t text_end = std::min(xml.find('<', end), xml.size());
    check(xml.substr(attributes, end - attributes), xml.substr(end + 1, text_end - end - 1));
  }
}

/// Whether one of NAME="VALUE" has that name; not within a value, nor at the end of a longer name.
bool hasAttribute(const std::string& attributes, const std::string& name) {
  for (std::size_t i = attributes.find_first_not_of(" \t\r\n"); i != std::string::npos;) {
    const std::size_t equals = attributes.find('=', i);
    if (equals == std::string::npos) return false;
    if (attributes.compare(i, equals - i, name) == 0) return true;
    const std::size_t quote = attributes.find_first_of("\"'", equals);
    if (quote == std::string::npos) return false;
    const std::size_t end = attributes.find(attributes[quote], quote + 1);
    if (end == std::string::npos) return false;
    i = attributes.find_first_not_of(" \t\r\n", end + 1);
  }
  return false;
}

/// assimp's Collada reader does not return from index lists that hold anything but integers, and crashes on arrays
/// without count.
void checkDaeText(const std::string& xml) {
  const std::string name = "cannot be read as .dae: ";
  for (const char* element : {"p", "vcount"}) {
    forEachElement(xml, element, [&](const std::string&, const std::string& text) {
      const std::size_t position = text.find_first_not_of("0123456789 \t\r\n");
      if (position == std::string::npos) return;
      throw MeshError(name + "an index list <" + element + "> holds '" + text.substr(position, 8) +
                      "' where an integer was expected");
    });
  }
  for (const char* element : {"float_array", "Name_array", "IDREF_array"}) {
    forEachElement(xml, element, [&](const std::string& attributes, const std::string&) {
      if (!hasAttribute(attributes, "count")) throw MeshError(name + "an element <" + element + "> has no count");
    });
  }
  for (const char* attribute : {" count=\"", " stride=\"", " offset=\""}) {
    for (std::size_t i = xml.find(attribute); i != std::string::npos; i = xml.find(attribute, i + 1)) {
      const std::size_t begin = i + std::strlen(attribute);
      const std::string value = xml.substr(begin, std::min(xml.find('"', begin), xml.size()) - begin);
      const bool is_count =
          !value.empty() && value.size() <= 9 && value.find_first_not_of("0123456789") == std::string::npos;
      if (!is_count) throw MeshError(name + "the attribute" + attribute + value.substr(0, 20) + "\" is not a count");
    }
  }
}

}  // namespace

std::string meshExtension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  if (std::find(kMeshExtensions.begin(), kMeshExtensions.end(), extension) != kMeshExtensions.end()) return extension;
  throw MeshError("the format '." + extension + "' is not supported; convert it to .obj, .stl, .ply or .dae");
}

void checkMeshContent(const std::string& content, const std::string& extension) {
  if (content.empty()) throw MeshError("the file is empty");
  if (extension == "ply") checkPlyHeader(content);
  if (extension == "dae") checkDaeText(content);
}

}  // namespace depth_object_tracker
