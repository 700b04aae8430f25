#pragma once

#include <cassert>
#include <cstdint>
#include <vector>

#include "core/attachments/grabs.h"
#include "core/attachments/pins.h"
#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/contact/colliders/collider_state.h"
#include "core/definition.h"
#include "core/geometry/bvh.h"

// Sleep of resting cloths.

namespace weft {

/// When a resting cloth is no longer stepped.
struct SleepDef {
  double after = 0;         ///< duration of stillness [s], 0 to 3600; 0: never
  double distance = 0.001;  ///< largest displacement of any particle during stillness [m]
};

template <class Def, class Visitor>
void visit_fields_of_sleep(Def& def, Visitor&& visit) {
  visit(FieldInfo{"after", 0, 3600, "s", "duration of stillness before cloth sleeps; 0: never"},
        def.after);
  visit(FieldInfo{"distance", 1e-7, 1, "m", "largest displacement that counts as still"},
        def.distance);
}

/// Decides which cloths sleep. Cloths that touch, or soon could, form an island, and sleep and wake
/// together. A cloth is still while no particle is farther than a distance from its position at the
/// beginning of the stillness, so a jitter counts as rest and a creep does not.
///
/// A sleeping cloth has velocity 0 and is immovable for all others (ClothState::inverse_mass), so a
/// body that is too fast to wake it is stopped and does not pass through. Everything depends on
/// positions and velocities only, in a fixed order: the same for any number of threads.
template <class Real>
class Sleep {
 public:
  /// @param tick_seconds  length of a tick [s]
  /// @param together      all cloths are one island, because the contact does not distinguish them
  Sleep(const ClothModel<Real>& model, const SleepDef& def, double tick_seconds, bool together);

  /// Whether sleep is enabled.
  bool wanted() const { return def_.after > 0; }
  bool is_asleep(std::size_t part) const {
    assert(part < asleep_.size());
    return asleep_[part] != 0;
  }
  /// Ticks of stillness after which a cloth may sleep.
  std::uint32_t ticks_to_sleep() const { return ticks_; }
  /// Ticks for which a cloth has been still, those before it fell asleep included.
  std::uint32_t still_ticks(std::size_t part) const {
    assert(part < still_ticks_.size());
    return still_ticks_[part];
  }
  bool any_asleep() const;
  bool all_asleep() const;
  /// For each cloth, in the order of the model: 1 if it sleeps.
  const std::vector<char>& asleep() const { return asleep_; }
  /// Index of the first cloth of the island with which a sleeping cloth fell asleep.
  std::size_t island_of(std::size_t part) const {
    assert(part < island_.size());
    return island_[part];
  }

  /// Marks a cloth on which something acts in the coming tick: its stillness restarts.
  void disturb(std::size_t part) {
    assert(part < disturbed_.size());
    disturbed_[part] = 1;
  }
  void disturb_all();

  /// The same for all cloths that a moving or pressing object could touch in the coming ticks.
  void disturb_near(const ClothState<Real>& state, const ColliderDef& def,
                    const ColliderState& collider);

  /// Wakes the islands of sleeping cloths that were disturbed, or that an awake one could touch in
  /// the coming ticks.
  /// @return whether any woke
  bool rouse(const Pins& pins, ClothState<Real>& state);
  /// Wakes the island of a cloth, or all; stillness of awake cloths restarts.
  void wake(std::size_t part, const Pins& pins, ClothState<Real>& state);
  void wake_all(const Pins& pins, ClothState<Real>& state);

  /// Checks the cloths after a tick and puts islands to sleep that have been still long enough.
  /// @return whether any fell asleep
  bool settle(ClothState<Real>& state);

 private:
  /// Boxes around neighbouring triangles and around a whole cloth, including its coming motion.
  struct Boxes {
    std::vector<std::vector<Index>> patches;  ///< the particles of each patch
    std::vector<Aabb<Real>> list;
    Bvh<Real> tree;
    Aabb<Real> whole;
    bool fitted = false;  ///< list and tree are up to date with `whole`
  };

  void add_coming(Index particle, const ClothState<Real>& state, Aabb<Real>& box) const;
  void enclose(std::size_t part, const ClothState<Real>& state);
  void fit(std::size_t part, const ClothState<Real>& state);
  bool could_touch(std::size_t a, std::size_t b, const ClothState<Real>& state);
  bool has_left(std::size_t part, const ClothState<Real>& state) const;
  void begin_stillness(std::size_t part, const ClothState<Real>& state);
  void find_islands(const ClothState<Real>& state);
  void wake_cloth(std::size_t part, const Pins& pins, ClothState<Real>& state);

  SleepDef def_;
  Real tick_seconds_;
  std::uint32_t ticks_;  ///< of stillness before a cloth sleeps
  bool together_;
  std::vector<IndexRange> particles_;  ///< of each cloth
  std::vector<Real> mass_;             ///< of each particle [kg]
  std::vector<Real> margin_;           ///< of each cloth, around its boxes [m]
  std::vector<Boxes> boxes_;           ///< of each cloth
  std::vector<char> asleep_, disturbed_;
  std::vector<std::size_t> island_;         ///< of each cloth; for awake ones as last determined
  std::vector<std::uint32_t> still_ticks_;  ///< number of still ticks of each cloth
  Vec3Array<Real> place_;                   ///< of each particle when stillness began [m]
};

extern template class Sleep<float>;
extern template class Sleep<double>;

}  // namespace weft
