// Adds, moves and removes pins.

#include "core/attachments/pins.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/error.h"

namespace weft {
namespace {

auto find(PinId id, Pins& pins) {
  return std::find_if(pins.list.begin(), pins.list.end(),
                      [id](const Pin& pin) { return pin.id == id; });
}

}  // namespace

bool is_fixed(const Pins& pins, Index particle) {
  assert(particle >= 0 && static_cast<std::size_t>(particle) < pins.fixed_count.size());
  return pins.fixed_count[static_cast<std::size_t>(particle)] > 0;
}

bool Pins::any_moving() const {
  return std::any_of(list.begin(), list.end(), [](const Pin& pin) { return pin.path.has_value(); });
}

Clamps clamps_of(const Pins& pins) {
  Clamps clamps;
  for (const Pin& pin : pins.list) {
    if (pin.clamp) clamps.lines.push_back(*pin.clamp);
    if (pin.disc) clamps.discs.push_back({*pin.disc, pin.particles});
  }
  return clamps;
}

void validate(const PinMove& move) {
  visit_fields_of_pin_move(
      move, [](const FieldInfo& info, const auto& value) { check_field("", info, value); });
}

template <class Real>
Pins make_pins(const ClothModel<Real>& model) {
  Pins pins;
  pins.pin_count.assign(model.mass.size(), 0);
  pins.fixed_count.assign(model.mass.size(), 0);
  return pins;
}

template <class Real>
PinId add_pin(const ClothModel<Real>& model, const PinDef& def, Pins& pins,
              ClothState<Real>& state) {
  assert(pins.pin_count.size() == model.mass.size());
  assert(state.x.size() == model.mass.size());
  PinnedParticles held = find_pinned(model, def);
  if (pins.list.size() >= kMostPins)
    throw DefinitionError("pin", std::to_string(pins.list.size() + 1),
                          "at most " + std::to_string(kMostPins) + " pins", "release some first");
  if (pins.held + held.particles.size() > kMostHeld)
    throw DefinitionError(
        "pin", std::to_string(pins.held + held.particles.size()),
        "at most " + std::to_string(kMostHeld) + " particles of all pins together",
        "give it a smaller radius, or release some first");
  pins.held += held.particles.size();
  Pin pin{pins.next_id++, def,        held.centre, std::move(held.particles), {},
          Vec3d::Zero(),  held.clamp, held.disc};
  for (const Index i : pin.particles) {
    const auto p = static_cast<std::size_t>(i);
    ++pins.pin_count[p];
    ++pins.fixed_count[p];
    state.inverse_mass[p] = 0;
    state.v[p].setZero();
  }
  pins.list.push_back(std::move(pin));
  return pins.list.back().id;
}

template <class Real>
bool move_pin(const ClothModel<Real>& model, PinId id, const PinMove& move, Pins& pins,
              ClothState<Real>& state) {
  const auto found = find(id, pins);
  if (found == pins.list.end()) return false;
  validate(move);
  if (found->path) {
    found->path->move = move;
    return true;
  }
  PinPath path;
  path.move = move;
  for (const Index i : found->particles)
    path.start.push_back(state.x[static_cast<std::size_t>(i)].template cast<double>());
  path.velocity.assign(path.start.size(), Vec3d::Zero());
  found->path = std::move(path);
  for (const Index i : found->particles) {
    const auto p = static_cast<std::size_t>(i);
    if (--pins.fixed_count[p] == 0) state.inverse_mass[p] = Real(1) / model.mass[p];
  }
  return true;
}

template <class Real>
bool stop_pin(PinId id, Pins& pins, ClothState<Real>& state) {
  const auto found = find(id, pins);
  if (found == pins.list.end()) return false;
  if (!found->path) return true;
  for (const Index i : found->particles) {
    ++pins.fixed_count[static_cast<std::size_t>(i)];
    state.inverse_mass[static_cast<std::size_t>(i)] = 0;
    state.v[static_cast<std::size_t>(i)].setZero();
  }
  found->path.reset();
  return true;
}

template <class Real>
bool remove_pin(const ClothModel<Real>& model, PinId id, Pins& pins, ClothState<Real>& state) {
  const auto found = find(id, pins);
  if (found == pins.list.end()) return false;
  const std::vector<Index> particles = std::move(found->particles);
  const bool rested = !found->path;
  pins.list.erase(found);
  assert(pins.held >= particles.size());
  pins.held -= particles.size();
  for (const Index i : particles) {
    const auto p = static_cast<std::size_t>(i);
    assert(pins.pin_count[p] > 0 && pins.fixed_count[p] >= (rested ? 1 : 0));
    --pins.pin_count[p];
    if (rested) --pins.fixed_count[p];
    if (!is_fixed(pins, i)) state.inverse_mass[p] = Real(1) / model.mass[p];
  }
  return true;
}

#define WEFT_INSTANTIATE(Real)                                                              \
  template Pins make_pins(const ClothModel<Real>&);                                         \
  template PinId add_pin(const ClothModel<Real>&, const PinDef&, Pins&, ClothState<Real>&); \
  template bool move_pin(const ClothModel<Real>&, PinId, const PinMove&, Pins&,             \
                         ClothState<Real>&);                                                \
  template bool stop_pin(PinId, Pins&, ClothState<Real>&);                                  \
  template bool remove_pin(const ClothModel<Real>&, PinId, Pins&, ClothState<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
