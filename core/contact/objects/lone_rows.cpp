#include "core/contact/objects/lone_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/objects/lone_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second inclusion guard belongs to that.
#include "core/contact/objects/lone_rows-inl.h"

#if HWY_ONCE
#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

#include "core/contact/parts.h"

namespace weft {

namespace {

WEFT_EXPORT_KERNEL(step);
WEFT_EXPORT_KERNEL(sweep);
WEFT_EXPORT_KERNEL(next_crossing);

/// Nothing is done to any of its particles.
template <class Real>
LoneBlock<Real> empty_block(std::size_t first) {
  LoneBlock<Real> block{};
  std::fill_n(block.touch2, kLoneLanes, std::numeric_limits<Real>::infinity());
  std::fill_n(block.cross2, kLoneLanes, std::numeric_limits<Real>::infinity());
  std::fill_n(block.row, kLoneLanes, kNone);
  block.first = static_cast<Index>(first);
  return block;
}

/// Lets work(blocks) respond, for all at once or in parts.
template <class Real, class Work>
LoneResponse<Real> in_parts(std::span<LoneBlock<Real>> blocks, Executor* executor, Work&& work) {
  // The last block may have particles of the one before, which are in the same part.
  constexpr std::size_t kMost = 4, kFewBlocks = 64;
  static_assert(kFewBlocks >= 2);
  const std::size_t parts = std::min(parts_of(blocks.size(), kFewBlocks), kMost);
  if (!executor || parts == 1) return work(blocks);
  std::array<LoneResponse<Real>, kMost> of_part;
  run_parts(executor, blocks.size(), parts,
            [&](std::size_t part, std::size_t first, std::size_t last) {
              of_part[part] = work(blocks.subspan(first, last - first));
            });
  LoneResponse<Real> whole;
  for (const LoneResponse<Real>& part : of_part) {
    whole.largest = std::max(whole.largest, part.largest);
    whole.within = whole.within && part.within;
    whole.friction_evaluations += part.friction_evaluations;
  }
  return whole;
}

}  // namespace

template <class Real>
void LoneRows<Real>::find(const std::vector<ContactRow<Real>>& rows,
                          const std::vector<RowRoom<Real>>& rooms,
                          const std::vector<ContactDef>& cloths, std::size_t particles) {
  assert(rooms.size() == rows.size());
  constexpr Index kNoRow = -1, kSeveral = -2;
  const auto cloth = [&](const ContactRow<Real>& row) -> const ContactDef& {
    return cloths[at_index(row.cloth)];
  };
  blocks_.clear();
  is_lone_.assign(rows.size(), 0);
  row_of_.assign(particles, kNoRow);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const ContactRow<Real>& row = rows[r];
    const bool alone =
        row.count == 1 && row.responds && row.mover == kNone && cloth(row).restitution == 0;
    for (std::size_t k = 0; k < row.count; ++k) {
      Index& known = row_of_[at_index(row.particle[k])];
      known = known == kNoRow && alone ? static_cast<Index>(r) : kSeveral;
    }
  }
  // A cloth of fewer particles is worked on row by row.
  for (std::size_t i = 0; i < particles && particles >= kLoneLanes; ++i) {
    if (row_of_[i] < 0) continue;
    if (blocks_.empty() || i >= static_cast<std::size_t>(blocks_.back().first) + kLoneLanes)
      blocks_.push_back(empty_block<Real>(std::min(i, particles - kLoneLanes)));
    LoneBlock<Real>& block = blocks_.back();
    const std::size_t k = i - at_index(block.first);
    const auto r = at_index(row_of_[i]);
    is_lone_[r] = 1;
    for (std::size_t c = 0; c < 3; ++c) block.normal[c][k] = rows[r].normal[static_cast<Index>(c)];
    block.offset[k] = rows[r].offset;
    block.thickness[k] = rows[r].thickness;
    block.friction[k] = rows[r].friction;
    block.touch2[k] = rooms[r].touch2;
    block.cross2[k] = rooms[r].cross2;
    block.row[k] = row_of_[i];
  }
}

template <class Real>
LoneResponse<Real> LoneRows<Real>::respond(const LonePass<Real>& pass, Executor* executor) {
  return in_parts<Real>(blocks_, executor, [&pass](std::span<LoneBlock<Real>> part) {
    return WEFT_RUN(step, Real)(part, pass);
  });
}

template <class Real>
LoneResponse<Real> LoneRows<Real>::sweep(const LonePass<Real>& pass, Executor* executor) {
  return in_parts<Real>(blocks_, executor, [&pass](std::span<LoneBlock<Real>> part) {
    return WEFT_RUN(sweep, Real)(part, pass);
  });
}

/// The first block, not before number `block`, with a particle that could cross its plane; the
/// number of blocks if there is none.
template <class Real>
std::size_t LoneRows<Real>::next_crossing(const Real* travel2, std::size_t block) const {
  return WEFT_RUN(next_crossing, Real)(blocks_, travel2, block);
}

template class LoneRows<float>;
template class LoneRows<double>;

}  // namespace weft
#endif
