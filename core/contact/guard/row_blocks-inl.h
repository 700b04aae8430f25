// Included once for each instruction set by Highway's foreach_target, hence no plain #pragma once.
#if defined(WEFT_ROW_BLOCKS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_ROW_BLOCKS_INL_H
#undef WEFT_ROW_BLOCKS_INL_H
#else
#define WEFT_ROW_BLOCKS_INL_H
#endif

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>

#include <hwy/highway.h>

#include "core/contact/guard/row_blocks.h"
#include "core/contact/guard/row_quads-inl.h"
#include "core/math/kernels.h"
#include "core/math/triple-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// One row a lane.
template <class Real>
using RowsTag = hn::CappedTag<Real, kBatchRows>;

#if HWY_TARGET != HWY_SCALAR
/// What RowBlock's constructor does, with whole vectors.
HWY_INLINE void take(const RowBatch& batch, std::span<const GuardRow<float>> rows,
                     RowBlock<float>& block) {
  using Row = GuardRow<float>;
  const hn::CappedTag<float, kBatchRows> d;
  const hn::RebindToUnsigned<decltype(d)> integers;
  static_assert(offsetof(Row, radius) == offsetof(Row, inertia) + 4 &&
                offsetof(Row, friction) == offsetof(Row, inertia) + 8 &&
                offsetof(Row, room) == offsetof(Row, inertia) + 12 &&
                offsetof(Row, push) == offsetof(Row, least_speed) + 4 &&
                sizeof(Row) >= offsetof(Row, least_speed) + 16);
  const auto first_number = [](std::size_t offset) { return offset / sizeof(float); };
  const Row none = idle_row(rows[at_index(batch[0])]);
  std::array<const Row*, kBatchRows> of;
  block.row = batch;
  block.lacks = 0;
  block.count = 0;
  for (std::size_t k = 0; k < kBatchRows; ++k) {
    of[k] = batch[k] == kNone ? &none : &rows[at_index(batch[k])];
    block.count += batch[k] == kNone ? 0 : 1;
  }
  for (std::size_t k = 0; k < kBatchRows; k += hn::Lanes(d)) {
    const auto copy = [&](std::size_t offset, std::initializer_list<float*> to) HWY_ATTR {
      const auto four = load_four(d, of.data() + k, first_number(offset));
      for (std::size_t n = 0; n < to.size(); ++n) hn::StoreU(four[n], d, to.begin()[n] + k);
    };
    const auto particles = load_four(d, of.data() + k, first_number(offsetof(Row, particle)));
    for (std::size_t n = 0; n < 4; ++n) {
      const auto place = hn::ShiftLeft<2>(hn::BitCast(integers, particles[n]));
      hn::StoreU(place, integers, block.place[n].data() + k);
    }
    auto& [w0, w1, w2, w3] = block.weight;
    auto& [s0, s1, s2, s3] = block.share;
    copy(offsetof(Row, weight), {w0.data(), w1.data(), w2.data(), w3.data()});
    copy(offsetof(Row, share), {s0.data(), s1.data(), s2.data(), s3.data()});
    const auto copy_vector = [&](std::size_t offset, auto& to) HWY_ATTR {
      copy(offset, {to[0].data(), to[1].data(), to[2].data()});
    };
    copy_vector(offsetof(Row, normal), block.normal);
    copy_vector(offsetof(Row, drag), block.drag);
    copy_vector(offsetof(Row, slip), block.slip);
    copy_vector(offsetof(Row, apart), block.apart);
    copy(offsetof(Row, inertia),
         {block.inertia.data(), block.radius.data(), block.friction.data(), block.room.data()});
    copy(offsetof(Row, least_speed), {block.least_speed.data(), block.push.data()});
  }
}
#endif

/// As many rows of a block as there are lanes, from the k-th on.
template <class D, class Real = hn::TFromD<D>>
struct RowLanes {
  using V = hn::Vec<D>;
  using Numbers = typename RowBlock<Real>::Numbers;

  D d;
  RowBlock<Real>& block;
  std::size_t k;

  HWY_INLINE V load(const Numbers& of) const { return hn::LoadU(d, of.data() + k); }
  HWY_INLINE void store(V a, Numbers& to) const { hn::StoreU(a, d, to.data() + k); }
  HWY_INLINE Triple<V> load(const std::array<Numbers, 3>& of) const {
    return {load(of[0]), load(of[1]), load(of[2])};
  }
  HWY_INLINE void store(const Triple<V>& a, std::array<Numbers, 3>& to) const {
    store(a.x, to[0]);
    store(a.y, to[1]);
    store(a.z, to[2]);
  }
  /// Of each row what its n-th particle has.
  HWY_INLINE Triple<V> load_of(const Quad<Real>* quads, std::size_t n) const {
    return gather_quads(d, quads, block.place[n].data() + k);
  }
  HWY_INLINE void store_of(const Triple<V>& a, Quad<Real>* quads, std::size_t n) const {
    scatter_quads(d, a, reinterpret_cast<Real*>(quads), block.place[n].data() + k, block.count - k);
  }
  HWY_INLINE V load_of(const Real* values, std::size_t n) const {
    HWY_ALIGN Real of[kBatchRows];
    for (std::size_t j = 0; j < hn::Lanes(d); ++j) of[j] = values[block.particle(n, k + j)];
    return hn::Load(d, of);
  }
};

/// A vector, but no longer than `most`.
template <class V>
HWY_INLINE Triple<V> shortened(const Triple<V>& v, V most) {
  const auto length2 = dot(v, v);
  const auto is_long = hn::Gt(length2, hn::Mul(most, most));
  return select(is_long, v * hn::Div(most, hn::Sqrt(length2)), v);
}

/// @return room of the rows, which must reach the normal velocities that are stored
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> aim(const RowLanes<D>& rows, const RowPass<Real>& pass) {
  const D d;
  RowBlock<Real>& b = rows.block;
  const auto zero = hn::Zero(d), radius = rows.load(b.radius);
  const auto normal = rows.load(b.normal);
  auto apart = rows.load_of(pass.x, 0) * rows.load(b.weight[0]);
  for (std::size_t n = 1; n < 4; ++n)
    apart = apart + rows.load_of(pass.x, n) * rows.load(b.weight[n]);
  const auto room = hn::Sub(dot(normal, apart), radius);
  const auto went = apart - rows.load(b.apart), slip = rows.load(b.slip);
  const auto slipped = slip + (went - normal * dot(normal, went));
  const auto busy_room = hn::Mul(radius, hn::Set(d, static_cast<Real>(kBusyRoom)));
  const auto is_free = hn::And(hn::Eq(rows.load(b.push), zero), hn::Gt(room, busy_room));
  const auto rubs = hn::Gt(rows.load(b.friction), zero);
  rows.store(drop_if(is_free, select(rubs, slipped, slip)), b.slip);
  rows.store(apart, b.apart);
  rows.store(room, b.room);
  const auto least = hn::Div(hn::Neg(room), hn::Set(d, pass.dt));
  rows.store(hn::IfThenElseZero(hn::Gt(room, zero), least), b.least_speed);
  return room;
}

/// Mean pressure on the features of each row [Pa].
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> pressure_on(const RowLanes<D>& rows, const Real* pressure) {
  const D d;
  const RowBlock<Real>& b = rows.block;
  auto both = hn::Mul(hn::Abs(rows.load(b.weight[0])), rows.load_of(pressure, 0));
  for (std::size_t n = 1; n < 4; ++n) {
    const auto weight = hn::Abs(rows.load(b.weight[n]));
    both = hn::Add(both, hn::Mul(weight, rows.load_of(pressure, n)));
  }
  return hn::Mul(both, hn::Set(d, Real(0.5)));
}

/// What rows keep of their impulses from one step to the next.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V kept_part(D d, V pressure) {
  using Real = hn::TFromD<D>;
  const auto zero = hn::Zero(d), one = hn::Set(d, Real(1));
  const auto over = hn::Sub(hn::Div(pressure, hn::Set(d, static_cast<Real>(kCrushing))), one);
  const auto above = hn::IfThenElse(hn::Lt(over, zero), zero, over);
  const auto part = hn::IfThenElse(hn::Lt(one, above), one, above);
  return hn::Sub(one, hn::Mul(hn::Set(d, static_cast<Real>(kLeak)), part));
}

/// Notes which rows lack more of their radius than pressure takes and is let be, and how much.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void note_lack(const RowLanes<D>& rows, V room, V radius, V slack, V pressure) {
  using Real = hn::TFromD<D>;
  const D d;
  const auto taken = hn::Mul(pressure, hn::Set(d, static_cast<Real>(1 / kFlattening)));
  const auto most = hn::Set(d, static_cast<Real>(kMostFlattening));
  const auto pressed = hn::IfThenElse(hn::Lt(most, taken), most, taken);
  const auto lack = hn::Sub(hn::Neg(room), hn::Mul(radius, pressed));
  rows.store(lack, rows.block.lack);
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(d, hn::Gt(lack, slack), bits);
  rows.block.lacks |= std::uint32_t(bits[0]) << rows.k;
}

/// See warm_rows.
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE void warm(const RowLanes<D>& rows, const RowPass<Real>& pass) {
  const D d;
  RowBlock<Real>& b = rows.block;
  const auto room = aim(rows, pass), radius = rows.load(b.radius);
  const auto slack = hn::Mul(radius, hn::Set(d, static_cast<Real>(kPushSlack)));
  const bool is_short = !hn::AllFalse(d, hn::Gt(hn::Neg(room), slack));
  const auto old_push = rows.load(b.push);
  const auto pushes = hn::Ne(old_push, hn::Zero(d));
  const bool any_pushes = !hn::AllFalse(d, pushes);
  if (!is_short && !any_pushes) return;
  auto kept = hn::Set(d, pass.warm);
  // Where nothing is crushed all is kept, bit for bit.
  const bool crushes = pass.most_pressure > static_cast<Real>(0.99 * kCrushing);
  if (is_short || crushes) {
    const auto pressure = pressure_on(rows, pass.pressure);
    if (is_short) note_lack(rows, room, radius, slack, pressure);
    kept = hn::Mul(kept, kept_part(d, pressure));
  }
  if (!any_pushes) return;
  const auto push = hn::Mul(old_push, kept);
  const auto old_drag = rows.load(b.drag), drag = old_drag * kept;
  rows.store(hn::IfThenElse(pushes, push, old_push), b.push);
  rows.store(select(pushes, drag, old_drag), b.drag);
  const auto change = rows.load(b.normal) * push + drag;
  for (std::size_t n = 0; n < 4; ++n) {
    const auto v = rows.load_of(pass.v, n);
    rows.store_of(select(pushes, v + change * rows.load(b.share[n]), v), pass.v, n);
  }
}

/// What friction changes of the impulses. What slides drags its anchor along.
/// @param push   impulses along the normals [N s]
/// @param slide  velocities across them [m/s]
template <class D, class V = hn::Vec<D>>
HWY_INLINE Triple<V> rub(const RowLanes<D>& rows, V push, const Triple<V>& slide,
                         hn::Mask<D> rubs) {
  using Real = hn::TFromD<D>;
  const D d;
  RowBlock<Real>& b = rows.block;
  const auto slip = rows.load(b.slip), old = rows.load(b.drag);
  const auto back = shortened(slip * hn::Set(d, static_cast<Real>(1 / kStickTime)),
                              hn::Set(d, static_cast<Real>(kFastestReturn)));
  const auto wanted = old - (slide + back) * rows.load(b.inertia);
  const auto most = hn::Mul(rows.load(b.friction), push), size2 = dot(wanted, wanted);
  const auto slides = hn::Gt(size2, hn::Mul(most, most));
  const auto drag = select(slides, wanted * hn::Div(most, hn::Sqrt(size2)), wanted);
  const auto farthest = hn::Mul(rows.load(b.radius), hn::Set(d, static_cast<Real>(kMostSlip)));
  rows.store(select(hn::And(rubs, slides), shortened(slip, farthest), slip), b.slip);
  rows.store(select(rubs, drag, old), b.drag);
  return drag - old;
}

/// @return changes of the normal velocities [m/s]
template <class D, class Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> solve(const RowLanes<D>& rows, const RowPass<Real>& pass) {
  const D d;
  RowBlock<Real>& b = rows.block;
  const auto zero = hn::Zero(d), old_push = rows.load(b.push), least = rows.load(b.least_speed),
             inertia = rows.load(b.inertia);
  const auto normal = rows.load(b.normal);
  std::array<Triple<hn::Vec<D>>, 4> v_of;
  for (std::size_t n = 0; n < 4; ++n) v_of[n] = rows.load_of(pass.v, n);
  auto v = v_of[0] * rows.load(b.weight[0]);
  for (std::size_t n = 1; n < 4; ++n) v = v + v_of[n] * rows.load(b.weight[n]);
  const auto speed = dot(normal, v);
  const auto idle = hn::And(hn::Eq(old_push, zero), hn::Ge(speed, least));
  if (hn::AllTrue(d, idle)) return zero;
  const auto wanted = hn::Add(old_push, hn::Mul(hn::Sub(least, speed), inertia));
  const auto push = hn::IfThenElseZero(hn::Lt(zero, wanted), wanted);
  const auto more = hn::Sub(push, old_push);
  auto change = normal * more;
  rows.store(hn::IfThenElse(idle, old_push, push), b.push);
  const auto rubs = hn::AndNot(idle, hn::Gt(rows.load(b.friction), zero));
  if (!hn::AllFalse(d, rubs)) {
    const auto rubbed = rub(rows, push, v - normal * speed, rubs);
    change = select(rubs, change + rubbed, change);
  }
  for (std::size_t n = 0; n < 4; ++n) {
    const auto changed = v_of[n] + change * rows.load(b.share[n]);
    rows.store_of(select(idle, v_of[n], changed), pass.v, n);
  }
  return hn::IfThenZeroElse(idle, hn::Div(hn::Abs(more), inertia));
}

HWY_ATTR void take_f32(std::span<const RowBatch> batches, std::span<const GuardRow<float>> rows,
                       std::span<RowBlock<float>> blocks) {
  for (std::size_t n = 0; n < batches.size(); ++n) {
#if HWY_TARGET != HWY_SCALAR
    take(batches[n], rows, blocks[n]);
#else
    blocks[n] = {batches[n], rows};
#endif
  }
}

template <class Real>
HWY_ATTR bool warm_blocks(std::span<RowBlock<Real>> blocks, const RowPass<Real>& pass) {
  const RowsTag<Real> d;
  std::uint32_t lacks = 0;
  for (RowBlock<Real>& block : blocks) {
    block.lacks = 0;
    for (std::size_t k = 0; k < block.count; k += hn::Lanes(d))
      warm(RowLanes<RowsTag<Real>>{d, block, k}, pass);
    lacks |= block.lacks;
  }
  return lacks != 0;
}

template <class Real>
HWY_ATTR Real sweep_blocks(std::span<RowBlock<Real>> blocks, bool upwards,
                           const RowPass<Real>& pass) {
  const RowsTag<Real> d;
  auto most = hn::Zero(d);
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    RowBlock<Real>& block = blocks[upwards ? n : blocks.size() - 1 - n];
    for (std::size_t k = 0; k < block.count; k += hn::Lanes(d)) {
      const auto change = solve(RowLanes<RowsTag<Real>>{d, block, k}, pass);
      most = hn::IfThenElse(hn::Lt(most, change), change, most);
    }
  }
  return hn::GetLane(hn::MaxOfLanes(d, most));
}

WEFT_KERNEL(warm_blocks);
WEFT_KERNEL(sweep_blocks);

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#endif
