// Strain of springs and triangles: largest and 99th percentile.

#include "core/diagnostics/strain.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/forces/membrane.h"

namespace weft {
namespace {

template <class Real>
void collect_strains(const ClothModel<Real>& model, const Vec3Array<Real>& x,
                     std::vector<Real>& strains) {
  assert(x.size() == model.mass.size());
  assert(model.spring_kinds.size() == model.springs.size());
  strains.clear();
  for (std::size_t n = 0; n < model.springs.size(); ++n) {
    if (model.spring_kinds[n] == SpringKind::skip) continue;
    const Spring<Real>& s = model.springs[n];
    assert(s.rest_length > 0);
    const Vec3<Real> d = x[static_cast<std::size_t>(s.j)] - x[static_cast<std::size_t>(s.i)];
    strains.push_back(std::abs(d.norm() - s.rest_length) / s.rest_length);
  }
  for (const MembraneTriangle<Real>& t : model.membrane) {
    const auto at = [&](std::size_t k) { return x[static_cast<std::size_t>(t.x[k])]; };
    strains.push_back(principal_strain(membrane_strain<Real>(t, at(1) - at(0), at(2) - at(0))));
  }
}

}  // namespace

template <class Real>
StrainStatistics strain_statistics(const ClothModel<Real>& model, const Vec3Array<Real>& x,
                                   std::vector<Real>& scratch) {
  collect_strains(model, x, scratch);
  if (scratch.empty()) return {};
  const auto p99 = scratch.begin() + static_cast<std::ptrdiff_t>((scratch.size() - 1) * 99 / 100);
  std::nth_element(scratch.begin(), p99, scratch.end());
  return {static_cast<double>(*std::max_element(p99, scratch.end())), static_cast<double>(*p99)};
}

template StrainStatistics strain_statistics(const ClothModel<float>&, const Vec3Array<float>&,
                                            std::vector<float>&);
template StrainStatistics strain_statistics(const ClothModel<double>&, const Vec3Array<double>&,
                                            std::vector<double>&);

}  // namespace weft
