#pragma once

#include <Eigen/Core>

#include "core/cloth/bending_stencil.h"

namespace weft::test {

/// Stiffness of quadratic bending against displacements across a flat cloth that is the whole
/// model [N/m]: rows and columns are particles.
inline Eigen::MatrixXd bending_matrix(const ClothModel<double>& model) {
  const auto n = static_cast<Eigen::Index>(model.mass.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  visit_bending_stencils(model.parts.at(0),
                         [&](double k, const Index* corners, const double* weights, int count) {
                           for (int a = 0; a < count; ++a) {
                             for (int b = 0; b < count; ++b)
                               matrix(corners[a], corners[b]) += k * weights[a] * weights[b];
                           }
                         });
  return matrix;
}

}  // namespace weft::test
