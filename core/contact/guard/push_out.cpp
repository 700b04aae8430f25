// Pushes apart what is too near, for one drift.

#include "core/contact/guard/push_out.h"

#include <algorithm>
#include <cassert>
#include <span>

#include "core/contact/guard/constants.h"
#include "core/contact/guard/row_blocks.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// Pushes the rows of blocks that lack. @return largest velocity of a push that was given [m/s]
template <class Real>
Real push_blocks(std::span<const RowBlock<Real>> blocks, PushOut<Real>& push) {
  Real most = 0;
  for (const RowBlock<Real>& block : blocks) {
    for (std::size_t k = 0; block.lacks >> k != 0; ++k) {
      if ((block.lacks >> k & 1) == 0) continue;
      const Quad<Real> normal = block.quad(block.normal, k);
      const Real wanted = std::min(block.lack[k] * Real(kPushRate), static_cast<Real>(kPushSpeed));
      const Real more = wanted - dot(normal, block.weighted(k, push.extra.data()));
      if (!(more > 0)) continue;
      block.share_out(k, normal * (more * block.inertia[k]), push.extra.data());
      for (std::size_t n = 0; n < 4; ++n) push.is_pushed[block.particle(n, k)] = 1;
      most = std::max(most, more);
    }
  }
  return most;
}

}  // namespace

template <class Real>
PushOut<Real> push_out(std::size_t particles) {
  PushOut<Real> push;
  push.extra.assign(particles, {});
  push.is_pushed.assign(particles, 0);
  return push;
}

template <class Real>
void add_push(RowSet<Real>& rows, PushOut<Real>& push, Vec3Array<Real>& v, Executor* executor) {
  assert(push.particles.empty() && "the last push was taken back");
  const Real most = rows.deals.largest(executor, true, [&](std::span<const RowBlock<Real>> blocks) {
    return push_blocks(blocks, push);
  });
  if (!(most > 0)) return;
  rows.slabs.visit_particles(nullptr, [&](Index i) {
    if (push.is_pushed[at_index(i)]) push.particles.push_back(i);
  });
  for (const Index k : push.particles) {
    const auto i = at_index(k);
    v[i] += to_vector(push.extra[i]);
    push.v.push_back(v[i]);
  }
}

template <class Real>
void take_back_push(PushOut<Real>& push, Vec3Array<Real>& v) {
  assert(push.v.size() == push.particles.size());
  for (std::size_t n = 0; n < push.particles.size(); ++n) {
    const auto i = at_index(push.particles[n]);
    const Vec3<Real> extra = to_vector(push.extra[i]);
    // What was stopped keeps no more of the push than it had, and gets no velocity against it.
    Real part = 1;
    if (v[i] != push.v[n]) {
      const Real size = extra.squaredNorm();
      part = size > 0 ? std::clamp(v[i].dot(extra) / size, Real(0), Real(1)) : Real(0);
    }
    v[i] -= extra * part;
    push.extra[i] = {};
    push.is_pushed[i] = 0;
  }
  push.particles.clear();
  push.v.clear();
}

template <class Real>
void forget_push(PushOut<Real>& push) {
  std::fill(push.extra.begin(), push.extra.end(), Quad<Real>());
  std::fill(push.is_pushed.begin(), push.is_pushed.end(), 0);
  push.particles.clear();
  push.v.clear();
}

WEFT_INSTANTIATE_FUNCTIONS(forget_push, push_out, add_push, take_back_push)

}  // namespace weft
