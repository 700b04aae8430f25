#include "core/forces/mesh_pass.h"

#include <cmath>

#include <catch2/catch.hpp>
#include <hwy/targets.h>

#include "core/cloth/cloth_model.h"
#include "core/forces/force_pass.h"
#include "core/solver/vector_passes.h"
#include "tests/support/cloths.h"
#include "tests/support/seeded_random.h"
#include "tests/support/worlds.h"

using namespace weft;
using test::Random;
using test::SeededRandom;

namespace {

/// A flat mesh of about so many vertices, with some of its triangles missing.
ClothDef ragged_mesh(int vertices, Random& random) {
  ClothDef def = test::flat_cloth(2, 2);
  ClothMesh mesh;
  const int columns = 9, rows = (vertices + columns - 1) / columns;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c)
      mesh.mesh.positions.emplace_back(0.05 * c + 0.01 * random.uniform(0, 1),
                                       0.05 * r + 0.01 * random.uniform(0, 1), 0);
  }
  for (int r = 0; r + 1 < rows; ++r) {
    for (int c = 0; c + 1 < columns; ++c) {
      const Index a = r * columns + c, b = a + 1, e = a + columns, f = e + 1;
      mesh.mesh.triangles.push_back({a, b, f});
      // Every vertex keeps a triangle.
      if (c == 0 || r + 2 == rows || random.uniform(0, 1) > 0.3)
        mesh.mesh.triangles.push_back({a, f, e});
    }
  }
  def.mesh = mesh;
  def.fabric.bending_warp = 2e-5;
  def.fabric.bending_weft = 1e-5;
  return def;
}

/// A flat square of n x n vertices whose cells are cut by alternating diagonals: eight triangles
/// meet at every second vertex and four at the others.
ClothDef union_jack(int n) {
  ClothDef def = test::flat_cloth(2, 2);
  ClothMesh mesh;
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < n; ++c) mesh.mesh.positions.emplace_back(0.02 * c, 0.02 * r, 0);
  }
  for (int r = 0; r + 1 < n; ++r) {
    for (int c = 0; c + 1 < n; ++c) {
      const Index a = r * n + c, b = a + 1, e = a + n, f = e + 1;
      const bool even = (r + c) % 2 == 0;
      mesh.mesh.triangles.push_back(even ? Triangle{a, b, f} : Triangle{a, b, e});
      mesh.mesh.triangles.push_back(even ? Triangle{a, f, e} : Triangle{b, f, e});
    }
  }
  def.mesh = mesh;
  return def;
}

/// A flat wheel: a hub and so many vertices about it.
ClothDef wheel(int spokes) {
  ClothDef def = test::flat_cloth(2, 2);
  ClothMesh mesh;
  mesh.mesh.positions.emplace_back(0, 0, 0);
  for (int i = 0; i < spokes; ++i) {
    const double angle = 2 * 3.14159265358979 * i / spokes;
    mesh.mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0);
    mesh.mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % spokes});
  }
  def.mesh = mesh;
  return def;
}

template <class Real>
bool is_gathered(const ClothModel<Real>& model) {
  MeshPass<Real> pass;
  pass.prepare(model, model.parts[0]);
  return pass.fits();
}

template <class Real>
struct Shaken {
  ClothModel<Real> model;
  Vec3Array<Real> x, v, gathered, element_wise;
};

template <class Real>
Shaken<Real> forces_on(const ClothDef& def) {
  Shaken<Real> s;
  s.model = build_cloth<Real>(def);
  Random random(4);
  s.x = test::shaken(s.model, 0.01, random);
  s.v = test::random_velocities(s.model, 3, random);
  s.gathered.assign(s.x.size(), Vec3<Real>::Constant(99));
  MeshPass<Real> pass;
  pass.prepare(s.model, s.model.parts[0]);
  REQUIRE(pass.fits());
  pass.compute_forces(s.x, s.v, s.gathered);
  s.element_wise.assign(s.x.size(), Vec3<Real>::Zero());
  add_spring_forces(s.model, s.x, s.v, s.element_wise);
  add_membrane_forces(s.model, s.x, s.v, s.element_wise);
  add_quadratic_bending_forces(s.model, s.x, s.element_wise);
  return s;
}

template <class Real>
double largest(const Vec3Array<Real>& forces) {
  double most = 0;
  for (const Vec3<Real>& f : forces) most = std::max(most, static_cast<double>(f.norm()));
  return most;
}

}  // namespace

TEST_CASE("forces gathered by particle are those of the elements, to 1e-12 of the largest") {
  SeededRandom random(7);
  ClothDef def = ragged_mesh(GENERATE(18, 27, 63, 64, 65, 200, 700), random);
  def.membrane_model = GENERATE(MembraneModel::triangles, MembraneModel::springs);
  const Shaken<double> s = forces_on<double>(def);
  CHECK(s.model.hinges.empty());
  const double scale = largest(s.element_wise);
  for (std::size_t i = 0; i < s.x.size(); ++i)
    CHECK((s.gathered[i] - s.element_wise[i]).norm() < 1e-12 * scale);
  const Shaken<float> single = forces_on<float>(def);
  for (std::size_t i = 0; i < s.x.size(); ++i)
    CHECK((single.gathered[i] - single.element_wise[i]).norm() < 2e-5F * static_cast<float>(scale));
}

TEST_CASE("gathered forces add up to nothing: no momentum is made") {
  SeededRandom random(8);
  ClothDef def = ragged_mesh(300, random);
  def.membrane_model = GENERATE(MembraneModel::triangles, MembraneModel::springs);
  const Shaken<double> s = forces_on<double>(def);
  Vec3d sum = Vec3d::Zero(), turn = Vec3d::Zero();
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    sum += s.gathered[i];
    turn += s.x[i].cross(s.gathered[i]);
  }
  CHECK(sum.norm() < 1e-11 * largest(s.gathered));
  CHECK(turn.norm() < 1e-11 * largest(s.gathered));
}

TEST_CASE("a mesh moved far from the origin bends and stretches with the same forces") {
  SeededRandom random(9);
  const Shaken<float> s = forces_on<float>(ragged_mesh(200, random));
  MeshPass<float> pass;
  pass.prepare(s.model, s.model.parts[0]);
  // By a power of two the places keep their bits but the last three.
  Vec3Array<float> far = s.x, force = s.x;
  for (Vec3f& p : far) p += Vec3f(8, 0, 0);
  pass.compute_forces(far, s.v, force);
  for (std::size_t i = 0; i < far.size(); ++i)
    CHECK((force[i] - s.gathered[i]).norm() < 1e-3 * largest(s.gathered));
}

TEST_CASE("every instruction set gathers the same bits") {
  SeededRandom random(10);
  ClothDef def = ragged_mesh(200, random);
  def.membrane_model = GENERATE(MembraneModel::triangles, MembraneModel::springs);
  const auto best = forces_on<float>(def).gathered;
  const std::int64_t supported = hwy::SupportedTargets();
  int tried = 0;
  for (std::int64_t left = supported; left != 0; left &= left - 1) {
    hwy::SetSupportedTargetsForTest(left & -left);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    CHECK(forces_on<float>(def).gathered == best);
    ++tried;
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  CHECK(tried > 1);
}

TEST_CASE("springs whose damping does not go with their stiffness stay element-wise") {
  SeededRandom random(11);
  ClothDef def = ragged_mesh(100, random);
  def.membrane_model = MembraneModel::springs;
  ClothModel<float> model = build_cloth<float>(def);
  model.springs[3].damping *= 2;
  CHECK(!is_gathered(model));
}

TEST_CASE("hubs of many springs, and neighbours far apart in memory, stay element-wise") {
  for (const MembraneModel membrane : {MembraneModel::triangles, MembraneModel::springs}) {
    // Two triangles are one pair.
    const int spokes = membrane == MembraneModel::triangles ? 128 : 64;
    ClothDef most = wheel(spokes), more = wheel(spokes + 2);
    most.membrane_model = more.membrane_model = membrane;
    CHECK(is_gathered(build_cloth<float>(most)));
    CHECK(!is_gathered(build_cloth<float>(more)));
  }
  ClothModel<float> model = build_cloth<float>(test::flat_cloth(190, 190));
  CHECK(is_gathered(model));
  model.springs[0].j = 190 * 190 - 1;
  CHECK(!is_gathered(model));
}

TEST_CASE("a mesh is kicked in one pass to the bits of its forces and a kick by them") {
  SeededRandom random(12);
  ClothDef def = ragged_mesh(GENERATE(18, 63, 65, 700), random);
  def.membrane_model = GENERATE(MembraneModel::triangles, MembraneModel::springs);
  const Shaken<float> s = forces_on<float>(def);
  const Vec3Array<float> pull = test::random_velocities(s.model, 1, random);
  std::vector<float> inverse_mass;
  for (const float mass : s.model.mass) inverse_mass.push_back(1 / mass);
  inverse_mass[0] = inverse_mass[inverse_mass.size() / 2] = 0;
  const KickLaw<float> law{0.99F, 1e-4F, {1, -9.81F, 2}};
  for (const bool has_external : {false, true}) {
    const KickedParticles<float> particles{inverse_mass.data(),
                                           has_external ? pull.data()->data() : nullptr};
    Vec3Array<float> by_forces = s.v, at_once = s.v;
    run_kick<float>({s.x.size(), s.v.data()->data(), by_forces.data()->data(),
                     s.gathered.data()->data(), particles, law});
    MeshPass<float> pass;
    pass.prepare(s.model, s.model.parts[0]);
    for (int again = 0; again < 2; ++again) {
      at_once = s.v;
      pass.kick(law, particles, s.x, at_once, 0);
      CHECK(at_once == by_forces);
    }
    CHECK(at_once[0] == s.v[0] * law.keep);
  }
}

TEST_CASE(
    "a substep later the dashpots of triangles act as by the velocities of the drift between") {
  SeededRandom random(13);
  ClothDef def = ragged_mesh(200, random);
  def.fabric.damping_ratio = 1;
  const ClothModel<double> model = build_cloth<double>(def);
  ClothModel<double> undamped = model;
  undamped.parts[0].membrane_tensor.stretch_time = 0;
  undamped.parts[0].membrane_tensor.shear_time = 0;
  std::vector<double> inverse_mass;
  for (const double mass : model.mass) inverse_mass.push_back(1 / mass);
  const KickedParticles<double> particles{inverse_mass.data(), nullptr};
  constexpr double kSubstep = 1e-6;
  const KickLaw<double> law{1, kSubstep, {0, 0, 0}};
  Vec3Array<double> x = test::shaken(model, 0.01, random);
  Vec3Array<double> v = test::random_velocities(model, 1, random);
  MeshPass<double> again, anew, without;
  again.prepare(model, model.parts[0]);
  anew.prepare(model, model.parts[0]);
  without.prepare(undamped, undamped.parts[0]);
  again.kick(law, particles, x, v, 0);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += v[i] * kSubstep;
  Vec3Array<double> by_differences = v, by_velocities = v, elastic = v;
  again.kick(law, particles, x, by_differences, kSubstep);
  anew.kick(law, particles, x, by_velocities, 0);
  without.kick(law, particles, x, elastic, 0);
  double dashpots = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    dashpots = std::max(dashpots, (by_velocities[i] - elastic[i]).norm());
  REQUIRE(dashpots > 0);
  for (std::size_t i = 0; i < x.size(); ++i)
    CHECK((by_differences[i] - by_velocities[i]).norm() < 1e-3 * dashpots);
}

TEST_CASE("a mesh's lists leave few slots free: particles with as many neighbours share them") {
  ClothDef def = union_jack(64);
  def.membrane_model = MembraneModel::springs;
  const ClothModel<float> springs = build_cloth<float>(def);
  const double links = static_cast<double>(springs.parts[0].bending_links.size()) / (64 * 64);
  CHECK(links < 11);
  // The offset to itself, its part of a group's head, and in the mean three springs, further
  // neighbours that only bending leads to, and what as many earlier ones have found. The ring that
  // holds this for the next rows takes a third of that on so small a mesh.
  const double needed = 2 + 0.25 + 3 * (2 + 3 * 4) + (links - 3) * (2 + 4) + links * 2;
  MeshPass<float> pass;
  pass.prepare(springs, springs.parts[0]);
  CHECK(static_cast<double>(pass.bytes()) / (64 * 64) < 1.45 * needed);
  // A pair of triangles with four offsets, eight numbers of its shape, six strains and six links,
  // four corners' pulls, and what bending leads to outside of pairs: all but about
  // three links.
  const double triangles = 2 + 0.25 + 4 * 2 + (8 + 6 + 6) * 4 + 4 * 2 + (links - 3) * (2 + 4 + 2);
  def.membrane_model = MembraneModel::triangles;
  const ClothModel<float> membrane = build_cloth<float>(def);
  pass.prepare(membrane, membrane.parts[0]);
  CHECK(static_cast<double>(pass.bytes()) / (64 * 64) < 1.3 * triangles);
}

TEST_CASE("verlet takes at most 230 bytes a particle of a large mesh, until air or hands come") {
  const int n = 128;
  ClothDef def = union_jack(n);
  World<float> world(test::empty_world(def));
  CHECK(static_cast<double>(world.solver_bytes()) <= 230 * n * n);
  def.membrane_model = MembraneModel::springs;
  World<float> net(test::empty_world(def));
  CHECK(static_cast<double>(net.solver_bytes()) <= 190 * n * n);
}
