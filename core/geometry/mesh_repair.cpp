// Removes degenerate triangles and turns meshes that face inwards.

#include "core/geometry/mesh_repair.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/geometry/constants.h"

namespace weft {
namespace {

const Vec3d& at(const TriangleMesh& mesh, Index vertex) {
  assert(static_cast<std::size_t>(vertex) < mesh.positions.size());
  return mesh.positions[static_cast<std::size_t>(vertex)];
}

bool has_valid_indices(const TriangleMesh& mesh) {
  const auto count = static_cast<Index>(mesh.positions.size());
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [count](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [count](Index i) { return i >= 0 && i < count; });
  });
}

/// Removes triangles without area, and keeps a closed surface closed where possible.
class FlatTriangles {
 public:
  explicit FlatTriangles(TriangleMesh& mesh) : mesh_(mesh), removed_(mesh.triangles.size(), false) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      enter(t);
      if (is_degenerate(mesh, mesh.triangles[t])) flat_.push_back(t);
    }
  }

  /// @returns how many were removed
  std::size_t take_out() {
    // Collinear consecutive corners leave another flat triangle, with a shorter row of corners.
    for (int i = 0; i < kMostRepairPasses && !flat_.empty(); ++i) {
      if (!pass()) break;
    }
    for (const std::size_t t : flat_) remove(t);
    return erase_removed();
  }

 private:
  using Side = std::array<Index, 2>;  // from, to

  /// @returns whether anything has changed
  bool pass() {
    const std::vector<std::size_t> flat = std::exchange(flat_, {});
    bool changed = false;
    for (const std::size_t t : flat) {
      if (removed_[t] || !is_degenerate(mesh_, mesh_.triangles[t])) continue;
      if (has_doubled_corner(mesh_.triangles[t])) {
        remove(t);  // its remainder is one side, there and back
        changed = true;
      } else if (cut_neighbour(t)) {
        changed = true;
      } else {
        flat_.push_back(t);
      }
    }
    return changed;
  }

  static bool has_doubled_corner(const Triangle& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  }

  /// Replaces a flat triangle q, p, m, with m between the others, and its neighbour p, q, c by p,
  /// m, c and m, q, c.
  bool cut_neighbour(std::size_t t) {
    const Triangle flat = mesh_.triangles[t];
    std::size_t longest = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if (length(flat, k) > length(flat, longest)) longest = k;
    }
    const Index q = flat[longest], p = flat[(longest + 1) % 3], m = flat[(longest + 2) % 3];
    const std::optional<std::size_t> other = only_triangle_along({p, q});
    if (!other || *other == t || !only_triangle_along({q, p})) return false;
    const Index c = corner_opposite(mesh_.triangles[*other], {p, q});
    assert(c != kNone && "that triangle runs along the side");
    if (c == m || sides_.contains({m, c}) || sides_.contains({c, m})) return false;
    remove(t);
    remove(*other);
    put(t, {p, m, c});
    put(*other, {m, q, c});
    ++cut_;
    return true;
  }

  double length(const Triangle& t, std::size_t side) const {
    return (at(mesh_, t[(side + 1) % 3]) - at(mesh_, t[side])).norm();
  }

  static Index corner_opposite(const Triangle& t, const Side& side) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (t[k] == side[0] && t[(k + 1) % 3] == side[1]) return t[(k + 2) % 3];
    }
    return kNone;
  }

  std::optional<std::size_t> only_triangle_along(const Side& side) const {
    const auto [first, last] = sides_.equal_range(side);
    if (first == last || std::next(first) != last) return {};
    return first->second;
  }

  void enter(std::size_t t) {
    const Triangle& corners = mesh_.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) sides_.insert({{corners[k], corners[(k + 1) % 3]}, t});
  }

  void put(std::size_t t, const Triangle& corners) {
    mesh_.triangles[t] = corners;
    removed_[t] = false;
    enter(t);
    if (is_degenerate(mesh_, corners)) flat_.push_back(t);
  }

  void remove(std::size_t t) {
    removed_[t] = true;
    const Triangle& corners = mesh_.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [first, last] = sides_.equal_range({corners[k], corners[(k + 1) % 3]});
      const auto own =
          std::find_if(first, last, [t](const auto& side) { return side.second == t; });
      if (own != last) sides_.erase(own);
    }
  }

  std::size_t erase_removed() {
    std::vector<Triangle> kept;
    kept.reserve(mesh_.triangles.size());
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (!removed_[t]) kept.push_back(mesh_.triangles[t]);
    }
    const std::size_t removed = mesh_.triangles.size() - kept.size();
    mesh_.triangles = std::move(kept);
    return removed + cut_;
  }

  TriangleMesh& mesh_;
  std::vector<bool> removed_;
  std::vector<std::size_t> flat_;
  std::multimap<Side, std::size_t> sides_;
  std::size_t cut_ = 0;  // flat triangles replaced by half of their neighbour
};

}  // namespace

bool is_degenerate(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3d normal = (at(mesh, t[1]) - at(mesh, t[0])).cross(at(mesh, t[2]) - at(mesh, t[0]));
  return !(normal.norm() > kLeastDoubledArea);
}

MeshRepair repair(TriangleMesh& mesh) {
  MeshRepair done;
  done.triangles = mesh.triangles.size();
  if (mesh.triangles.empty() || !has_valid_indices(mesh)) return done;
  const bool any_flat = std::any_of(mesh.triangles.begin(), mesh.triangles.end(),
                                    [&](const Triangle& t) { return is_degenerate(mesh, t); });
  if (any_flat) {
    const bool closed = is_closed(mesh);
    done.dropped = FlatTriangles(mesh).take_out();
    done.opened = closed && !is_closed(mesh);
  }
  const double least = kLeastEnclosedVolume * std::pow(surface_area(mesh), 1.5);
  if (!(enclosed_volume(mesh) < -least) || !is_closed(mesh)) return done;
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  done.turned = true;
  return done;
}

}  // namespace weft
