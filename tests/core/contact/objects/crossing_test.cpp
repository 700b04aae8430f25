#include <functional>

#include <catch2/catch.hpp>

#include "core/contact/objects/contact.h"
#include "core/scenes/dress_form.h"
#include "tests/support/meshes.h"
#include "tests/support/particles.h"
#include "tests/support/seeded_random.h"

// Nothing passes through anything.

using namespace weft;
using test::Particles;
using test::Random;
using test::SeededRandom;

namespace {

struct Target {
  std::string name;
  ShapeDef shape;
  TriangleMesh mesh;                             ///< empty for an analytic shape
  std::function<double(const Vec3d&)> distance;  ///< signed, of an analytic shape
};

std::vector<Target> targets() {
  std::vector<Target> list;
  const auto add_mesh = [&](const std::string& name, const TriangleMesh& mesh) {
    list.push_back({name, MeshDef{mesh}, mesh, {}});
  };
  list.push_back({"plane", PlaneDef{Vec3d::Zero(), Vec3d(0.1, 1, -0.2)}, {}, [](const Vec3d& p) {
                    return p.dot(Vec3d(0.1, 1, -0.2).normalized());
                  }});
  list.push_back({"sphere", SphereDef{Vec3d(0, -0.2, 0), 0.2}, {}, [](const Vec3d& p) {
                    return (p - Vec3d(0, -0.2, 0)).norm() - 0.2;
                  }});
  list.push_back(
      {"capsule", CapsuleDef{Vec3d(-0.3, 0, 0), Vec3d(0.3, 0, 0), 0.05}, {}, [](const Vec3d& p) {
         return (p - Vec3d(std::clamp(p[0], -0.3, 0.3), 0, 0)).norm() - 0.05;
       }});
  const BoxDef box{Vec3d(0, -0.1, 0), Vec3d(0.2, 0.1, 0.3),
                   Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Vec3d(1, 2, 3).normalized()))};
  list.push_back({"box", box, world_mesh(box), {}});
  add_mesh("closed plate of 1 mm", test::plate(0.3, 1e-3));
  add_mesh("open sheet", test::sheet(0.3));
  add_mesh("blade of 2 degrees", test::blade(0.035, 0.3, 0.3));
  TriangleMesh form = make_dress_form();
  for (Vec3d& p : form.positions) p[1] -= 1.2;
  add_mesh("dressmaker's form", form);
  return list;
}

/// A point on the target's surface, more or less.
Vec3d aim(const Target& target, Random& random) {
  if (target.mesh.triangles.empty()) return random.vector(0.05);
  const auto t =
      static_cast<std::size_t>(random.index(static_cast<Index>(target.mesh.triangles.size())));
  double u = random.uniform(0, 1), v = random.uniform(0, 1);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  const auto at = [&](std::size_t k) {
    return target.mesh.positions[static_cast<std::size_t>(target.mesh.triangles[t][k])];
  };
  return at(0) + (at(1) - at(0)) * u + (at(2) - at(0)) * v;
}

/// Particles from all around (from above, for the plane), each aimed at the surface.
template <class Real>
Particles<Real> shower(const Target& target, double speed, Random& random) {
  Particles<Real> rain;
  while (rain.state.x.size() < 60) {
    const Vec3d goal = aim(target, random);
    Vec3d from = goal + random.vector(1).normalized() * random.uniform(0.02, 0.6);
    if (target.distance && target.distance(from) < 0.01) continue;
    if (!target.mesh.triangles.empty() && is_closed(target.mesh)) {
      // Outside: a far point is seen through an even number of faces.
      int faces = 0;
      for (const Triangle& t : target.mesh.triangles) {
        const auto at = [&](std::size_t k) {
          return target.mesh.positions[static_cast<std::size_t>(t[k])];
        };
        faces += test::pierces(from, from + Vec3d(7.13, 11.7, 5.91), at(0), at(1), at(2));
      }
      if (faces % 2) continue;
    }
    rain.add(from, (goal - from).normalized() * speed);
  }
  return rain;
}

template <class Real>
void check_showers(double speed, double tolerance) {
  SeededRandom random(21);
  for (const Target& target : targets()) {
    Particles<Real> rain = shower<Real>(target, speed, random);
    Contact<Real> contact = rain.meet({}, {{target.name, target.shape}});
    int crossings = 0;
    double deepest = 0;
    for (int tick = 0; tick < 12; ++tick) {
      rain.step(contact, [&](const ClothState<Real>& before) {
        for (std::size_t i = 0; i < rain.state.x.size(); ++i) {
          const Vec3d p = before.x[i].template cast<double>(),
                      q = rain.position(static_cast<Index>(i));
          if (target.distance)
            deepest = std::min(deepest, target.distance(q));
          else
            crossings += p != q && test::pierces(p, q, target.mesh);
        }
      });
    }
    INFO(target.name << " at " << speed << " m/s");
    CHECK(crossings == 0);
    CHECK(deepest > -tolerance);
  }
}

}  // namespace

TEST_CASE("a thrown particle crosses no surface at any speed up to 1000 m/s, double") {
  for (const double speed : {0.5, 5.0, 50.0, 1000.0}) check_showers<double>(speed, 1e-9);
}

TEST_CASE("a thrown particle crosses no surface at any speed up to 1000 m/s, float") {
  for (const double speed : {0.5, 5.0, 50.0, 1000.0}) check_showers<float>(speed, 1e-6);
}

namespace {

/// Two particles on an edge, dropped astride a ridge along z at the height of the origin.
template <class Real>
void check_edge_over_ridge(const TriangleMesh& ridge, double pull, double skew) {
  Particles<Real> pair;
  const Index i = pair.add(Vec3d(-0.03, 0.05, 0.0)), j = pair.add(Vec3d(0.025, 0.05, skew));
  pair.join(i, j, 400);
  pair.dashpot = 0.05;
  pair.substeps = 100;
  for (Vec3d& f : pair.forces) f = Vec3d(0, -pull, 0);
  Contact<Real> contact = pair.meet({}, {{"ridge", MeshDef{ridge}}});
  int pierced = 0;
  for (int tick = 0; tick < 90; ++tick) {
    pair.step(contact, [&](const ClothState<Real>&) {
      pierced += test::pierces(pair.position(i), pair.position(j), ridge);
    });
  }
  INFO("pull " << pull << " N, skew " << skew);
  CHECK(pierced == 0);
}

TriangleMesh ridge_of_box() {
  return world_mesh({Vec3d(0, -0.2 * std::sqrt(0.5) * 2, 0), Vec3d(0.2, 0.2, 0.2),
                     Eigen::Quaterniond(Eigen::AngleAxisd(0.78539816339744831, Vec3d::UnitZ()))});
}

template <class Real>
void check_edge_over_ridge(const TriangleMesh& ridge) {
  for (const double skew : {0.0, 0.02}) {
    for (const double pull : {0.0, 0.1, 1.0, 50.0}) check_edge_over_ridge<Real>(ridge, pull, skew);
  }
}

}  // namespace

TEST_CASE("an edge that falls astride a ridge is not cut by it, however it is pulled") {
  SECTION("box") {
    check_edge_over_ridge<double>(ridge_of_box());
  }
  SECTION("box, float") {
    check_edge_over_ridge<float>(ridge_of_box());
  }
  SECTION("knife of 2 degrees") {
    check_edge_over_ridge<double>(test::blade(0.035, 0.3, 0.3));
  }
  SECTION("knife of 2 degrees, float") {
    check_edge_over_ridge<float>(test::blade(0.035, 0.3, 0.3));
  }
}

namespace {

template <class Real>
void check_triangle_over_needle(const TriangleMesh& needle, double pull) {
  Particles<Real> cloth;
  const Index a = cloth.add(Vec3d(-0.03, 0.04, -0.02)), b = cloth.add(Vec3d(0.03, 0.04, -0.02)),
              c = cloth.add(Vec3d(0.002, 0.04, 0.03));
  cloth.add_triangle(a, b, c, 400);
  cloth.dashpot = 0.05;
  cloth.substeps = 100;
  for (Vec3d& f : cloth.forces) f = Vec3d(0, -pull, 0);
  Contact<Real> contact = cloth.meet({}, {{"needle", MeshDef{needle}}});
  int pierced = 0;
  for (int tick = 0; tick < 60; ++tick) {
    cloth.step(contact, [&](const ClothState<Real>&) {
      pierced +=
          test::mesh_pierces(needle, cloth.position(a), cloth.position(b), cloth.position(c));
    });
  }
  INFO("pull " << pull << " N");
  CHECK(pierced == 0);
}

}  // namespace

TEST_CASE("a needle does not poke through a triangle of the cloth") {
  for (const int sides : {4, 32}) {
    for (const double pull : {0.0, 0.1, 1.0, 50.0}) {
      check_triangle_over_needle<double>(test::needle(0.01, 0.3, sides), pull);
      check_triangle_over_needle<float>(test::needle(0.01, 0.3, sides), pull);
    }
  }
}

namespace {

/// A triangle that falls on a round bar or ball, narrower than itself, and is pulled down at its
/// corners.
template <class Real>
double nearest_on_bar(const CapsuleDef& bar, const ShapeDef& shape, double pull) {
  Particles<Real> cloth;
  const Index a = cloth.add(Vec3d(-0.03, 0.04, -0.02)), b = cloth.add(Vec3d(0.03, 0.04, -0.02)),
              c = cloth.add(Vec3d(0.002, 0.04, 0.03));
  cloth.add_triangle(a, b, c, 400);
  cloth.dashpot = 0.05;
  cloth.substeps = 100;
  for (Vec3d& f : cloth.forces) f = Vec3d(0, -pull, 0);
  Contact<Real> contact = cloth.meet({}, {{"bar", shape}});
  double nearest = 1;
  for (int tick = 0; tick < 60; ++tick) {
    cloth.step(contact, [&](const ClothState<Real>&) {
      for (int u = 0; u <= 20; ++u) {
        for (int v = 0; u + v <= 20; ++v) {
          const Vec3d p = cloth.position(a) + (cloth.position(b) - cloth.position(a)) * (u / 20.0) +
                          (cloth.position(c) - cloth.position(a)) * (v / 20.0);
          const Vec3d q = bar.a + (bar.b - bar.a) * closest_on_segment<double>(p, bar.a, bar.b);
          nearest = std::min(nearest, (p - q).norm() - bar.radius);
        }
      }
    });
  }
  return nearest;
}

}  // namespace

TEST_CASE("a thin bar and a small ball do not come through a triangle that is pulled over them") {
  const CapsuleDef bar{Vec3d(0, -0.005, -0.2), Vec3d(0, -0.005, 0.2), 0.005};
  const CapsuleDef ball{Vec3d(0, -0.005, 0), Vec3d(0, -0.005, 0), 0.005};
  for (const double pull : {0.0, 1.0, 50.0}) {
    INFO("pull " << pull << " N");
    CHECK(nearest_on_bar<double>(bar, bar, pull) > 0);
    CHECK(nearest_on_bar<float>(bar, bar, pull) > 0);
    CHECK(nearest_on_bar<double>(ball, SphereDef{ball.a, ball.radius}, pull) > 0);
    CHECK(nearest_on_bar<float>(ball, ball, pull) > 0);
  }
}

TEST_CASE("a cloth on the lower face of a thin plate is not pulled through by the upper one") {
  // Thinner than the contact distance: the far side's features are within reach.
  const TriangleMesh plate = test::plate(0.05, 1e-3);
  Particles<double> cloth;
  cloth.gravity = Vec3d(0, 9.81, 0);
  const Index a = cloth.add(Vec3d(-0.06, -0.02, -0.06)), b = cloth.add(Vec3d(0.06, -0.02, -0.06)),
              c = cloth.add(Vec3d(0, -0.02, 0.07)), d = cloth.add(Vec3d(0, -0.02, 0));
  cloth.add_triangle(a, b, d, 100);
  cloth.add_triangle(b, c, d, 100);
  cloth.add_triangle(c, a, d, 100);
  cloth.dashpot = 0.02;
  Contact<double> contact = cloth.meet({}, {{"plate", MeshDef{plate}}});
  int crossings = 0;
  for (int tick = 0; tick < 60; ++tick) {
    cloth.step(contact, [&](const ClothState<double>&) {
      for (const Edge& e : cloth.edges)
        crossings += test::pierces(cloth.position(e[0]), cloth.position(e[1]), plate);
    });
  }
  CHECK(crossings == 0);
  CHECK(cloth.position(d)[1] == Approx(-1e-3 - 0.004).margin(1e-4));
}

namespace {

/// A patch of n x n particles in the plane y = height, pressed down by 50 N on its middle.
template <class Real>
void check_pressed_patch(const TriangleMesh& wall) {
  constexpr Index kSide = 7;
  Particles<Real> cloth;
  cloth.add_patch(kSide, 0.02, Vec3d(-0.057, 0.03, -0.059), 8e-5, 300, 50);
  cloth.dashpot = 0.01;
  cloth.substeps = 120;
  cloth.forces[24] = Vec3d(3, -50, 2);
  Contact<Real> contact = cloth.meet({}, {{"wall", MeshDef{wall}}});
  int crossings = 0;
  for (int tick = 0; tick < 45; ++tick) {
    if (tick == 20) cloth.forces[24] = Vec3d(-30, -40, 0);
    cloth.step(contact, [&](const ClothState<Real>& before) {
      for (Index i = 0; i < kSide * kSide; ++i)
        crossings += test::pierces(before.x[static_cast<std::size_t>(i)].template cast<double>(),
                                   cloth.position(i), wall);
    });
    for (const Edge& e : cloth.edges)
      crossings += test::pierces(cloth.position(e[0]), cloth.position(e[1]), wall);
  }
  CHECK(crossings == 0);
}

}  // namespace

TEST_CASE("a cloth pressed against a wall by a hand of 50 N stays on its side") {
  SECTION("solid wall") {
    check_pressed_patch<double>(test::plate(0.3, 0.1));
  }
  SECTION("solid wall, float") {
    check_pressed_patch<float>(test::plate(0.3, 0.1));
  }
  SECTION("plate of 1 mm") {
    check_pressed_patch<double>(test::plate(0.3, 1e-3));
  }
  SECTION("plate of 1 mm, float") {
    check_pressed_patch<float>(test::plate(0.3, 1e-3));
  }
  SECTION("open sheet") {
    check_pressed_patch<double>(test::sheet(0.3));
  }
  SECTION("open sheet, float") {
    check_pressed_patch<float>(test::sheet(0.3));
  }
  SECTION("small plate whose rim is crossed") {
    check_pressed_patch<double>(test::plate(0.045, 1e-3));
  }
  SECTION("small open sheet whose rim is crossed") {
    check_pressed_patch<float>(test::sheet(0.045));
  }
}

namespace {

/// A heavy particle swings an edge over a bar, and the light one at its other end up to a ceiling
/// that is far out of its reach.
template <class Real>
void check_lever() {
  TriangleMesh ceiling = test::sheet(0.3);
  for (Vec3d& p : ceiling.positions) p[1] += 0.05;
  Particles<Real> lever;
  const Index light = lever.add(Vec3d(-0.05, 0, 0), Vec3d::Zero(), 1e-4);
  const Index heavy = lever.add(Vec3d(0.006, 0, 0), Vec3d(0, -20, 0), 1);
  lever.join(light, heavy, 10);
  lever.gravity.setZero();
  Contact<Real> contact =
      lever.meet({}, {{"bar", CapsuleDef{Vec3d(0, -0.011, -1), Vec3d(0, -0.011, 1), 0.005}},
                      {"ceiling", MeshDef{ceiling}}});
  int crossings = 0;
  double fastest = 0;
  for (int tick = 0; tick < 10; ++tick) {
    lever.step(contact, [&](const ClothState<Real>& before) {
      for (const Index i : {light, heavy})
        crossings += test::pierces(before.x[static_cast<std::size_t>(i)].template cast<double>(),
                                   lever.position(i), ceiling);
      fastest = std::max(fastest, lever.velocity(light)[1]);
    });
  }
  CHECK(crossings == 0);
  CHECK(fastest > 1);
}

}  // namespace

TEST_CASE("a particle swung up by a lever does not fly through what it was not near to") {
  SECTION("double") {
    check_lever<double>();
  }
  SECTION("float") {
    check_lever<float>();
  }
}
