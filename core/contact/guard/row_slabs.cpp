// Cuts space into slabs and sorts rows into them.

#include "core/contact/guard/row_slabs.h"

#include <cassert>
#include <cmath>

namespace weft {
namespace {

/// As many positions tell well enough where to cut.
constexpr std::size_t kSamples = 256;

}  // namespace

template <class Real>
void RowSlabs<Real>::cut(const std::vector<Index>& particles, const QuadArray<Real>& x) {
  slab_of_.assign(x.size(), 0);
  const std::size_t step = 1 + particles.size() / kSamples;
  int longest = 0;
  Real most = -1;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Real>& samples = samples_[at_index(axis)];
    samples.clear();
    for (std::size_t k = 0; k < particles.size(); k += step) {
      const Real at = x[at_index(particles[k])][axis];
      if (std::isfinite(at)) samples.push_back(at);
    }
    if (samples.size() < kSlabs) return;
    std::sort(samples.begin(), samples.end());
    const Real extent = samples.back() - samples.front();
    if (!(extent > most)) continue;
    most = extent;
    longest = axis;
  }
  const std::vector<Real>& samples = samples_[at_index(longest)];
  for (std::size_t cut = 1; cut < kSlabs; ++cut) {
    const Real border = samples[cut * samples.size() / kSlabs];
    for (std::size_t i = 0; i < x.size(); ++i)
      slab_of_[i] = static_cast<std::uint8_t>(slab_of_[i] + (x[i][longest] >= border));
  }
}

template <class Real>
void RowSlabs<Real>::clear() {
  for (std::size_t k = 0; k < kLists; ++k) {
    rows_[k].clear();
    busy_[k].clear();
    ++changes_[k];
  }
  busy_count_ = 0;
}

template <class Real>
void RowSlabs<Real>::clear_particles() {
  for (std::vector<Index>& list : particles_) list.clear();
  particle_count_ = 0;
}

template <class Real>
std::uint8_t RowSlabs<Real>::list_of(const std::array<Index, 4>& particles) const {
  assert(!slab_of_.empty() && "cut comes first");
  std::uint8_t first = kSlabs, last = 0;
  for (const Index i : particles) {
    const std::uint8_t slab = slab_of_[at_index(i)];
    first = std::min(first, slab);
    last = std::max(last, slab);
  }
  return last > first + 1 ? kSlabs : first;
}

template class RowSlabs<float>;
template class RowSlabs<double>;

}  // namespace weft
