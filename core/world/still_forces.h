#pragma once

#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/world/reactions.h"

// Forces of the supports of cloth that sleeps.

namespace weft {

template <class Real>
class Sleep;

/// Means of the forces of pins and colliders over the time T in which a cloth was still. Cloth that
/// falls asleep trembles until then, by less than counts as a motion. The forces of its last tick
/// are off from its weight by up to a quarter, the static ones of the state in which it stopped by
/// up to 6 %. The means are weighted by a parabola that is zero at both ends of T: integrated by
/// parts twice, they are right to about its mass times 24 d / T^2, where d is the largest
/// displacement that counts as still.
class StillForces {
 public:
  /// Forgets all, as measuring begins anew.
  void forget() { cloths_.clear(); }

  /// Call when cloth has woken: its next sleep has means of its own.
  /// @param asleep  for each cloth 1 if it sleeps
  void let_go(const std::vector<char>& asleep);

  /// Call after each tick, when it is known what sleeps.
  /// @param told  forces of the tick; those of sleeping cloth become its means
  template <class Real>
  void note(const ClothModel<Real>& model, const Pins& pins, const Sleep<Real>& sleep,
            Reactions& told);

 private:
  /// Weighted sums over the ticks of a cloth's stillness [N].
  struct Cloth {
    bool asleep = false;
    double weight = 0;  ///< of all ticks
    std::vector<PinReaction> pins;
    std::vector<Vec3d> colliders;

    void add(const std::vector<PinReaction>& held, const std::vector<Vec3d>& met, double share);
  };

  std::vector<Cloth> cloths_;
};

extern template void StillForces::note(const ClothModel<float>&, const Pins&, const Sleep<float>&,
                                       Reactions&);
extern template void StillForces::note(const ClothModel<double>&, const Pins&, const Sleep<double>&,
                                       Reactions&);

}  // namespace weft
