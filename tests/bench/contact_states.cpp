#include "tests/bench/contact_states.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/cloth/fabric_presets.h"
#include "tests/support/sheets.h"

namespace weft::bench {
namespace {

using std::numbers::pi;
constexpr double kThickness = 0.25;     ///< in parts of the edge length
constexpr int kCoarse = 65;             ///< particles a side of the sheet that is crumpled
constexpr int kTicksOfCrumpling = 72;   ///< until most of it lies on the ground
constexpr int kLayers = 8, kWaves = 8;  ///< of the folded sheet, of the wrinkled one
constexpr double kSteepest = pi / 3;    ///< slope of a wrinkle's flanks [rad]
constexpr double kOpening = 1.5;        ///< rise of a folded layer, in thicknesses

/// The state in which a world starts, with each particle's place by row and column.
template <class Place>
ContactState placed(const char* name, const char* how, const WorldDef& def, Place&& place) {
  ContactState state{name, how, def, {}, {}};
  const int n = def.cloths[0].rows;
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < n; ++c) state.x.push_back(Vec3d(place(r, c)).cast<float>());
  }
  state.v.assign(state.x.size(), Vec3f::Zero());
  return state;
}

ContactState flat(int n) {
  const double cell = 1.0 / (n - 1);
  return placed("flat", "hangs by its upper edge in its plane", hanging_sheet(n, true),
                [&](int r, int c) { return Vec3d(c * cell, -r * cell, 0); });
}

/// Waves across the sheet whose slope is a sine of the distance along it: nothing is stretched.
ContactState wrinkled(int n) {
  const double cell = 1.0 / (n - 1);
  std::vector<Vec3d> section = {Vec3d::Zero()};
  for (int c = 1; c < n; ++c) {
    const double slope = kSteepest * std::sin(2 * pi * kWaves * (c - 0.5) * cell);
    section.push_back(section.back() + cell * Vec3d(std::cos(slope), 0, std::sin(slope)));
  }
  return placed("wrinkled", "hangs by its upper edge in eight waves with flanks of 60 degrees",
                hanging_sheet(n, true), [&](int r, int c) {
                  return Vec3d(section[static_cast<std::size_t>(c)] - r * cell * Vec3d::UnitY());
                });
}

/// Layers to and fro on the ground, which rise by more than a thickness from crease to crease.
ContactState folded(int n) {
  WorldDef def = falling_sheet(n, kThickness);
  const int layer = (n - 1) / kLayers;
  const double cell = 1.0 / (n - 1), thickness = def.cloths[0].fabric.thickness;
  const double rise = kOpening * thickness / layer, run = std::sqrt(cell * cell - rise * rise);
  return placed("folded", "lies on the ground in eight layers", def, [&](int r, int c) {
    const int at = c % (2 * layer), along = at <= layer ? at : 2 * layer - at;
    return Vec3d(along * run, 1.1 * thickness + c * rise, r * cell);
  });
}

/// A sheet of n x n particles in the shape of a coarser one: each of its triangles is divided into
/// flat ones, and as the number of parts of an edge is even, these are triangles of the fine grid.
Vec3Array<float> refined(const Vec3Array<float>& coarse, int from, int n) {
  const int parts = (n - 1) / (from - 1);
  const auto corner = [&](int r, int c) {
    return Vec3d(coarse[static_cast<std::size_t>(r * from + c)].cast<double>());
  };
  Vec3Array<float> fine;
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < n; ++c) {
      const int top = std::min(r / parts, from - 2), left = std::min(c / parts, from - 2);
      const double v = static_cast<double>(r - top * parts) / parts;
      const double u = static_cast<double>(c - left * parts) / parts;
      const Vec3d a = corner(top, left), b = corner(top, left + 1), d = corner(top + 1, left),
                  e = corner(top + 1, left + 1);
      Vec3d p;
      if ((top + left) % 2 == 0)  // divided from a to e
        p = u > v ? Vec3d(a + (b - a) * u + (e - b) * v) : Vec3d(a + (e - d) * u + (d - a) * v);
      else  // from b to d
        p = u + v < 1 ? Vec3d(a + (b - a) * u + (d - a) * v)
                      : Vec3d(e + (d - e) * (1 - u) + (b - e) * (1 - v));
      fine.push_back(p.cast<float>());
    }
  }
  return fine;
}

ContactState crumpled(int n) {
  ContactState state;
  state.name = "crumpled";
  state.def = falling_sheet(n, kThickness);
  const int coarse = std::min(n, kCoarse);
  WorldDef def = falling_sheet(coarse, kThickness);
  def.cloths[0].fabric.thickness = state.def.cloths[0].fabric.thickness;
  World<float> world(def);
  for (int tick = 0; tick < kTicksOfCrumpling; ++tick) world.step();
  state.how = "1.2 s after it fell upright on the ground";
  if (coarse < n)
    state.how += ", there with 65 x 65 particles of the same thickness, refined in its shape";
  state.x = coarse < n ? refined(world.state().x, coarse, n) : world.state().x;
  state.v = coarse < n ? refined(world.state().v, coarse, n) : world.state().v;
  return state;
}

}  // namespace

WorldDef falling_sheet(int n, double thickness) {
  return test::upright_sheet(n, 1, 1.1, thickness, 5, make_fabric("cotton"));
}

WorldDef hanging_sheet(int n, bool self_contact) {
  WorldDef def;
  ClothDef& cloth = def.cloths[0];
  cloth.rows = cloth.columns = n;
  cloth.fabric = make_fabric("cotton");
  cloth.fabric.thickness = kThickness / (n - 1);
  for (int c = 0; c < n; ++c) def.pins.push_back({c, 0, {}});
  def.environment.damping = 1;
  def.contact.seed.self = self_contact ? SelfContact::guard : SelfContact::none;
  return def;
}

std::vector<ContactState> contact_states(int n) {
  return {flat(n), wrinkled(n), folded(n), crumpled(n)};
}

void take_state(const ContactState& state, World<float>& world) {
  world.state().x = state.x;
  world.state().v = state.v;
  world.accept_state();
}

}  // namespace weft::bench
