#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "core/cloth/fabric_modes.h"
#include "core/cloth/fabric_presets.h"
#include "core/diagnostics/cantilever.h"
#include "core/diagnostics/drape.h"
#include "core/scenes/scenes.h"
#include "core/scenes/textile_scenes.h"
#include "core/world/world.h"
#include "tests/support/worlds.h"

using namespace weft;

namespace {

constexpr double kPi = 3.14159265358979323846;

ClothModel<double> specimen(int cells) {
  WorldDef def = make_scene("drape-test");
  def.cloths[0].rows = def.cloths[0].columns = cells + 1;
  return build_cloth<double>(def.cloths[0]);
}

/// Each particle of the specimen moved along its own ray to the radius and height that `shape`
/// gives for its radius and direction.
template <class Shape>
DrapeMeasurement measured(const ClothModel<double>& model, Shape&& shape) {
  Vec3Array<double> x;
  for (const auto& m : model.material) {
    const double u = m[0] - kDrapeSpecimenRadius, v = m[1] - kDrapeSpecimenRadius;
    const double direction = std::atan2(v, u);
    const auto [radius, height] = shape(std::hypot(u, v), direction);
    x.push_back(
        Vec3d(7 + radius * std::cos(direction), 2 + height, -3 + radius * std::sin(direction)));
  }
  return measure_drape(model, model.parts[0], x, Vec3d(7, 2, -3));
}

}  // namespace

TEST_CASE("a grid cut to a disc has the disc's area and mass, to 1 %, and whole cells") {
  const ClothModel<double> model = specimen(60);
  double area = 0, mass = 0;
  for (const double a : model.triangle_area) area += a;
  for (const double m : model.mass) mass += m;
  CHECK(area == Approx(kPi * 0.15 * 0.15).epsilon(0.01));
  CHECK(mass == Approx(area * model.parts[0].fabric.areal_density).epsilon(1e-12));
  CHECK(model.triangles.size() % 2 == 0);
  for (const auto& m : model.material)
    CHECK(std::hypot(m[0] - 0.15, m[1] - 0.15) < 0.15 + std::sqrt(0.5) * 0.005);
}

TEST_CASE(
    "the drape's mesh of rings is the specimen, in triangles of about one size that face up") {
  for (const int rings : {2, 5, 10, 40}) {
    INFO(rings << " rings");
    const WorldDef def = drape_test_on_rings(make_fabric("cotton"), rings);
    const TriangleMesh& mesh = def.cloths[0].mesh->mesh;
    const double gap = (kDrapeSpecimenRadius - kDrapeSupportRadius) / (rings + 0.5);
    double area = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      const auto at = [&](Index i) { return mesh.positions[static_cast<std::size_t>(i)]; };
      const double twice = (at(b) - at(a)).cross(at(c) - at(a)).y();
      REQUIRE(twice > 0.4 * gap * gap);
      REQUIRE(twice < 1.6 * gap * gap);
      area += twice / 2;
    }
    std::size_t border = 0;
    for (const MeshEdge& edge : edges_of(mesh)) border += edge.triangle[1] == kNone ? 1U : 0U;
    const double corners = static_cast<double>(border);  // of the polygon that the hem is
    CHECK(area == Approx(kDrapeSpecimenRadius * kDrapeSpecimenRadius * corners / 2 *
                         std::sin(2 * kPi / corners)));
    World<double> world(def);
    double held = 0;
    for (const auto i : world.pins().list[0].particles) {
      const Vec3d& x = world.state().x[static_cast<std::size_t>(i)];
      held = std::max(held, std::hypot(x.x(), x.z()));
    }
    CHECK(held == Approx(kDrapeSupportRadius + gap / 2));
  }
}

TEST_CASE("the springs and hinges of a cut grid are those of the whole grid at the same places") {
  ClothDef def = test::flat_cloth(9, 11, 1, 0.9);
  def.bending_model = BendingModel::hinges;
  const ClothModel<double> whole = build_cloth<double>(def);
  def.outline = Outline::ellipse;
  const ClothModel<double> cut = build_cloth<double>(def);
  CHECK(cut.mass.size() < whole.mass.size());
  const auto near = [](const auto& a, const auto& b) { return std::abs(a - b) < 1e-12; };
  const auto place_in_whole = [&](Index i) {
    const Vec3d& x = cut.rest_positions[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < whole.mass.size(); ++k) {
      if ((whole.rest_positions[k] - x).norm() < 1e-9) return static_cast<Index>(k);
    }
    return kNone;
  };
  std::size_t inner = 0;
  for (const Spring<double>& s : cut.springs) {
    const Index i = place_in_whole(s.i), j = place_in_whole(s.j);
    bool found = false;
    for (const Spring<double>& w : whole.springs) {
      if (std::minmax(w.i, w.j) != std::minmax(i, j)) continue;
      found = near(w.rest_length, s.rest_length) && s.stiffness < w.stiffness + 1e-9;
      inner += near(w.stiffness, s.stiffness);
    }
    CHECK(found);
  }
  CHECK(inner > cut.springs.size() / 2);
  CHECK(cut.hinges.size() > whole.hinges.size() / 2);
}

TEST_CASE(
    "a disc that stays flat has drape coefficient 100 % and no folds, a skirt that hangs straight "
    "0 %") {
  const ClothModel<double> model = specimen(60);
  for (const int cells : {24, 40, 41, 81, 120}) {
    const ClothModel<double> other = specimen(cells);
    for (const double steepness : {0.0, 0.5, 0.9}) {
      const DrapeMeasurement cone = measured(other, [&](double r, double) {
        const double out = std::max(0.0, r - 0.09);
        return std::pair(r - steepness * out, -out);
      });
      INFO(cells << " cells, steepness " << steepness);
      CHECK(cone.folds == 0);
    }
  }
  const DrapeMeasurement flat = measured(model, [](double r, double) { return std::pair(r, 0.0); });
  CHECK(flat.coefficient == Approx(100).margin(0.5));
  CHECK(flat.folds == 0);
  CHECK(flat.droop == Approx(0).margin(1e-12));
  const DrapeMeasurement skirt = measured(model, [](double r, double) {
    return std::pair(std::min(r, 0.09), std::min(0.0, 0.09 - r));
  });
  CHECK(skirt.coefficient == Approx(0).margin(1.5));
  CHECK(skirt.droop == Approx(0.06).margin(0.003));
}

TEST_CASE("waves around the disc are counted as folds, ripples of a millimetre are not") {
  const ClothModel<double> model = specimen(60);
  for (int folds = 2; folds <= 9; ++folds) {
    const DrapeMeasurement wavy = measured(model, [&](double r, double direction) {
      const double out = std::max(0.0, r - 0.09);
      return std::pair(r - out * (0.5 + 0.25 * std::cos(folds * direction)), -out);
    });
    CHECK(wavy.folds == folds);
    // The shadow's edge is at 0.12 + 0.015 cos: its area pi (0.12^2 + 0.015^2 / 2).
    CHECK(wavy.coefficient ==
          Approx(100 * (0.0144 + 0.0001125 - 0.0081) / (0.0225 - 0.0081)).margin(1.5));
  }
  const DrapeMeasurement ripples = measured(model, [](double r, double direction) {
    const double out = std::max(0.0, r - 0.09);
    return std::pair(r - out * (0.3 + 0.008 * std::cos(6 * direction)), -out);
  });
  CHECK(ripples.folds == 0);
}

TEST_CASE("chord angle and gamma of the elastica are those of the table, to 1e-4, and inverses") {
  // heavy_elastica_cantilever.table and peirce_cantilever_41.5_degrees.
  const auto [gamma, degrees] = GENERATE(table<double, double>({{0.1, 0.716134375803661},
                                                                {1, 7.100292374864014},
                                                                {3, 20.032909148863038},
                                                                {8.004197032598174, 41.5},
                                                                {10, 46.851245752486825},
                                                                {30, 68.56573347004903},
                                                                {100, 80.3612022971564}}));
  CHECK(elastica_chord_angle(gamma) * 180 / kPi == Approx(degrees).epsilon(1e-4));
  CHECK(elastica_gamma(degrees * kPi / 180) == Approx(gamma).epsilon(1e-3));
}

TEST_CASE("the cantilever test finds the bending length of every preset, to 1 % below 75 degrees") {
  for (const FabricPreset& preset : fabric_presets()) {
    WorldDef def = make_scene("cantilever-test");
    def.cloths[0].fabric = preset.fabric;
    World<float> world(def);
    test::advance(world, 3);
    const auto m = world.measurements();
    REQUIRE(m.size() == 5);
    INFO(preset.name << ": droop " << m[0].value << " m, " << m[1].value << " degrees");
    CHECK(m[4].value < 0.01);  // what rounding keeps moving in single precision
    const double expected =
        std::cbrt(preset.fabric.bending_warp / (preset.fabric.areal_density * 9.81));
    // Close to the plumb line a degree is a tenth of the bending length and more.
    const double tolerance = m[1].value < 75 ? 0.01 : 0.05;
    CHECK(m[2].value == Approx(expected).epsilon(tolerance));
    CHECK(m[3].value == Approx(preset.fabric.bending_warp).epsilon(3 * tolerance));
  }
}

TEST_CASE("a strip that trembles as it is let go has not swung through") {
  Swing swing;
  const auto at = [](double t) {
    const double tremble = t < 0.2 ? 2e-3 * std::sin(100 * t) : 0;
    return std::exp(-t / 5) * std::cos(kPi * t) + tremble;
  };
  for (int tick = 0; tick < 600; ++tick) swing.look(tick / 60.0, at(tick / 60.0));
  CHECK(swing.decay().period == Approx(2).epsilon(0.01));
  CHECK(swing.decay().decay_time == Approx(5).epsilon(0.02));
}

TEST_CASE("the decay test finds the relaxation time of bending and the period, to 5 %") {
  const auto [name, times] = GENERATE(table<std::string, double>({{"cotton", 1},
                                                                  {"cotton", 4},
                                                                  {"silk", 1},
                                                                  {"wool", 1},
                                                                  {"denim", 1},
                                                                  {"leather", 1},
                                                                  {"nylon", 1}}));
  WorldDef def = make_scene("decay-test");
  def.cloths[0].fabric = make_fabric(name);
  const double time = def.cloths[0].fabric.bending_damping *= times;
  World<float> world(def);
  test::advance(world, 0.5);
  CHECK(world.measurements().size() == 1);  // held by the hand
  test::advance(world, 19.5);               // a limp strip swings less than once a second
  const auto m = world.measurements();
  REQUIRE(m.size() == 5);
  const double omega = angular_frequency(def.cloths[0].fabric, FabricMode::bending, 0.04);
  INFO(name << " with " << time << " s: " << m[1].value << " s, " << m[2].value << " s");
  CHECK(m[1].value == Approx(2 * kPi / omega).epsilon(0.02));
  CHECK(m[2].value == Approx(2 / (omega * omega * time)).epsilon(0.07));
  CHECK(m[3].value == Approx(omega * time).epsilon(0.05));
  CHECK(m[4].value == Approx(time).epsilon(0.05));
}

TEST_CASE("presets lose a fifth in waves of 5 cm, by bending, without a substep more") {
  for (const FabricPreset& preset : fabric_presets()) {
    INFO(preset.name);
    const FabricDef& f = preset.fabric;
    const double wave = 2 * kPi / 0.05;
    const double omega = wave * wave * std::sqrt(f.bending_warp / f.areal_density);
    CHECK(omega * f.bending_damping == Approx(0.2));
    WorldDef def = make_scene("table");
    def.cloths[0].fabric = f;
    const auto substeps = [&def] { return World<float>(def).cost_in(def.environment).substeps; };
    const double damped = substeps();
    def.cloths[0].fabric.bending_damping = 0;
    CHECK(damped == substeps());
  }
}

TEST_CASE(
    "a swing begins anew with each hold, and one that does not decay tells its period alone") {
  Swing swing;
  const auto look = [&swing](double from, double to, double growth) {
    for (double t = from; t < to; t += 0.01) swing.look(t, std::exp(growth * t) * std::cos(20 * t));
  };
  look(0, 1, -0.5);
  CHECK(swing.decay().period == Approx(2 * kPi / 20).epsilon(1e-3));
  CHECK(swing.decay().decay_time == Approx(2).epsilon(0.01));
  swing.begin_anew();
  CHECK(swing.amplitude() == 0);
  CHECK(swing.decay().period == 0);
  look(1, 2, 0.5);
  CHECK(swing.decay().period == Approx(2 * kPi / 20).epsilon(1e-3));
  CHECK(swing.decay().decay_time == 0);
  CHECK(swing.decay().relaxation_time() == 0);
}

TEST_CASE("a fabric with a bending length c has the rigidity B = sigma g c^3") {
  CHECK(bending_rigidity(0.324, 0.02662639748288505) == Approx(6e-5).epsilon(1e-6));  // denim
  CHECK(bending_rigidity(0.324, 0.02) == Approx(0.324 * 9.81 * 8e-6));
}

TEST_CASE("a scene that is no test measures nothing, and one that does not fit its test neither") {
  WorldDef def = make_scene("wall");
  World<float> wall(def);
  CHECK(wall.measurements().empty());
  def = make_scene("cantilever-test");
  def.pins.clear();
  World<float> loose(def);
  CHECK(measurements(TextileTest::cantilever, loose.model(), loose.state(), loose.mean_velocities(),
                     9.81, {})
            .empty());
  CHECK(measurements(TextileTest::drape, loose.model(), loose.state(), loose.mean_velocities(),
                     9.81, {})
            .empty());
}
