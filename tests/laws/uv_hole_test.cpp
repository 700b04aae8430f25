#include <cmath>

#include <catch2/catch.hpp>

#include "core/forces/force_pass.h"
#include "tests/support/sheets_of_triangles.h"

// Meshes some of whose triangles have no place in the (u, v).

using namespace weft;
using test::Cut;

namespace {

ClothDef sheet(Cut cut) {
  ClothDef def = test::triangle_sheet(cut, 0.5, 0.4, 0.05, 0.6);
  def.fabric.stretch_warp = 600, def.fabric.stretch_weft = 150, def.fabric.shear = 10;
  def.fabric.bending_warp = 3e-5, def.fabric.bending_weft = 1e-5;
  return def;
}

/// Puts all corners of some triangles in one place of the (u, v).
template <class IsHole>
ClothDef with_holes(ClothDef def, const IsHole& is_hole) {
  ClothMesh& mesh = *def.mesh;
  for (std::size_t t = 0; t < mesh.mesh.triangles.size(); ++t) {
    CornerUv corners = {};
    for (std::size_t k = 0; k < 3 && !is_hole(t); ++k)
      corners[k] = mesh.uv[static_cast<std::size_t>(mesh.mesh.triangles[t][k])];
    mesh.corner_uv.push_back(corners);
  }
  return def;
}

/// Energies of stretch and bending of a sheet that is strained, sheared and curved.
ElasticEnergy energy_of(const ClothModel<double>& model) {
  Vec3Array<double> x = model.rest_positions;
  for (Vec3d& p : x)
    p = Vec3d(1.002 * p[0] + 0.001 * p[1], 0.999 * p[1], 0.3 * p[0] * p[0] + 0.1 * p[0] * p[1]);
  return elastic_energy(model, x);
}

}  // namespace

TEST_CASE("holes in the uv of a flat mesh continue the threads beside them") {
  for (const Cut cut : test::kCuts) {
    INFO(test::name_of(cut));
    const ClothModel<double> whole = build_cloth<double>(sheet(cut));
    // Single ones, and a patch in a corner of the sheet with particles of its own.
    const ClothModel<double> holed = build_cloth<double>(
        with_holes(sheet(cut), [](std::size_t t) { return t % 9 == 4 || t < 7; }));
    const ElasticEnergy a = energy_of(whole), b = energy_of(holed);
    CHECK(b.stretch == Approx(a.stretch).epsilon(1e-9));
    CHECK(b.bending == Approx(a.bending).epsilon(1e-9));
    for (std::size_t i = 0; i < whole.material.size(); ++i) {
      CHECK(holed.material[i][0] == Approx(whole.material[i][0]).margin(1e-12));
      CHECK(holed.material[i][1] == Approx(whole.material[i][1]).margin(1e-12));
    }
  }
}

TEST_CASE("where most of the uv are holes a mesh is projected as without them") {
  ClothDef none = sheet(Cut::irregular);
  const ClothDef most = with_holes(none, [](std::size_t t) { return t % 5 != 0; });
  none.mesh->uv.clear();
  const ClothModel<double> a = build_cloth<double>(none), b = build_cloth<double>(most);
  CHECK(b.material == a.material);
  CHECK(b.corner_material.empty());
  CHECK(energy_of(b).stretch == energy_of(a).stretch);
}
