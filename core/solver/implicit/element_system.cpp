// Assembles and applies the element-wise matrix.

#include "core/solver/implicit/element_system.h"

#include <cassert>

#include "core/cloth/bending_stencil.h"
#include "core/forces/hinge.h"
#include "core/forces/rest_curve.h"
#include "core/geometry/hinge_angle.h"

namespace weft {
namespace {

template <class Real>
void add_to(SymmetricBlock<Real>& sum, const SymmetricBlock<Real>& more) {
  for (std::size_t e = 0; e < 6; ++e) sum[e] += more[e];
}

template <class Real>
Eigen::Map<const Vec3<Real>> at(const Real* p, Index particle) {
  return Eigen::Map<const Vec3<Real>>(p + 3 * static_cast<std::ptrdiff_t>(particle));
}

template <class Real>
Eigen::Map<Vec3<Real>> at(Real* p, Index particle) {
  return Eigen::Map<Vec3<Real>>(p + 3 * static_cast<std::ptrdiff_t>(particle));
}

}  // namespace

template <class Real>
ElementSystem<Real>::ElementSystem(const ClothModel<Real>& model, const ClothPart<Real>& part)
    : number_(static_cast<std::size_t>(&part - model.parts.data())), particles_(part.particles),
      springs_(part.springs), hinges_(part.hinges), tensor_(part.membrane_tensor) {
  const auto count = static_cast<std::size_t>(particles_.count);
  const auto margin = static_cast<std::size_t>(kGridMargin);
  size_ = (3 * count + margin - 1) / margin * margin;
  for (auto* list : {&own_, &diagonal_, &inverse_}) list->assign(count, {});
  free_.assign(count, Real(1));
  for (Index k = springs_.first; k < springs_.end(); ++k) {
    const Spring<Real>& spring = model.springs[static_cast<std::size_t>(k)];
    assert(particles_.contains(spring.i) && particles_.contains(spring.j));
    ends_.push_back({spring.i - particles_.first, spring.j - particles_.first});
  }
  blocks_.assign(ends_.size(), {});
  for (Index n = part.membrane.first; n < part.membrane.end(); ++n) {
    MembraneTriangle<Real> t = model.membrane[static_cast<std::size_t>(n)];
    for (Index& corner : t.x) {
      assert(particles_.contains(corner));
      corner -= particles_.first;
    }
    membrane_.push_back({t, {}});
  }
  visit_bending_stencils(
      part, [&](double stiffness, const Index* corners, const double* weights, int corner_count) {
        if (stiffness == 0) return;
        Stencil& stencil = stencils_.emplace_back();
        stencil.stiffness = static_cast<Real>(stiffness);
        stencil.count = corner_count;
        for (int n = 0; n < corner_count; ++n) {
          stencil.x[n] = corners[n] - particles_.first;
          stencil.weight[n] = static_cast<Real>(weights[n]);
        }
      });
  hinge_terms_.resize(static_cast<std::size_t>(hinges_.count));
  for (std::size_t n = 0; n < hinge_terms_.size(); ++n) {
    const Hinge<Real>& hinge = model.hinges[static_cast<std::size_t>(hinges_.first) + n];
    for (int k = 0; k < 4; ++k) hinge_terms_[n].x[k] = hinge.x[k] - particles_.first;
  }
  prepare_factor(model);
}

template <class Real>
void ElementSystem<Real>::set_pinned(const std::vector<Real>& inverse_mass) {
  assert(static_cast<std::size_t>(particles_.end()) <= inverse_mass.size());
  for (std::size_t i = 0; i < free_.size(); ++i)
    free_[i] = inverse_mass[static_cast<std::size_t>(particles_.first) + i] > 0 ? Real(1) : Real(0);
  factored_ = false;
}

template <class Real>
void ElementSystem<Real>::linearise_membrane(const NewtonPoint<Real>& point,
                                             Vec3Array<Real>& force) {
  const auto first = static_cast<std::size_t>(particles_.first);
  for (MembraneElement& element : membrane_) {
    const MembraneTriangle<Real>& t = element.triangle;
    std::array<Vec3<Real>, 3> x, v;
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = point.x[first + static_cast<std::size_t>(t.x[k])];
      v[k] = point.v[first + static_cast<std::size_t>(t.x[k])];
    }
    element.term = MembraneTerm<Real>(tensor_, t, x, v, point.rate);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(t.x[k]);
      force[first + i] += element.term.forces()[k];
      add_to(diagonal_[i], element.term.own(t, k));
    }
  }
}

template <class Real>
void ElementSystem<Real>::linearise(const ClothModel<Real>& model, const NewtonPoint<Real>& point,
                                    Vec3Array<Real>& force) {
  assert(point.rate > 0);
  assert(point.v.size() == point.x.size() && point.inertia.size() == point.x.size());
  assert(force.size() == point.x.size());
  const auto first = static_cast<std::size_t>(particles_.first);
  for (std::size_t i = 0; i < own_.size(); ++i) {
    const Real inertia = point.inertia[first + i];
    own_[i] = point.air ? (*point.air)[first + i] : SymmetricBlock<Real>{};
    for (const std::size_t e : {std::size_t{0}, std::size_t{3}, std::size_t{5}})
      own_[i][e] += inertia;
    diagonal_[i] = own_[i];
  }
  for (std::size_t n = 0; n < ends_.size(); ++n) {
    const Spring<Real>& spring = model.springs[static_cast<std::size_t>(springs_.first) + n];
    const auto i = static_cast<std::size_t>(spring.i), j = static_cast<std::size_t>(spring.j);
    const SpringTerm<Real> term(spring, point.x[j] - point.x[i], point.v[j] - point.v[i],
                                point.rate);
    force[i] += term.force;
    force[j] -= term.force;
    blocks_[n] = term.block;
    add_to(diagonal_[i - first], term.block);
    add_to(diagonal_[j - first], term.block);
  }
  linearise_membrane(point, force);
  for (const Stencil& stencil : stencils_) {
    Vec3<Real> sum = Vec3<Real>::Zero();
    for (int n = 0; n < stencil.count; ++n)
      sum += point.x[first + static_cast<std::size_t>(stencil.x[n])] * stencil.weight[n];
    for (int n = 0; n < stencil.count; ++n) {
      const auto i = static_cast<std::size_t>(stencil.x[n]);
      force[first + i] -= sum * (stencil.stiffness * stencil.weight[n]);
      const Real own = stencil.stiffness * stencil.weight[n] * stencil.weight[n];
      add_to(diagonal_[i], {own, 0, 0, own, 0, own});
    }
  }
  add_rest_curve_forces(model.parts[number_], point.x, force);
  for (std::size_t n = 0; n < hinge_terms_.size(); ++n) {
    const Hinge<Real>& hinge = model.hinges[static_cast<std::size_t>(hinges_.first) + n];
    const auto x = [&](int k) -> const Vec3<Real>& {
      return point.x[static_cast<std::size_t>(hinge.x[k])];
    };
    const HingeAngle<Real> angle = hinge_angle(x(0), x(1), x(2), x(3), hinge.smallest_normal2);
    Real turning = 0;
    for (std::size_t k = 0; k < 4; ++k)
      turning += angle.gradient[k].dot(point.v[static_cast<std::size_t>(hinge.x[k])]);
    const Real moment = hinge_moment(hinge, angle.theta, turning);
    HingeTerm& term = hinge_terms_[n];
    term.gradient = angle.gradient;
    term.stiffness = hinge.stiffness + hinge.damping * point.rate;
    for (std::size_t k = 0; k < 4; ++k) {
      force[static_cast<std::size_t>(hinge.x[k])] += angle.gradient[k] * moment;
      add_to(diagonal_[static_cast<std::size_t>(term.x[k])],
             along_and_across<Real>(0, term.stiffness, angle.gradient[k]));
    }
  }
  for (std::size_t i = 0; i < inverse_.size(); ++i)
    inverse_[i] = free_[i] > 0 ? inverse_of(diagonal_[i]) : SymmetricBlock<Real>{};
  if (factor_.is_worn(uses_)) factored_ = false;
  if (!factored_ && !factor_.empty()) factor();
}

template <class Real>
void ElementSystem<Real>::load(const Vec3Array<Real>& from, Real* to) const {
  for (Index i = 0; i < particles_.count; ++i)
    at(to, i) = from[static_cast<std::size_t>(particles_.first + i)];
}

template <class Real>
void ElementSystem<Real>::add(const Real* from, Vec3Array<Real>& to) const {
  for (Index i = 0; i < particles_.count; ++i)
    to[static_cast<std::size_t>(particles_.first + i)] += at(from, i);
}

template <class Real>
void ElementSystem<Real>::apply(const Real* p, Real* y) const {
  for (Index i = 0; i < particles_.count; ++i)
    at(y, i) = times<Real>(own_[static_cast<std::size_t>(i)], at(p, i));
  for (std::size_t n = 0; n < ends_.size(); ++n) {
    const auto [i, j] = ends_[n];
    const Vec3<Real> product = times<Real>(blocks_[n], at(p, i) - at(p, j));
    at(y, i) += product;
    at(y, j) -= product;
  }
  for (const MembraneElement& element : membrane_) {
    const MembraneTriangle<Real>& t = element.triangle;
    const std::array<Vec3<Real>, 3> push =
        element.term.times(t, {at(p, t.x[0]), at(p, t.x[1]), at(p, t.x[2])});
    for (std::size_t k = 0; k < 3; ++k) at(y, t.x[k]) += push[k];
  }
  for (const Stencil& stencil : stencils_) {
    Vec3<Real> sum = Vec3<Real>::Zero();
    for (int n = 0; n < stencil.count; ++n) sum += at(p, stencil.x[n]) * stencil.weight[n];
    sum *= stencil.stiffness;
    for (int n = 0; n < stencil.count; ++n) at(y, stencil.x[n]) += sum * stencil.weight[n];
  }
  for (const HingeTerm& term : hinge_terms_) {
    Real turn = 0;
    for (std::size_t k = 0; k < 4; ++k) turn += term.gradient[k].dot(at(p, term.x[k]));
    turn *= term.stiffness;
    for (std::size_t k = 0; k < 4; ++k) at(y, term.x[k]) += term.gradient[k] * turn;
  }
  for (Index i = 0; i < particles_.count; ++i) at(y, i) *= free_[static_cast<std::size_t>(i)];
}

template <class Real>
void ElementSystem<Real>::precondition(const Real* r, Real* z) {
  if (factored_) {
    factor_.solve(r, z);
    ++uses_;
    return;
  }
  for (Index i = 0; i < particles_.count; ++i)
    at(z, i) = times<Real>(inverse_[static_cast<std::size_t>(i)], at(r, i));
}

template class ElementSystem<float>;
template class ElementSystem<double>;

}  // namespace weft
