// Finds and merges vertices that only rounding keeps apart.

#include "core/geometry/mesh_seams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/geometry/constants.h"

namespace weft {
namespace {

/// Edges with a triangle on one side only.
std::vector<Edge> border_edges(const TriangleMesh& mesh) {
  std::vector<Edge> border;
  for (const MeshEdge& edge : edges_of(mesh)) {
    if (edge.triangle[1] == kNone) border.push_back({edge.a, edge.b});
  }
  return border;
}

/// Distance below which vertices of the border count as one [m].
double tolerance_of(const TriangleMesh& mesh, const std::vector<Edge>& border) {
  double edges = 0, farthest = 0;
  for (const Edge& edge : border) {
    const Vec3d &a = mesh.positions[static_cast<std::size_t>(edge[0])],
                &b = mesh.positions[static_cast<std::size_t>(edge[1])];
    edges += (b - a).norm();
    farthest = std::max({farthest, a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff()});
  }
  const double rounding = farthest * static_cast<double>(std::numeric_limits<float>::epsilon());
  return std::max(kOpenSeam * edges / static_cast<double>(border.size()), 2 * rounding);
}

/// Vertices in cubes as large as the tolerance.
class Cubes {
 public:
  Cubes(const std::vector<Vec3d>& positions, double size) : positions_(positions), size_(size) {}

  /// The first vertex that is nearer than the tolerance, and for which `may`.
  template <class May>
  std::optional<Index> near(Index i, May&& may) const {
    const Vec3d& p = at(i);
    std::optional<Index> first;
    const Cube own = cube(p);
    for (long x = -1; x <= 1; ++x) {
      for (long y = -1; y <= 1; ++y) {
        for (long z = -1; z <= 1; ++z) {
          const auto [begin, end] = vertices_.equal_range({own[0] + x, own[1] + y, own[2] + z});
          for (auto there = begin; there != end; ++there) {
            const Index j = there->second;
            if ((at(j) - p).norm() < size_ && (!first || j < *first) && may(j)) first = j;
          }
        }
      }
    }
    return first;
  }
  void add(Index i) { vertices_.emplace(cube(at(i)), i); }

 private:
  using Cube = std::array<long, 3>;
  const Vec3d& at(Index i) const { return positions_[static_cast<std::size_t>(i)]; }
  Cube cube(const Vec3d& p) const {
    const auto number = [&](int k) { return static_cast<long>(std::floor(p[k] / size_)); };
    return {number(0), number(1), number(2)};
  }

  const std::vector<Vec3d>& positions_;
  double size_;
  std::multimap<Cube, Index> vertices_;
};

/// The vertex that each one becomes.
std::vector<Index> merged_vertices(const TriangleMesh& mesh, const std::vector<Edge>& border) {
  std::vector<Index> to(mesh.positions.size());
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = static_cast<Index>(i);
  std::map<Index, std::vector<Index>> neighbours;  // of vertices of the border
  std::vector<Index> vertices;
  for (const Edge& edge : border) vertices.insert(vertices.end(), edge.begin(), edge.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  for (const Triangle& t : mesh.triangles) {
    for (const Index i : t) {
      if (std::binary_search(vertices.begin(), vertices.end(), i))
        neighbours[i].insert(neighbours[i].end(), t.begin(), t.end());
    }
  }
  Cubes cubes(mesh.positions, tolerance_of(mesh, border));
  for (const Index i : vertices) {
    const std::vector<Index>& near = neighbours[i];
    const auto there = cubes.near(
        i, [&](Index j) { return std::find(near.begin(), near.end(), j) == near.end(); });
    if (there)
      to[static_cast<std::size_t>(i)] = *there;
    else
      cubes.add(i);
  }
  return to;
}

}  // namespace

void close_seams(MeshFile& file) {
  TriangleMesh& mesh = file.mesh;
  const std::vector<Edge> border = border_edges(mesh);
  if (border.empty()) return;
  const std::vector<Index> to = merged_vertices(mesh, border);
  bool parts_uv = false, any = false;
  for (std::size_t i = 0; i < to.size(); ++i) {
    const auto other = static_cast<std::size_t>(to[i]);
    any = any || other != i;
    parts_uv = parts_uv || (!file.uv.empty() && file.uv[i] != file.uv[other]);
  }
  if (!any) return;
  if (parts_uv && file.corner_uv.empty()) {
    for (const Triangle& t : mesh.triangles) {
      CornerUv& corners = file.corner_uv.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) corners[k] = file.uv[static_cast<std::size_t>(t[k])];
    }
  }
  // Those that stay close the gaps, in their order.
  std::vector<Index> place(to.size(), kNone);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (to[i] != static_cast<Index>(i)) continue;
    place[i] = static_cast<Index>(kept);
    mesh.positions[kept] = mesh.positions[i];
    if (!file.uv.empty()) file.uv[kept] = file.uv[i];
    ++kept;
  }
  mesh.positions.resize(kept);
  if (!file.uv.empty()) file.uv.resize(kept);
  for (Triangle& t : mesh.triangles) {
    for (Index& i : t) i = place[static_cast<std::size_t>(to[static_cast<std::size_t>(i)])];
  }
}

}  // namespace weft
