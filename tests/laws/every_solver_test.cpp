#include <algorithm>

#include <catch2/catch.hpp>

#include "core/solver/verlet.h"
#include "tests/support/sheets_of_triangles.h"
#include "tests/support/worlds.h"

// What holds with each solver that a scene can name: one that is added is tested here without being
// named.

using namespace weft;

namespace {

/// Calls body(kind, word) for each solver.
template <class Body>
void for_each_solver(Body&& body) {
  SolverDef def;
  visit_fields_of_solver(def, [&](const FieldInfo& info, auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, SolverKind>) {
      const std::string words = info.words;
      const auto count = std::count(words.begin(), words.end(), '|') + 1;
      for (int k = 0; k < count; ++k) body(static_cast<SolverKind>(k), choice_word(info, k));
    }
  });
}

double energy_of(const World<double>& world, const Vec3Array<double>& x) {
  ClothState<double> state = world.state();
  state.x = x;
  for (Vec3d& v : state.v) v.setZero();
  return read_energies(world.model(), state, world.environment().gravity).energies.total();
}

/// The largest slope of the energy at a free particle where the cloth is [N].
double steepest(const World<double>& world) {
  constexpr double kStep = 1e-6;
  double most = 0;
  Vec3Array<double> x = world.state().x;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (world.state().inverse_mass[i] == 0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const double here = x[i][axis];
      x[i][axis] = here + kStep;
      const double high = energy_of(world, x);
      x[i][axis] = here - kStep;
      const double low = energy_of(world, x);
      x[i][axis] = here;
      most = std::max(most, std::abs(high - low) / (2 * kStep));
    }
  }
  return most;
}

}  // namespace

TEST_CASE("with every solver a cloth hangs where its energy is least, to 1 % of its weight") {
  int tried = 0;
  for (const bool grid : {true, false}) {
    for_each_solver([&](SolverKind kind, const std::string& word) {
      ClothDef cloth = grid ? test::flat_cloth(4, 5, 0.5, 0.4)
                            : test::triangle_sheet(test::Cut::irregular, 0.5, 0.4, 0.1, 0.5);
      cloth.fabric.bending_warp = cloth.fabric.bending_weft = 3e-4;
      WorldDef def = test::empty_world(cloth);
      def.environment.gravity = Vec3d(0, -9.81, 0);
      def.environment.damping = 8;
      def.pins = grid ? std::vector<PinDef>{{Corner::top_left, 0, {}}, {Corner::top_right, 0, {}}}
                      : test::upper_border(cloth);
      def.solver.kind = kind;
      def.relaxation.compliance = 1;
      def.relaxation.damping = 0;
      def.relaxation.sweeps = 4;
      def.relaxation.substeps = 100;
      World<double> world(def);
      test::advance(world, 4);
      double weight = 0;
      for (const double m : world.model().mass) weight += m * 9.81;
      INFO((grid ? "grid, " : "mesh, ") << word);
      CHECK(steepest(world) < 0.01 * weight);
      ++tried;
    });
  }
  CHECK(tried >= 8);
}
