// Loads, stores and loops over a grid's rows.
// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_GRID_LAYOUT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_GRID_LAYOUT_INL_H
#undef WEFT_GRID_LAYOUT_INL_H
#else
#define WEFT_GRID_LAYOUT_INL_H
#endif

#include <cstddef>

#include <hwy/highway.h>

#include "core/forces/grid_view.h"
#include "core/math/triple-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class Real>
using GridTag = hn::CappedTag<Real, kGridLanes>;

/// Loads three components, one line each.
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE Triple<hn::Vec<D>> load(D d, const Real* at, std::ptrdiff_t line) {
  return {hn::LoadU(d, at), hn::LoadU(d, at + line), hn::LoadU(d, at + 2 * line)};
}

template <class D, class Real = hn::TFromD<D>>
HWY_INLINE void store(D d, const Triple<hn::Vec<D>>& a, Real* at, std::ptrdiff_t line) {
  hn::StoreU(a.x, d, at);
  hn::StoreU(a.y, d, at + line);
  hn::StoreU(a.z, d, at + 2 * line);
}

/// Calls body(d, row, column, particle) for stretches of the grid's rows; `particle` is the offset
/// of their first number in arrays of x y z x y z. A stretch is a whole vector where the row is
/// long enough, and one particle in the remainder, so that each is visited exactly once.
template <class Real, class Body>
HWY_INLINE void for_each_stretch(const GridView<Real>& g, Body&& body) {
  const GridTag<Real> wide;
  const hn::CappedTag<Real, 1> single;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(wide));
  for (std::ptrdiff_t r = 0; r < g.rows; ++r) {
    const GridRow<Real>& row = g.row[r];
    std::ptrdiff_t c = 0;
    for (; c + lanes <= row.count; c += lanes)
      body(wide, r, row.column + c, 3 * (row.particle + c));
    for (; c < row.count; ++c) body(single, r, row.column + c, 3 * (row.particle + c));
  }
}

/// Splits arrays of three numbers per particle into three lines for every row.
/// @param pitch  from row to row
template <class Real>
HWY_ATTR void take_apart(const GridView<Real>& g, const Real* from, Real* to,
                         std::ptrdiff_t pitch) {
  for_each_stretch(
      g, [&](auto d, std::ptrdiff_t r, std::ptrdiff_t c, std::ptrdiff_t number)
             HWY_ATTR { store(d, load_particles(d, from + number), to + r * pitch + c, g.line); });
}

template <class Real>
HWY_ATTR void put_together(const GridView<Real>& g, const Real* from, std::ptrdiff_t pitch,
                           Real* to) {
  for_each_stretch(
      g, [&](auto d, std::ptrdiff_t r, std::ptrdiff_t c, std::ptrdiff_t number)
             HWY_ATTR { store_particles(d, load(d, from + r * pitch + c, g.line), to + number); });
}

/// The origin of all places of a grid.
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE Triple<hn::Vec<D>> origin_of(D d, const GridView<Real>& g) {
  return {hn::Set(d, g.origin[0]), hn::Set(d, g.origin[1]), hn::Set(d, g.origin[2])};
}

/// Splits places of the model, as seen from the origin.
template <class Real>
HWY_ATTR void take_places(const GridView<Real>& g, const Real* from, Real* to,
                          std::ptrdiff_t pitch) {
  for_each_stretch(
      g, [&](auto d, std::ptrdiff_t r, std::ptrdiff_t c, std::ptrdiff_t number) HWY_ATTR {
        store(d, load_particles(d, from + number) - origin_of(d, g), to + r * pitch + c, g.line);
      });
}

/// Places for the model, rounded.
template <class Real>
HWY_ATTR void put_places(const GridView<Real>& g, Real* to) {
  for_each_stretch(
      g, [&](auto d, std::ptrdiff_t r, std::ptrdiff_t c, std::ptrdiff_t number) HWY_ATTR {
        const auto place = load(d, g.motion + r * g.pitch() + c, g.line) + origin_of(d, g);
        store_particles(d, place, to + number);
      });
}

/// Takes over a coordinate of the model if something else has moved it, which then has lost
/// nothing to rounding.
template <class V>
HWY_INLINE void take_over(V of_model, V origin, V& place, V& lost) {
  const auto same = hn::Eq(hn::Add(place, origin), of_model);
  place = hn::IfThenElse(same, place, hn::Sub(of_model, origin));
  lost = hn::IfThenElseZero(same, lost);
}

/// Calls visit(d, row, column, number, place, lost) for stretches, whose places and what these lost
/// have taken over what moved in the model, and stores what it makes of them.
template <class Real, class Visit>
HWY_INLINE void visit_places(const GridView<Real>& g, const Real* x, Visit&& visit) {
  for_each_stretch(g,
                   [&](auto d, std::ptrdiff_t r, std::ptrdiff_t c, std::ptrdiff_t number) HWY_ATTR {
                     Real* const motion = g.motion + r * g.pitch() + c;
                     Real* const remainder = motion + GridView<Real>::kRemainderLine * g.line;
                     auto place = load(d, motion, g.line), lost = load(d, remainder, g.line);
                     const auto of_model = load_particles(d, x + number), origin = origin_of(d, g);
                     take_over(of_model.x, origin.x, place.x, lost.x);
                     take_over(of_model.y, origin.y, place.y, lost.y);
                     take_over(of_model.z, origin.z, place.z, lost.z);
                     visit(d, r, c, number, place, lost);
                     store(d, place, motion, g.line);
                     store(d, lost, remainder, g.line);
                   });
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
