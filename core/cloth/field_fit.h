#pragma once

#include <cassert>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "core/cloth/constants.h"

// Least squares of fields in a plane.

namespace weft {

/// A fit of Fields fields, besides the linear ones, to some particles. The nearer ones count more.
template <int Fields>
class FieldFit {
 public:
  using Values = Eigen::Matrix<double, Fields, 1>;

  /// @param places  of the particles, in units such that nearby ones are about 1 away
  /// @param values  of the fields there, about 1 too
  FieldFit(std::vector<Eigen::Vector2d> places, std::vector<Values> values)
      : places_(std::move(places)), values_(std::move(values)) {
    assert(places_.size() == values_.size());
    Eigen::Matrix3d linear = Eigen::Matrix3d::Zero();
    Mixed mixed = Mixed::Zero();
    Square square = Square::Zero();
    for (std::size_t k = 0; k < places_.size(); ++k) {
      const double near = nearness(places_[k]);
      const Eigen::Vector3d a = linear_part(places_[k]);
      linear += near * a * a.transpose();
      mixed += near * a * values_[k].transpose();
      square += near * values_[k] * values_[k].transpose();
    }
    linear_.compute(linear);
    linear_of_fields_ = linear_.solve(mixed);
    const Square own = square - mixed.transpose() * linear_of_fields_;
    if constexpr (Fields == 1)
      solver_.compute(own);
    else
      solver_.computeDirect(own);
  }

  /// Whether the particles distinguish all the fields.
  bool is_determined() const { return solver_.eigenvalues()[0] > kTellsApart; }

  /// Weights of the least squares' slope at a point: exact for linear fields, and for the others as
  /// far as determined.
  /// @param fields  slopes of the others there, in this direction
  std::vector<double> slope(const Eigen::Vector2d& direction, const Values& fields) const {
    const Eigen::Vector3d factors = linear_.solve(Eigen::Vector3d(0, direction[0], direction[1]));
    std::vector<double> linear;
    Values lacking = fields;
    for (std::size_t k = 0; k < places_.size(); ++k) {
      linear.push_back(nearness(places_[k]) * linear_part(places_[k]).dot(factors));
      lacking -= linear[k] * values_[k];
    }
    std::vector<double> slope = weights(lacking);
    for (std::size_t k = 0; k < slope.size(); ++k) slope[k] += linear[k];
    return slope;
  }

  /// The least weights that vanish for linear fields and give these values for the others, as far
  /// as determined.
  std::vector<double> weights(const Values& wanted) const {
    Values of_modes = solver_.eigenvectors().transpose() * wanted;
    for (int k = 0; k < Fields; ++k) {
      const double own = solver_.eigenvalues()[k];
      of_modes[k] = own > kTellsApart ? of_modes[k] / own : 0;
    }
    const Values factors = solver_.eigenvectors() * of_modes;
    std::vector<double> weights;
    for (std::size_t k = 0; k < places_.size(); ++k) {
      const Values rest = values_[k] - linear_of_fields_.transpose() * linear_part(places_[k]);
      weights.push_back(nearness(places_[k]) * rest.dot(factors));
    }
    return weights;
  }

 private:
  using Mixed = Eigen::Matrix<double, 3, Fields>;
  using Square = Eigen::Matrix<double, Fields, Fields>;

  static Eigen::Vector3d linear_part(const Eigen::Vector2d& p) { return {1, p[0], p[1]}; }
  static double nearness(const Eigen::Vector2d& p) {
    const double root = 1 + p.squaredNorm();
    return 1 / (root * root);
  }

  std::vector<Eigen::Vector2d> places_;
  std::vector<Values> values_;
  Eigen::LDLT<Eigen::Matrix3d> linear_;
  Mixed linear_of_fields_;
  Eigen::SelfAdjointEigenSolver<Square> solver_;
};

}  // namespace weft
