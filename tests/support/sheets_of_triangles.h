#pragma once

#include <array>
#include <cmath>
#include <string>

#include "core/attachments/pins.h"
#include "core/cloth/cloth_model.h"
#include "tests/support/cloths.h"
#include "tests/support/random.h"

namespace weft::test {

/// How a rectangle is cut into triangles.
enum class Cut { one_diagonal, alternating, equilateral, irregular };
inline constexpr std::array<Cut, 4> kCuts = {Cut::one_diagonal, Cut::alternating, Cut::equilateral,
                                             Cut::irregular};
inline std::string name_of(Cut cut) {
  constexpr const char* kNames[] = {"one diagonal", "alternating", "equilateral", "irregular"};
  return kNames[static_cast<int>(cut)];
}

/// Corners of a rectangle's triangles in its own plane, s across and t down [m].
struct FlatMesh {
  std::vector<std::array<double, 2>> points;
  std::vector<Triangle> triangles;
};

/// @param h  about the length of an edge [m]
inline FlatMesh cut_rectangle(Cut cut, double width, double height, double h) {
  const bool equilateral = cut == Cut::equilateral;
  const int columns = static_cast<int>(std::lround(width / h));
  const int rows = static_cast<int>(std::lround(height / (equilateral ? h * 0.8660254 : h)));
  FlatMesh mesh;
  Random random(5);
  std::vector<std::vector<Index>> row(static_cast<std::size_t>(rows) + 1);
  const auto add = [&](int r, double s) {
    std::array<double, 2> p = {s, height * r / rows};
    // Inner points are moved; those of the border stay on it.
    if (cut == Cut::irregular) {
      if (s > 0 && s < width) p[0] += 0.2 * width / columns * random.uniform(-1, 1);
      if (r > 0 && r < rows) p[1] += 0.2 * height / rows * random.uniform(-1, 1);
    }
    row[static_cast<std::size_t>(r)].push_back(static_cast<Index>(mesh.points.size()));
    mesh.points.push_back(p);
  };
  for (int r = 0; r <= rows; ++r) {
    const bool between = equilateral && r % 2 == 1;
    if (between) add(r, 0);
    for (int c = 0; c <= columns - (between ? 1 : 0); ++c)
      add(r, width * (c + (between ? 0.5 : 0)) / columns);
    if (between) add(r, width);
  }
  for (int r = 0; r < rows; ++r) {
    const auto &upper = row[static_cast<std::size_t>(r)],
               &lower = row[static_cast<std::size_t>(r) + 1];
    if (equilateral) {
      // Two rows of different counts: always the shorter of the two possible edges.
      std::size_t a = 0, b = 0;
      const auto s_of = [&](Index i) { return mesh.points[static_cast<std::size_t>(i)][0]; };
      while (a + 1 < upper.size() || b + 1 < lower.size()) {
        const bool along_upper = b + 1 == lower.size() ||
                                 (a + 1 < upper.size() && s_of(upper[a + 1]) - s_of(lower[b]) <=
                                                              s_of(lower[b + 1]) - s_of(upper[a]));
        if (along_upper) {
          mesh.triangles.push_back({upper[a], lower[b], upper[a + 1]});
          ++a;
        } else {
          mesh.triangles.push_back({upper[a], lower[b], lower[b + 1]});
          ++b;
        }
      }
      continue;
    }
    for (std::size_t c = 0; c + 1 < upper.size(); ++c) {
      const bool falling = cut == Cut::one_diagonal ||
                           (cut == Cut::alternating ? (static_cast<std::size_t>(r) + c) % 2 == 0
                                                    : random.uniform(0, 1) < 0.5);
      const Index a = upper[c], b = upper[c + 1], d = lower[c], e = lower[c + 1];
      if (falling) {
        mesh.triangles.push_back({a, d, e});
        mesh.triangles.push_back({a, e, b});
      } else {
        mesh.triangles.push_back({a, d, b});
        mesh.triangles.push_back({b, d, e});
      }
    }
  }
  return mesh;
}

/// A rectangle that hangs from its upper border at y = 0 in the plane z = 0, its warp turned out of
/// the horizontal by `grain` [rad].
inline ClothDef triangle_sheet(Cut cut, double width, double height, double h, double grain = 0) {
  const FlatMesh flat = cut_rectangle(cut, width, height, h);
  ClothDef def = flat_cloth(2, 2);
  ClothMesh mesh;
  const double c = std::cos(grain), s = std::sin(grain);
  for (const auto& p : flat.points) {
    mesh.mesh.positions.emplace_back(p[0], -p[1], 0);
    mesh.uv.push_back({c * p[0] - s * p[1], s * p[0] + c * p[1]});
  }
  mesh.mesh.triangles = flat.triangles;
  def.mesh = mesh;
  return def;
}

/// Rows of triangles of a strip that is cut into `segments` of the edges' length.
inline double rows_of(Cut cut, int segments) {
  if (cut != Cut::equilateral) return segments;
  return static_cast<double>(std::lround(segments / 0.8660254));
}

/// Puts the second and third line of an irregular strip back where they were, so that one can say
/// where it is clamped if these are pinned.
/// @param cell  length of an edge [m]
inline void straighten(Cut cut, double cell, ClothMesh& mesh) {
  if (cut != Cut::irregular) return;
  for (std::size_t i = 0; i < mesh.uv.size(); ++i) {
    Vec3d& p = mesh.mesh.positions[i];
    for (const int k : {1, 2}) {
      if (std::abs(p[1] + k * cell) < 0.3 * cell) p[1] = -k * cell;
    }
    mesh.uv[i] = {p[0], -p[1]};
  }
}

/// Pins on the border of such a sheet at y = 0, whose particles have their own numbers.
inline std::vector<PinDef> upper_border(const ClothDef& sheet) {
  std::vector<PinDef> pins;
  const ClothModel<double> model = build_cloth<double>(sheet);
  for (std::size_t i = 0; i < model.rest_positions.size(); ++i) {
    if (model.rest_positions[i][1] > -1e-9) pins.push_back({static_cast<Index>(i), 0, {}});
  }
  return pins;
}

}  // namespace weft::test
