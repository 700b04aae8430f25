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

/// Calls visit(first, second) for each pair of an element's corners.
template <class Visitor>
void visit_pairs(std::size_t corners, Visitor&& visit) {
  for (std::size_t second = 1; second < corners; ++second)
    for (std::size_t first = 0; first < second; ++first) visit(first, second);
}

}  // namespace

/// Time of a product of the matrix with a vector, in products of two blocks [1], as measured.
template <class Real>
std::size_t ElementSystem<Real>::products() const {
  return (ends_.size() + stencils_.size()) / 2 + 2 * membrane_.size() + 4 * hinge_terms_.size();
}

/// Calls visit(i, j, block) for each block that an element adds to the matrix in row i and column
/// j, i not j, in an order that does not change. `block()` is that block.
template <class Real>
template <class Visitor>
void ElementSystem<Real>::visit_blocks(Visitor&& visit) const {
  using Block = BlockFactor::Block;
  for (std::size_t n = 0; n < ends_.size(); ++n)
    visit(ends_[n][0], ends_[n][1], [&] { return Block(-full<Real>(blocks_[n])); });
  for (const MembraneElement& element : membrane_) {
    const MembraneTriangle<Real>& t = element.triangle;
    visit_pairs(3, [&](std::size_t i, std::size_t j) {
      visit(t.x[i], t.x[j],
            [&] { return Block(element.term.between(t, i, j).template cast<double>()); });
    });
  }
  for (const Stencil& stencil : stencils_) {
    visit_pairs(static_cast<std::size_t>(stencil.count), [&](std::size_t i, std::size_t j) {
      const Real product = stencil.stiffness * stencil.weight[i] * stencil.weight[j];
      visit(stencil.x[i], stencil.x[j],
            [&] { return Block(Block::Identity() * static_cast<double>(product)); });
    });
  }
  for (const HingeTerm& term : hinge_terms_) {
    visit_pairs(4, [&](std::size_t i, std::size_t j) {
      visit(term.x[i], term.x[j], [&] {
        const Eigen::Matrix<Real, 3, 3> block =
            term.gradient[i] * term.gradient[j].transpose() * term.stiffness;
        return Block(block.template cast<double>());
      });
    });
  }
}

template <class Real>
void ElementSystem<Real>::prepare_factor(const ClothModel<Real>& model) {
  CouplingLists coupled(free_.size());
  visit_blocks([&coupled](Index i, Index j, const auto&) {
    coupled[static_cast<std::size_t>(i)].push_back(j);
    coupled[static_cast<std::size_t>(j)].push_back(i);
  });
  for (std::vector<Index>& list : coupled) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  Vec3Array<double> places;
  for (Index i = particles_.first; i < particles_.end(); ++i)
    places.push_back(model.rest_positions[static_cast<std::size_t>(i)].template cast<double>());
  if (!factor_.prepare(coupled, places, kIterationsOfFactor * products())) return;
  visit_blocks([this](Index i, Index j, const auto&) { slots_.push_back(factor_.slot(i, j)); });
}

/// Assembles and factors the matrix of the last linearisation.
template <class Real>
void ElementSystem<Real>::factor() {
  using Block = BlockFactor::Block;
  factor_.clear();
  const auto is_free = [this](Index i) { return free_[static_cast<std::size_t>(i)] > 0; };
  for (Index i = 0; i < particles_.count; ++i)
    factor_.add_own(i, is_free(i) ? full<Real>(diagonal_[static_cast<std::size_t>(i)])
                                  : Block(Block::Identity()));
  std::size_t slot = 0;
  visit_blocks([&](Index i, Index j, const auto& block) {
    if (is_free(i) && is_free(j)) factor_.add(slots_[slot], block());
    ++slot;
  });
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
