// SPDX-License-Identifier: BSD-3-Clause
#include "edge_collapse.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <iterator>
#include <limits>

namespace depth_object_tracker {
namespace {

/// Directions in which the planes hold a point less than this, relative to the firmest one, count as free.
constexpr double kFreeDirection = 1e-3;

bool contains(const std::array<std::uint32_t, 3>& triangle, std::uint32_t vertex) {
  return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

}  // namespace

void PlaneQuadric::addPlane(const Eigen::Vector3d& normal, const Eigen::Vector3d& point, double weight) {
  const double height = normal.dot(point);
  normals += weight * normal * normal.transpose();
  moment += weight * height * normal;
  constant += weight * height * height;
}

PlaneQuadric& PlaneQuadric::operator+=(const PlaneQuadric& other) {
  normals += other.normals;
  moment += other.moment;
  constant += other.constant;
  return *this;
}

double PlaneQuadric::at(const Eigen::Vector3d& point) const {
  return std::max(0.0, point.dot(normals * point) - 2.0 * moment.dot(point) + constant);
}

Eigen::Vector3d PlaneQuadric::minimum(const Eigen::Vector3d& start) const {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(normals);
  const Eigen::Vector3d& firmness = solver.eigenvalues();  // ascending
  const Eigen::Vector3d gradient = moment - normals * start;
  Eigen::Vector3d point = start;
  for (int k = 0; k < 3; ++k) {
    if (!(firmness[k] > kFreeDirection * firmness[2])) continue;
    const Eigen::Vector3d direction = solver.eigenvectors().col(k);
    point += direction * (direction.dot(gradient) / firmness[k]);
  }
  return point;
}

EdgeCollapser::EdgeCollapser(const TriangleMesh& mesh)
    : triangles_(mesh.triangles),
      triangles_of_(mesh.vertices.size()),
      quadrics_(mesh.vertices.size()),
      version_(mesh.vertices.size(), 0),
      is_border_(mesh.vertices.size(), false),
      num_triangles_(mesh.triangles.size()) {
  positions_.reserve(mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices) positions_.push_back(vertex.cast<double>());
  for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
    for (const std::uint32_t corner : triangles_[i]) triangles_of_[corner].push_back(i);
  }
  addPlanes();
}

void EdgeCollapser::addPlanes() {
  std::vector<std::array<std::uint32_t, 3>> edges;  // lower vertex, higher vertex, triangle
  edges.reserve(3 * triangles_.size());
  std::vector<Eigen::Vector3d> normals;
  normals.reserve(triangles_.size());
  for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
    const Triangle& t = triangles_[i];
    const Eigen::Vector3d& a = positions_[t[0]];
    const Eigen::Vector3d area_vector = 0.5 * (positions_[t[1]] - a).cross(positions_[t[2]] - a);
    normals.push_back(area_vector.normalized());
    for (std::size_t k = 0; k < 3; ++k) {
      quadrics_[t[k]].addPlane(normals[i], a, area_vector.norm());
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      edges.push_back({low, high, i});
    }
  }
  std::sort(edges.begin(), edges.end());
  const auto same_edge = [&](std::size_t i, std::size_t j) {
    return j < edges.size() && edges[i][0] == edges[j][0] && edges[i][1] == edges[j][1];
  };
  std::vector<std::size_t> first_of_edge;
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    first_of_edge.push_back(i);
    for (end = i + 1; same_edge(i, end);) ++end;
    if (end - i == 2) continue;
    for (std::size_t k = i; k < end; ++k) addBorder(edges[k][0], edges[k][1], normals[edges[k][2]]);
  }
  for (const std::size_t i : first_of_edge) pushEdge(edges[i][0], edges[i][1]);  // now that all planes are known
}

/// A border stays in place as if a wall stood on it.
void EdgeCollapser::addBorder(std::uint32_t i, std::uint32_t j, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d along = positions_[j] - positions_[i];
  const Eigen::Vector3d wall = along.cross(normal).normalized();
  for (const std::uint32_t end : {i, j}) {
    quadrics_[end].addPlane(wall, positions_[i], along.squaredNorm());
    is_border_[end] = true;
  }
}

Eigen::Vector3d EdgeCollapser::mergedPosition(std::uint32_t i, std::uint32_t j) const {
  PlaneQuadric sum = quadrics_[i];
  sum += quadrics_[j];
  return sum.minimum(0.5 * (positions_[i] + positions_[j]));
}

void EdgeCollapser::pushEdge(std::uint32_t i, std::uint32_t j) {
  constexpr double kLengthCost = 1e-9;  // a trace, for regular triangles where nothing else counts
  const auto [low, high] = std::minmax(i, j);
  const Eigen::Vector3d merged = mergedPosition(low, high);
  const double length_squared = (positions_[i] - positions_[j]).squaredNorm();
  const double cost = quadrics_[i].at(merged) + quadrics_[j].at(merged) + kLengthCost * length_squared * length_squared;
  queue_.push({cost, low, high, version_[low], version_[high]});
}

std::vector<std::uint32_t> EdgeCollapser::neighbours(std::uint32_t i) const {
  std::vector<std::uint32_t> found;
  for (const std::uint32_t triangle : triangles_of_[i]) {
    for (const std::uint32_t corner : triangles_[triangle]) {
      if (corner != i) found.push_back(corner);
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

/// The link condition: only the far corners of the edge's own triangles may be neighbours of both ends.
bool EdgeCollapser::keepsTopology(std::uint32_t i, std::uint32_t j) const {
  const auto on_edge = static_cast<std::size_t>(
      std::count_if(triangles_of_[i].begin(), triangles_of_[i].end(),
                    [&](std::uint32_t triangle) { return contains(triangles_[triangle], j); }));
  if (on_edge == 2 && is_border_[i] && is_border_[j]) return false;                // would pinch the surface
  if (triangles_of_[i].size() <= 3 && triangles_of_[j].size() <= 3) return false;  // a tetrahedron, or a loose piece
  const std::vector<std::uint32_t> of_i = neighbours(i), of_j = neighbours(j);
  std::vector<std::uint32_t> common;
  std::set_intersection(of_i.begin(), of_i.end(), of_j.begin(), of_j.end(), std::back_inserter(common));
  return common.size() == on_edge;
}

/// Would a triangle of `moved` (that stays) turn over or become a sliver?
bool EdgeCollapser::folds(std::uint32_t moved, std::uint32_t other, const Eigen::Vector3d& position) const {
  constexpr double kLeastCosine = 0.5;     // of the angle that a triangle turns by
  constexpr double kLeastFlatness = 1e-3;  // height / longest side
  for (const std::uint32_t triangle : triangles_of_[moved]) {
    const Triangle& t = triangles_[triangle];
    if (contains(t, other)) continue;
    const std::size_t k = t[0] == moved ? 0 : t[1] == moved ? 1 : 2;
    const Eigen::Vector3d &b = positions_[t[(k + 1) % 3]], &c = positions_[t[(k + 2) % 3]];
    const Eigen::Vector3d before = (b - positions_[moved]).cross(c - positions_[moved]);
    const Eigen::Vector3d after = (b - position).cross(c - position);
    if (!(before.dot(after) > kLeastCosine * before.norm() * after.norm())) return true;
    const double longest_squared =
        std::max({(b - c).squaredNorm(), (b - position).squaredNorm(), (c - position).squaredNorm()});
    if (after.norm() < kLeastFlatness * longest_squared) return true;
  }
  return false;
}

void EdgeCollapser::collapse(std::uint32_t kept, std::uint32_t removed, const Eigen::Vector3d& position) {
  positions_[kept] = position;
  quadrics_[kept] += quadrics_[removed];
  is_border_[kept] = is_border_[kept] || is_border_[removed];
  ++version_[kept];
  ++version_[removed];
  for (const std::uint32_t triangle : triangles_of_[removed]) {
    Triangle& t = triangles_[triangle];
    if (!contains(t, kept)) {
      std::replace(t.begin(), t.end(), removed, kept);
      triangles_of_[kept].push_back(triangle);
      continue;
    }
    for (const std::uint32_t corner : t) {
      if (corner == removed) continue;
      auto& list = triangles_of_[corner];
      list.erase(std::find(list.begin(), list.end(), triangle));
    }
    t = {0, 0, 0};
    --num_triangles_;
  }
  triangles_of_[removed].clear();
  for (const std::uint32_t neighbour : neighbours(kept)) pushEdge(kept, neighbour);
}

void EdgeCollapser::reduceTo(std::size_t target_triangles, Topology topology) {
  while (num_triangles_ > target_triangles && !queue_.empty()) {
    const Edge edge = queue_.top();
    queue_.pop();
    if (edge.low_version != version_[edge.low] || edge.high_version != version_[edge.high]) continue;
    // Nothing but holes would come of a surface of loose triangles.
    if (triangles_of_[edge.low].size() == 1 && triangles_of_[edge.high].size() == 1) continue;
    if (topology == Topology::kKept && !keepsTopology(edge.low, edge.high)) continue;
    const Eigen::Vector3d position = mergedPosition(edge.low, edge.high);
    if (folds(edge.low, edge.high, position) || folds(edge.high, edge.low, position)) continue;
    collapse(edge.low, edge.high, position);
  }
}

TriangleMesh EdgeCollapser::mesh() const {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  TriangleMesh mesh;
  std::vector<std::uint32_t> new_index(positions_.size(), kNone);
  for (const Triangle& t : triangles_) {
    if (t[0] == t[1]) continue;
    Triangle mapped;
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& index = new_index[t[k]];
      if (index == kNone) {
        index = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(positions_[t[k]].cast<float>());
      }
      mapped[k] = index;
    }
    mesh.triangles.push_back(mapped);
  }
  return mesh;
}

}  // namespace depth_object_tracker
