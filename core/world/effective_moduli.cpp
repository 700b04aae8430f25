// Compares the moduli that compliant sweeps give a cloth with those asked for.

#include "core/world/effective_moduli.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "core/cloth/membrane.h"
#include "core/solver/uniform_sweeps.h"

namespace weft {
namespace {

/// The cloth whose sweeps are computed: of a grid a square of its cells.
std::optional<ClothModel<double>> probe_of(const ClothDef& cloth) {
  if (cloth.direct_springs || (cloth.mesh && !has_membrane_triangles(cloth))) return std::nullopt;
  if (cloth.mesh) return build_cloth<double>(cloth);
  ClothDef probe = cloth;
  probe.outline = Outline::rectangle;
  probe.rows = probe.columns = kModulusCells + 1;
  probe.width = cloth.width / (cloth.columns - 1) * kModulusCells;
  probe.height = cloth.height / (cloth.rows - 1) * kModulusCells;
  return build_cloth<double>(probe);
}

/// Whether the triangles of a mesh are at rest where its uv put them, to a hundredth.
bool is_flat_in_uv(const ClothModel<double>& model) {
  const auto place = [&](Index i) {
    const auto& [u, v] = model.material[static_cast<std::size_t>(i)];
    return Vec3d(u, v, 0);
  };
  return std::all_of(model.membrane.begin(), model.membrane.end(), [&](const auto& t) {
    const Vec3d x0 = place(t.x[0]);
    const auto e = membrane_strain<double>(t, place(t.x[1]) - x0, place(t.x[2]) - x0);
    return std::max({std::abs(e.u), std::abs(e.v), std::abs(e.shear)}) < kUvStrain;
  });
}

/// The fabric's own tensor, in the order of a SweptTensor.
SweptTensor tensor_of(const FabricDef& f) {
  SweptTensor tensor = SweptTensor::Zero();
  tensor(0, 0) = f.stretch_warp;
  tensor(1, 1) = f.stretch_weft;
  tensor(0, 1) = tensor(1, 0) = membrane_coupling(f);
  tensor(2, 2) = f.shear;
  return tensor;
}

double share(double has, double asked) {
  return asked > 0 ? std::max(has, 0.0) / asked : 0;
}

double along_warp(const SweptTensor& c) {
  return c(1, 1) > 0 ? c(0, 0) - c(0, 1) * c(1, 0) / c(1, 1) : 0;
}
double along_weft(const SweptTensor& c) {
  return c(0, 0) > 0 ? c(1, 1) - c(0, 1) * c(1, 0) / c(0, 0) : 0;
}
/// What it narrows along v, pulled along u.
double narrowing(const SweptTensor& c) {
  return c(1, 1) > 0 ? c(1, 0) / c(1, 1) : 0;
}

struct Probe {
  ClothModel<double> model;
  SweptTensor fabric;
  double compliance, tick_seconds;
  int sweeps;

  /// Work of computing the moduli once, in springs relaxed.
  double work() const {
    // Three strains.
    const double relaxed = 3.0 * sweeps * static_cast<double>(membrane_elements(model.parts[0]));
    return model.membrane.empty() ? relaxed : kSpringsOfTriangle * relaxed;
  }

  EffectiveModuli with(int substeps) const {
    const double dt = tick_seconds / substeps;
    const SweptSubstep substep{compliance / (dt * dt), sweeps};
    const SweptTensor c = model.membrane.empty() ? swept_tensor_of_grid(model, substep)
                                                 : swept_tensor_of_mesh(model, substep);
    EffectiveModuli moduli;
    moduli.substeps = substeps;
    moduli.sweeps = sweeps;
    moduli.known = c.norm() > 0;
    moduli.warp = share(along_warp(c), along_warp(fabric));
    moduli.weft = share(along_weft(c), along_weft(fabric));
    moduli.shear = share(c(2, 2), fabric(2, 2));
    moduli.poisson = narrowing(c);
    moduli.of_fabric = narrowing(fabric);
    return moduli;
  }

  /// Fewest substeps that leave enough of each modulus, to a sixteenth; 0: none that may be had.
  int needed(const EffectiveModuli& now) const {
    const auto is_enough = [&](int substeps) {
      return with(substeps).least() >= kLeastModulusShare;
    };
    if (now.least() >= kLeastModulusShare) return now.substeps;
    int few = now.substeps, enough = 2 * few;
    while (!is_enough(enough)) {
      if (enough > kMostSubsteps / 2) return 0;
      few = enough;
      enough *= 2;
    }
    while (enough - few > few / 16 + 1) {
      const int middle = (few + enough) / 2;
      (is_enough(middle) ? enough : few) = middle;
    }
    return enough;
  }
};

std::string percent(double part) {
  std::array<char, 16> text = {};
  std::snprintf(text.data(), text.size(), "%.0f %%", 100 * part);
  return text.data();
}

std::string ratio(double value) {
  std::array<char, 16> text = {};
  std::snprintf(text.data(), text.size(), "%.2f", value);
  return text.data();
}

std::string describe(const EffectiveModuli& m) {
  const std::string with = m.cloth + ": with " + std::to_string(m.substeps) +
                           " substeps and relaxation.sweeps " + std::to_string(m.sweeps) + " ";
  if (!m.known)
    return with + "it may be softer than asked for: by how much is not measured for such a cloth";
  std::string shares;
  const auto add = [&shares](const char* what, double part) {
    if (part > 0) shares += (shares.empty() ? "" : ", ") + percent(part) + " " + what;
  };
  add("along the warp", m.warp);
  add("along the weft", m.weft);
  add("in shear", m.shear);
  return with + "it is softer than asked for: it has about " + shares + ", and Poisson's ratio " +
         ratio(m.poisson) + " instead of " + ratio(m.of_fabric) +
         (m.needed > 0
              ? "; " + std::to_string(m.needed) + " substeps (relaxation.substeps) keep about " +
                    percent(kLeastModulusShare)
              : "");
}

}  // namespace

double EffectiveModuli::least() const {
  double least = 1;
  for (const double part : {warp, weft, shear}) {
    if (part > 0) least = std::min(least, part);
  }
  return least;
}

template <class Real>
std::vector<EffectiveModuli> effective_moduli(const World<Real>& world) {
  std::vector<EffectiveModuli> found;
  const WorldDef& def = world.def();
  if (solver_of(def) != SolverKind::relaxation || def.relaxation.compliance == 0) return found;
  const int substeps = static_cast<int>(world.cost_in(def.environment).substeps);
  const std::vector<ClothDef> cloths = cloths_to_build(def);
  for (std::size_t k = 0; k < cloths.size(); ++k) {
    if (membrane_elements(world.model().parts[k]) == 0) continue;
    EffectiveModuli moduli;
    moduli.substeps = substeps;
    moduli.sweeps = sweeps_taken(def.relaxation);
    if (auto model = probe_of(cloths[k])) {
      const Probe probe{std::move(*model), tensor_of(cloths[k].fabric), def.relaxation.compliance,
                        world.tick_seconds(), sweeps_taken(def.relaxation)};
      const bool flat = probe.model.membrane.empty() || is_flat_in_uv(probe.model);
      if (flat && probe.work() <= kMostProbedSprings) {
        moduli = probe.with(substeps);
        if (moduli.known) moduli.needed = probe.needed(moduli);
      }
    }
    moduli.cloth = cloth_name(def, static_cast<Index>(k));
    found.push_back(moduli);
  }
  return found;
}

std::vector<std::string> describe(const std::vector<EffectiveModuli>& moduli) {
  std::vector<std::string> sentences;
  for (const EffectiveModuli& m : moduli) {
    if (!m.known || m.least() < kLeastModulusShare) sentences.push_back(describe(m));
  }
  return sentences;
}

template std::vector<EffectiveModuli> effective_moduli(const World<float>&);
template std::vector<EffectiveModuli> effective_moduli(const World<double>&);

}  // namespace weft
