#include "core/cloth/mesh_cloth.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/forces/force_pass.h"
#include "core/forces/hinge.h"
#include "core/forces/rest_curve.h"
#include "core/geometry/hinge_angle.h"
#include "core/world/world.h"
#include "tests/support/cloths.h"
#include "tests/support/seeded_random.h"
#include "tests/support/worlds.h"

using namespace weft;

namespace {

constexpr double kSin60 = 0.86602540378443864676;

/// Equilateral triangles of side h in the plane z = 0, rows from the top down.
ClothMesh equilateral_sheet(int rows, int columns, double h) {
  ClothMesh sheet;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c)
      sheet.mesh.positions.emplace_back(h * (c + 0.5 * (r % 2)), -h * kSin60 * r, 0);
  }
  for (int r = 0; r + 1 < rows; ++r) {
    for (int c = 0; c + 1 < columns; ++c) {
      const Index a = r * columns + c, b = a + 1, d = a + columns, e = d + 1;
      if (r % 2 == 0) {
        sheet.mesh.triangles.push_back({a, d, b});
        sheet.mesh.triangles.push_back({b, d, e});
      } else {
        sheet.mesh.triangles.push_back({a, d, e});
        sheet.mesh.triangles.push_back({a, e, b});
      }
    }
  }
  return sheet;
}

ClothDef sheet_cloth(int rows, int columns, double h) {
  ClothDef def;
  def.mesh = equilateral_sheet(rows, columns, h);
  def.fabric.stretch_warp = def.fabric.stretch_weft = 300;
  def.fabric.shear = 100;  // a third: what a network of springs has
  return def;
}

std::string refused(const ClothDef& def) {
  try {
    build_cloth<double>(def);
  } catch (const DefinitionError& error) {
    return error.field;
  }
  return "nothing";
}

double interior_energy_density(const ClothModel<double>& model, const Vec3Array<double>& x,
                               double lowest, double highest) {
  // Springs and hinges whose middle is in a band away from the borders, per area.
  double energy = 0;
  const auto middle_inside = [&](std::initializer_list<Index> corners) {
    for (const Index i : corners) {
      const Vec3d& p = model.rest_positions[static_cast<std::size_t>(i)];
      if (p[0] < lowest || p[0] > highest || -p[1] < lowest || -p[1] > highest) return false;
    }
    return true;
  };
  double area = 0;
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const Triangle& c = model.triangles[t];
    if (!middle_inside({c[0], c[1], c[2]})) continue;
    area += model.triangle_area[t];
    // Each spring belongs to two triangles: half of it to each.
    for (const Spring<double>& s : model.springs) {
      const bool ends =
          std::count(c.begin(), c.end(), s.i) + std::count(c.begin(), c.end(), s.j) == 2;
      if (!ends) continue;
      const double stretch =
          (x[static_cast<std::size_t>(s.j)] - x[static_cast<std::size_t>(s.i)]).norm() -
          s.rest_length;
      energy += 0.25 * s.stiffness * stretch * stretch;
    }
  }
  return energy / area;
}

}  // namespace

TEST_CASE("a mesh's mass is density times area, by thirds to the corners") {
  ClothDef def = sheet_cloth(7, 8, 0.1);
  const ClothModel<double> model = build_cloth<double>(def);
  double mass = 0;
  for (const double m : model.mass) mass += m;
  CHECK(mass == Approx(0.2 * surface_area(def.mesh->mesh)).epsilon(1e-12));
  // A vertex with six triangles about it has two triangles' mass.
  const double inner = *std::max_element(model.mass.begin(), model.mass.end());
  CHECK(inner == Approx(0.2 * 2 * 0.1 * 0.1 * kSin60 / 2));
  def.mass_lumping = MassLumping::equal;
  for (const double m : build_cloth<double>(def).mass) CHECK(m == Approx(mass / 56));
}

TEST_CASE("equilateral springs stretch like the isotropic fabric with a third for the shear") {
  ClothDef def = sheet_cloth(21, 21, 0.05);
  def.membrane_model = MembraneModel::springs;
  const ClothModel<double> model = build_cloth<double>(def);
  for (const Spring<double>& s : model.springs) {
    CHECK(s.rest_length == Approx(0.05));
    // Inner: Y (2 sqrt(3)/4 l^2) / l^2; on the border half.
    const double inner = 300 * kSin60;
    CHECK((s.stiffness == Approx(inner) || s.stiffness == Approx(inner / 2)));
  }
  // The network with k = Y sqrt(3)/2 has C11 = 9/8 Y and C12 = C66 = 3/8 Y.
  constexpr double kStrain = 1e-5;
  const auto density = [&](double eu, double ev, double gamma) {
    Vec3Array<double> x = model.rest_positions;
    for (Vec3d& p : x) p += Vec3d(eu * p[0] + gamma * p[1], ev * p[1], 0);
    return interior_energy_density(model, x, 0.2, 0.7) / (kStrain * kStrain);
  };
  CHECK(density(kStrain, 0, 0) == Approx(0.5 * 9.0 / 8 * 300).epsilon(0.01));
  CHECK(density(0, kStrain, 0) == Approx(0.5 * 9.0 / 8 * 300).epsilon(0.01));
  CHECK(density(0, 0, kStrain) == Approx(0.5 * 3.0 / 8 * 300).epsilon(0.01));
}

/// Energy of each hinge and its corners.
template <class Visitor>
void visit_bending_energies(const ClothModel<double>& model, const Vec3Array<double>& x,
                            Visitor&& visit) {
  const auto at = [&](Index i) { return x[static_cast<std::size_t>(i)]; };
  for (const Hinge<double>& h : model.hinges) {
    const double theta = hinge_angle<double>(at(h.x[0]), at(h.x[1]), at(h.x[2]), at(h.x[3])).theta;
    visit(h.x, hinge_energy(h, theta));
  }
}

TEST_CASE("equilateral triangles bend by hinges with rigidity B in every direction") {
  ClothDef def = sheet_cloth(31, 31, 0.02);
  def.fabric.bending_warp = def.fabric.bending_weft = 1e-3;
  def.bending_model = BendingModel::hinges;
  const ClothModel<double> model = build_cloth<double>(def);
  const double angle = GENERATE(0.0, 0.4, 1.0, 1.5);
  constexpr double kCurvature = 1e-3;
  Vec3Array<double> x = model.rest_positions;
  for (Vec3d& p : x) {
    const double s = p[0] * std::cos(angle) + p[1] * std::sin(angle);
    p[2] = 0.5 * kCurvature * s * s;
  }
  double energy = 0;
  std::size_t counted = 0;
  // Sum each of the three families of edges on its own, so that their numbers need not agree.
  std::array<double, 3> sum = {}, number = {};
  visit_bending_energies(model, x, [&](const Index* corners, double of_one) {
    const auto rest = [&](int k) {
      return model.rest_positions[static_cast<std::size_t>(corners[k])];
    };
    for (int k = 0; k < 4; ++k) {
      const Vec3d p = rest(k);
      if (!(p[0] > 0.1 && p[0] < 0.5 && p[1] < -0.1 && p[1] > -0.4)) return;
    }
    const Vec3d e = rest(1) - rest(0);
    const std::size_t family = std::abs(e[1]) < 1e-9 ? 0 : (e[0] * e[1] > 0 ? 1 : 2);
    sum[family] += of_one;
    ++number[family];
    ++counted;
  });
  REQUIRE(counted > 500);
  const double area_per_hinge = 2 * 0.02 * 0.02 * kSin60 / 2;  // one of each family
  for (std::size_t f = 0; f < 3; ++f) energy += sum[f] / number[f];
  CHECK(energy / area_per_hinge == Approx(0.5 * 1e-3 * kCurvature * kCurvature).epsilon(0.01));
}

TEST_CASE("a mesh bends by the quadratic form, but with a rest angle or if asked to by hinges") {
  ClothDef flat = sheet_cloth(7, 8, 0.1), curved = flat;
  curved.mesh->mesh.positions[20][2] += 0.01;
  for (const BendingModel model : {BendingModel::automatic, BendingModel::quadratic}) {
    flat.bending_model = curved.bending_model = model;
    CHECK(build_cloth<float>(flat).hinges.empty());
    CHECK(build_cloth<float>(flat).parts[0].rest_curves.triangles.empty());
    CHECK(build_cloth<float>(curved).hinges.empty());
    CHECK(!build_cloth<float>(curved).parts[0].rest_curves.triangles.empty());
  }
  flat.bending_model = BendingModel::automatic;
  for (const auto& change : std::vector<void (*)(ClothDef&)>{
           [](ClothDef& d) { d.rest_angle = 0.1; },
           [](ClothDef& d) { d.bending_model = BendingModel::hinges; },
           [](ClothDef& d) { d.bending_model = BendingModel::sine_hinges; }}) {
    ClothDef def = flat;
    change(def);
    const ClothModel<float> model = build_cloth<float>(def);
    CHECK(!model.hinges.empty());
    CHECK(model.parts[0].bending_links.empty());
  }
}

TEST_CASE("a flat mesh is so wherever it lies, and with six digits a vertex") {
  ClothDef def = sheet_cloth(25, 6, 0.005);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.5, Vec3d(1, 2, 3).normalized()));
  const Vec3d place = GENERATE(Vec3d(0, 0, 0), Vec3d(3, 2, 1), Vec3d(-90, 5, 40));
  const double digit = GENERATE(1e-9, 1e-6);
  for (Vec3d& p : def.mesh->mesh.positions) {
    p = turn * p + place;
    for (double& x : p) x = std::round(x / digit) * digit;
  }
  CHECK_FALSE(build_cloth<float>(def).parts[0].curved_at_rest);
  CHECK_FALSE(build_cloth<double>(def).parts[0].curved_at_rest);
}

TEST_CASE("a curved mesh is at rest as it lies") {
  ClothDef def = sheet_cloth(9, 9, 0.1);
  def.membrane_model = GENERATE(MembraneModel::triangles, MembraneModel::springs);
  def.bending_model = GENERATE(BendingModel::automatic, BendingModel::hinges);
  for (Vec3d& p : def.mesh->mesh.positions) p[2] = 0.3 * std::sin(3 * p[0]) * std::cos(2 * p[1]);
  const ClothModel<double> model = build_cloth<double>(def);
  const Vec3Array<double> still(model.mass.size(), Vec3d::Zero());
  Vec3Array<double> force = still;
  add_spring_forces(model, model.rest_positions, still, force);
  add_membrane_forces(model, model.rest_positions, still, force);
  add_hinge_forces(model, model.rest_positions, still, force);
  add_quadratic_bending_forces(model, model.rest_positions, force);
  add_rest_curve_forces(model.parts[0], model.rest_positions, force);
  for (const Vec3d& f : force) CHECK(f.norm() < 1e-9);  // springs have 1e-14 m^2 added to l^2
}

TEST_CASE("breadth-first numbers are a permutation that keeps neighbours near") {
  ClothMesh sheet = equilateral_sheet(20, 20, 0.1);
  // Shuffle the vertices, so that neighbours lie anywhere.
  std::vector<Index> place(400);
  for (std::size_t i = 0; i < place.size(); ++i)
    place[i] = static_cast<Index>((i * 147 + 11) % 400);
  std::vector<Vec3d> shuffled(400);
  for (std::size_t i = 0; i < 400; ++i)
    shuffled[static_cast<std::size_t>(place[i])] = sheet.mesh.positions[i];
  sheet.mesh.positions = shuffled;
  for (Triangle& t : sheet.mesh.triangles)
    for (Index& i : t) i = place[static_cast<std::size_t>(i)];
  std::vector<Index> order = breadth_first_order(400, sheet.mesh.triangles);
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < 400; ++i) CHECK(order[i] == static_cast<Index>(i));
  ClothDef def;
  def.mesh = sheet;
  const ClothModel<double> model = build_cloth<double>(def);
  Index farthest = 0;
  for (const Edge& e : model.edges) farthest = std::max(farthest, e[1] - e[0]);
  CHECK(farthest < 80);  // two waves of at most 40; 399 before
}

TEST_CASE("uv give the warp's direction and discs in metres, whatever their scale") {
  ClothDef def = sheet_cloth(9, 9, 0.1);
  for (const Vec3d& p : def.mesh->mesh.positions) def.mesh->uv.push_back({-7 * p[1], 7 * p[0]});
  const ClothModel<double> turned = build_cloth<double>(def);
  for (std::size_t i = 0; i < turned.mass.size(); ++i) {
    CHECK(turned.material[i][0] == Approx(-turned.rest_positions[i][1]).margin(1e-12));
    CHECK(turned.material[i][1] == Approx(turned.rest_positions[i][0]).margin(1e-12));
  }
  for (auto& point : def.mesh->uv) point = {0.5, 0.5};  // of no use: projected instead
  const ClothModel<double> facing = build_cloth<double>(def);
  for (std::size_t i = 0; i < facing.mass.size(); ++i) {
    CHECK(facing.material[i][0] == Approx(facing.rest_positions[i][0]));
    CHECK(facing.material[i][1] == Approx(-facing.rest_positions[i][1]).margin(1e-12));
  }
  const std::vector<Index> disc = particles_in_disc(facing, 40, 0.101);
  CHECK(disc.size() == 7);  // a vertex and its six neighbours
}

TEST_CASE("a mesh hangs by its corner, is picked and held, and keeps its momentum in free flight") {
  WorldDef world_def;
  world_def.cloths[0] = sheet_cloth(11, 11, 0.05);
  world_def.pins = {{Corner::top_left, 0.06}};
  World<double> world(world_def);
  CHECK(world.pins().list[0].particles.size() >= 3);
  const auto hit = world.pick(Vec3d(0.25, -0.2, 1), Vec3d(0, 0, -1));
  REQUIRE(hit);
  CHECK(hit->position[0] == Approx(0.25).margin(1e-9));
  GrabDef hand;
  hand.triangle = hit->triangle;
  hand.barycentric = hit->barycentric;
  hand.radius = 0.06;
  hand.target = hit->position + Vec3d(0, 0, 0.1);
  world.grab(hand);
  CHECK(world.grabs().list[0].particles.size() >= 4);
  test::advance(world, 1);
  CHECK(world.report().largest_strain < 0.2);

  WorldDef free = test::empty_world(sheet_cloth(11, 11, 0.05));
  World<double> flight(free);
  test::SeededRandom random(7);
  flight.state().v = test::random_velocities(flight.model(), 1, random);
  flight.accept_state();
  const auto momentum = [&] {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t i = 0; i < flight.state().v.size(); ++i)
      sum += flight.model().mass[i] * flight.state().v[i];
    return sum;
  };
  const Vec3d before = momentum();
  test::advance(flight, 0.5);
  CHECK((momentum() - before).norm() < 1e-12);
}

TEST_CASE("degenerate meshes are refused with the name of what is wrong") {
  const ClothDef good = sheet_cloth(4, 4, 0.1);
  CHECK(refused(good) == "nothing");
  const auto with = [&](auto&& change) {
    ClothDef def = good;
    change(*def.mesh);
    return refused(def);
  };
  CHECK(with([](ClothMesh& m) { m.mesh.positions.emplace_back(9, 9, 9); }) ==
        "cloth.mesh.positions[16]");
  CHECK(with([](ClothMesh& m) {
          m.mesh.positions.push_back(m.mesh.positions[3]);
          m.mesh.triangles.push_back({0, 5, 16});
        }) == "cloth.mesh.positions[16]");
  CHECK(with([](ClothMesh& m) { m.mesh.triangles[2] = {0, 1, 2}; }) == "cloth.mesh.triangles[2]");
  CHECK(with([](ClothMesh& m) { m.mesh.triangles[2] = {0, 0, 5}; }) == "cloth.mesh.triangles[2]");
  CHECK(with([](ClothMesh& m) { m.mesh.triangles.push_back(m.mesh.triangles[4]); }) ==
        "cloth.mesh.triangles[18]");
  CHECK(with([](ClothMesh& m) {
          m.mesh.positions.emplace_back(0.05, 0, 0.1);
          m.mesh.triangles.push_back({5, 6, 16});
        }) == "cloth.mesh.triangles[18]");
  CHECK(with([](ClothMesh& m) { m.mesh.triangles[0][1] = 99; }) == "cloth.mesh.triangles[0]");
  CHECK(with([](ClothMesh& m) { m.mesh.positions[0][1] = std::nan(""); }) ==
        "cloth.mesh.positions[0][1]");
  CHECK(with([](ClothMesh& m) { m.mesh.triangles.clear(); }) == "cloth.mesh.triangles");
  CHECK(with([](ClothMesh& m) { m.uv.resize(3); }) == "cloth.mesh.uv");
  ClothDef skip = good;
  skip.skip_stiffness = 3;
  CHECK(refused(skip) == "cloth.skip_stiffness");
  ClothDef quadratic = good;
  quadratic.bending_model = BendingModel::quadratic;
  CHECK(refused(quadratic) == "nothing");
  quadratic.rest_angle = 0.1;
  CHECK(refused(quadratic) == "cloth.bending_model");
}

TEST_CASE("vertices that fall together in the precision of the solver are refused by name") {
  ClothDef def = sheet_cloth(4, 4, 0.1);
  def.mesh->mesh.positions.push_back(def.mesh->mesh.positions[3] + Vec3d(1e-10, 0, 0));
  def.mesh->mesh.positions.push_back(def.mesh->mesh.positions[3] + Vec3d(0, 0.1, 0));
  def.mesh->mesh.triangles.push_back({3, 16, 17});
  CHECK(refused(def) == "nothing");  // in double
  try {
    build_cloth<float>(def);
    FAIL("not refused");
  } catch (const DefinitionError& error) {
    CHECK(error.field == "cloth.mesh.positions[16]");
  }
}

namespace {

/// A strip of triangles `width` across, whose long edges are `ratio` times as long.
ClothDef needles(double width, double ratio) {
  ClothDef def;
  ClothMesh strip;
  for (int k = 0; k < 6; ++k) {
    strip.mesh.positions.emplace_back(0, -width * k, 0);
    strip.mesh.positions.emplace_back(width * ratio, -width * k, 0);
    if (k == 0) continue;
    const Index a = 2 * k - 2, b = a + 1, c = a + 2, d = a + 3;
    strip.mesh.triangles.push_back({a, c, b});
    strip.mesh.triangles.push_back({b, c, d});
  }
  def.mesh = strip;
  return def;
}

}  // namespace

TEST_CASE("triangles of aspect 1e4 hang from their edge and stay whole, with and without guard") {
  WorldDef def;
  def.cloths[0] = needles(1e-3, 1e4);
  def.cloths[0].fabric.thickness = 2e-4;
  def.pins = {{Corner::top_left, 0.0}, {Corner::top_right, 0.0}};
  def.contact.seed.self = GENERATE(SelfContact::none, SelfContact::guard);
  World<float> world(def);
  for (int tick = 0; tick < 30; ++tick) REQUIRE_FALSE(world.step().divergence);
  for (const Vec3f& x : world.state().x) REQUIRE(x.allFinite());
  CHECK(world.report().largest_strain < 1);
}

TEST_CASE("a rest shape that would take too small substeps is refused, and told what would help") {
  WorldDef def;
  def.cloths[0] = needles(1e-5, 1e4);
  try {
    World<float> world(def);
    FAIL("not refused");
  } catch (const DefinitionError& error) {
    CHECK(error.field == "fabric");
    CHECK(error.limit.find("substeps") != std::string::npos);
    CHECK(error.hint.find("tick_rate") != std::string::npos);
  }
}
