#pragma once

#include <cassert>
#include <cstddef>
#include <vector>

#include "core/attachments/grabs.h"
#include "core/attachments/pins.h"
#include "core/cloth/cloth_model.h"

// Impulses on fixed particles during a tick, from which the forces of pins follow.

namespace weft {

template <class Real>
struct Surroundings;

/// Impulses that fixed particles get during a tick from the cloth, the air and hands, without
/// contact and gravity. A solver shows it the state in which each kick finds the forces; only the
/// elements that have a fixed particle are evaluated. It changes no result.
template <class Real>
class HeldForces {
 public:
  /// Call when the model has changed.
  void forget() { stale_ = true; }

  /// Call at each start of a tick. Allocates only where more is held than ever before.
  void begin_tick(const ClothModel<Real>& model, const Pins& pins);

  /// The particles of one part whose state `act` looks at, ascending: those of the elements that
  /// have a fixed one.
  const std::vector<Index>& seen(std::size_t part) const { return seen_[part]; }

  /// Forces of one part of the cloth and of the air on it act for some time.
  /// @param v        velocities that the dashpots see [m/s]
  /// @param seconds  for which they act
  void act(std::size_t part, const Surroundings<Real>& around, const Vec3Array<Real>& x,
           const Vec3Array<Real>& v, double seconds);
  /// Those of all parts.
  void act(const Surroundings<Real>& around, const Vec3Array<Real>& x, const Vec3Array<Real>& v,
           double seconds);

  /// The last pulls of hands act, and slings for some time [s].
  void pull(const Grabs<Real>& grabs, double seconds);

  /// A fixed particle gets an impulse [N s].
  void push(Index particle, const Vec3d& impulse) {
    assert(holds(particle));
    impulse_[static_cast<std::size_t>(place_[static_cast<std::size_t>(particle)])] += impulse;
  }

  /// Keeps what has acted, for steps that may be taken back.
  void keep() { kept_ = impulse_; }
  void take_back() { impulse_ = kept_; }

  /// Whether a particle has been fixed since the start of the tick.
  bool holds(Index particle) const {
    assert(static_cast<std::size_t>(particle) < place_.size() && "begin_tick comes first");
    return place_[static_cast<std::size_t>(particle)] != kNone;
  }
  /// What it got so far in this tick [N s].
  const Vec3d& impulse(Index particle) const {
    assert(holds(particle));
    return impulse_[static_cast<std::size_t>(place_[static_cast<std::size_t>(particle)])];
  }

 private:
  /// Stencils of quadratic bending, one behind the other.
  struct Stencils {
    std::vector<double> stiffness, weights;
    std::vector<std::size_t> begin;  ///< of each one's corners and weights, and the last one's end
    std::vector<Index> corners;
    std::vector<std::size_t>
        first_of_part;  ///< number of each part's first, and the last one's end

    void clear();
    void add(double k, const Index* corner, const double* weight, int count);
    template <class Visit>
    void visit(std::size_t part, Visit&& visit) const;
  };

  void list(const ClothModel<Real>& model);
  void list_part(const ClothModel<Real>& model, const ClothPart<Real>& part);
  void list_seen(std::size_t part);
  bool touches(const Index* particles, std::size_t count) const;

  bool stale_ = true;
  std::vector<Index> held_, found_;  ///< fixed particles, in the order of their pins
  std::vector<Index> place_;         ///< of each particle among them; kNone: it is free
  std::vector<Vec3d> impulse_, kept_;
  ClothModel<Real> near_;  ///< the elements that have a fixed particle
  Stencils bending_;
  std::vector<std::vector<Index>> seen_;  ///< by part
  Vec3Array<Real> force_;                 ///< scratch; only those of fixed particles are read
};

extern template class HeldForces<float>;
extern template class HeldForces<double>;

}  // namespace weft
