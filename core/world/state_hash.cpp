#include "core/world/state_hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace weft {
namespace {

template <class T>
void feed(XXH64_state_t& hash, const T* values, std::size_t count) {
  if (count > 0) XXH64_update(&hash, values, count * sizeof(T));
}

}  // namespace

template <class Real>
std::uint64_t state_hash(const ClothState<Real>& state, const Pins& pins, const Grabs<Real>& grabs,
                         std::uint64_t tick) {
  static_assert(sizeof(Vec3<Real>) == 3 * sizeof(Real), "positions are hashed as plain numbers");
  XXH64_state_t hash;
  XXH64_reset(&hash, 0);
  feed(hash, &tick, 1);
  feed(hash, state.x.data(), state.x.size());
  feed(hash, state.v.data(), state.v.size());
  feed(hash, pins.pin_count.data(), pins.pin_count.size());
  for (const Grab<Real>& grab : grabs.list) {
    feed(hash, grab.particles.data(), grab.particles.size());
    feed(hash, grab.weights.data(), grab.weights.size());
    feed(hash, &grab.target_before, 1);
    feed(hash, &grab.target, 1);
    feed(hash, &grab.def.stiffness, 1);
    feed(hash, &grab.def.max_force, 1);
    if (grab.def.mode == GrabMode::sling) feed(hash, &grab.def.mode, 1);
  }
  for (const Shot<Real>& shot : grabs.shots) {
    feed(hash, shot.particles.data(), shot.particles.size());
    feed(hash, shot.weights.data(), shot.weights.size());
    feed(hash, &shot.force, 1);
    feed(hash, &shot.ticks_left, 1);
  }
  return XXH64_digest(&hash);
}

template std::uint64_t state_hash(const ClothState<float>&, const Pins&, const Grabs<float>&,
                                  std::uint64_t);
template std::uint64_t state_hash(const ClothState<double>&, const Pins&, const Grabs<double>&,
                                  std::uint64_t);

}  // namespace weft
