// Lays out a grid part's arrays and runs its kernels, in bands on several threads.

#include "core/forces/grid_pass.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>
#include <utility>

#include "core/cloth/bending_stencil.h"
#include "core/forces/constants.h"
#include "core/forces/grid_coefficients.h"
#include "core/forces/grid_kernels.h"
#include "core/geometry/exact_origin.h"

namespace weft {
namespace {

/// Sum of the powers that a pass has added up; clears their line, which is 0 without such forces.
template <class Real>
double take_power(const GridView<Real>& view, bool has_external) {
  if (!has_external) return 0;
  Real* const line = view.scratch + kPowerLine * view.scratch_line();
  const double sum = sum_of_columns(view, line);
  std::fill_n(line, view.scratch_line(), Real(0));
  return sum;
}

template <class Real>
Real* velocities(const GridView<Real>& view) {
  return view.motion + GridView<Real>::kVelocityLine * view.line;
}

}  // namespace

template <class Real>
void GridPass<Real>::lay_out(const ClothPart<Real>& part) {
  const GridCells& cells = part.cells;
  view_.rows = cells.rows;
  view_.columns = cells.columns;
  view_.line = (cells.columns + kGridLanes - 1) / kGridLanes * kGridLanes;
  // Rows a multiple of 4 KiB apart would compete for the same cache lines.
  if (view_.line % 64 == 0) view_.line += kGridLanes;
  rows_.assign(static_cast<std::size_t>(cells.rows), {});
  for (int r = 0; r < cells.rows; ++r) {
    GridRow<Real>& row = rows_[static_cast<std::size_t>(r)];
    for (int c = 0; c < cells.columns; ++c) {
      if (cells.particle(r, c) == kNone) continue;
      if (row.count++ > 0) {
        assert(c == row.column + row.count - 1 && "no row has a gap");
        continue;
      }
      row.column = c;
      row.particle = part.particles.first + cells.particle(r, c);
    }
  }
  view_.row = rows_.data();
}

/// Equal rows, which most rows of a whole grid are, share their coefficients.
template <class Real>
void GridPass<Real>::lay_out_coefficients(const ClothPart<Real>& part) {
  coefficients_.clear();
  std::vector<std::size_t> place;
  std::vector<Real> last;
  for (int r = 0; r < view_.rows; ++r) {
    std::vector<Real> lines = coefficient_row(part, r, view_.line);
    if (lines != last) coefficients_.insert(coefficients_.end(), lines.begin(), lines.end());
    place.push_back(coefficients_.size() - lines.size());
    last = std::move(lines);
  }
  coefficients_.shrink_to_fit();
  for (std::size_t r = 0; r < place.size(); ++r)
    rows_[r].coefficients = coefficients_.data() + place[r];
}

template <class Real>
void GridPass<Real>::prepare(const ClothPart<Real>& part) {
  view_ = {};
  if (!part.grid_springs || part.hinges.count > 0 || part.locks.count > 0) return;
  particles_ = part.particles;
  lay_out(part);
  lay_out_coefficients(part);
  view_.springs = *part.grid_springs;
  view_.misfit = MisfitLaw<Real>(view_.springs);
  view_.fine = shake_of(part) > kMostShake;
  air_normal_ = static_cast<Real>(part.fabric.air_normal);
  air_tangential_ = static_cast<Real>(part.fabric.air_tangential);
  view_.motion = allocate(motion_, (view_.rows + 2) * GridView<Real>::kMotionLines);
  for (AlignedVector<Real>* array : {&external_, &wind_, &paths_, &kept_}) array->clear();
  bands_.clear();
  scratch_.assign(static_cast<std::size_t>(kGridScratchLines * view_.scratch_line()), Real(0));
  view_.scratch = scratch_.data();
  allocate(odd_, 1);
  for (int c = 0; c < view_.columns; ++c)
    odd_[static_cast<std::size_t>(c)] = static_cast<Real>(c % 2);
  view_.odd = odd_.data();
}

/// Trailing zeros serve the reads of the last rows and vectors beyond their ends.
template <class Real>
Real* GridPass<Real>::allocate(AlignedVector<Real>& array, std::ptrdiff_t lines) const {
  array.assign(static_cast<std::size_t>(lines * view_.line + kGridLanes), Real(0));
  return array.data();
}

template <class Real>
void GridPass<Real>::allocate_external(bool air) {
  assert(fits());
  if (external_.empty()) view_.external = allocate(external_, view_.rows * 3);
  if (air && wind_.empty()) view_.wind = allocate(wind_, (view_.rows + 1) * 3);
}

template <class Real>
void GridPass<Real>::allocate_paths() {
  assert(fits());
  allocate(paths_, view_.rows * 6);
  kept_ = motion_;
}

template <class Real>
void GridPass<Real>::load_paths(const Vec3Array<Real>& base, const Vec3Array<Real>& velocity) {
  assert(!paths_.empty() && "allocate_paths comes first");
  assert(base.size() == velocity.size());
  const std::ptrdiff_t pitch = 6 * view_.line;
  grid_take_places(view_, base.data()->data(), paths_.data(), pitch);
  grid_take_apart(view_, velocity.data()->data(), paths_.data() + 3 * view_.line, pitch);
}

template <class Real>
Aabb<Real> GridPass<Real>::box_off_paths(Real time) const {
  assert(!paths_.empty() && "allocate_paths comes first");
  std::array<Real, 6> corners;
  grid_box_paths(view_, paths_.data(), time, corners.data());
  return {{corners[0], corners[1], corners[2]}, {corners[3], corners[4], corners[5]}};
}

template <class Real>
void GridPass<Real>::load_positions(const Vec3Array<Real>& x) {
  assert(fits());
  grid_take_apart(view_, x.data()->data(), view_.motion, view_.pitch());
}

template <class Real>
void GridPass<Real>::load_inverse_mass(const std::vector<Real>& inverse_mass) {
  assert(fits());
  Real* to = view_.motion + GridView<Real>::kInverseMassLine * view_.line;
  for (const GridRow<Real>& row : rows_) {
    std::copy_n(inverse_mass.begin() + row.particle, row.count, to + row.column);
    to += view_.pitch();
  }
}

template <class Real>
void GridPass<Real>::load_wind(const Vec3Array<Real>& wind) {
  assert(!wind_.empty() && "allocate_external(true) comes first");
  grid_take_apart(view_, wind.data()->data(), view_.wind, 3 * view_.line);
}

template <class Real>
void GridPass<Real>::load_external(const Vec3Array<Real>& force) {
  assert(!external_.empty() && "allocate_external comes first");
  grid_take_apart(view_, force.data()->data(), view_.external, 3 * view_.line);
}

template <class Real>
void GridPass<Real>::store(std::span<const Index> particles, Vec3Array<Real>& x,
                           Vec3Array<Real>& v) const {
  assert(fits() && std::is_sorted(particles.begin(), particles.end()));
  auto row = rows_.begin();
  for (const Index i : particles) {
    while (i >= row->particle + row->count) ++row;
    assert(row != rows_.end() && i >= row->particle);
    const Real* const motion =
        view_.motion + (row - rows_.begin()) * view_.pitch() + row->column + (i - row->particle);
    for (int k = 0; k < 3; ++k) {
      x[static_cast<std::size_t>(i)][k] = view_.origin[k] + motion[k * view_.line];
      v[static_cast<std::size_t>(i)][k] = motion[(GridView<Real>::kVelocityLine + k) * view_.line];
    }
  }
}

template <class Real>
void GridPass<Real>::store_external(Vec3Array<Real>& force) const {
  assert(!external_.empty() && "allocate_external comes first");
  grid_put_together(view_, view_.external, 3 * view_.line, force.data()->data());
}

template <class Real>
int GridPass<Real>::band_count() const {
  const std::ptrdiff_t rows = view_.rows;
  return static_cast<int>(std::clamp<std::ptrdiff_t>(
      std::min(rows / kBandRows, rows * view_.columns / kBandParticles), 1, kMostBands));
}

/// An even row, because the buffers carried from row to row alternate.
template <class Real>
std::ptrdiff_t GridPass<Real>::first_row(int band) const {
  const int bands = band_count();
  assert(band >= 0 && band <= bands);
  return band == bands ? view_.rows : std::ptrdiff_t{view_.rows} * band / bands / 2 * 2;
}

template <class Real>
void GridPass<Real>::allocate_bands() {
  bands_.clear();
  if (band_count() == 1) return;
  bands_.resize(static_cast<std::size_t>(band_count()));
  for (Band& band : bands_) {
    band.scratch.assign(scratch_.size(), Real(0));
    allocate(band.tail, 4 * GridView<Real>::kMotionLines);
  }
}

template <class Real>
GridView<Real> GridPass<Real>::view_of(Band& band) const {
  GridView<Real> view = view_;
  view.scratch = band.scratch.data();
  return view;
}

/// Reads rows of other bands, and must therefore finish before any band moves.
template <class Real>
void GridPass<Real>::begin_band(int number) {
  Band& band = bands_[static_cast<std::size_t>(number)];
  grid_begin_rows(view_of(band), first_row(number));
  const std::ptrdiff_t tail = first_row(number + 1) - 2;
  if (tail + 2 < view_.rows)
    std::copy_n(view_.motion + tail * view_.pitch(), 4 * view_.pitch(), band.tail.data());
}

/// The last two rows read the first two of the next band, which may have moved by then: they are
/// advanced with copies of those rows in their old state.
template <class Real>
void GridPass<Real>::advance_band(int number, const GridStep<Real>& step) {
  Band& band = bands_[static_cast<std::size_t>(number)];
  const std::ptrdiff_t first = first_row(number), last = first_row(number + 1);
  GridView<Real> view = view_of(band);
  if (last == view_.rows) {
    grid_advance(view, step, first, last);
  } else {
    const std::ptrdiff_t tail = last - 2;
    grid_advance(view, step, first, tail);
    view.row += tail;
    view.motion = band.tail.data();
    if (step.has_external) view.external += 3 * tail * view_.line;
    grid_advance(view, step, 0, 2);
    std::copy_n(view.motion, 2 * view.pitch(), view_.motion + tail * view.pitch());
  }
  band.power = take_power(view, step.has_external);
}

template <class Real>
double GridPass<Real>::advance(const GridStep<Real>& step, Executor* executor) {
  assert(fits());
  assert(!step.has_external || !external_.empty());
  const int bands = band_count();
  double power = 0;
  if (!executor || bands_.empty()) {
    grid_begin_rows(view_, 0);
    for (int band = 0; band < bands; ++band) {
      grid_advance(view_, step, first_row(band), first_row(band + 1));
      power += take_power(view_, step.has_external);
    }
    return power;
  }
  run_chunks(executor, bands, [this](int band) { begin_band(band); });
  run_chunks(executor, bands, [&](int band) { advance_band(band, step); });
  for (const Band& band : bands_) power += band.power;
  return power;
}

/// A band's rows alone.
template <class Real>
GridView<Real> GridPass<Real>::rows_of(int band) {
  const std::ptrdiff_t first = first_row(band);
  GridView<Real> view = bands_.empty() ? view_ : view_of(bands_[static_cast<std::size_t>(band)]);
  view.rows = static_cast<int>(first_row(band + 1) - first);
  view.row += first;
  view.motion += first * view.pitch();
  if (view.external) view.external += 3 * first * view.line;
  return view;
}

/// Calls work(band, view of its rows) for all bands, whose rows do not depend on each other.
template <class Real>
template <class Work>
void GridPass<Real>::for_bands(Executor* executor, Work&& work) {
  assert(fits());
  run_chunks(bands_.empty() ? nullptr : executor, band_count(),
             [&](int band) { work(band, rows_of(band)); });
}

template <class Real>
void GridPass<Real>::load(const Vec3Array<Real>& x, const Vec3Array<Real>& v, Executor* executor) {
  assert(v.size() == x.size());
  const auto first = static_cast<std::size_t>(particles_.first);
  const std::span own = std::span(x).subspan(first, static_cast<std::size_t>(particles_.count));
  std::copy_n(exact_origin<Real>(own).data(), 3, view_.origin);
  for_bands(executor, [&](int, const GridView<Real>& rows) {
    grid_take_places(rows, x.data()->data(), rows.motion, rows.pitch());
    for (int r = 0; r < rows.rows; ++r)
      std::fill_n(rows.remainder() + r * rows.pitch(), 3 * rows.line, Real(0));
  });
  load_velocities(v, executor);
}

template <class Real>
void GridPass<Real>::take_over(const Vec3Array<Real>& x, const Vec3Array<Real>& v,
                               Executor* executor) {
  assert(v.size() == x.size());
  for_bands(executor, [&](int, const GridView<Real>& rows) {
    grid_take_motion(rows, x.data()->data(), v.data()->data());
  });
}

template <class Real>
void GridPass<Real>::load_velocities(const Vec3Array<Real>& v, Executor* executor) {
  for_bands(executor, [&](int, const GridView<Real>& rows) {
    grid_take_apart(rows, v.data()->data(), velocities(rows), rows.pitch());
  });
}

template <class Real>
void GridPass<Real>::forget_remainder(Index particle, const Vec3<Real>& x) {
  assert(particles_.contains(particle));
  auto row = rows_.begin();
  while (particle >= row->particle + row->count) ++row;
  Real* const at =
      view_.motion + (row - rows_.begin()) * view_.pitch() + row->column + particle - row->particle;
  for (int k = 0; k < 3; ++k) {
    at[k * view_.line] = x[k] - view_.origin[k];
    at[(GridView<Real>::kRemainderLine + k) * view_.line] = 0;
  }
}

template <class Real>
void GridPass<Real>::store(Vec3Array<Real>& x, Vec3Array<Real>& v, Executor* executor) {
  assert(v.size() == x.size());
  for_bands(executor,
            [&](int, const GridView<Real>& rows) { grid_put_places(rows, x.data()->data()); });
  store_velocities(v, executor);
}

template <class Real>
void GridPass<Real>::store_velocities(Vec3Array<Real>& v, Executor* executor) {
  for_bands(executor, [&](int, const GridView<Real>& rows) {
    grid_put_together(rows, velocities(rows), rows.pitch(), v.data()->data());
  });
}

template <class Real>
double GridPass<Real>::drift(Real dt, bool has_external, const Vec3Array<Real>& v,
                             Vec3Array<Real>& x, Executor* executor) {
  assert(x.size() == v.size());
  assert(!has_external || !external_.empty());
  std::array<double, kMostBands> power{};
  for_bands(executor, [&](int band, const GridView<Real>& rows) {
    grid_drift(rows, dt, has_external, v.data()->data(), x.data()->data());
    power[static_cast<std::size_t>(band)] = take_power(rows, has_external);
  });
  return std::accumulate(power.begin(), power.end(), 0.0);
}

template <class Real>
void GridPass<Real>::compute_internal_forces(Vec3Array<Real>& force) {
  allocate_external(false);
  grid_internal_forces(view_);
  store_external(force);
}

template <class Real>
void GridPass<Real>::compute_air_forces(double density) {
  assert(density >= 0);
  assert(!wind_.empty() && "allocate_external(true) comes first");
  const Real pressure = static_cast<Real>(0.5 * density) * air_normal_;
  grid_air_forces(view_, pressure, density > 0 ? air_tangential_ : Real(0));
}

template <class Real>
ElasticEnergy GridPass<Real>::elastic_energy() const {
  assert(fits());
  return grid_elastic_energy(view_);
}

template <class Real>
std::size_t GridPass<Real>::bytes() const {
  std::size_t numbers = 0;
  for (const AlignedVector<Real>* array :
       {&motion_, &external_, &wind_, &coefficients_, &odd_, &scratch_, &paths_, &kept_})
    numbers += array->capacity();
  for (const Band& band : bands_) numbers += band.scratch.capacity() + band.tail.capacity();
  return numbers * sizeof(Real) + rows_.capacity() * sizeof(GridRow<Real>);
}

template class GridPass<float>;
template class GridPass<double>;

}  // namespace weft
