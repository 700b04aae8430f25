// Factors sparse matrices of 3 x 3 blocks.

#include "core/solver/implicit/block_factor.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/stop_signal.h"

namespace weft {
namespace {

constexpr auto kNoColumn = static_cast<std::size_t>(-1);

/// Products of blocks that a column causes.
std::size_t products_of(const std::vector<std::size_t>& rows) {
  return rows.size() * (rows.size() + 3) / 2;
}

/// Rows below the diagonal of each column of the factor: those of the matrix, and those of the
/// columns whose first row it is. Ends where the products exceed the most.
std::vector<std::vector<std::size_t>> filled_rows(const CouplingLists& coupled,
                                                  const std::vector<Index>& columns,
                                                  const std::vector<std::size_t>& position,
                                                  std::size_t most_products,
                                                  std::size_t& products) {
  std::vector<std::vector<std::size_t>> rows(columns.size());
  products = 0;
  for (std::size_t j = 0; j < columns.size() && products <= most_products; ++j) {
    std::vector<std::size_t>& own = rows[j];  // so far of columns before
    for (const Index other : coupled[static_cast<std::size_t>(columns[j])]) {
      const std::size_t row = position[static_cast<std::size_t>(other)];
      if (row > j) own.push_back(row);
    }
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    products += products_of(own);
    if (own.empty()) continue;
    std::vector<std::size_t>& parent = rows[own.front()];
    parent.insert(parent.end(), own.begin() + 1, own.end());
  }
  return rows;
}

/// Inverse of a symmetric block by its own triangular factors.
/// @returns whether it is positive definite
bool invert(const BlockFactor::Block& a, BlockFactor::Block& inverse) {
  const double l00 = std::sqrt(a(0, 0)), l10 = a(1, 0) / l00, l20 = a(2, 0) / l00;
  const double l11 = std::sqrt(a(1, 1) - l10 * l10), l21 = (a(2, 1) - l20 * l10) / l11;
  const double l22 = std::sqrt(a(2, 2) - l20 * l20 - l21 * l21);
  if (!(l00 > 0) || !(l11 > 0) || !(l22 > 0)) return false;
  const double i00 = 1 / l00, i11 = 1 / l11, i22 = 1 / l22;
  const double i10 = -l10 * i00 * i11, i21 = -l21 * i11 * i22;
  const double i20 = -(l20 * i00 + l21 * i10) * i22;
  const BlockFactor::Block lower{{i00, 0, 0}, {i10, i11, 0}, {i20, i21, i22}};
  inverse = lower.transpose() * lower;
  return inverse.allFinite();
}

}  // namespace

bool BlockFactor::prepare(const CouplingLists& coupled, const Vec3Array<double>& places,
                          std::size_t most_products) {
  assert(!coupled.empty());
  columns_ = dissect(coupled, places);
  const std::size_t count = columns_.size();
  position_.resize(count);
  for (std::size_t k = 0; k < count; ++k) position_[static_cast<std::size_t>(columns_[k])] = k;
  std::vector<std::vector<std::size_t>> rows =
      filled_rows(coupled, columns_, position_, most_products, products_);
  if (products_ > most_products) {
    *this = {};
    return false;
  }
  begin_.assign(1, 0);
  rows_.clear();
  for (const std::vector<std::size_t>& column : rows) {
    rows_.insert(rows_.end(), column.begin(), column.end());
    begin_.push_back(rows_.size());
  }
  lower_.assign(rows_.size(), Block::Zero());
  for (auto* list : {&diagonal_, &inverse_, &sum_}) list->assign(count, Block::Zero());
  for (auto* list : {&next_, &of_, &top_}) list->assign(count, kNoColumn);
  solution_.assign(count, Eigen::Vector3d::Zero());
  return true;
}

BlockFactor::Slot BlockFactor::slot(Index i, Index j) const {
  const std::size_t at_i = position_[static_cast<std::size_t>(i)],
                    at_j = position_[static_cast<std::size_t>(j)];
  assert(at_i != at_j);
  const std::size_t column = std::min(at_i, at_j), row = std::max(at_i, at_j);
  const auto end = rows_.begin() + static_cast<std::ptrdiff_t>(begin_[column + 1]);
  const auto found =
      std::lower_bound(rows_.begin() + static_cast<std::ptrdiff_t>(begin_[column]), end, row);
  assert(found != end && *found == row && "coupled");
  return {static_cast<std::size_t>(found - rows_.begin()), at_i < at_j};
}

void BlockFactor::clear() {
  std::fill(lower_.begin(), lower_.end(), Block::Zero());
  std::fill(diagonal_.begin(), diagonal_.end(), Block::Zero());
}

/// Subtracts what a column adds to a later one.
/// @param from  its block in the diagonal's row of the later one
void BlockFactor::update(std::size_t column, std::size_t from) {
  const std::size_t row = rows_[from], end = begin_[column + 1];
  const Block factor = inverse_[column] * lower_[from].transpose();
  diagonal_[row].noalias() -= lower_[from].lazyProduct(factor);
  for (std::size_t k = from + 1; k < end; ++k)
    sum_[rows_[k]].noalias() -= lower_[k].lazyProduct(factor);
  if (from + 1 == end) return;
  const std::size_t later = rows_[from + 1];  // the next row on which the column acts
  of_[column] = from + 1;
  next_[column] = top_[later];
  top_[later] = column;
}

bool BlockFactor::factor() {
  std::fill(top_.begin(), top_.end(), kNoColumn);
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    stop_point();
    for (std::size_t k = begin_[j]; k < begin_[j + 1]; ++k) sum_[rows_[k]] = lower_[k];
    for (std::size_t from = top_[j]; from != kNoColumn;) {
      const std::size_t next = next_[from];
      update(from, of_[from]);
      from = next;
    }
    for (std::size_t k = begin_[j]; k < begin_[j + 1]; ++k) lower_[k] = sum_[rows_[k]];
    if (!invert(diagonal_[j], inverse_[j])) return false;
    if (begin_[j] == begin_[j + 1]) continue;
    const std::size_t first = rows_[begin_[j]];
    of_[j] = begin_[j];
    next_[j] = top_[first];
    top_[first] = j;
  }
  return true;
}

template <class Real>
void BlockFactor::solve(const Real* r, Real* z) {
  using Vector = Eigen::Matrix<Real, 3, 1>;
  const auto place = [this](std::size_t j) { return 3 * static_cast<std::ptrdiff_t>(columns_[j]); };
  for (std::size_t j = 0; j < columns_.size(); ++j)
    solution_[j] = Eigen::Map<const Vector>(r + place(j)).template cast<double>();
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    const Eigen::Vector3d push = inverse_[j] * solution_[j];
    for (std::size_t k = begin_[j]; k < begin_[j + 1]; ++k)
      solution_[rows_[k]].noalias() -= lower_[k].lazyProduct(push);
  }
  for (std::size_t j = columns_.size(); j-- > 0;) {
    Eigen::Vector3d sum = solution_[j];
    for (std::size_t k = begin_[j]; k < begin_[j + 1]; ++k)
      sum.noalias() -= lower_[k].transpose().lazyProduct(solution_[rows_[k]]);
    solution_[j] = inverse_[j] * sum;
    Eigen::Map<Vector>(z + place(j)) = solution_[j].template cast<Real>();
  }
}

template void BlockFactor::solve(const float*, float*);
template void BlockFactor::solve(const double*, double*);

}  // namespace weft
