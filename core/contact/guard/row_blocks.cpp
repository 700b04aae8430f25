#include "core/contact/guard/row_blocks.h"

#include <cassert>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/guard/row_blocks.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second inclusion guard belongs to that.
#include "core/contact/guard/row_blocks-inl.h"

#if HWY_ONCE
#include "core/instantiate.h"

namespace weft {

HWY_EXPORT(take_f32);
WEFT_EXPORT_KERNEL(warm_blocks);
WEFT_EXPORT_KERNEL(sweep_blocks);

void take_rows(std::span<const RowBatch> batches, std::span<const GuardRow<float>> rows,
               std::span<RowBlock<float>> blocks) {
  HWY_DYNAMIC_DISPATCH(take_f32)(batches, rows, blocks);
}
void take_rows(std::span<const RowBatch> batches, std::span<const GuardRow<double>> rows,
               std::span<RowBlock<double>> blocks) {
  for (std::size_t n = 0; n < batches.size(); ++n) blocks[n] = {batches[n], rows};
}

template <class Real>
bool warm_rows(std::span<RowBlock<Real>> blocks, const RowPass<Real>& pass) {
  return WEFT_RUN(warm_blocks, Real)(blocks, pass);
}

template <class Real>
Real sweep_rows(std::span<RowBlock<Real>> blocks, bool upwards, const RowPass<Real>& pass) {
  return WEFT_RUN(sweep_blocks, Real)(blocks, upwards, pass);
}

template <class Real>
RowBlock<Real>::RowBlock(const RowBatch& batch, std::span<const GuardRow<Real>> rows)
    : row(batch), lacks(0), count(0) {
  assert(batch[0] != kNone);
  const GuardRow<Real> none = idle_row(rows[at_index(batch[0])]);
  for (std::size_t k = 0; k < kBatchRows; ++k) {
    const bool any = batch[k] != kNone;
    const GuardRow<Real>& from = any ? rows[at_index(batch[k])] : none;
    count += any ? 1 : 0;
    for (std::size_t n = 0; n < 4; ++n) {
      place[n][k] = 4 * static_cast<std::uint32_t>(from.particle[n]);
      weight[n][k] = from.weight[n];
      share[n][k] = from.share[n];
    }
    for (int c = 0; c < 3; ++c) {
      const auto axis = at_index(c);
      normal[axis][k] = from.normal[c];
      drag[axis][k] = from.drag[c];
      slip[axis][k] = from.slip[c];
      apart[axis][k] = from.apart[c];
    }
    inertia[k] = from.inertia;
    radius[k] = from.radius;
    friction[k] = from.friction;
    room[k] = from.room;
    least_speed[k] = from.least_speed;
    push[k] = from.push;
  }
}

template <class Real>
void RowBlock<Real>::give_back(std::span<GuardRow<Real>> rows) const {
  for (std::size_t k = 0; k < count; ++k) {
    GuardRow<Real>& to = rows[at_index(row[k])];
    to.drag = quad(drag, k);
    to.slip = quad(slip, k);
    to.apart = quad(apart, k);
    to.room = room[k];
    to.least_speed = least_speed[k];
    to.push = push[k];
  }
}

WEFT_INSTANTIATE_FUNCTIONS(warm_rows, sweep_rows)
template struct RowBlock<float>;
template struct RowBlock<double>;

}  // namespace weft
#endif
