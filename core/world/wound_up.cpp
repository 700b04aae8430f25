// Refuses changes of a fabric that would throw the cloth.

#include "core/world/wound_up.h"

#include <cassert>

#include "core/definition.h"
#include "core/error.h"
#include "core/forces/force_pass.h"
#include "core/instantiate.h"
#include "core/world/constants.h"

namespace weft {
namespace {

template <class Real>
double mass_of(const ClothModel<Real>& model, const IndexRange& particles) {
  double mass = 0;
  for (Index i = particles.first; i < particles.end(); ++i)
    mass += static_cast<double>(model.mass[at_index(i)]);
  return mass;
}

template <class Real>
double stored(const ClothModel<Real>& model, std::size_t cloth, const Vec3Array<Real>& x) {
  const ElasticEnergy energy = elastic_energy(model, model.parts[cloth], x);
  return energy.stretch + energy.bending;
}

/// An energy for people, to three digits.
std::string joules(double energy) {
  return rounded_text(energy) + " J";
}

}  // namespace

template <class Real>
void refuse_wound_up(const ClothModel<Real>& before, const ClothModel<Real>& after,
                     std::size_t cloth, const Vec3Array<Real>& x, const std::string& field) {
  assert(cloth < before.parts.size() && before.parts.size() == after.parts.size());
  const double mass = mass_of(after, after.parts[cloth].particles);
  const double before_mass = mass_of(before, before.parts[cloth].particles);
  assert(mass > 0 && before_mass > 0);
  const double energy = stored(after, cloth, x);
  const double most = stored(before, cloth, x) * (mass / before_mass) +
                      mass * kFastestRelease * kFastestRelease / 2;
  if (!(energy > most)) return;
  throw DefinitionError(
      field, joules(energy) + " in the present shape, of " + rounded_text(mass) + " kg",
      "at most " + joules(most), "change it in smaller steps, or where the cloth is flat");
}

WEFT_INSTANTIATE_FUNCTIONS(refuse_wound_up)

}  // namespace weft
