// Generates or loads the meshes of built-in scenes.

#include "core/scenes/built_in_meshes.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/error.h"
#include "core/scenes/dress_form.h"

namespace weft {
namespace {

/// A prism standing on y = 0, with a sharp ridge along z: half a metre high, 36 cm wide, 60 cm
/// long.
TriangleMesh make_gable() {
  constexpr double kHeight = 0.5;
  const double w = 0.18, l = 0.3;  // half width and half length
  return {{{0, kHeight, -l}, {0, kHeight, l}, {-w, 0, -l}, {-w, 0, l}, {w, 0, -l}, {w, 0, l}},
          {{0, 2, 3}, {0, 3, 1}, {0, 1, 5}, {0, 5, 4}, {2, 4, 5}, {2, 5, 3}, {0, 4, 2}, {1, 3, 5}}};
}

/// A strip of 1 m by 30 cm, bent around z to a loop with skewed, crossing ends.
TriangleMesh make_loop() {
  constexpr int kColumns = 41, kRows = 13;
  constexpr double kCell = 0.025, kRadius = 0.08, kMost = 2.2, kSkew = 0.02;
  TriangleMesh mesh;
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kColumns; ++c) {
      const int column = c - kColumns / 2, row = r - kRows / 2;
      const double s = kCell * column, z = kCell * row + kSkew * s;
      const double angle = std::clamp(s / kRadius, -kMost, kMost), straight = s - angle * kRadius;
      mesh.positions.push_back({kRadius * std::sin(angle) + straight * std::cos(angle),
                                -kRadius * std::cos(angle) + straight * std::sin(angle), z});
      if (r == 0 || c == 0) continue;
      const Index d = r * kColumns + c, b = d - kColumns;
      mesh.triangles.push_back({b - 1, d - 1, d});
      mesh.triangles.push_back({b - 1, d, b});
    }
  }
  return mesh;
}

}  // namespace

const std::vector<std::string>& built_in_mesh_names() {
  static const std::vector<std::string> names = {"dress-form", "gable", "loop", "bunny"};
  return names;
}

MeshFile built_in_mesh(const std::string& name, const std::string& directory) {
  if (name == "dress-form") return {make_dress_form(), {}};
  if (name == "gable") return {make_gable(), {}};
  if (name == "loop") return {make_loop(), {}};
  if (name != "bunny") {
    std::string names;
    for (const std::string& each : built_in_mesh_names())
      names += (names.empty() ? "" : ", ") + each;
    throw DefinitionError("mesh", name, "one of " + names);
  }
  const std::string path = directory + "/" + name + ".ply";
  std::ifstream file(path, std::ios::binary);
  if (directory.empty() || !file)
    throw DefinitionError("mesh", name, "a mesh that is installed",
                          "its package comes with ./dev setup and is converted by the build");
  return read_mesh(std::string(std::istreambuf_iterator<char>(file), {}), path);
}

}  // namespace weft
