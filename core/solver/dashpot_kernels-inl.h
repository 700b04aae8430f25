// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_DASHPOT_KERNELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_DASHPOT_KERNELS_INL_H
#undef WEFT_DASHPOT_KERNELS_INL_H
#else
#define WEFT_DASHPOT_KERNELS_INL_H
#endif

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <hwy/highway.h>

#include "core/math/kernels.h"
#include "core/math/quads-inl.h"
#include "core/solver/constants.h"
#include "core/solver/dashpot_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Groups of a batch, as many as a vector has lanes.
/// @tparam Curvatures   of each
/// @tparam OfTriangles  see DashpotFamily
template <class Real, std::size_t Curvatures, bool OfTriangles>
struct DashpotLanes {
  using Family = DashpotFamily<Real>;
  using D = hn::CappedTag<Real, Family::kLanes>;
  using V = hn::Vec<D>;
  static constexpr std::size_t kLanes = Family::kLanes;
  /// Where the line f ends.
  static constexpr std::size_t kEnd = OfTriangles ? 2 : 3;

  std::size_t slots;
  const std::uint32_t* place;
  const Real *weights, *viscosity;
  Real* geometry;

  /// @param lane  of the batch, the first of these
  HWY_INLINE DashpotLanes(Family& family, std::size_t batch, std::size_t lane)
      : slots(family.slots), place(family.places.data() + batch * family.slots * kLanes + lane),
        weights(OfTriangles
                    ? family.weights.data() + batch * Curvatures * family.slots * kLanes + lane
                    : family.weights.data()),
        viscosity(family.viscosity.data() + batch * Curvatures * kLanes + lane),
        geometry(family.geometry.data() + batch * family.geometry_numbers() * kLanes + lane) {}

  HWY_INLINE V weight(std::size_t curvature, std::size_t slot) const {
    const Real* const first = weights + (curvature * slots + slot) * (OfTriangles ? kLanes : 1);
    return OfTriangles ? hn::LoadU(D(), first) : hn::Set(D(), *first);
  }
  HWY_INLINE Triple<V> take(const Quad<Real>* from, std::size_t slot) const {
    return gather_quads(D(), from, place + slot * kLanes);
  }

  /// Forces on the particles of each lane, slot by slot. They begin as whatever was there.
  struct Forces {
    HWY_ALIGN Real numbers[4 * kLanes * Family::kMostSlots];

    static HWY_INLINE std::size_t at(std::size_t lane, std::size_t slot) {
      return 4 * (lane * Family::kMostSlots + slot);
    }
    HWY_INLINE void set(const Triple<V>& force, std::size_t slot) {
      std::uint32_t to[kLanes];
      for (std::size_t k = 0; k < hn::Lanes(D()); ++k)
        to[k] = static_cast<std::uint32_t>(at(k, slot));
      scatter_quads(D(), force, numbers, to, hn::Lanes(D()));
    }
    HWY_INLINE Quad<Real> of(std::size_t lane, std::size_t slot) const {
      Quad<Real> force;
      std::memcpy(&force.lanes, numbers + at(lane, slot), sizeof force.lanes);
      force.lanes[3] = 0;
      return force;
    }
  };

  /// Adds forces lane by lane: in the same order whatever the width of a vector, as several lanes
  /// may have the same particle.
  /// @param is_in  whether a place is to be given something
  template <class IsIn>
  HWY_INLINE void give(const Forces& forces, const IsIn& is_in, Quad<Real>* to) const {
    for (std::size_t k = 0; k < hn::Lanes(D()); ++k) {
      for (std::size_t slot = 0; slot < slots; ++slot) {
        const std::uint32_t at = place[slot * kLanes + k];
        if (is_in(at)) to[at / 4] += forces.of(k, slot);
      }
    }
  }
  HWY_INLINE V load(std::size_t number) const { return hn::LoadU(D(), geometry + number * kLanes); }
  HWY_INLINE Triple<V> load_three(std::size_t number) const {
    return {load(number), load(number + 1), load(number + 2)};
  }
  HWY_INLINE void store(V a, std::size_t number) const {
    hn::StoreU(a, D(), geometry + number * kLanes);
  }
  HWY_INLINE void store(const Triple<V>& a, std::size_t number) const {
    store(a.x, number);
    store(a.y, number + 1);
    store(a.z, number + 2);
  }

  /// Calls visit(slot, difference from slot 0) for all others, and returns what the lines e and f
  /// are of the differences.
  template <class Visit>
  HWY_INLINE std::array<Triple<V>, 2> for_differences(const Quad<Real>* of, Visit&& visit) const {
    const Triple<V> origin = take(of, 0);
    const auto next = [&](std::size_t slot) HWY_ATTR __attribute__((always_inline)) {
      const Triple<V> away = take(of, slot) - origin;
      visit(slot, away);
      return away;
    };
    const Triple<V> e = next(1);
    Triple<V> f = next(2);
    if constexpr (!OfTriangles) f = next(3) - f;
    for (std::size_t slot = kEnd + 1; slot < slots; ++slot) next(slot);
    return {e, f};
  }

  HWY_INLINE void aim(const Quad<Real>* x) const {
    const D d;
    const V zero = hn::Zero(d);
    std::array<Triple<V>, Curvatures> value;
    std::array<V, Curvatures> weight_sum;
    for (std::size_t k = 0; k < Curvatures; ++k) {
      value[k] = {zero, zero, zero};
      weight_sum[k] = hn::Abs(weight(k, 0));
    }
    const auto [e, f] = for_differences(x, [&](std::size_t slot, const Triple<V>& away) HWY_ATTR {
      for (std::size_t k = 0; k < Curvatures; ++k) {
        const V w = weight(k, slot);
        value[k] = value[k] + away * w;
        weight_sum[k] = hn::Add(weight_sum[k], hn::Abs(w));
      }
    });
    const Triple<V> across = cross(e, f);
    const V area = hn::Sqrt(dot(across, across));
    const V per_area = hn::IfThenElseZero(hn::Gt(area, zero), hn::Div(hn::Set(d, Real(1)), area));
    const Triple<V> normal = across * per_area;
    const V lengths = hn::Add(hn::Sqrt(dot(e, e)), hn::Sqrt(dot(f, f)));
    store(e, 0);
    store(f, 3);
    store(normal, 6);
    for (std::size_t k = 0; k < Curvatures; ++k) {
      const Triple<V> tangential = value[k] - normal * dot(normal, value[k]);
      const V turning =
          hn::Mul(hn::Mul(hn::Set(d, Real(2)), lengths), hn::Sqrt(dot(tangential, tangential)));
      const V most = hn::Mul(hn::Mul(hn::Set(d, Real(kMostTurning)), weight_sum[k]), area);
      // What is no number is crumpled too.
      const auto turns = hn::Not(hn::Le(turning, most));
      const std::size_t number = Family::kOfNormal + Family::kOfCurvature * k;
      store(drop_if(turns, tangential * per_area), number);
      store(hn::IfThenZeroElse(turns, hn::LoadU(d, viscosity + k * kLanes)), number + 3);
    }
  }

  template <class IsIn>
  HWY_INLINE void multiply(const Quad<Real>* v, const IsIn& is_in, Quad<Real>* product) const {
    const D d;
    const Triple<V> normal = load_three(6);
    std::array<V, Curvatures> rate;
    rate.fill(hn::Zero(d));
    const auto [e_rate, f_rate] =
        for_differences(v, [&](std::size_t slot, const Triple<V>& away) HWY_ATTR {
          const V along = dot(normal, away);
          for (std::size_t k = 0; k < Curvatures; ++k)
            rate[k] = hn::Add(rate[k], hn::Mul(weight(k, slot), along));
        });
    const Triple<V> e = load_three(0), f = load_three(3);
    const Triple<V> turning = cross(e_rate, f) + cross(e, f_rate);
    Triple<V> aside = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (std::size_t k = 0; k < Curvatures; ++k) {
      const std::size_t number = Family::kOfNormal + Family::kOfCurvature * k;
      const Triple<V> turn = load_three(number);
      rate[k] = hn::Mul(load(number + 3), hn::Add(rate[k], dot(turn, turning)));
      aside = aside + turn * rate[k];
    }
    const Triple<V> by_e = cross(f, aside), by_f = cross(aside, e);
    Forces forces;
    for (std::size_t slot = 0; slot < slots; ++slot) {
      V along = hn::Mul(weight(0, slot), rate[0]);
      for (std::size_t k = 1; k < Curvatures; ++k)
        along = hn::Add(along, hn::Mul(weight(k, slot), rate[k]));
      Triple<V> force = normal * along;
      if (slot == 0) force = force - by_e;
      if (slot == 1) force = force + by_e;
      if (slot == kEnd) force = force + by_f;
      if (slot == (OfTriangles ? 0 : 2)) force = force - by_f;
      forces.set(force, slot);
    }
    give(forces, is_in, product);
  }
};

/// Calls work(lanes) for all groups of some batches.
template <std::size_t Curvatures, bool OfTriangles, class Real, class Work>
HWY_INLINE void for_lanes(std::size_t first_batch, std::size_t end_batch,
                          DashpotFamily<Real>& family, Work&& work) {
  using Lanes = DashpotLanes<Real, Curvatures, OfTriangles>;
  for (std::size_t batch = first_batch; batch < end_batch; ++batch) {
    for (std::size_t lane = 0; lane < Lanes::kLanes; lane += hn::Lanes(typename Lanes::D()))
      work(Lanes(family, batch, lane));
  }
}

/// The same for any family.
template <class Real, class Work>
HWY_INLINE void for_all_lanes(std::size_t first_batch, std::size_t end_batch,
                              DashpotFamily<Real>& family, Work&& work) {
  if (family.of_triangles)
    for_lanes<3, true>(first_batch, end_batch, family, work);
  else if (family.curvatures == 2)
    for_lanes<2, false>(first_batch, end_batch, family, work);
  else
    for_lanes<1, false>(first_batch, end_batch, family, work);
}

template <class Real>
HWY_ATTR void aim(const DashpotRun& run, const Quad<Real>* x, DashpotFamily<Real>& family) {
  for_all_lanes(run.first, run.end, family, [&](const auto& lanes) HWY_ATTR { lanes.aim(x); });
}

template <class Real>
HWY_ATTR void multiply(const DashpotRun& run, const Quad<Real>* v, std::size_t first,
                       std::size_t end, DashpotFamily<Real>& family, Quad<Real>* product) {
  const auto multiply_where = [&](const auto& is_in) HWY_ATTR {
    for_all_lanes(run.first, run.end, family,
                  [&](const auto& lanes) HWY_ATTR { lanes.multiply(v, is_in, product); });
  };
  if (run.inside)
    multiply_where([](std::uint32_t) { return true; });
  else
    multiply_where([&](std::uint32_t place) { return place >= 4 * first && place < 4 * end; });
}

WEFT_KERNEL(aim);
WEFT_KERNEL(multiply);

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
