#include <cmath>
#include <tuple>

#include <catch2/catch.hpp>

#include "core/cloth/cloth_meshes.h"
#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

// A cloth that is written as an OBJ and read again, to rest in its uv.

using namespace weft;

namespace {

/// Unlike in both ways, so that threads in a wrong direction are seen in the energy.
void make_unlike(FabricDef& fabric) {
  fabric.stretch_warp = 600;
  fabric.stretch_weft = 150;
  fabric.shear = 20;
  fabric.bending_warp = 2e-3;
  fabric.bending_weft = 5e-4;
}

/// Stretched by unlike amounts and rolled up, aslant.
Vec3d deformed(const Vec3d& p) {
  constexpr double kRadius = 0.4;
  const double s = 1.05 * p[0] + 0.1 * p[1], t = 0.98 * p[1];
  return {kRadius * std::sin(s / kRadius), t, kRadius * std::cos(s / kRadius) + p[2]};
}

ClothDef written_and_read(const World<double>& world) {
  const std::string text = encode_meshes(cloth_meshes(world.model(), world.state().x), "cloth.obj");
  const MeshFile file = read_mesh(text, "cloth.obj");
  ClothDef def;
  def.fabric = world.def().cloths[0].fabric;
  ClothMesh& mesh = def.mesh.emplace();
  mesh.mesh = file.mesh;
  mesh.uv = file.uv;
  mesh.corner_uv = file.corner_uv;
  def.rest_shape = RestShape::uv;
  return def;
}

double mass_of(const World<double>& world) {
  double sum = 0;
  for (const double m : world.model().mass) sum += m;
  return sum;
}

/// Energies to the rounding of the file.
void check_same_cloth(const World<double>& first, const World<double>& again) {
  CHECK(again.model().particle_count() == first.model().particle_count());
  CHECK(mass_of(again) == Approx(mass_of(first)).epsilon(1e-6));
  const auto &wanted = first.report().energies, &read = again.report().energies;
  CHECK(wanted.stretch > 1e-3);
  CHECK(wanted.bending > 1e-6);
  CHECK(read.stretch == Approx(wanted.stretch).epsilon(1e-4));
  CHECK(read.bending == Approx(wanted.bending).epsilon(1e-3));
}

}  // namespace

TEST_CASE("a cloth written and read again has its threads, its rest shape and its mass") {
  ClothDef sheet = test::triangle_sheet(test::Cut::irregular, 0.3, 0.2, 0.025, 0.5);
  make_unlike(sheet.fabric);
  sheet.rest_shape = RestShape::uv;
  for (Vec3d& p : sheet.mesh->mesh.positions) p = deformed(p);
  const World<double> world(test::empty_world(sheet));
  const ClothDef read = written_and_read(world);
  CHECK(read.mesh->corner_uv.empty());
  check_same_cloth(world, World<double>(test::empty_world(read)));
}

TEST_CASE("a cloth with a seam in its uv is written with both of its sides") {
  ClothDef sheet = test::triangle_sheet(test::Cut::one_diagonal, 0.4, 0.2, 0.02);
  make_unlike(sheet.fabric);
  sheet.rest_shape = RestShape::uv;
  ClothMesh& mesh = *sheet.mesh;
  for (const Triangle& t : mesh.mesh.triangles) {
    CornerUv corners;
    double middle = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = mesh.uv[static_cast<std::size_t>(t[k])];
      middle += corners[k][0] / 3;
    }
    // The threads of the right half are turned.
    for (auto& [u, v] : corners) {
      if (middle > 0.2) std::tie(u, v) = std::tuple(v, 5 - u);
    }
    mesh.corner_uv.push_back(corners);
  }
  for (Vec3d& p : mesh.mesh.positions) p = deformed(p);
  const World<double> world(test::empty_world(sheet));
  const ClothDef read = written_and_read(world);
  CHECK(read.mesh->corner_uv.size() == mesh.corner_uv.size());
  check_same_cloth(world, World<double>(test::empty_world(read)));
}

TEST_CASE("a grid written and read again has its mass and its places in the fabric") {
  ClothDef grid = test::flat_cloth(7, 9);
  make_unlike(grid.fabric);
  const World<double> world(test::empty_world(grid));
  const World<double> again(test::empty_world(written_and_read(world)));
  CHECK(mass_of(again) == Approx(mass_of(world)).epsilon(1e-6));
  REQUIRE(again.model().particle_count() == world.model().particle_count());
  for (std::size_t i = 0; i < again.state().x.size(); ++i) {
    std::size_t same = 0;
    const auto distance = [&](std::size_t k) {
      return (world.state().x[k] - again.state().x[i]).norm();
    };
    for (std::size_t k = 1; k < world.state().x.size(); ++k) {
      if (distance(k) < distance(same)) same = k;
    }
    CHECK(distance(same) < 1e-6);
    for (std::size_t k = 0; k < 2; ++k)
      CHECK(again.model().material[i][k] == Approx(world.model().material[same][k]).margin(1e-6));
  }
}

TEST_CASE("each cloth of an OBJ is a group of its name") {
  WorldDef def = test::empty_world(test::flat_cloth(3, 3));
  def.cloths[0].name = "left";
  def.cloths.push_back(test::flat_cloth(2, 2));
  def.cloths[1].name = "right";
  def.cloths[1].origin = Vec3d(5, 0, 0);
  const World<double> world(def);
  const std::string text = encode_meshes(cloth_meshes(world.model(), world.state().x), "two.obj");
  const std::size_t left = text.find("\ng left\n"), right = text.find("\ng right\n");
  REQUIRE(left != text.npos);
  REQUIRE(right != text.npos);
  const auto faces = [](std::string_view part) {
    std::size_t count = 0;
    for (std::size_t at = part.find("\nf "); at != part.npos; at = part.find("\nf ", at + 1))
      ++count;
    return count;
  };
  CHECK(faces(std::string_view(text).substr(left, right - left)) == 8);
  CHECK(faces(std::string_view(text).substr(right)) == 2);
}
