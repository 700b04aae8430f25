#pragma once

#include <vector>

#include "core/world/world.h"

namespace weft::bench {

/// CPU seconds of the calling thread.
double cpu_seconds();

double median(std::vector<double> values);

/// A cloth at one instant, in double.
struct Snapshot {
  Vec3Array<double> x, v;
};

/// Samples of one run.
struct Path {
  std::vector<Snapshot> samples;  ///< the start first
  double deepest = 0;             ///< deepest penetration at a sample [m]
};

/// How far a run is from its reference. Of several instants the worst.
struct ErrorVector {
  double position = 0;     ///< L2 of x - x_ref over the largest L2 of x_ref - x_start
  double strain = 0;       ///< L2 over all springs, over the largest of the reference
  double energy = 0;       ///< of the total, over m g L with L the longer side
  double momentum = 0;     ///< over m sqrt(g L)
  double mean_shape = 0;   ///< as position, of the mean over the second half of the horizon
  double penetration = 0;  ///< deepest [m]; not against the reference
};

/// Samples that are compared, by their numbers: each quantity's from `first` to its last. One whose
/// last is before the first is not compared: it is not a number.
struct Compared {
  std::size_t first = 0;
  std::size_t positions = 0;  ///< and momenta
  std::size_t strains = 0, energies = 0;
};

/// A run's distance from its reference at each sample; position, strain, energy and momentum alone.
/// @param model  of the reference, in double
std::vector<ErrorVector> errors(const ClothModel<double>& model, const ClothDef& cloth,
                                const Vec3d& gravity, const Path& path, const Path& reference);

/// The worst of the samples that are compared, the mean shape and the penetration.
ErrorVector worst_error(const std::vector<ErrorVector>& errors, const Compared& compared,
                        const Path& path, const Path& reference);

/// Of the positions' mean over the second half of all samples: what is left to compare where a
/// perturbation grows.
double mean_shape_error(const Path& path, const Path& reference);

/// Position error alone.
double position_error(const Path& path, const Path& reference, std::size_t first, std::size_t last);

template <class Real>
Snapshot snapshot(const ClothState<Real>& state) {
  Snapshot s;
  for (const Vec3<Real>& x : state.x) s.x.push_back(x.template cast<double>());
  for (const Vec3<Real>& v : state.v) s.v.push_back(v.template cast<double>());
  return s;
}

/// Root mean square distance of two snapshots' positions [m].
double rms_distance(const Snapshot& a, const Snapshot& b);

/// Relative distance of the positions of a grid from those of one with twice the particles a side,
/// read off by bilinear interpolation at the same places of the material; the worst sample.
double spatial_error(const ClothDef& coarse, const Path& coarse_path, const ClothDef& fine,
                     const Path& fine_path, std::size_t first, std::size_t last);

}  // namespace weft::bench
