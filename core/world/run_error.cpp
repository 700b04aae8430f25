// Repeats a run with finer steps, with noise and on a finer mesh, and compares.

#include "core/world/run_error.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include "core/diagnostics/constants.h"
#include "core/diagnostics/measurements.h"
#include "core/world/constants.h"
#include "core/world/cost.h"

namespace weft {
namespace {

/// A mesh has no rows, and springs that are given between particles mean another cloth on more
/// rows.
bool is_plain_grid(const ClothDef& cloth) {
  return !cloth.mesh && !cloth.direct_springs && cloth.skip_stiffness == 0;
}

int twice_the_rows(int rows) {
  return 2 * (rows - 1) + 1;
}

template <class Real>
double rms_distance(const Vec3Array<Real>& a, const Vec3Array<Real>& b) {
  assert(a.size() == b.size() && !a.empty());
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += (a[i].template cast<double>() - b[i].template cast<double>()).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// Whether a triangle of a cloth faces away from where the cloth faces on average.
template <class Real>
bool is_folded(const ClothModel<Real>& model, const Vec3Array<Real>& x) {
  const auto normal = [&](Index t) {
    const auto& corners = model.triangles[static_cast<std::size_t>(t)];
    const auto at = [&](std::size_t c) {
      return x[static_cast<std::size_t>(corners[c])].template cast<double>().eval();
    };
    return (at(1) - at(0)).cross(at(2) - at(0)).eval();
  };
  for (const ClothPart<Real>& part : model.parts) {
    Vec3d mean = Vec3d::Zero();
    for (Index t = part.triangles.first; t < part.triangles.end(); ++t) mean += normal(t);
    for (Index t = part.triangles.first; t < part.triangles.end(); ++t)
      if (normal(t).dot(mean) <= 0) return true;
  }
  return false;
}

template <class Real>
double drape_of(const World<Real>& world) {
  for (const NamedNumber& number : world.measurements())
    if (number.name == "drape_coefficient_percent") return number.value;
  return std::numeric_limits<double>::quiet_NaN();
}

template <class Real>
bool stopped(const World<Real>& world) {
  const std::optional<Divergence>& divergence = world.report().divergence;
  return divergence && divergence->remedy == DivergenceRemedy::stopped_cloth;
}

}  // namespace

std::string what_forbids_rows(const WorldDef& def) {
  if (!std::all_of(def.cloths.begin(), def.cloths.end(), is_plain_grid))
    return "a cloth is a mesh or has springs of its own";
  if (def.start) return "it starts from positions of particles";
  for (const PinDef& pin : def.pins)
    if (std::holds_alternative<Index>(pin.place)) return "a pin names a particle";
  for (const DisturbanceDef& disturbance : def.disturbances)
    if (disturbance.noise > 0 || disturbance.gather > 0) return "particles are disturbed by chance";
  return {};
}

WorldDef with_twice_the_rows(WorldDef def) {
  assert(what_forbids_rows(def).empty());
  for (ClothDef& cloth : def.cloths) {
    cloth.rows = twice_the_rows(cloth.rows);
    cloth.columns = twice_the_rows(cloth.columns);
  }
  return def;
}

template <class Real>
RunError<Real>::RunError(const WorldDef& def, const Runtime& runtime, const World<Real>& run)
    : twice_(std::make_unique<World<Real>>(def, runtime)),
      four_(std::make_unique<World<Real>>(def, runtime)),
      noisy_(std::make_unique<World<Real>>(def, runtime)) {
  assert(run.tick() == 0);
  twice_->refine_substeps(2);
  four_->refine_substeps(4);
  const double substeps = four_->cost_in(four_->environment()).substeps;
  if (substeps > kMostSubsteps)
    throw DefinitionError("--error", std::to_string(static_cast<long>(substeps)) + " substeps",
                          "at most " + std::to_string(kMostSubsteps) + " substeps a tick",
                          "lower the stiffness or the resolution, or raise tick_rate");
  add_noise();
  build_finer_mesh(def, runtime);
  const Differences start = differences(run, *noisy_);
  for (std::size_t k = 0; k < kQuantities; ++k) time_[k] = space_[k] = ErrorWatch(start[k]);
}

template <class Real>
void RunError<Real>::add_noise() {
  ClothState<Real>& state = noisy_->state();
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    if (state.inverse_mass[i] == 0) continue;
    // Numbers from -1 to 1 have a mean square of 1/3, so that three of them have one of 1.
    for (int axis = 0; axis < 3; ++axis)
      state.x[i][axis] +=
          static_cast<Real>(kStartNoise * noise_at(1, i, static_cast<std::uint64_t>(axis)));
  }
  noisy_->accept_state();
}

template <class Real>
void RunError<Real>::build_finer_mesh(const WorldDef& def, const Runtime& runtime) {
  space_forbidden_ = what_forbids_rows(def);
  if (!space_forbidden_.empty()) return;
  const auto is_cut = [](const ClothDef& cloth) { return cloth.outline != Outline::rectangle; };
  folded_ = std::any_of(def.cloths.begin(), def.cloths.end(), is_cut);
  try {
    const WorldDef finer = with_twice_the_rows(def);
    check_size(finer);
    finer_ = std::make_unique<World<Real>>(finer, runtime);
    check_cost(finer_->cost_in(finer_->environment()), "rows", "twice");
  } catch (const DefinitionError& error) {
    finer_.reset();
    space_forbidden_ = std::string("twice the rows are refused: ") + error.what();
  }
}

template <class Real>
double RunError<Real>::relative_cost(const World<Real>& run) const {
  double updates = 0;
  for (const auto* world : {&twice_, &four_, &noisy_, &finer_})
    if (*world) updates += (*world)->cost_in((*world)->environment()).updates();
  return updates / run.cost_in(run.environment()).updates();
}

template <class Real>
typename RunError<Real>::Reading RunError<Real>::read(const World<Real>& world) {
  Reading reading;
  reading.strain = world.report().largest_strain;
  reading.energy = world.report().energies.total();
  const Vec3d gravity = world.environment().gravity;
  const Vec3d up = gravity.isZero(0) ? Vec3d::UnitY() : (-gravity.normalized()).eval();
  double mass = 0;
  reading.least_height = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < world.state().x.size(); ++i) {
    const double height = world.state().x[i].template cast<double>().dot(up);
    const double m = static_cast<double>(world.model().mass[i]);
    mass += m;
    reading.mean_height += m * height;
    reading.least_height = std::min(reading.least_height, height);
  }
  reading.mean_height /= mass;
  return reading;
}

/// Without positions if the two have different meshes.
template <class Real>
typename RunError<Real>::Differences RunError<Real>::differences(const World<Real>& a,
                                                                 const World<Real>& b) {
  const Reading one = read(a), other = read(b);
  const bool same_mesh = a.state().x.size() == b.state().x.size();
  return {same_mesh ? rms_distance(a.state().x, b.state().x) : 0,
          std::abs(one.strain - other.strain), std::abs(one.energy - other.energy),
          std::abs(one.mean_height - other.mean_height),
          std::abs(one.least_height - other.least_height)};
}

template <class Real>
void RunError<Real>::note_tick(const World<Real>& run) {
  if (broke_off_) return;
  broke_off_ = stopped(run);
  for (const auto* world : {&twice_, &four_, &noisy_, &finer_}) {
    if (!*world) continue;
    const TickReport& report = (*world)->step();
    assert(report.halted || (*world)->tick() == run.tick());
    broke_off_ = broke_off_ || report.halted || stopped(**world);
  }
  if (broke_off_) return;
  noise_ = differences(run, *noisy_);
  compare_steps(run);
  if (finer_) compare_rows(run);
}

template <class Real>
void RunError<Real>::compare_steps(const World<Real>& run) {
  const Differences once_twice = differences(run, *twice_);
  const Differences twice_four = differences(*twice_, *four_);
  const Differences once_four = differences(run, *four_);
  for (std::size_t k = 0; k < kQuantities; ++k)
    time_[k].note_steps(run.report().time, {once_twice[k], twice_four[k], once_four[k], noise_[k]});
}

template <class Real>
void RunError<Real>::compare_rows(const World<Real>& run) {
  const Differences now = differences(run, *finer_);
  const double time = run.report().time;
  for (std::size_t k = kStrain; k < kQuantities; ++k) space_[k].note_rows(time, now[k], noise_[k]);
  folded_ = folded_ || is_folded(run.model(), run.state().x);
  if (!folded_) space_[kPositions].note_rows(time, distance_to_finer(run), noise_[kPositions]);
}

/// Root mean square distance of the run's particles from the same places of the fabric on the finer
/// mesh, which has a particle there: row 2 r and column 2 c. An outline is cut anew on each mesh,
/// so that a cut cloth has no such pairs and counts as folded.
template <class Real>
double RunError<Real>::distance_to_finer(const World<Real>& run) const {
  double sum = 0;
  for (std::size_t k = 0; k < run.model().parts.size(); ++k) {
    const ClothPart<Real>&coarse = run.model().parts[k], &fine = finer_->model().parts[k];
    for (int r = 0; r < coarse.rows; ++r) {
      for (int c = 0; c < coarse.columns; ++c) {
        const auto from = static_cast<std::size_t>(coarse.particles.first + r * coarse.columns + c);
        const auto to =
            static_cast<std::size_t>(fine.particles.first + 2 * r * fine.columns + 2 * c);
        sum += (run.state().x[from].template cast<double>() -
                finer_->state().x[to].template cast<double>())
                   .squaredNorm();
      }
    }
  }
  return std::sqrt(sum / static_cast<double>(run.state().x.size()));
}

template <class Real>
std::vector<QuantityError> RunError<Real>::in_time() const {
  return {{"positions", "m", time_[kPositions].figure()},
          {"strain", "1", time_[kStrain].figure()},
          {"energy", "J", time_[kEnergy].figure()}};
}

template <class Real>
std::vector<QuantityError> RunError<Real>::in_space(const World<Real>& run) const {
  if (!finer_) return {};
  std::vector<QuantityError> all = {{"positions", "m", space_[kPositions].figure()},
                                    {"mean_height", "m", space_[kMeanHeight].figure()},
                                    {"least_height", "m", space_[kLeastHeight].figure()},
                                    {"strain", "1", space_[kStrain].figure()},
                                    {"energy", "J", space_[kEnergy].figure()}};
  if (run.def().test == TextileTest::drape)
    all.push_back({"drape_coefficient", "%", drape_figure(run)});
  return all;
}

/// Of the present alone, because a shadow takes longer to measure than a tick to compute.
template <class Real>
ErrorFigure RunError<Real>::drape_figure(const World<Real>& run) const {
  ErrorFigure figure;
  const double here = drape_of(run);
  figure.estimate.error = std::abs(here - drape_of(*finer_));
  figure.noise = std::abs(here - drape_of(*noisy_));
  figure.until = run.report().time;
  figure.measured = figure.noise <= kNoiseFraction * figure.estimate.error;
  figure.chaotic = !broke_off_ && figure.noise > kNoiseFraction * figure.estimate.error;
  figure.chaotic_at = figure.chaotic ? figure.until : 0;
  return figure;
}

template class RunError<float>;
template class RunError<double>;

}  // namespace weft
