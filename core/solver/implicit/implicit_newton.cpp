// Newton's method for one substep of the implicit solver.

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/forces/air/air_force.h"
#include "core/solver/implicit/conjugate_gradients.h"
#include "core/solver/implicit/constants.h"
#include "core/solver/implicit/implicit_step.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// Positions and velocities that result from the present displacements.
template <class Real>
void place(Step<Real>& step) {
  ImplicitWorkspace<Real>& work = step.work;
  for (std::size_t i = 0; i < work.x.size(); ++i) {
    work.x[i] = step.state.x[i] + work.displacement[i];
    work.near[i] = work.start_near[i] + work.displacement[i];
    if (!step.movable(i)) {
      work.v[i] = Vec3<Real>::Zero();
      continue;
    }
    const Scheme<Real> scheme(step, i);
    work.v[i] = work.displacement[i] * scheme.rate - scheme.offset;
  }
}

/// Gravity, damping and inertia, with their terms of the matrix.
template <class Real>
void add_own(Step<Real>& step) {
  ImplicitWorkspace<Real>& work = step.work;
  const auto damping = static_cast<Real>(step.surroundings.damping);
  for (std::size_t i = 0; i < work.x.size(); ++i) {
    const Real mass = step.model.mass[i];
    const Scheme<Real> scheme(step, i);
    work.force[i] =
        (step.surroundings.gravity - work.v[i] * (scheme.rate + damping) + scheme.before) * mass;
    work.inertia[i] = mass * scheme.rate * (scheme.rate + damping);
  }
}

/// Air on all triangles. The matrix treats each corner as if the others moved with it.
template <class Real>
void add_air(Step<Real>& step) {
  const Surroundings<Real>& around = step.surroundings;
  if (!around.air) return;
  ImplicitWorkspace<Real>& work = step.work;
  std::fill(work.air.begin(), work.air.end(), Vec3<Real>::Zero());
  std::fill(work.air_blocks.begin(), work.air_blocks.end(), SymmetricBlock<Real>{});
  constexpr Real kThird = Real(1) / 3;
  const Real rate = Real(1.5) / step.dt;
  for (std::size_t p = 0; p < step.model.parts.size(); ++p) {
    if (step.state.is_asleep(p)) continue;
    const ClothPart<Real>& part = step.model.parts[p];
    const StageTimer timer(step.profile, Stage::air,
                           static_cast<std::size_t>(part.triangles.count));
    const auto pressure = static_cast<Real>(0.5 * around.air_density * part.fabric.air_normal);
    const auto skin = static_cast<Real>(part.fabric.air_tangential);
    for (Index t = part.triangles.first; t < part.triangles.end(); ++t) {
      const Triangle& triangle = step.model.triangles[static_cast<std::size_t>(t)];
      const auto a = static_cast<std::size_t>(triangle[0]),
                 b = static_cast<std::size_t>(triangle[1]),
                 c = static_cast<std::size_t>(triangle[2]);
      const Vec3<Real> normal = (work.x[b] - work.x[a]).cross(work.x[c] - work.x[a]);
      const Real doubled = normal.norm();
      if (!(doubled > 0)) continue;
      const Vec3<Real> u = ((around.wind[a] - work.v[a]) + (around.wind[b] - work.v[b]) +
                            (around.wind[c] - work.v[c])) *
                           kThird;
      const Vec3<Real> third = air_force(normal, u, pressure, skin) * kThird;
      const Real share = Real(0.5) * doubled * kThird * rate;
      const Vec3<Real> unit = normal / doubled;
      const Real across = 2 * pressure * std::abs(u.dot(unit));
      const SymmetricBlock<Real> block =
          along_and_across<Real>(skin * share, (across - skin) * share, unit);
      for (const std::size_t i : {a, b, c}) {
        work.air[i] += third;
        for (std::size_t e = 0; e < 6; ++e) work.air_blocks[i][e] += block[e];
      }
    }
  }
}

/// Forces of the live hands at the end of the substep, with their terms of the matrix.
/// @param progress  fraction of the tick that has passed then, 0 to 1
template <class Real>
void add_hands(Step<Real>& step, Real progress) {
  ImplicitWorkspace<Real>& work = step.work;
  const StageTimer timer(step.profile, Stage::attachments, work.hand_count);
  for (std::size_t h = 0; h < work.hand_count; ++h) {
    HandTerm<Real>& hand = work.hands[h];
    assert(hand.grab < step.grabs.list.size() && "take_hands comes first");
    Grab<Real>& grab = step.grabs.list[hand.grab];
    const auto stiffness = static_cast<Real>(grab.def.stiffness);
    const Vec3<Real> target = grab.path_begin + (grab.path_end - grab.path_begin) * progress;
    Vec3<Real> velocity = Vec3<Real>::Zero();
    for (std::size_t n = 0; n < grab.particles.size(); ++n)
      velocity += work.v[static_cast<std::size_t>(grab.particles[n])] * grab.weights[n];
    const Vec3<Real> pull =
        (target - held_point(grab, work.x)) * stiffness - velocity * grab.damping;
    const Real size = pull.norm(), most = static_cast<Real>(grab.def.max_force);
    const Real fraction = size > most ? most / size : Real(1);
    grab.force = pull * fraction;
    hand.stiffness = fraction * (stiffness + grab.damping * Real(1.5) / step.dt);
    for (std::size_t n = 0; n < grab.particles.size(); ++n) {
      grab.impulse[n] = grab.force * (grab.weights[n] * step.dt);
      work.force[static_cast<std::size_t>(grab.particles[n])] += grab.force * grab.weights[n];
    }
  }
}

/// y += the hands' terms of the matrix, times p.
template <class Real>
void apply_hands(const ImplicitWorkspace<Real>& work, std::size_t part, const Real* p, Real* y) {
  for (std::size_t h = 0; h < work.hand_count; ++h) {
    const HandTerm<Real>& hand = work.hands[h];
    if (hand.part != part) continue;
    for (std::size_t d = 0; d < 3; ++d) {
      Real sum = 0;
      for (std::size_t n = 0; n < hand.places.size(); ++n)
        sum += hand.weights[n] * p[hand.places[n][d]];
      sum *= hand.stiffness;
      for (std::size_t n = 0; n < hand.places.size(); ++n)
        y[hand.places[n][d]] += hand.weights[n] * sum;
    }
  }
}

/// Forces and matrix at the present displacements.
template <class Real>
void linearise(Step<Real>& step, Real progress) {
  ImplicitWorkspace<Real>& work = step.work;
  place(step);
  add_own(step);
  add_air(step);
  if (step.surroundings.air)
    for (std::size_t i = 0; i < work.force.size(); ++i) work.force[i] += work.air[i];
  add_sling_forces(step.grabs, work.force);
  add_hands(step, progress);
  const NewtonPoint<Real> point{work.near, work.v, Real(1.5) / step.dt, work.inertia,
                                step.surroundings.air ? &work.air_blocks : nullptr};
  for (std::size_t p = 0; p < step.model.parts.size(); ++p) {
    if (step.state.is_asleep(p)) continue;
    const ClothPart<Real>& part = step.model.parts[p];
    const StageTimer timer(step.profile, Stage::stretch, membrane_elements(part));
    step.profile[Stage::bending].work +=
        quadratic_stencil_count(part) + static_cast<std::size_t>(part.hinges.count);
    std::visit([&](auto& system) { system.linearise(step.model, point, work.force); },
               work.systems[p]);
  }
  for (std::size_t i = 0; i < work.force.size(); ++i)
    if (!step.movable(i)) work.force[i].setZero();
}

/// Moves a part that nothing holds by what the linear solver left over of the sum of all forces:
/// internal ones have no part in that, so it would be momentum out of nothing.
template <class Real, class System>
void keep_momentum(Step<Real>& step, std::size_t p, const System& system) {
  ImplicitWorkspace<Real>& work = step.work;
  const IndexRange& range = step.model.parts[p].particles;
  Vec3d left = Vec3d::Zero();
  SymmetricBlock<double> total{};
  const auto add_to_diagonal = [&total](double value) {
    for (double* number : {&total[0], &total[3], &total[5]}) *number += value;
  };
  for (Index k = range.first; k < range.end(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    if (!step.movable(i)) return;
    const std::array<std::size_t, 3> places = system.places(k - range.first);
    for (std::size_t d = 0; d < 3; ++d)
      left[static_cast<Eigen::Index>(d)] += static_cast<double>(work.residual[places[d]]);
    add_to_diagonal(static_cast<double>(work.inertia[i]));
    for (std::size_t e = 0; step.surroundings.air && e < total.size(); ++e)
      total[e] += static_cast<double>(work.air_blocks[i][e]);
  }
  for (std::size_t h = 0; h < work.hand_count; ++h) {
    if (work.hands[h].part == p) add_to_diagonal(static_cast<double>(work.hands[h].stiffness));
  }
  const Vec3<Real> shift = times(inverse_of(total), left).template cast<Real>();
  if (!shift.allFinite()) return;
  for (Index k = range.first; k < range.end(); ++k)
    work.displacement[static_cast<std::size_t>(k)] += shift;
}

/// Newton step of a part. @returns whether it was found
template <class Real>
bool take_newton_step(Step<Real>& step, std::size_t p, bool first, double& start) {
  ImplicitWorkspace<Real>& work = step.work;
  return std::visit(
      [&](auto& system) {
        const StageTimer timer(step.profile, Stage::linear_systems, 0);
        if (work.systems.size() > 1) {  // others may have left values at zeros of this one
          for (GridVector<Real>* vector : {&work.residual, &work.product, &work.preconditioned})
            std::fill(vector->begin(), vector->end(), Real(0));
        }
        system.load(work.force, work.residual.data());
        const LinearVectors<Real> vectors{work.residual.data(),       work.step.data(),
                                          work.direction.data(),      work.product.data(),
                                          work.preconditioned.data(), system.size()};
        const LinearEffort effort = system.effort();
        const double tolerance = effort.tolerance * step.solver.tolerance;
        const double enough = first ? 0 : kEnoughOfTolerance * tolerance * start;
        const LinearSolution found = solve_linear(
            vectors, tolerance, enough, effort.iterations,
            [&](const Real* q, Real* y) {
              system.apply(q, y);
              apply_hands(work, p, q, y);
            },
            [&](const Real* r, Real* z) { system.precondition(r, z); });
        step.profile[Stage::linear_systems].work += static_cast<std::size_t>(found.iterations);
        if (first) start = found.start;
        system.add(work.step.data(), work.displacement);
        if (found.solved) keep_momentum(step, p, system);
        return found.solved;
      },
      work.systems[p]);
}

/// Limits the mean velocities of what hands hold to kFastestHeld, and subtracts from a hand's force
/// what it then does not give.
template <class Real>
void hold_back(Step<Real>& step) {
  ImplicitWorkspace<Real>& work = step.work;
  const Real longest = static_cast<Real>(kFastestHeld) * step.dt;
  for (std::size_t h = 0; h < work.hand_count; ++h) {
    Grab<Real>& grab = step.grabs.list[work.hands[h].grab];
    for (std::size_t n = 0; n < grab.particles.size(); ++n) {
      const auto i = static_cast<std::size_t>(grab.particles[n]);
      Vec3<Real>& displacement = work.displacement[i];
      const Real length = displacement.norm();
      if (!(length > longest)) continue;
      const Vec3<Real> lost = displacement * (1 - longest / length);
      const Real rate = Scheme<Real>(step, i).rate;
      grab.force -= lost * (step.model.mass[i] * rate * rate);
      displacement -= lost;
    }
  }
}

}  // namespace

template <class Real>
void take_hands(Step<Real>& step) {
  ImplicitWorkspace<Real>& work = step.work;
  work.hand_count = 0;
  for (std::size_t g = 0; g < step.grabs.list.size(); ++g) {
    Grab<Real>& grab = step.grabs.list[g];
    if (grab.def.mode != GrabMode::live) continue;
    assert(!grab.particles.empty());
    if (work.hands.size() == work.hand_count) work.hands.emplace_back();
    HandTerm<Real>& hand = work.hands[work.hand_count++];
    hand.grab = g;
    hand.part = 0;
    hand.given.setZero();
    hand.places.clear();
    hand.weights.clear();
    while (!step.model.parts[hand.part].particles.contains(grab.particles.front())) ++hand.part;
    assert(hand.part < step.model.parts.size());
    const Index first = step.model.parts[hand.part].particles.first;
    for (std::size_t n = 0; n < grab.particles.size(); ++n) {
      const Index i = grab.particles[n];
      hand.places.push_back(
          std::visit([&](const auto& s) { return s.places(i - first); }, work.systems[hand.part]));
      hand.weights.push_back(step.movable(static_cast<std::size_t>(i)) ? grab.weights[n] : Real(0));
    }
  }
}

template <class Real>
bool solve_displacements(Step<Real>& step, Real progress) {
  ImplicitWorkspace<Real>& work = step.work;
  assert(step.dt > 0);
  assert(progress > 0 && progress < Real(1.001));
  for (std::size_t i = 0; i < work.displacement.size(); ++i)
    work.displacement[i] =
        step.movable(i) ? (step.state.v[i] * step.dt).eval() : Vec3<Real>::Zero().eval();
  bool solved = true;
  for (int k = 0; k < step.solver.iterations; ++k) {
    linearise(step, progress);
    for (std::size_t p = 0; p < step.model.parts.size(); ++p) {
      stop_point();
      if (!step.state.is_asleep(p))
        solved = take_newton_step(step, p, k == 0, work.starts[p]) && solved;
    }
  }
  hold_back(step);
  place(step);
  return solved;
}

template <class Real>
double outer_work(const Step<Real>& step) {
  const ImplicitWorkspace<Real>& work = step.work;
  double sum = 0;
  if (step.surroundings.air) {
    for (std::size_t i = 0; i < work.displacement.size(); ++i)
      sum += static_cast<double>(work.air[i].dot(work.displacement[i]));
  }
  const auto add = [&](const auto& held, const Vec3<Real>& force) {
    for (std::size_t n = 0; n < held.particles.size(); ++n)
      sum += static_cast<double>(
          force.dot(work.displacement[static_cast<std::size_t>(held.particles[n])]) *
          held.weights[n]);
  };
  for (const SlingImpulse<Real>& impulse : step.grabs.impulses) add(impulse, impulse.force);
  for (std::size_t h = 0; h < work.hand_count; ++h) {
    const Grab<Real>& grab = step.grabs.list[work.hands[h].grab];
    add(grab, grab.force);
  }
  return sum;
}

template <class Real>
void meter_displacements(Step<Real>& step) {
  if (!step.metered) return;
  const ImplicitWorkspace<Real>& work = step.work;
  EnergyFlows& flows = step.flows;
  Vec3Array<double> moved(work.displacement.size());
  const auto dt = static_cast<double>(step.dt);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    moved[i] = work.displacement[i].template cast<double>();
    flows.drag += step.surroundings.damping * static_cast<double>(step.model.mass[i]) *
                  work.v[i].template cast<double>().dot(moved[i]);
    if (!step.surroundings.air) continue;
    const Vec3d air = work.air[i].template cast<double>();
    const Vec3d wind = step.surroundings.wind[i].template cast<double>() * dt;
    flows.wind += air.dot(wind);
    flows.air += air.dot(wind - moved[i]);
  }
  const auto work_of = [&moved](const auto& held, const Vec3<Real>& force) {
    double sum = 0;
    for (std::size_t n = 0; n < held.particles.size(); ++n)
      sum += force.template cast<double>().dot(moved[static_cast<std::size_t>(held.particles[n])]) *
             static_cast<double>(held.weights[n]);
    return sum;
  };
  for (const SlingImpulse<Real>& impulse : step.grabs.impulses)
    flows.slings += work_of(impulse, impulse.force);
  for (std::size_t h = 0; h < work.hand_count; ++h) {
    const Grab<Real>& grab = step.grabs.list[work.hands[h].grab];
    flows.hands += work_of(grab, grab.force);
  }
  flows.damping += dashpot_loss(step.model, work.x, work.v, moved);
}

template <class Real>
void book_forces(Step<Real>& step) {
  ImplicitWorkspace<Real>& work = step.work;
  const auto dt = static_cast<double>(step.dt);
  for (std::size_t h = 0; h < work.hand_count; ++h) {
    HandTerm<Real>& hand = work.hands[h];
    hand.given += step.grabs.list[hand.grab].force.template cast<double>() * dt;
  }
  if (!step.held) return;
  step.held->act(step.surroundings, work.x, work.v, dt);
  step.held->pull(step.grabs, dt);
}

template <class Real>
void take_back_forces(Step<Real>& step) {
  for (std::size_t h = 0; h < step.work.hand_count; ++h) step.work.hands[h].given.setZero();
  if (step.held) step.held->take_back();
}

template <class Real>
void finish_forces(Step<Real>& step) {
  for (std::size_t h = 0; h < step.work.hand_count; ++h) {
    HandTerm<Real>& hand = step.work.hands[h];
    step.grabs.list[hand.grab].given += hand.given;
    hand.given.setZero();
  }
  if (step.held) step.held->keep();
}

#define WEFT_INSTANTIATE(Real)                          \
  template void take_hands(Step<Real>&);                \
  template bool solve_displacements(Step<Real>&, Real); \
  template double outer_work(const Step<Real>&);        \
  template void meter_displacements(Step<Real>&);       \
  template void book_forces(Step<Real>&);               \
  template void take_back_forces(Step<Real>&);          \
  template void finish_forces(Step<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
