#include "tests/bench/measures.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <time.h>

namespace weft::bench {
namespace {

double squared_distance(const Vec3Array<double>& a, const Vec3Array<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return sum;
}

double longest_way(const Path& reference) {
  double most = 0;
  for (const Snapshot& s : reference.samples)
    most = std::max(most, squared_distance(s.x, reference.samples.front().x));
  return most;
}

double strain(const Spring<double>& s, const Vec3Array<double>& x) {
  return (x[static_cast<std::size_t>(s.j)] - x[static_cast<std::size_t>(s.i)]).norm() /
             s.rest_length -
         1;
}

/// The largest sum over all springs of their squared strains [1].
double largest_strain(const ClothModel<double>& model, const Path& reference) {
  double most = 0;
  for (const Snapshot& s : reference.samples) {
    double all = 0;
    for (const Spring<double>& spring : model.springs) all += std::pow(strain(spring, s.x), 2);
    most = std::max(most, all);
  }
  return most;
}

Vec3d momentum(const ClothModel<double>& model, const Vec3Array<double>& v) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t i = 0; i < v.size(); ++i) sum += model.mass[i] * v[i];
  return sum;
}

double total_energy(const ClothModel<double>& model, const Snapshot& s, const Vec3d& gravity) {
  ClothState<double> state = initial_state(model);
  state.x = s.x;
  state.v = s.v;
  return read_energies<double>(model, state, gravity).energies.total();
}

/// Position of a grid at (row, column), which need not be whole numbers.
Vec3d at(const ClothDef& grid, const Vec3Array<double>& x, double row, double column) {
  const int r = std::min(static_cast<int>(row), grid.rows - 2);
  const int c = std::min(static_cast<int>(column), grid.columns - 2);
  const double a = row - r, b = column - c;
  const auto particle = [&](int i, int j) {
    return x[static_cast<std::size_t>(i * grid.columns + j)];
  };
  return (1 - a) * ((1 - b) * particle(r, c) + b * particle(r, c + 1)) +
         a * ((1 - b) * particle(r + 1, c) + b * particle(r + 1, c + 1));
}

}  // namespace

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

double rms_distance(const Snapshot& a, const Snapshot& b) {
  return std::sqrt(squared_distance(a.x, b.x) / static_cast<double>(a.x.size()));
}

double mean_shape_error(const Path& path, const Path& reference) {
  const std::size_t end = path.samples.size(), half = end / 2, n = path.samples[0].x.size();
  Vec3Array<double> mine(n, Vec3d::Zero()), right(n, Vec3d::Zero());
  for (std::size_t k = half; k < end; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      mine[i] += path.samples[k].x[i] / static_cast<double>(end - half);
      right[i] += reference.samples[k].x[i] / static_cast<double>(end - half);
    }
  }
  return std::sqrt(squared_distance(mine, right) / longest_way(reference));
}

double position_error(const Path& path, const Path& reference, std::size_t first,
                      std::size_t last) {
  double worst = 0;
  for (std::size_t k = first; k <= last; ++k) {
    const double d = squared_distance(path.samples[k].x, reference.samples[k].x);
    if (!(d <= worst)) worst = d;
  }
  return std::sqrt(worst / longest_way(reference));
}

std::vector<ErrorVector> errors(const ClothModel<double>& model, const ClothDef& cloth,
                                const Vec3d& gravity, const Path& path, const Path& reference) {
  assert(path.samples.size() == reference.samples.size());
  double mass = 0;
  for (const double m : model.mass) mass += m;
  const double length = std::max(cloth.width, cloth.height), g = gravity.norm();
  const double way = longest_way(reference), strained = largest_strain(model, reference);
  std::vector<ErrorVector> all(path.samples.size());
  for (std::size_t k = 1; k < all.size(); ++k) {
    const Snapshot &mine = path.samples[k], &right = reference.samples[k];
    all[k].position = std::sqrt(squared_distance(mine.x, right.x) / way);
    double apart = 0;
    for (const Spring<double>& s : model.springs) {
      const double d = strain(s, mine.x) - strain(s, right.x);
      apart += d * d;
    }
    all[k].strain = std::sqrt(apart / strained);
    const double energy = total_energy(model, mine, gravity) - total_energy(model, right, gravity);
    all[k].energy = std::abs(energy) / (mass * g * length);
    const Vec3d p = momentum(model, mine.v) - momentum(model, right.v);
    all[k].momentum = p.norm() / (mass * std::sqrt(g * length));
  }
  return all;
}

ErrorVector worst_error(const std::vector<ErrorVector>& errors, const Compared& compared,
                        const Path& path, const Path& reference) {
  const auto worst = [&](double ErrorVector::*quantity, std::size_t last) {
    double most = last < compared.first ? std::numeric_limits<double>::quiet_NaN() : 0;
    for (std::size_t k = compared.first; k <= last; ++k) {
      if (!(errors[k].*quantity <= most)) most = errors[k].*quantity;
    }
    return most;
  };
  ErrorVector error;
  error.position = worst(&ErrorVector::position, compared.positions);
  error.momentum = worst(&ErrorVector::momentum, compared.positions);
  error.strain = worst(&ErrorVector::strain, compared.strains);
  error.energy = worst(&ErrorVector::energy, compared.energies);
  error.mean_shape = mean_shape_error(path, reference);
  error.penetration = path.deepest;
  return error;
}

double spatial_error(const ClothDef& coarse, const Path& coarse_path, const ClothDef& fine,
                     const Path& fine_path, std::size_t first, std::size_t last) {
  const double down = static_cast<double>(fine.rows - 1) / (coarse.rows - 1);
  const double right = static_cast<double>(fine.columns - 1) / (coarse.columns - 1);
  double worst = 0;
  for (std::size_t k = first; k <= last; ++k) {
    double sum = 0;
    std::size_t i = 0;
    for (int r = 0; r < coarse.rows; ++r) {
      for (int c = 0; c < coarse.columns; ++c, ++i)
        sum += (coarse_path.samples[k].x[i] - at(fine, fine_path.samples[k].x, r * down, c * right))
                   .squaredNorm();
    }
    worst = std::max(worst, sum);
  }
  return std::sqrt(worst / longest_way(coarse_path));
}

}  // namespace weft::bench
