#include <functional>
#include <type_traits>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/solver/verlet.h"
#include "tests/support/cloths.h"
#include "tests/support/seeded_random.h"
#include "tests/support/sheets_of_triangles.h"

// Force and energy of each cloth that can be defined, as a solver sees them: a force or an energy
// that is added to the model is checked here without being named.

using namespace weft;

namespace {

/// A mesh that is not flat at rest.
ClothDef curved_mesh() {
  ClothDef def = test::triangle_sheet(test::Cut::irregular, 0.5, 0.4, 0.1, 0.5);
  for (Vec3d& p : def.mesh->mesh.positions) p[2] = 0.1 * std::sin(5 * p[0]) * std::cos(4 * p[1]);
  return def;
}

/// Calls body(def, text) for the cloth itself and for each other word of each of its choices.
void for_each_model(const ClothDef& base, const std::function<void(const ClothDef&)>& body) {
  body(base);
  ClothDef def = base;
  visit_fields_of_any_cloth(def, [&](const FieldInfo& info, auto& value) {
    if constexpr (std::is_enum_v<std::decay_t<decltype(value)>>) {
      const auto before = value;
      const std::string words = info.words;
      const auto count = std::count(words.begin(), words.end(), '|') + 1;
      for (int k = 0; k < count; ++k) {
        value = static_cast<std::decay_t<decltype(value)>>(k);
        INFO(info.name << " = " << choice_word(info, k));
        body(def);
      }
      value = before;
    }
  });
}

/// Force on each particle [N]: what verlet makes of a cloth at rest in so short a time that it does
/// not move.
Vec3Array<double> force_on(const ClothModel<double>& model, const Vec3Array<double>& x) {
  constexpr double kInstant = 1e-10;
  ClothState<double> state = initial_state(model);
  state.x = x;
  VerletWorkspace<double> work;
  const SolverDef solver;
  work.prepare(model, solver, nullptr);
  Grabs<double> no_hands;
  Profile profile;
  advance_verlet<double>(model, {}, solver, kInstant, {}, no_hands, {}, state, work, profile);
  Vec3Array<double> force;
  for (std::size_t i = 0; i < x.size(); ++i)
    force.push_back(state.v[i] * (model.mass[i] / kInstant));
  return force;
}

double energy_of(const ClothModel<double>& model, const Vec3Array<double>& x) {
  ClothState<double> state = initial_state(model);
  state.x = x;
  return read_energies(model, state, Vec3d::Zero().eval()).energies.total();
}

}  // namespace

TEST_CASE("what moves a cloth is minus the gradient of the energy that it tells, to 1e-5") {
  ClothDef grid = test::flat_cloth(4, 5, 1, 0.6), disc = grid,
           mesh = test::triangle_sheet(test::Cut::irregular, 0.5, 0.4, 0.1, 0.5), narrowing = mesh;
  disc.rows = disc.columns = 6;
  disc.outline = Outline::ellipse;
  narrowing.fabric.poisson = 0.4;
  int tried = 0;
  for (const ClothDef& base : {grid, disc, mesh, narrowing, curved_mesh()}) {
    for_each_model(base, [&](ClothDef def) {
      def.fabric.bending_warp = 3e-4;
      ClothModel<double> model;
      try {
        model = build_cloth<double>(def);
      } catch (const DefinitionError&) {
        return;  // not every cloth has every model
      }
      test::SeededRandom random(3);
      const Vec3Array<double> x = test::shaken(model, 0.02, random);
      const Vec3Array<double> force = force_on(model, x);
      double largest = 0, error = 0;
      for (const Vec3d& f : force) largest = std::max(largest, f.norm());
      constexpr double kStep = 1e-6;
      for (std::size_t i = 0; i < x.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          Vec3Array<double> moved = x;
          moved[i][axis] += kStep;
          const double high = energy_of(model, moved);
          moved[i][axis] -= 2 * kStep;
          const double low = energy_of(model, moved);
          error = std::max(error, std::abs(force[i][axis] + (high - low) / (2 * kStep)));
        }
      }
      REQUIRE(largest > 0);
      CHECK(error < 1e-5 * largest);
      ++tried;
    });
  }
  CHECK(tried > 20);
}
