// SPDX-License-Identifier: BSD-3-Clause
#include "surface_distance.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

namespace depth_object_tracker {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

constexpr std::uint32_t kLeafSize = 4;  // triangles

/// Barycentric weights of the point of triangle (a, b, c) that is nearest to p (Ericson, Real-Time Collision Detection,
/// 5.1.5). Not a number where the triangle has no area: such a one is never nearest, its neighbours are.
inline Eigen::Vector3f nearestBarycentric(const Eigen::Vector3f& p, const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                                          const Eigen::Vector3f& c) {
  const Eigen::Vector3f ab = b - a, ac = c - a, ap = p - a;
  const float d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0f && d2 <= 0.0f) return {1.0f, 0.0f, 0.0f};
  const Eigen::Vector3f bp = p - b;
  const float d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0f && d4 <= d3) return {0.0f, 1.0f, 0.0f};
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f) return {1.0f - d1 / (d1 - d3), d1 / (d1 - d3), 0.0f};
  const Eigen::Vector3f cp = p - c;
  const float d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0f && d5 <= d6) return {0.0f, 0.0f, 1.0f};
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f) return {1.0f - d2 / (d2 - d6), 0.0f, d2 / (d2 - d6)};
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0.0f && d4 - d3 >= 0.0f && d5 - d6 >= 0.0f) {
    const float w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0.0f, 1.0f - w, w};
  }
  const float scale = 1.0f / (va + vb + vc);
  return {1.0f - vb * scale - vc * scale, vb * scale, vc * scale};
}

inline void keepNearer(const Eigen::Vector3f& p, const std::array<Eigen::Vector3f, 3>& corners, std::uint32_t triangle,
                       SurfacePoint& best) {
  const Eigen::Vector3f weights = nearestBarycentric(p, corners[0], corners[1], corners[2]);
  const Eigen::Vector3f position = weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
  const float squared_distance = (p - position).squaredNorm();
  if (squared_distance < best.squared_distance) best = {position, weights, triangle, squared_distance};
}

std::array<Eigen::Vector3f, 3> cornersOf(const TriangleMesh& mesh, const Triangle& t) {
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

}  // namespace

Eigen::Vector3d areaVector(const TriangleMesh& mesh, const Triangle& t) {
  const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
  return 0.5 * (mesh.vertices[t[1]].cast<double>() - a).cross(mesh.vertices[t[2]].cast<double>() - a);
}

SurfaceTree::SurfaceTree(const TriangleMesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  std::vector<Eigen::Vector3f> centres;
  centres.reserve(order_.size());
  for (const Triangle& t : mesh.triangles) {
    centres.push_back((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0f);
  }
  nodes_.reserve(order_.size());
  build(centres, 0, static_cast<std::uint32_t>(order_.size()));
  corners_.reserve(order_.size());
  for (const std::uint32_t i : order_) corners_.push_back(cornersOf(mesh, mesh.triangles[i]));
}

/// Halves the triangles along the longest side. @return index of the node for order_[begin, end).
std::uint32_t SurfaceTree::build(const std::vector<Eigen::Vector3f>& centres, std::uint32_t begin, std::uint32_t end) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  if (end - begin <= kLeafSize) {
    nodes_[index].begin = begin;
    nodes_[index].end = end;
    for (std::uint32_t i = begin; i < end; ++i) {
      for (const std::uint32_t corner : mesh_.triangles[order_[i]]) nodes_[index].box.extend(mesh_.vertices[corner]);
    }
    return index;
  }
  Eigen::AlignedBox3f spread;
  for (std::uint32_t i = begin; i < end; ++i) spread.extend(centres[order_[i]]);
  Eigen::Index axis = 0;
  spread.sizes().maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t i, std::uint32_t j) {
                     return std::make_pair(centres[i][axis], i) < std::make_pair(centres[j][axis], j);
                   });
  const std::uint32_t left = build(centres, begin, middle);
  const std::uint32_t right = build(centres, middle, end);
  nodes_[index].right = right;
  nodes_[index].box = nodes_[left].box.merged(nodes_[right].box);
  return index;
}

SurfacePoint SurfaceTree::nearest(const Eigen::Vector3f& point, std::uint32_t guess) const {
  SurfacePoint best;
  keepNearer(point, cornersOf(mesh_, mesh_.triangles[guess]), guess, best);
  descend(point, 0, best);
  return best;
}

void SurfaceTree::descend(const Eigen::Vector3f& point, std::uint32_t node_index, SurfacePoint& best) const {
  const Node& node = nodes_[node_index];
  if (node.right == 0) {
    for (std::uint32_t i = node.begin; i < node.end; ++i) keepNearer(point, corners_[i], order_[i], best);
    return;
  }
  std::uint32_t near = node_index + 1, far = node.right;
  float near_distance = nodes_[near].box.squaredExteriorDistance(point);
  float far_distance = nodes_[far].box.squaredExteriorDistance(point);
  if (far_distance < near_distance) {
    std::swap(near, far);
    std::swap(near_distance, far_distance);
  }
  if (near_distance < best.squared_distance) descend(point, near, best);
  if (far_distance < best.squared_distance) descend(point, far, best);
}

std::vector<SurfacePoint> samplePoints(const TriangleMesh& mesh, const SurfaceTree& tree, std::size_t count,
                                       std::uint32_t seed) {
  double total_area = 0.0;
  for (const std::uint32_t i : tree.spatialOrder()) total_area += areaVector(mesh, mesh.triangles[i]).norm();
  const double area_per_point = total_area / static_cast<double>(count);
  std::mt19937 engine(seed);
  const auto uniform = [&] { return (static_cast<double>(engine()) + 0.5) / 4294967296.0; };  // in (0, 1)
  std::vector<SurfacePoint> points;
  points.reserve(count);
  double area_so_far = 0.0;
  double next = uniform() * area_per_point;
  for (const std::uint32_t i : tree.spatialOrder()) {
    area_so_far += areaVector(mesh, mesh.triangles[i]).norm();
    const auto corners = cornersOf(mesh, mesh.triangles[i]);
    while (points.size() < count && next < area_so_far) {
      const double root = std::sqrt(uniform()), v = uniform();
      SurfacePoint point;
      point.barycentric = Eigen::Vector3d(1.0 - root, root * (1.0 - v), root * v).cast<float>();
      point.position =
          point.barycentric[0] * corners[0] + point.barycentric[1] * corners[1] + point.barycentric[2] * corners[2];
      point.triangle = i;
      points.push_back(point);
      next = (static_cast<double>(points.size()) + uniform()) * area_per_point;
    }
  }
  return points;
}

}  // namespace depth_object_tracker
