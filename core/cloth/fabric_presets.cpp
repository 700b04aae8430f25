// The values of the named fabrics, with their sources.

#include "core/cloth/fabric_presets.h"

#include <cassert>
#include <cmath>
#include <numbers>

#include "core/cloth/fabric_modes.h"
#include "core/error.h"

// Sources:
//     Penava   Penava, Simic Penava, Knezic 2014, Determination of the elastic constants of plain
//              woven fabrics by a tensile test: thickness t, areal density, Young's modulus E; the
//              stretch stiffness is E t.
//     ASTM     D1388: B = sigma g c^3 with the bending length c; c is ours unless a measurement is
//              named, so that the drape test agrees with the literature for such a fabric.
//     KES      Kawabata: shear G of 1 gf/(cm degree) is 56.188 N/m, bending B of 1 gf cm^2/cm is
//              9.80665e-5 N m.
//     Denim    Regenerated cellulose-based denim fabric for tropical regions, Journal of Textiles
//              2016, table 5 (KES): G 1.5 to 3.4 gf/(cm degree).
//     ours     chosen by us; not a measurement.
//     filaments  ours: the rigidity of filaments that slide freely, the least that a cloth of them
//              can have: n E I, with n filaments a metre that make up half of the areal density.
//              Nylon, 3 denier of 1140 kg/m^3 and 2.7 GPa: 75,000 a metre, 1.4e-6 N m. Silk, 1.1
//              denier of 1340 kg/m^3 and 10 GPa, would have 1.9e-6 N m, beyond what the published
//              drape of such fabrics allows.
// Bands of the drape coefficient are those published for such fabrics; we know of none for flag
// nylon.
// Contact thickness and restitution have the defaults of all fabrics, because they belong to the
// simulation and not to the material. Friction is ours: cloth on a smooth object. So is damping:
// all of it in bending, as most of real cloth's is, such that waves of 5 cm lose a fifth of their
// energy in each radian. KES hysteresis 2HB of wool and polyester, by Matsudaira, Masuda, Wada,
// Yokura 2015 as others quote it, comes to 0.24 to 0.31 at 1/cm, by 2 2HB / (pi B K); that is
// friction and the same at any frequency, where a relaxation time damps slow bends less and fast
// ones more.

namespace weft {
namespace {

constexpr double kGravity = 9.81;     // [m/s^2]
constexpr double kKesShear = 56.188;  // [N/m] in 1 gf/(cm degree)

FabricDef cotton() {
  FabricDef f;
  f.areal_density = 0.1503;                                            // Penava
  f.stretch_warp = f.stretch_weft = 0.821e6 * 0.318e-3;                // Penava: E t
  f.shear = 0.8 * kKesShear;                                           // ours, a plain weave
  f.bending_warp = f.bending_weft = bending_rigidity(0.1503, 0.0215);  // ASTM, c ours
  f.friction = 0.5;                                                    // ours
  return f;
}

FabricDef silk() {
  FabricDef f;
  f.areal_density = 0.07;                                           // ours, a light plain silk
  f.stretch_warp = f.stretch_weft = 400;                            // ours
  f.shear = 0.3 * kKesShear;                                        // ours
  f.bending_warp = f.bending_weft = bending_rigidity(0.07, 0.012);  // ASTM, c ours
  f.friction = 0.25;                                                // ours
  return f;
}

FabricDef wool() {
  FabricDef f;
  f.areal_density = 0.2348;                                           // Penava
  f.stretch_warp = f.stretch_weft = 0.170e6 * 0.568e-3;               // Penava: E t
  f.shear = 0.4 * kKesShear;                                          // ours, a suiting
  f.bending_warp = f.bending_weft = bending_rigidity(0.2348, 0.019);  // ASTM, c ours
  f.friction = 0.6;                                                   // ours
  return f;
}

FabricDef denim() {
  FabricDef f;
  f.areal_density = 0.324;                                            // ours
  f.stretch_warp = f.stretch_weft = 1500;                             // ours
  f.shear = 1.6 * kKesShear;                                          // Denim, median
  f.bending_warp = f.bending_weft = bending_rigidity(0.324, 0.0267);  // ASTM, c ours: 6e-5 N m
  f.friction = 0.6;                                                   // ours
  return f;
}

FabricDef leather() {
  FabricDef f;
  f.areal_density = 0.6;                   // ours, 0.9 mm of garment leather
  f.stretch_warp = f.stretch_weft = 2500;  // ours
  f.shear = 600;                           // ours: no weave, so nearly isotropic
  f.bending_warp = f.bending_weft = bending_rigidity(0.6, 0.0192);  // ASTM, c ours
  f.friction = 0.6;                                                 // ours
  return f;
}

FabricDef nylon() {
  FabricDef f;
  f.areal_density = 0.05;                                           // ours, flag cloth
  f.stretch_warp = f.stretch_weft = 1000;                           // ours
  f.shear = 0.7 * kKesShear;                                        // ours
  f.bending_warp = f.bending_weft = bending_rigidity(0.05, 0.014);  // filaments
  f.friction = 0.3;                                                 // ours
  return f;
}

/// Relaxation time of bending for a loss factor of waves along the warp [s].
double relaxation_in_waves(const FabricDef& fabric) {
  constexpr double kWave = 2 * std::numbers::pi / 0.05;  // [1/m]
  constexpr double kLossFactor = 0.2;
  const double omega = kWave * kWave * std::sqrt(fabric.bending_warp / fabric.areal_density);
  return relaxation_of_loss(omega, kLossFactor);
}

bool same(const FabricDef& a, const FabricDef& b) {
  std::vector<double> values;
  visit_fields_of_fabric(a, [&](const FieldInfo&, double value) { values.push_back(value); });
  std::size_t k = 0;
  bool equal = true;
  visit_fields_of_fabric(
      b, [&](const FieldInfo&, double value) { equal = equal && values[k++] == value; });
  return equal;
}

}  // namespace

const std::vector<FabricPreset>& fabric_presets() {
  static const std::vector<FabricPreset> presets = [] {
    std::vector<FabricPreset> list = {
        {"cotton", "plain cotton: crisp, falls in few folds", cotton(), {60, 76}},
        {"silk", "light silk: soft, many fine folds", silk(), {20, 40}},
        {"wool", "wool suiting: soft to pull, round folds", wool(), {40, 70}},
        {"denim", "denim: heavy and stiff", denim(), {70, 90}},
        {"leather", "garment leather: heavy, stiff in every direction", leather(), {47, 70}},
        {"nylon", "flag nylon: very light and hard to stretch", nylon(), {}}};
    for (FabricPreset& preset : list) {
      preset.fabric.preset = preset.name;
      preset.fabric.bending_damping = relaxation_in_waves(preset.fabric);
    }
    return list;
  }();
  return presets;
}

double bending_rigidity(double areal_density, double bending_length) {
  assert(areal_density > 0 && bending_length >= 0);
  return areal_density * kGravity * bending_length * bending_length * bending_length;
}

FabricDef make_fabric(const std::string& name) {
  std::string names;
  for (const FabricPreset& preset : fabric_presets()) {
    if (preset.name == name) return preset.fabric;
    names += (names.empty() ? "" : ", ") + std::string(preset.name);
  }
  throw DefinitionError("fabric", name, "one of " + names);
}

DrapeBand published_drape(const FabricDef& fabric) {
  for (const FabricPreset& preset : fabric_presets()) {
    if (same(fabric, preset.fabric)) return preset.drape;
  }
  return {};
}

std::string fabric_name(const FabricDef& fabric) {
  if (same(fabric, FabricDef{})) return "default";
  for (const FabricPreset& preset : fabric_presets()) {
    if (same(fabric, preset.fabric)) return preset.name;
  }
  return "custom";
}

}  // namespace weft
