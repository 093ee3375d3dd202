// SPDX-License-Identifier: BSD-3-Clause
// Simplify, move the vertices into the middle of the original surface, measure.
#include "depth_object_tracker/geometry/level_of_detail.h"

#include "depth_object_tracker/geometry/mesh_orientation.h"
#include "edge_collapse.h"
#include "surface_distance.h"

#include <Eigen/Core>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>

namespace depth_object_tracker {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

constexpr double kStepRatio = 0.6;                // triangles of a level per triangle of the one before
constexpr double kAcceptedRatio = 0.65;           // what still counts as a step, where no more edges can be collapsed
constexpr std::size_t kLargestLevel = 50'000;     // triangles; a finer one is of no use in a small image
constexpr std::size_t kSmallestLevel = 100;       // triangles; this or the next smaller one is the last level
constexpr std::size_t kMeasuredPoints = 4000;     // on each of the two surfaces
constexpr std::size_t kFittedPointsMin = 4000;    // on the original
constexpr double kFittedPointsPerTriangle = 4.0;  // of the level
constexpr int kFitIterations = 2;
constexpr double kExact = 1e-6;  // rms distance, relative to the size of the mesh: nothing left to improve

enum Seed : std::uint32_t { kSeedOriginal = 1, kSeedLevel = 2, kSeedFit = 3 };

/// Joins vertices at the same place and leaves out unused ones. @param mesh valid triangles only.
TriangleMesh weldVertices(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> order;
  for (const Triangle& t : mesh.triangles) order.insert(order.end(), t.begin(), t.end());
  const auto place = [&](std::uint32_t i) {
    return std::make_tuple(mesh.vertices[i].x(), mesh.vertices[i].y(), mesh.vertices[i].z());
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    return std::make_pair(place(i), i) < std::make_pair(place(j), j);
  });
  // Vertices keep their order in the file: of those at one place the first stays.
  std::vector<std::uint32_t> first_at_place(mesh.vertices.size(), 0);
  std::vector<bool> is_kept(mesh.vertices.size(), false);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_new = i == 0 || place(order[i]) != place(order[i - 1]);
    first_at_place[order[i]] = is_new ? order[i] : first_at_place[order[i - 1]];
    is_kept[first_at_place[order[i]]] = true;
  }
  TriangleMesh welded;
  std::vector<std::uint32_t> new_index(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!is_kept[i]) continue;
    new_index[i] = static_cast<std::uint32_t>(welded.vertices.size());
    welded.vertices.push_back(mesh.vertices[i]);
  }
  for (Triangle t : mesh.triangles) {
    for (std::uint32_t& corner : t) corner = new_index[first_at_place[corner]];
    welded.triangles.push_back(t);
  }
  return welded;
}

TriangleMesh withoutDegenerateTriangles(TriangleMesh mesh) {
  removeDegenerateTriangles(mesh);
  return weldVertices(mesh);
}

/// The original and what every level needs of it.
struct Original {
  const TriangleMesh& mesh;
  bool is_closed;
  double size_m;
  SurfaceTree tree;
  std::vector<SurfacePoint> points;  // to measure on

  Original(const TriangleMesh& welded, bool closed)
      : mesh(welded),
        is_closed(closed),
        size_m(boundingBox(welded).size().norm()),
        tree(welded),
        points(samplePoints(welded, tree, kMeasuredPoints, kSeedOriginal)) {}
};

struct DistanceStatistics {
  double rms_m = 0.0, max_m = 0.0;
  double along_normal_m = 0.0;  // mean, along the normals of the points' own surface
};

/// From points of `mesh` to the surface of the tree. Not a number without points.
DistanceStatistics distances(const TriangleMesh& mesh, const std::vector<SurfacePoint>& points,
                             const SurfaceTree& tree) {
  double squared = 0.0, largest_squared = 0.0, along_normal = 0.0;
  std::uint32_t guess = 0;
  for (const SurfacePoint& point : points) {
    const SurfacePoint nearest = tree.nearest(point.position, guess);
    guess = nearest.triangle;
    const Eigen::Vector3d offset = (nearest.position - point.position).cast<double>();
    squared += offset.squaredNorm();
    largest_squared = std::max(largest_squared, offset.squaredNorm());
    along_normal += offset.dot(areaVector(mesh, mesh.triangles[point.triangle]).normalized());
  }
  const auto count = static_cast<double>(points.size());
  return {std::sqrt(squared / count), std::sqrt(largest_squared), along_normal / count};
}

MeshLevel measure(const Original& original, TriangleMesh mesh) {
  const SurfaceTree tree(mesh);
  const DistanceStatistics from_original = distances(original.mesh, original.points, tree);
  const DistanceStatistics to_original =
      distances(mesh, samplePoints(mesh, tree, kMeasuredPoints, kSeedLevel), original.tree);
  MeshLevel level;
  level.mesh = std::move(mesh);
  level.error_m = std::max(from_original.rms_m, to_original.rms_m);
  level.max_error_m = std::max(from_original.max_m, to_original.max_m);
  level.bias_m = original.is_closed ? from_original.along_normal_m : 0.0;
  return level;
}

/// Least-squares problem: each point of the original is to lie where it was projected to on its triangle of the level.
struct FitProblem {
  Eigen::SparseMatrix<double, Eigen::RowMajor> weights;  // (points + vertices) x vertices
  Eigen::MatrixX3d residuals;                            // [m], one row per row of weights
};

FitProblem makeFitProblem(const TriangleMesh& mesh, const std::vector<SurfacePoint>& points) {
  // A weak pull to where they are, for vertices that few points (or none) hold.
  constexpr double kPull = 0.05;  // relative to the mean weight of the points on a vertex
  const SurfaceTree tree(mesh);
  const auto num_points = static_cast<Eigen::Index>(points.size());
  const auto num_vertices = static_cast<Eigen::Index>(mesh.vertices.size());
  FitProblem problem;
  problem.weights.resize(num_points + num_vertices, num_vertices);
  problem.weights.reserve(3 * num_points + num_vertices);
  problem.residuals = Eigen::MatrixX3d::Zero(num_points + num_vertices, 3);
  std::uint32_t guess = 0;
  for (Eigen::Index row = 0; row < num_points; ++row) {
    const SurfacePoint& point = points[static_cast<std::size_t>(row)];
    const SurfacePoint nearest = tree.nearest(point.position, guess);
    guess = nearest.triangle;
    problem.residuals.row(row) = (point.position - nearest.position).cast<double>();
    std::array<std::pair<std::uint32_t, float>, 3> entries;  // vertex, weight
    for (std::size_t k = 0; k < 3; ++k) {
      entries[k] = {mesh.triangles[nearest.triangle][k], nearest.barycentric[static_cast<Eigen::Index>(k)]};
    }
    std::sort(entries.begin(), entries.end());
    problem.weights.startVec(row);
    for (const auto& [vertex, weight] : entries) problem.weights.insertBack(row, vertex) = weight;
  }
  const double pull = std::sqrt(kPull * static_cast<double>(num_points) / static_cast<double>(num_vertices));
  for (Eigen::Index vertex = 0; vertex < num_vertices; ++vertex) {
    problem.weights.startVec(num_points + vertex);
    problem.weights.insertBack(num_points + vertex, vertex) = pull;
  }
  problem.weights.finalize();
  return problem;
}

/// Moves the vertices so that the squared distances from points of the original become least on average: the surface
/// comes to lie in its middle (Hoppe et al., Mesh Optimization, SIGGRAPH 1993).
TriangleMesh fitVertices(const Original& original, TriangleMesh mesh) {
  constexpr int kMaxSolverIterations = 30;
  constexpr double kSolverTolerance = 1e-3;
  const auto wanted = static_cast<std::size_t>(kFittedPointsPerTriangle * static_cast<double>(mesh.triangles.size()));
  const std::vector<SurfacePoint> points =
      samplePoints(original.mesh, original.tree, std::max(kFittedPointsMin, wanted), kSeedFit);
  for (int iteration = 0; iteration < kFitIterations; ++iteration) {
    const FitProblem problem = makeFitProblem(mesh, points);
    Eigen::LeastSquaresConjugateGradient<Eigen::SparseMatrix<double, Eigen::RowMajor>> solver;
    solver.setMaxIterations(kMaxSolverIterations);
    solver.setTolerance(kSolverTolerance);
    solver.compute(problem.weights);
    const Eigen::MatrixX3d shift = solver.solve(problem.residuals);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      mesh.vertices[i] += shift.row(static_cast<Eigen::Index>(i)).transpose().cast<float>();
    }
  }
  return mesh;
}

/// Fewer triangles, at best `target`. A closed surface keeps its topology as long as that goes.
TriangleMesh simplify(const TriangleMesh& mesh, std::size_t target, bool is_closed) {
  const auto most = static_cast<std::size_t>(kAcceptedRatio * static_cast<double>(mesh.triangles.size()));
  if (is_closed) {
    EdgeCollapser collapser(mesh);
    collapser.reduceTo(target, EdgeCollapser::Topology::kKept);
    if (collapser.numTriangles() <= most) return collapser.mesh();
  }
  EdgeCollapser collapser(mesh);
  collapser.reduceTo(target, EdgeCollapser::Topology::kFree);
  return collapser.numTriangles() <= most ? collapser.mesh() : TriangleMesh();
}

/// The level after a mesh; without triangles when there is none.
MeshLevel nextLevel(const Original& original, const TriangleMesh& previous) {
  const auto step = static_cast<std::size_t>(kStepRatio * static_cast<double>(previous.triangles.size()));
  TriangleMesh mesh = simplify(previous, std::min(step, kLargestLevel), original.is_closed);
  if (mesh.triangles.empty()) return {};
  MeshLevel level = measure(original, std::move(mesh));
  if (level.error_m > kExact * original.size_m) {
    MeshLevel fitted = measure(original, fitVertices(original, level.mesh));
    if (fitted.error_m < level.error_m) level = std::move(fitted);
  }
  // The renderer would draw both sides of a level that is open: slower than the level before.
  if (original.is_closed && !orientOutward(level.mesh, level.mesh.triangles)) return {};
  return level;
}

}  // namespace

std::vector<MeshLevel> makeLevels(const TriangleMesh& mesh, double max_error_m) {
  std::vector<MeshLevel> levels(1);
  TriangleMesh& finest = levels[0].mesh;
  finest = withoutDegenerateTriangles(mesh);
  if (finest.triangles.empty() || !(max_error_m > 0.0)) return levels;
  const bool is_closed = orientOutward(finest, finest.triangles);
  const TriangleMesh original_mesh = finest;
  const Original original(original_mesh, is_closed);
  while (levels.back().mesh.triangles.size() > kSmallestLevel) {
    // From the level before, not from the original: it already lies in the middle of the surface, which measures better
    // on nearly every mesh, and takes less time.
    MeshLevel level = nextLevel(original, levels.back().mesh);
    if (level.mesh.triangles.empty() || !(level.error_m <= max_error_m)) break;
    levels.push_back(std::move(level));
  }
  return levels;
}

std::size_t chooseLevel(const std::vector<MeshLevel>& levels, double allowed_error_m) {
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (levels[i].error_m <= allowed_error_m) chosen = i;
  }
  return chosen;
}

}  // namespace depth_object_tracker
