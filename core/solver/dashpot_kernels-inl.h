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
#include <type_traits>

#include <hwy/highway.h>

#include "core/math/kernels.h"
#include "core/math/lanes-inl.h"
#include "core/math/quads-inl.h"
#include "core/solver/constants.h"
#include "core/solver/dashpot_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <auto Value>
using Constant = std::integral_constant<decltype(Value), Value>;

/// Forces on the particles of a batch, by slot and lane: as quads of triangles, else component by
/// component. Not initialised: `set` comes first for all slots and lanes.
template <class Real, bool OfTriangles>
struct BatchForces {
  using Family = DashpotFamily<Real>;
  static constexpr std::size_t kLanes = Family::kLanes, kNumbers = OfTriangles
                                                                       ? 4 * Family::kMostSlots
                                                                       : 3 * Family::kMostGridSlots;
  HWY_ALIGN Real numbers[kNumbers * kLanes];

  template <class D>
  HWY_INLINE void set(D d, const Triple<hn::Vec<D>>& force, std::size_t slot, std::size_t lane) {
    if constexpr (OfTriangles) {
      std::uint32_t to[kLanes];
      for (std::size_t k = 0; k < hn::Lanes(d); ++k)
        to[k] = static_cast<std::uint32_t>(4 * (slot * kLanes + lane + k));
      scatter_quads(d, force, numbers, to, hn::Lanes(d));
    } else {
      Real* const to = numbers + 3 * slot * kLanes + lane;
      hn::StoreU(force.x, d, to);
      hn::StoreU(force.y, d, to + kLanes);
      hn::StoreU(force.z, d, to + 2 * kLanes);
    }
  }

  /// Adds them, slot by slot and lane by lane, whatever the width of a vector: several may be on
  /// the same particle.
  /// @tparam InRows  the particles of a slot are neighbours, and all are in
  /// @param is_in    whether a particle of the model is to be given something
  template <bool InRows, class IsIn>
  HWY_INLINE void give(const Family& family, std::size_t batch, const IsIn& is_in, Real* to) const {
    const std::uint32_t* place = family.places.data() + batch * family.slots * kLanes;
    for (std::size_t slot = 0; slot < family.slots; ++slot, place += kLanes) {
      if constexpr (InRows) {
        give_row(3 * slot, family.plane, to + *place);
        continue;
      }
      for (std::size_t k = 0; k < kLanes; ++k) {
        if (is_in(family.particle(place[k]))) give_one(slot, k, family.plane, to + place[k]);
      }
    }
  }

 private:
  HWY_INLINE void give_row(std::size_t number, std::size_t plane, Real* to) const {
    const hn::CappedTag<Real, kLanes> d;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < kLanes; k += hn::Lanes(d)) {
        Real* const at = to + c * plane + k;
        hn::StoreU(hn::Add(hn::LoadU(d, at), hn::LoadU(d, numbers + (number + c) * kLanes + k)), d,
                   at);
      }
    }
  }
  HWY_INLINE void give_one(std::size_t slot, std::size_t lane, std::size_t plane, Real* to) const {
    if constexpr (OfTriangles) {
      Quad<Real> force, sum;
      std::memcpy(&force.lanes, numbers + 4 * (slot * kLanes + lane), sizeof force.lanes);
      std::memcpy(&sum.lanes, to, sizeof sum.lanes);
      force.lanes[3] = 0;
      sum += force;
      std::memcpy(to, &sum.lanes, sizeof sum.lanes);
    } else {
      for (std::size_t c = 0; c < 3; ++c) to[c * plane] += numbers[(3 * slot + c) * kLanes + lane];
    }
  }
};

/// How a family reads and gives.
enum class Reading {
  triangles,  ///< quads of any particles
  rows,       ///< planes, of neighbours in a row
  anywhere,   ///< planes, of any particles
};

/// Groups of a batch, as many as a vector has lanes.
/// @tparam Curvatures  of each
template <class Real, std::size_t Curvatures, Reading How>
struct DashpotLanes {
  using Family = DashpotFamily<Real>;
  static constexpr bool kOfTriangles = How == Reading::triangles;
  using D = hn::CappedTag<Real, kOfTriangles ? 8 : Family::kLanes>;  // quads come in eights at most
  using V = hn::Vec<D>;
  static constexpr std::size_t kLanes = Family::kLanes;
  /// Where the line f ends.
  static constexpr std::size_t kEnd = kOfTriangles ? 2 : 3;

  std::size_t slots, plane, first_lane;
  const std::uint32_t* place;
  const Real *weights, *viscosity;
  Real* geometry;

  /// @param lane  of the batch, the first of these
  HWY_INLINE DashpotLanes(Family& family, std::size_t batch, std::size_t lane)
      : slots(slots_of(family)), plane(family.plane), first_lane(lane),
        place(family.places.data() + batch * slots * kLanes + lane),
        weights(kOfTriangles ? family.weights.data() + batch * Curvatures * slots * kLanes + lane
                             : family.weights.data()),
        viscosity(family.viscosity.data() + batch * Curvatures * kLanes + lane),
        geometry(family.geometry.data() + batch * family.geometry_numbers() * kLanes + lane) {}

  /// Those of grids are known to the compiler.
  static HWY_INLINE std::size_t slots_of(const Family& family) {
    if constexpr (kOfTriangles) return family.slots;
    return Curvatures == 2 ? 5 : 4;
  }
  HWY_INLINE V weight(std::size_t curvature, std::size_t slot) const {
    const Real* const first = weights + (curvature * slots + slot) * (kOfTriangles ? kLanes : 1);
    return kOfTriangles ? hn::LoadU(D(), first) : hn::Set(D(), *first);
  }
  HWY_INLINE Triple<V> take(const Real* from, std::size_t slot) const {
    const D d;
    const std::uint32_t* const at = place + slot * kLanes;
    if constexpr (kOfTriangles)
      return gather_quads(d, reinterpret_cast<const Quad<Real>*>(from), at);
    if constexpr (How == Reading::rows) {
      const Real* const x = from + *at;
      return {hn::LoadU(d, x), hn::LoadU(d, x + plane), hn::LoadU(d, x + 2 * plane)};
    }
    HWY_ALIGN Real of[3][kLanes];
    for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
      for (std::size_t c = 0; c < 3; ++c) of[c][k] = from[c * plane + at[k]];
    }
    return {hn::Load(d, of[0]), hn::Load(d, of[1]), hn::Load(d, of[2])};
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
  HWY_INLINE std::array<Triple<V>, 2> for_differences(const Real* of, Visit&& visit) const {
    const Triple<V> origin = take(of, 0);
    const auto next = [&](std::size_t slot) HWY_ATTR __attribute__((always_inline)) {
      const Triple<V> away = take(of, slot) - origin;
      visit(slot, away);
      return away;
    };
    const Triple<V> e = next(1);
    Triple<V> f = next(2);
    if constexpr (!kOfTriangles) f = next(3) - f;
    for (std::size_t slot = kEnd + 1; slot < slots; ++slot) next(slot);
    return {e, f};
  }

  HWY_INLINE void aim(const Real* x) const {
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

  /// @param forces  on the particles of these lanes
  HWY_INLINE void multiply(const Real* v, BatchForces<Real, kOfTriangles>& forces) const {
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
    for (std::size_t slot = 0; slot < slots; ++slot) {
      V along = hn::Mul(weight(0, slot), rate[0]);
      for (std::size_t k = 1; k < Curvatures; ++k)
        along = hn::Add(along, hn::Mul(weight(k, slot), rate[k]));
      Triple<V> force = normal * along;
      if (slot == 0) force = force - by_e;
      if (slot == 1) force = force + by_e;
      if (slot == kEnd) force = force + by_f;
      if (slot == (kOfTriangles ? 0 : 2)) force = force - by_f;
      forces.set(D(), force, slot, first_lane);
    }
  }
};

/// Calls work(lanes) for all groups of a batch.
template <std::size_t Curvatures, Reading How, class Real, class Work>
HWY_INLINE void for_lanes(std::size_t batch, DashpotFamily<Real>& family, Work&& work) {
  using Lanes = DashpotLanes<Real, Curvatures, How>;
  for (std::size_t lane = 0; lane < Lanes::kLanes; lane += hn::Lanes(typename Lanes::D()))
    work(Lanes(family, batch, lane));
}

/// Calls work(curvatures, reading, batch), the first two as constants, for batches of any family.
template <class Real, class Work>
HWY_INLINE void for_batches(const DashpotRun& run, const DashpotFamily<Real>& family, Work&& work) {
  const auto of_grid = [&](auto curvatures) HWY_ATTR {
    for (std::size_t batch = run.first; batch < run.end; ++batch) {
      if (family.in_rows[batch] != 0)
        work(curvatures, Constant<Reading::rows>(), batch);
      else
        work(curvatures, Constant<Reading::anywhere>(), batch);
    }
  };
  if (!family.of_triangles) {
    if (family.curvatures == 2) return of_grid(Constant<std::size_t(2)>());
    return of_grid(Constant<std::size_t(1)>());
  }
  for (std::size_t batch = run.first; batch < run.end; ++batch)
    work(Constant<std::size_t(3)>(), Constant<Reading::triangles>(), batch);
}

/// The first number of what a family reads or gives to.
template <class Numbers, class Real>
HWY_INLINE Numbers* numbers_of(const DashpotFamily<Real>& family, Numbers* of_model) {
  return of_model + (family.of_triangles ? 0 : 4 * family.first);
}

template <class Real>
HWY_ATTR void aim(const DashpotRun& run, const Real* x, DashpotFamily<Real>& family) {
  x = numbers_of(family, x);
  for_batches(run, family, [&](auto curvatures, auto how, std::size_t batch) HWY_ATTR {
    for_lanes<curvatures(), how()>(batch, family,
                                   [&](const auto& lanes) HWY_ATTR { lanes.aim(x); });
  });
}

template <class Real>
HWY_ATTR void multiply(const DashpotRun& run, const Real* v, std::size_t first, std::size_t end,
                       DashpotFamily<Real>& family, Real* product) {
  v = numbers_of(family, v);
  product = numbers_of(family, product);
  for_batches(run, family, [&](auto curvatures, auto how, std::size_t batch) HWY_ATTR {
    constexpr Reading kHow = how();
    BatchForces<Real, kHow == Reading::triangles> forces;
    for_lanes<curvatures(), kHow>(batch, family,
                                  [&](const auto& lanes) HWY_ATTR { lanes.multiply(v, forces); });
    if (run.inside)
      forces.template give<kHow == Reading::rows>(
          family, batch, [](std::size_t) { return true; }, product);
    else
      forces.template give<false>(
          family, batch, [&](std::size_t i) { return i >= first && i < end; }, product);
  });
}

template <class Real>
HWY_ATTR void open_stages(const NumberRange& range, Real by_start, const StageNumbers<Real>& of) {
  for_each_vector<Real>(range.end - range.first, [&](auto d, std::size_t k) HWY_ATTR {
    const std::size_t n = range.first + k;
    const auto now = hn::Mul(hn::LoadU(d, of.start + n), hn::Set(d, by_start));
    hn::StoreU(now, d, of.now + n);
    hn::StoreU(hn::Mul(now, hn::LoadU(d, of.inverse_mass + n)), d, of.next_change + n);
  });
}

template <class Real>
HWY_ATTR void advance_stage(const NumberRange& range, const StageFactors<Real>& by,
                            const StageNumbers<Real>& of) {
  for_each_vector<Real>(range.end - range.first, [&](auto d, std::size_t k) HWY_ATTR {
    const std::size_t n = range.first + k;
    auto next = hn::Mul(hn::LoadU(d, of.now + n), hn::Set(d, by.now));
    next = hn::Add(next, hn::Mul(hn::LoadU(d, of.before + n), hn::Set(d, by.before)));
    next = hn::Add(next, hn::Mul(hn::LoadU(d, of.product + n), hn::Set(d, by.product)));
    next = hn::Add(next, hn::Mul(hn::LoadU(d, of.start + n), hn::Set(d, by.start)));
    hn::StoreU(next, d, of.before + n);
    hn::StoreU(hn::Zero(d), d, of.product + n);
    hn::StoreU(hn::Mul(next, hn::LoadU(d, of.inverse_mass + n)), d, of.next_change + n);
  });
}

WEFT_KERNEL(aim);
WEFT_KERNEL(multiply);
WEFT_KERNEL(open_stages);
WEFT_KERNEL(advance_stage);

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
