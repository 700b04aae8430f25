#include "core/contact/objects/contact.h"

#include <cmath>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/scenes/dress_form.h"
#include "tests/support/allocations.h"
#include "tests/support/meshes.h"
#include "tests/support/particles.h"
#include "tests/support/seeded_random.h"
#include "tests/support/two_threads.h"

using namespace weft;
using test::Particles;
using test::SeededRandom;

namespace {

/// A square of n x n particles at a height, with triangles and springs.
template <class Real>
Particles<Real> make_square(Index n, double cell, double height) {
  Particles<Real> cloth;
  for (Index r = 0; r < n; ++r)
    for (Index c = 0; c < n; ++c)
      cloth.add(Vec3d(cell * (c - (n - 1) / 2.0), height, cell * (r - (n - 1) / 2.0)),
                Vec3d::Zero(), 1e-4);
  for (Index r = 0; r + 1 < n; ++r) {
    for (Index c = 0; c + 1 < n; ++c) {
      const Index i = r * n + c;
      cloth.triangles.push_back({i, i + n, i + 1});
      cloth.triangles.push_back({i + 1, i + n, i + n + 1});
      cloth.join(i + 1, i + n, 20);
    }
  }
  for (Index i = 0; i < n * n; ++i) {
    if (i % n + 1 < n) cloth.join(i, i + 1, 100);
    if (i / n + 1 < n) cloth.join(i, i + n, 100);
  }
  cloth.dashpot = 0.02;
  return cloth;
}

template <class Real>
void check_threads() {
  TriangleMesh form = make_dress_form();
  for (Vec3d& p : form.positions) p[1] -= 1.4;
  const std::vector<ColliderDef> colliders = {
      {"form", MeshDef{form}}, {"ground", PlaneDef{Vec3d(0, -0.3, 0), Vec3d::UnitY()}}};
  Particles<Real> one = make_square<Real>(14, 0.04, 0.16), two = one;
  test::TwoThreads threads;
  Contact<Real> serial = one.meet({}, colliders), parallel = two.meet({}, colliders, &threads);
  for (int tick = 0; tick < 40; ++tick) {
    one.step(serial);
    two.step(parallel);
    for (std::size_t i = 0; i < one.state.x.size(); ++i) {
      REQUIRE(one.state.x[i] == two.state.x[i]);
      REQUIRE(one.state.v[i] == two.state.v[i]);
    }
    for (std::size_t s = 0; s < kStageCount; ++s)
      REQUIRE(one.profile.stages[s].work == two.profile.stages[s].work);
  }
  CHECK_FALSE(serial.rows().empty());
}

}  // namespace

TEST_CASE("one thread and two give the same bits and count the same work") {
  SECTION("double") {
    check_threads<double>();
  }
  SECTION("float") {
    check_threads<float>();
  }
}

TEST_CASE("an object out of reach costs no narrow phase, no rows, and no work once that is known") {
  Particles<float> cloth = make_square<float>(8, 0.03, 0);
  cloth.gravity.setZero();
  TriangleMesh form = make_dress_form();
  for (Vec3d& p : form.positions) p[0] += 3;
  Contact<float> contact =
      cloth.meet({}, {{"form", MeshDef{form}}, {"sphere", SphereDef{Vec3d(-3, 0, 0), 0.5}}});
  cloth.step(contact);
  CHECK(cloth.profile[Stage::narrow_phase].work == 0);
  for (int tick = 0; tick < 10; ++tick) {
    cloth.step(contact);
    for (const Stage stage :
         {Stage::broad_phase, Stage::narrow_phase, Stage::contact, Stage::friction})
      CHECK(cloth.profile[stage].work == 0);
  }
  CHECK(contact.rows().empty());
}

TEST_CASE("without friction there is no friction evaluation, with it there is") {
  for (const double friction : {0.0, 0.3}) {
    Particles<float> cloth = make_square<float>(5, 0.03, 0.005);
    Contact<float> contact = cloth.meet({0.004, friction, 0}, {{"ground", PlaneDef{}}});
    std::uint64_t evaluations = 0, rows = 0;
    for (int tick = 0; tick < 20; ++tick) {
      cloth.step(contact);
      evaluations += cloth.profile[Stage::friction].work;
      rows += cloth.profile[Stage::contact].work;
    }
    CHECK(rows > 0);
    CHECK((evaluations > 0) == (friction > 0));
  }
}

TEST_CASE("a world without objects costs nothing and changes nothing") {
  Particles<double> cloth = make_square<double>(4, 0.03, 0);
  Particles<double> free = cloth;
  Contact<double> contact = cloth.meet({}, {});
  for (int tick = 0; tick < 5; ++tick) {
    cloth.step(contact);
    for (int s = 0; s < free.substeps; ++s) {
      free.kick();
      free.drift();
    }
  }
  for (std::size_t i = 0; i < cloth.state.x.size(); ++i) CHECK(cloth.state.x[i] == free.state.x[i]);
  CHECK(cloth.profile[Stage::broad_phase].work == 0);
}

TEST_CASE("nothing is allocated while a cloth lies, slides and falls on objects it has met") {
  TriangleMesh form = make_dress_form();
  for (Vec3d& p : form.positions) p[1] -= 1.4;
  Particles<float> cloth = make_square<float>(12, 0.04, 0.16);
  Contact<float> contact = cloth.meet(
      {}, {{"form", MeshDef{form}}, {"ground", PlaneDef{Vec3d(0, -1.4, 0), Vec3d::UnitY()}}});
  for (int tick = 0; tick < 120; ++tick) cloth.step(contact);
  REQUIRE_FALSE(contact.rows().empty());
  std::size_t taken = 0;
  for (int tick = 0; tick < 20; ++tick) {
    cloth.profile.clear();
    contact.begin_tick(cloth.tick_seconds);
    for (int s = 0; s < cloth.substeps; ++s) {
      cloth.kick();
      const std::size_t before = test::count_allocations();
      contact.resolve(cloth.state, static_cast<float>(cloth.dt()), cloth.profile);
      taken += test::count_allocations() - before;
      cloth.drift();
    }
  }
  CHECK(taken == 0);
}

TEST_CASE("a pinned particle never moves, whether outside, in contact or inside") {
  const TriangleMesh box = box_mesh(Vec3d(0.1, 0.1, 0.1));
  for (const double height : {0.2, 0.102, 0.05}) {
    Particles<double> cloth;
    const Index held = cloth.add(Vec3d(0.01, height, 0), Vec3d::Zero(), 0);
    const Index tail = cloth.add(Vec3d(0.15, 0.15, 0.01)),
                side = cloth.add(Vec3d(0.05, 0.15, 0.06));
    cloth.add_triangle(held, tail, side, 100);
    cloth.dashpot = 0.02;
    Contact<double> contact = cloth.meet({}, {{"box", MeshDef{box}}});
    const Vec3d start = cloth.position(held);
    for (int tick = 0; tick < 60; ++tick) cloth.step(contact);
    INFO("height " << height);
    CHECK(cloth.position(held) == start);
    for (const auto& x : cloth.state.x) CHECK(x.allFinite());
  }
}

TEST_CASE("the deepest penetration is that of the deepest of all particles and points of edges") {
  SeededRandom random(7);
  const std::vector<ColliderDef> solids = {{"form", MeshDef{make_dress_form()}},
                                           {"ball", SphereDef{Vec3d(0.4, 1.1, 0), 0.1}}};
  int inside = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Particles<float> cloth = make_square<float>(24, 0.04, 0);
    const double height = random.uniform(0.2, 2.2), wave = random.uniform(0, 0.2);
    const Vec3d away(random.uniform(-0.7, 0.7), height, random.uniform(-0.7, 0.7));
    for (Vec3f& x : cloth.state.x)
      x = (x.cast<double>() + away + Vec3d(0, wave * std::sin(9.0 * x[0] + 7.0 * x[2]), 0))
              .cast<float>();
    Particles<float> probes;
    probes.state = cloth.state;
    for (const Edge& e : cloth.edges) {
      for (const double t : {0.25, 0.5, 0.75})
        probes.add(cloth.position(e[0]) + (cloth.position(e[1]) - cloth.position(e[0])) * t);
    }
    const double all = probes.meet({}, solids).deepest_penetration(probes.state.x);
    inside += all > 0 ? 1 : 0;
    CHECK(cloth.meet({}, solids).deepest_penetration(cloth.state.x) == Approx(all).margin(1e-6));
  }
  CHECK(inside > 10);
  CHECK(inside < 40);
}

TEST_CASE(
    "a particle that starts inside a solid is pushed out gently, and is reported until then") {
  const TriangleMesh box = box_mesh(Vec3d(0.1, 0.1, 0.1));
  for (const ShapeDef& shape : std::vector<ShapeDef>{
           MeshDef{box}, SphereDef{Vec3d::Zero(), 0.1}, PlaneDef{Vec3d(0, 0.1, 0), Vec3d::UnitY()},
           CapsuleDef{Vec3d(-0.3, 0, 0), Vec3d(0.3, 0, 0), 0.1}}) {
    Particles<float> one;
    one.gravity.setZero();
    one.add(Vec3d(0, 0.06, 0));
    Contact<float> contact = one.meet({}, {{"solid", shape}});
    INFO("shape " << shape.index());
    CHECK(contact.deepest_penetration(one.state.x) == Approx(0.04).epsilon(0.1));
    double fastest = 0, last = contact.deepest_penetration(one.state.x);
    for (int tick = 0; tick < 120; ++tick) {
      one.step(contact);
      const double now = contact.deepest_penetration(one.state.x);
      CHECK(now <= last);
      last = now;
      fastest = std::max(fastest, one.velocity(0).norm());
    }
    CHECK(last == 0);
    CHECK(fastest < 1e-3);
  }
}

TEST_CASE("the deepest penetration is the largest depth, found anew, of particles and of edges") {
  const TriangleMesh box = box_mesh(Vec3d(0.1, 0.1, 0.1));
  Particles<double> cloth;
  const Index a = cloth.add(Vec3d(-0.2, 0.05, 0)), b = cloth.add(Vec3d(0.2, 0.05, 0));
  Contact<double> lone = cloth.meet({}, {{"box", MeshDef{box}}});
  CHECK(lone.deepest_penetration(cloth.state.x) == 0);
  cloth.join(a, b, 0);
  CHECK(cloth.meet({}, {{"box", MeshDef{box}}}).deepest_penetration(cloth.state.x) == Approx(0.05));
  CHECK(cloth.meet({}, {{"ground", PlaneDef{Vec3d(0, 0.3, 0), Vec3d::UnitY()}}})
            .deepest_penetration(cloth.state.x) == Approx(0.25));
}

namespace {

template <class Real>
double triangle_distance(const TriangleMesh& mesh, std::size_t t, const Vec3<Real>& p) {
  const auto at = [&](std::size_t k) -> Vec3d {
    return mesh.positions[static_cast<std::size_t>(mesh.triangles[t][k])];
  };
  const Vec3d q = p.template cast<double>();
  return (closest_on_triangle<double>(q, at(0), at(1), at(2)).point - q).norm();
}

/// Whether a row of these particles has this gap.
template <class Real>
bool has_row(const Contact<Real>& contact, const ClothState<Real>& state,
             std::initializer_list<Index> particles, double gap) {
  for (const ContactRow<Real>& row : contact.rows()) {
    if (row.count != particles.size() ||
        !std::equal(particles.begin(), particles.end(), row.particle.begin()))
      continue;
    double height = -static_cast<double>(row.offset);
    for (std::size_t k = 0; k < particles.size(); ++k)
      height += static_cast<double>(
          row.weight[k] * row.normal.dot(state.x[static_cast<std::size_t>(row.particle[k])]));
    if (std::abs(height - gap) < 1e-5) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("rows exist for the pairs that brute force finds within reach of the thickness") {
  SeededRandom random(31);
  const TriangleMesh box = box_mesh(Vec3d(0.08, 0.02, 0.06)), needle = test::needle(0.01, 0.1, 5);
  int pairs = 0;
  for (int round = 0; round < 100; ++round) {
    const TriangleMesh& mesh = round % 2 ? box : needle;
    const ContactDef def{0.01, 0, 0};
    Particles<double> cloth;
    for (int n = 0; n < 12; ++n) {
      // Small triangles outside the object.
      Vec3d corner[3];
      bool clear = false;
      while (!clear) {
        const Vec3d at = random.vector(0.1);
        for (Vec3d& p : corner) p = at + random.vector(0.02);
        clear = !test::mesh_pierces(mesh, corner[0], corner[1], corner[2]);
        for (int k = 0; k < 3; ++k) {
          clear = clear && !test::pierces(corner[k], corner[(k + 1) % 3], mesh);
          int faces = 0;
          for (const Triangle& t : mesh.triangles) {
            const auto q = [&](std::size_t c) {
              return mesh.positions[static_cast<std::size_t>(t[c])];
            };
            faces += test::pierces(corner[k], Vec3d(7.13, 11.7, 5.91), q(0), q(1), q(2));
          }
          clear = clear && faces % 2 == 0;
        }
      }
      const Index a = cloth.add(corner[0]), b = cloth.add(corner[1]), c = cloth.add(corner[2]);
      cloth.add_triangle(a, b, c, 0);
    }
    cloth.gravity.setZero();
    Contact<double> contact = cloth.meet(def, {{"object", MeshDef{mesh}}});
    Profile profile;
    contact.begin_tick(cloth.tick_seconds);
    // Rows are made before anything is pushed, at a state without velocity.
    ClothState<double> state = cloth.state;
    contact.resolve(state, cloth.dt(), profile);
    INFO("round " << round);
    // Edges and corners that particles keep off need rows only where they may meet while the rows
    // hold: until somebody at rest has gone so far.
    const double way = def.thickness / 2;
    for (std::size_t i = 0; i < cloth.state.x.size(); ++i) {
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const double distance = triangle_distance(mesh, t, cloth.state.x[i]);
        if (distance > def.thickness) continue;
        ++pairs;
        CHECK(has_row(contact, cloth.state, {static_cast<Index>(i)}, distance));
      }
    }
    for (const Edge& e : cloth.edges) {
      for (const MeshEdge& m : edges_of(mesh)) {
        const Vec3d n1 = unit_normal(mesh, m.triangle[0]), n2 = unit_normal(mesh, m.triangle[1]);
        if (n1.dot(n2) > 0.9) continue;  // flat diagonals of the box
        const auto c = closest_of_segments<double>(cloth.position(e[0]), cloth.position(e[1]),
                                                   mesh.positions[static_cast<std::size_t>(m.a)],
                                                   mesh.positions[static_cast<std::size_t>(m.b)]);
        const double distance = (c.p - c.q).norm();
        if (distance > way) continue;
        ++pairs;
        CHECK(has_row(contact, cloth.state, {e[0], e[1]}, distance));
      }
    }
    for (const Triangle& t : cloth.triangles) {
      const Vec3d tip = mesh.positions[0];
      const auto c = closest_on_triangle<double>(tip, cloth.position(t[0]), cloth.position(t[1]),
                                                 cloth.position(t[2]));
      const double distance = (c.point - tip).norm();
      if (distance > way) continue;
      ++pairs;
      CHECK(has_row(contact, cloth.state, {t[0], t[1], t[2]}, distance));
    }
  }
  CHECK(pairs > 200);
}

TEST_CASE("a shape out of range is refused by the name of its field") {
  const auto refused = [](const ShapeDef& shape) -> std::string {
    try {
      validate(ColliderDef{"object", shape}, "colliders[2].");
    } catch (const DefinitionError& error) {
      return error.field;
    }
    return {};
  };
  const double nan = std::nan("");
  CHECK(refused(PlaneDef{}).empty());
  CHECK(refused(PlaneDef{Vec3d::Zero(), Vec3d::Zero()}) == "colliders[2].normal");
  CHECK(refused(PlaneDef{Vec3d(0, nan, 0), Vec3d::UnitY()}) == "colliders[2].point[1]");
  CHECK(refused(SphereDef{}).empty());
  CHECK(refused(SphereDef{Vec3d::Zero(), 0}) == "colliders[2].radius");
  CHECK(refused(SphereDef{Vec3d::Zero(), nan}) == "colliders[2].radius");
  CHECK(refused(CapsuleDef{}).empty());
  CHECK(refused(CapsuleDef{Vec3d::Zero(), Vec3d(0, 0, 1e9), 0.1}) == "colliders[2].b[2]");
  CHECK(refused(BoxDef{}).empty());
  CHECK(refused(BoxDef{Vec3d::Zero(), Vec3d(0.1, -1, 0.1), Eigen::Quaterniond::Identity()}) ==
        "colliders[2].half_extents[1]");
  CHECK(refused(BoxDef{Vec3d::Zero(), Vec3d::Ones(), Eigen::Quaterniond(2, 0, 0, 0)}) ==
        "colliders[2].orientation");
  CHECK(refused(MeshDef{test::sheet(0.1)}).empty());
  CHECK(refused(MeshDef{}) == "colliders[2].positions");
}
