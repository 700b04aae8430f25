// Factors the element-wise matrix.

#include <algorithm>

#include "core/solver/implicit/constants.h"
#include "core/solver/implicit/element_system.h"

namespace weft {
namespace {

template <class Real>
BlockFactor::Block full(const SymmetricBlock<Real>& a) {
  const Eigen::Matrix<Real, 3, 3> block{{a[0], a[1], a[2]}, {a[1], a[3], a[4]}, {a[2], a[4], a[5]}};
  return block.template cast<double>();
}

/// Calls visit(k, first, second) for each pair of an element's particles.
template <class Visitor>
void visit_pairs(int corners, Visitor&& visit) {
  std::size_t k = 0;
  for (int second = 1; second < corners; ++second)
    for (int first = 0; first < second; ++first) visit(k++, first, second);
}

void couple(const Index* particles, int corners, CouplingLists& coupled) {
  visit_pairs(corners, [&](std::size_t, int first, int second) {
    coupled[static_cast<std::size_t>(particles[first])].push_back(particles[second]);
    coupled[static_cast<std::size_t>(particles[second])].push_back(particles[first]);
  });
}

}  // namespace

/// Time of a product of the matrix with a vector, in products of two blocks [1], as measured.
template <class Real>
std::size_t ElementSystem<Real>::products() const {
  return (ends_.size() + stencils_.size()) / 2 + 2 * membrane_.size() + 4 * hinge_terms_.size();
}

template <class Real>
void ElementSystem<Real>::prepare_factor(const ClothModel<Real>& model) {
  CouplingLists coupled(free_.size());
  for (const std::array<Index, 2>& ends : ends_) couple(ends.data(), 2, coupled);
  for (const MembraneElement& element : membrane_) couple(element.triangle.x.data(), 3, coupled);
  for (const Stencil& stencil : stencils_) couple(stencil.x, stencil.count, coupled);
  for (const HingeTerm& term : hinge_terms_) couple(term.x, 4, coupled);
  for (std::vector<Index>& list : coupled) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  Vec3Array<double> places;
  for (Index i = particles_.first; i < particles_.end(); ++i)
    places.push_back(model.rest_positions[static_cast<std::size_t>(i)].template cast<double>());
  if (!factor_.prepare(coupled, places, kIterationsOfFactor * products())) return;
  for (const std::array<Index, 2>& ends : ends_)
    spring_slots_.push_back(factor_.slot(ends[0], ends[1]));
  const auto find = [this](const auto& x, int corners, auto& slots) {
    visit_pairs(corners, [&](std::size_t k, int first, int second) {
      slots[k] =
          factor_.slot(x[static_cast<std::size_t>(first)], x[static_cast<std::size_t>(second)]);
    });
  };
  for (MembraneElement& element : membrane_) find(element.triangle.x, 3, element.slots);
  for (Stencil& stencil : stencils_) find(stencil.x, stencil.count, stencil.slots);
  for (HingeTerm& term : hinge_terms_) find(term.x, 4, term.slots);
}

/// Assembles and factors the matrix of the last linearisation.
template <class Real>
void ElementSystem<Real>::factor() {
  using Block = BlockFactor::Block;
  factor_.clear();
  const auto is_free = [this](Index i) { return free_[static_cast<std::size_t>(i)] > 0; };
  const auto add = [&](const BlockFactor::Slot& slot, Index i, Index j, const Block& block) {
    if (is_free(i) && is_free(j)) factor_.add(slot, block);
  };
  for (Index i = 0; i < particles_.count; ++i)
    factor_.add_own(i, is_free(i) ? full<Real>(diagonal_[static_cast<std::size_t>(i)])
                                  : Block(Block::Identity()));
  for (std::size_t n = 0; n < ends_.size(); ++n)
    add(spring_slots_[n], ends_[n][0], ends_[n][1], -full<Real>(blocks_[n]));
  for (const MembraneElement& element : membrane_) {
    const MembraneTriangle<Real>& t = element.triangle;
    visit_pairs(3, [&](std::size_t k, int first, int second) {
      const auto i = static_cast<std::size_t>(first), j = static_cast<std::size_t>(second);
      add(element.slots[k], t.x[i], t.x[j], element.term.between(t, i, j).template cast<double>());
    });
  }
  for (const Stencil& stencil : stencils_) {
    visit_pairs(stencil.count, [&](std::size_t k, int first, int second) {
      const Real product = stencil.stiffness * stencil.weight[first] * stencil.weight[second];
      add(stencil.slots[k], stencil.x[first], stencil.x[second],
          Block::Identity() * static_cast<double>(product));
    });
  }
  for (const HingeTerm& term : hinge_terms_) {
    visit_pairs(4, [&](std::size_t k, int first, int second) {
      const Vec3<Real>&g = term.gradient[static_cast<std::size_t>(first)],
            &h = term.gradient[static_cast<std::size_t>(second)];
      add(term.slots[k], term.x[first], term.x[second],
          (g * h.transpose() * term.stiffness).template cast<double>());
    });
  }
  factored_ = factor_.factor();
  uses_ = 0;
}

template std::size_t ElementSystem<float>::products() const;
template std::size_t ElementSystem<double>::products() const;
template void ElementSystem<float>::prepare_factor(const ClothModel<float>&);
template void ElementSystem<double>::prepare_factor(const ClothModel<double>&);
template void ElementSystem<float>::factor();
template void ElementSystem<double>::factor();

}  // namespace weft
