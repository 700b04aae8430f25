#include "core/solver/implicit/implicit.h"

#include <algorithm>
#include <cmath>

#include "core/solver/implicit/implicit_step.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// Energy out of nothing that is put down to rounding, as a part of the kinetic and elastic one.
constexpr double kRounding = 1e-4;
/// Part of the energy that was lost that may come back, kept each tick: for a moment the scheme has
/// what a wave brings back in the next.
constexpr double kKeptCredit = 0.9;
/// Longest way of a particle beside the others in a substep that the guard shall keep apart, in
/// mean lengths of the edges.
constexpr double kFarWay = 1;
/// Into how many pieces a substep is cut at the most.
constexpr int kMostPieces = 64;
/// Part of the kinetic and elastic energy that a violent substep takes.
constexpr double kViolentLoss = 0.1;
/// Speed of all particles whose energy a violently shaken cloth has at least [m/s].
constexpr double kViolentSpeed = 1;
/// And how far a spring of it is stretched or crushed. Waves in a stiff cloth that snaps taut may
/// have as much energy, and may go.
constexpr double kViolentStrain = 0.1;

/// Who was moved by others since the tick before starts anew.
template <class Real>
void check_history(const ClothState<Real>& state, double dt, ImplicitWorkspace<Real>& work) {
  const bool same_step = work.last_dt == dt;
  bool all_same = same_step;
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const bool same = state.x[i] == work.end_x[i] && state.v[i] == work.end_v[i];
    if (!same_step || !same || !(state.inverse_mass[i] > 0)) work.history[i] = 0;
    all_same = all_same && same;
  }
  work.credit = all_same ? work.credit * kKeptCredit : 0;
  work.last_dt = dt;
}

/// What is not gravity's [J].
double mechanical(const Energies& e) {
  return e.kinetic + e.stretch + e.bending;
}

template <class Real>
EnergyReading energies_at(const Step<Real>& step, const Vec3Array<Real>& x,
                          const Vec3Array<Real>& v) {
  const StageTimer timer(step.profile, Stage::diagnostics, 1);
  const ElasticEnergy elastic = step.work.energy.elastic_energy(step.model, x);
  EnergyReading reading;
  reading.largest_strain = elastic.largest_strain;
  Energies& e = reading.energies;
  e.stretch = elastic.stretch;
  e.bending = elastic.bending;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto mass = static_cast<double>(step.model.mass[i]);
    e.kinetic += 0.5 * mass * static_cast<double>(v[i].squaredNorm());
    e.gravity -= mass * static_cast<double>(step.surroundings.gravity.dot(x[i]));
  }
  return reading;
}

/// What drag took over the present ways [J].
template <class Real>
double drag_work(const Step<Real>& step) {
  double sum = 0;
  for (std::size_t i = 0; i < step.work.way.size(); ++i)
    sum += static_cast<double>(step.model.mass[i] * step.work.v[i].dot(step.work.way[i]));
  return step.surroundings.drag * sum;
}

/// Whether no energy came from nowhere in a substep, and if so what of what was lost is left.
bool explained(const Energies& before, const Energies& after, double work, double& credit) {
  const double excess = after.total() - before.total() - work - credit;
  const double rounding = kRounding * (mechanical(before) + std::abs(work) + 1e-9);
  if (!(excess <= rounding)) return false;
  credit = std::max(0.0, -excess);
  return true;
}

/// What the air gives to some particles and takes from others over the present ways, together [J].
template <class Real>
double air_turnover(const Step<Real>& step) {
  if (!step.surroundings.air) return 0;
  double sum = 0;
  for (std::size_t i = 0; i < step.work.way.size(); ++i)
    sum += std::abs(static_cast<double>(step.work.air[i].dot(step.work.way[i])));
  return sum;
}

/// Whether the substep brought energy to a cloth that is torn or shaken violently, or took much of
/// what it has. What the air's own work is off by does not count.
/// @param sound  it brought none
template <class Real>
bool is_violent(const Step<Real>& step, const EnergyReading& before, const EnergyReading& after,
                double work, bool sound) {
  const double had = mechanical(before.energies);
  if (!(had > step.work.violent_energy)) return false;
  if (!(std::max(before.largest_strain, after.largest_strain) > kViolentStrain)) return false;
  const double lost = before.energies.total() + work - after.energies.total() - drag_work(step);
  return !sound || lost > kViolentLoss * had + air_turnover(step);
}

/// The ways of a substep in pieces by backward Euler, `work.way`, `x` and `v` at its end.
/// @returns whether all linear systems were solved
template <class Real>
bool find_ways_in_pieces(Step<Real>& step, Real begin, Real end, int pieces, double& brought) {
  ImplicitWorkspace<Real>& work = step.work;
  ClothState<Real>& state = step.state;
  work.start_x = state.x;
  work.start_v = state.v;
  const Real whole = step.dt;
  step.dt = whole / static_cast<Real>(pieces);
  step.damped = true;
  bool solved = true;
  brought = 0;
  for (int k = 1; k <= pieces; ++k) {
    const Real passed = static_cast<Real>(k) / static_cast<Real>(pieces);
    solved = find_ways(step, begin + (end - begin) * passed) && solved;
    brought += outer_work(step);
    state.x = work.x;
    state.v = work.v;
  }
  for (std::size_t i = 0; i < state.x.size(); ++i) work.way[i] = work.x[i] - work.start_x[i];
  state.x = work.start_x;
  state.v = work.start_v;
  step.dt = whole;
  return solved;
}

/// The ways of a substep that brings no energy from nowhere.
/// @param after    gets the energies to which they lead
/// @param brought  gets the work of air, shots and hands [J]
/// @returns        false if there are none, or if the substep is violent and that is asked for
template <class Real>
bool find_sound_ways(Step<Real>& step, Real begin, Real end, const EnergyReading& before,
                     EnergyReading& after, double& brought) {
  ImplicitWorkspace<Real>& work = step.work;
  step.damped = false;
  bool solved = find_ways(step, end);
  brought = outer_work(step);
  for (int pieces = 1;; pieces *= 2) {
    after = energies_at(step, work.x, work.v);
    const bool sound = solved && explained(before.energies, after.energies, brought, work.credit);
    if (work.refuses && is_violent(step, before, after, brought, sound)) {
      work.violent = true;
      return false;
    }
    if (sound) return true;
    if (pieces > kMostPieces) return solved;
    solved = find_ways_in_pieces(step, begin, end, pieces, brought);
  }
}

/// Whether anybody goes so far beside the others in a substep that the guard would look at half the
/// cloth to keep him off it, and would stop him on the way.
template <class Real>
bool goes_far(const Step<Real>& step, const Collision<Real>& collision) {
  if (!collision.guard) return false;
  const Vec3Array<Real>& ways = step.work.way;
  Vec3<Real> mean = Vec3<Real>::Zero();
  for (const Vec3<Real>& way : ways) mean += way;
  mean /= static_cast<Real>(ways.size());
  const auto far = static_cast<Real>(step.work.far_way);
  return std::any_of(ways.begin(), ways.end(), [&mean, far](const Vec3<Real>& way) {
    return (way - mean).squaredNorm() > far * far;
  });
}

/// Goes the ways as far as contact lets. Who was not hindered has the scheme's velocity at the end;
/// who was has the mean one, and begins anew.
/// @returns the motion that contact must not see, if there is one; nothing has moved then
template <class Real>
std::optional<BlowUp> move(Step<Real>& step, const Collision<Real>& collision) {
  ClothState<Real>& state = step.state;
  ImplicitWorkspace<Real>& work = step.work;
  collision.before_kick(state);
  std::swap(state.v, work.last_v);  // the velocities before
  if (collision.empty()) {
    std::copy(work.v.begin(), work.v.end(), state.v.begin());
    std::copy(work.x.begin(), work.x.end(), state.x.begin());
    std::copy(work.way.begin(), work.way.end(), work.last_way.begin());
    for (std::size_t i = 0; i < state.x.size(); ++i) work.history[i] = !step.damped;
    return std::nullopt;
  }
  for (std::size_t i = 0; i < state.x.size(); ++i) state.v[i] = work.way[i] / step.dt;
  if (const auto found = find_blow_up(step.model, state, step.dt)) return found;
  collision.before_drift(state, step.dt, step.profile);
  for (std::size_t i = 0; i < state.x.size(); ++i) state.x[i] += state.v[i] * step.dt;
  collision.after_drift(state, step.dt, step.profile);
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const bool free = state.v[i] == (work.way[i] / step.dt).eval();
    work.history[i] = free && !step.damped && step.movable(i);
    if (!free) continue;
    state.v[i] = work.v[i];
    work.last_way[i] = work.way[i];
  }
  return std::nullopt;
}

}  // namespace

template <class Real>
void ImplicitWorkspace<Real>::prepare(const ClothModel<Real>& model) {
  systems.clear();
  energy.prepare(model);
  std::size_t longest = 0;
  for (const ClothPart<Real>& part : model.parts) {
    if (GridSystem<Real>::fits(model, part))
      systems.push_back(GridSystem<Real>(model, part));
    else
      systems.push_back(ElementSystem<Real>(model, part));
    longest = std::max(longest, std::visit([](const auto& s) { return s.size(); }, systems.back()));
  }
  for (Vec3Array<Real>* array :
       {&way, &x, &v, &force, &air, &last_way, &last_v, &end_x, &end_v, &start_x, &start_v})
    array->assign(model.mass.size(), Vec3<Real>::Zero());
  history.assign(model.mass.size(), 0);
  inertia.assign(model.mass.size(), Real(0));
  air_blocks.assign(model.mass.size(), {});
  starts.assign(model.parts.size(), 0);
  for (GridVector<Real>* vector : {&residual, &step, &direction, &product, &preconditioned})
    vector->assign(longest, Real(0));
  last_dt = credit = 0;
  double lengths = 0, mass = 0;
  for (const Edge& edge : model.edges) {
    const auto end = [&](std::size_t k) {
      return model.rest_positions[static_cast<std::size_t>(edge[k])];
    };
    lengths += static_cast<double>((end(0) - end(1)).norm());
  }
  const double mean_length =
      lengths / static_cast<double>(std::max<std::size_t>(model.edges.size(), 1));
  far_way = kFarWay * mean_length;
  for (const Real m : model.mass) mass += static_cast<double>(m);
  violent_energy = mass * kViolentSpeed * kViolentSpeed / 2;
}

template <class Real>
void ImplicitWorkspace<Real>::forget() {
  std::fill(history.begin(), history.end(), 0);
  last_dt = credit = 0;
}

template <class Real>
AdvanceResult advance_implicit(const ClothModel<Real>& model,
                               const Surroundings<Real>& surroundings, const ImplicitDef& solver,
                               double dt, int substeps, Grabs<Real>& grabs,
                               const Collision<Real>& collision, ClothState<Real>& state,
                               ImplicitWorkspace<Real>& work, Profile& profile) {
  Step<Real> step{model, surroundings, solver, static_cast<Real>(dt), grabs, state, work, profile};
  AdvanceResult result;
  EnergyReading reading = energies_at(step, state.x, state.v);
  result.before = reading.energies;
  check_history(state, dt, work);
  take_hands(step);
  for (typename ImplicitWorkspace<Real>::System& system : work.systems)
    std::visit([&](auto& s) { s.set_pinned(state.inverse_mass); }, system);
  work.unsolved = work.violent = work.touching = false;
  see_velocities(state.v, grabs);
  for (int s = 0; s < substeps; ++s) {
    stop_point();
    const Real count = static_cast<Real>(substeps), begin = static_cast<Real>(s) / count;
    const EnergyReading before = reading;
    double brought = 0;
    const Real end = static_cast<Real>(s + 1) / count;
    if (!find_sound_ways(step, begin, end, before, reading, brought)) work.unsolved = true;
    if (work.violent) return result;
    result.damped_substeps += step.damped ? 1 : 0;
    result.work += brought;
    work.touching = work.refuses && goes_far(step, collision);
    if (work.touching) return result;
    result.blow_up = move(step, collision);
    if (result.blow_up) return result;
    work.touching = work.refuses && collision.touches(state);
    if (work.touching) return result;
    if (!collision.empty()) reading = energies_at(step, state.x, state.v);
  }
  work.end_x = state.x;
  work.end_v = state.v;
  result.after = reading.energies;
  result.largest_strain = reading.largest_strain;
  return result;
}

#define WEFT_INSTANTIATE(Real)                                                                \
  template struct ImplicitWorkspace<Real>;                                                    \
  template AdvanceResult advance_implicit(const ClothModel<Real>&, const Surroundings<Real>&, \
                                          const ImplicitDef&, double, int, Grabs<Real>&,      \
                                          const Collision<Real>&, ClothState<Real>&,          \
                                          ImplicitWorkspace<Real>&, Profile&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
