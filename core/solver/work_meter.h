#pragma once

#include <cassert>
#include <cstddef>

#include "core/attachments/grabs.h"
#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/contact/objects/contact.h"
#include "core/diagnostics/dashpots.h"
#include "core/diagnostics/energy_flows.h"

// Measures what each cause does to the cloth's energy during a tick.

namespace weft {

template <class Real>
struct Surroundings;

/// A kick as it was done: v <- keep v + scaled_seconds (f/m + g).
struct MeteredKick {
  double keep = 1, scaled_seconds = 0;
  double seconds = 0;  ///< for which the forces act: half a substep at the ends of a tick
};

/// Forces of a kick besides the cloth's own, and what its dashpots saw.
template <class Real>
struct MeteredForces {
  const Surroundings<Real>* around = nullptr;
  const Vec3Array<Real>* external = nullptr;  ///< of air and slings [N]; null: none
  const Grabs<Real>* grabs = nullptr;         ///< whose slings are among them
  const Vec3Array<Real>* seen = nullptr;      ///< velocities that the dashpots saw; null: `v`
  Dashpots dashpots = Dashpots::all;
};

/// Work of all causes in one tick. A solver shows it the velocities before a kick and after each
/// cause that changed them up to the end of the drift. Between two drifts an impulse J does the
/// work J . (v + v')/2, with v and v' the velocities before and after all of them; the sum over
/// all causes is then exactly the change of the kinetic energy. The cloth's elasticity and gravity
/// are left out: their energies are functions of the state.
///
/// It only reads: no result changes by a bit. All sums are in double.
template <class Real>
class WorkMeter {
 public:
  /// @param first_jaw  number of the first collider that belongs to a gripper
  WorkMeter(std::size_t particles, std::size_t first_jaw);

  /// Call at each start of a tick.
  void begin_tick();
  const EnergyFlows& flows() const { return now_.flows; }

  /// Before a kick.
  void begin(const ClothState<Real>& state);
  /// After it.
  /// @param forces  valid until `finish`
  void kicked(const MeteredKick& kick, const MeteredForces<Real>& forces, const Vec3Array<Real>& v);
  /// After hands have pulled.
  void pulled(const Vec3Array<Real>& v) {
    assert(v.size() == mean_.size());
    v_pulled_ = v_driven_ = v;
  }
  /// Before and after moving pins drive their particles; each time, if contact acts between.
  void before_drive(const Vec3Array<Real>& v) {
    assert(v.size() == mean_.size());
    v_undriven_ = v;
  }
  void driven(const Vec3Array<Real>& v);
  /// After the drift and all that contact does.
  /// @param objects  contact that notes its impulses; may be null
  /// @param cloths   whether cloth meets cloth
  /// @param drift    length of the drift [s]; 0 at the end of a tick
  void finish(const ClothModel<Real>& model, const ClothState<Real>& state,
              const Contact<Real>* objects, bool cloths, double drift);

  /// Keeps what was measured, for steps that may be taken back.
  void keep() { kept_ = now_; }
  void take_back() { now_ = kept_; }

  /// For solvers without kicks, which compute their own flows.
  void add(const EnergyFlows& flows) { now_.flows += flows; }
  /// After a substep in which drag alone took energy from these particles: each kept so large a
  /// part of the velocity of `begin`.
  void dragged(const ClothModel<Real>& model, const IndexRange& particles, double keep,
               const Vec3Array<Real>& v);
  /// What moving pins and contact did between the velocities of `pulled` and those of the state.
  void add_contact(const ClothModel<Real>& model, const ClothState<Real>& state,
                   const Contact<Real>* objects, bool cloths);

 private:
  void take_means(const Vec3Array<Real>& before, const Vec3Array<Real>& after);
  void measure_outer_forces();
  void measure_particle(std::size_t i, double mass, const ClothState<Real>& state, double drift);
  double measure_objects(const ClothState<Real>& state, const Contact<Real>& objects);
  void share_contact(double work, const ClothState<Real>& state, const Contact<Real>* objects,
                     bool cloths);

  struct Measured {
    EnergyFlows flows;
    Vec3Array<double> corrected;    ///< of the last drift: displacement beyond that of v [m]
    std::size_t seen_impulses = 0;  ///< of contact with objects in this tick
  };

  std::size_t first_jaw_;
  Measured now_, kept_;
  MeteredKick kick_;
  MeteredForces<Real> forces_;
  Vec3Array<Real> x_, v_;  ///< before the kick
  Vec3Array<Real> v_kicked_, v_pulled_;
  Vec3Array<Real> v_undriven_;  ///< before moving pins
  Vec3Array<Real> v_driven_;    ///< `v_pulled_`, and what moving pins gave
  Vec3Array<Real> sling_;       ///< forces of slings alone [N]
  Vec3Array<double> mean_;      ///< (v + v')/2 [m/s]
};

extern template class WorkMeter<float>;
extern template class WorkMeter<double>;

}  // namespace weft
