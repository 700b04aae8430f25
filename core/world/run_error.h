#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/diagnostics/error_watch.h"
#include "core/world/world.h"

// The error of a run, from repetitions of it that are stepped beside it.

namespace weft {

/// The error of one quantity.
struct QuantityError {
  const char* name;
  const char* unit;
  ErrorFigure figure;
};

/// What changes the scene's meaning when it is given more rows; empty: nothing does.
std::string what_forbids_rows(const WorldDef& def);

/// The same scene with 2 (rows - 1) + 1 rows of each cloth, and as many columns.
/// @param def  for which what_forbids_rows() is empty
WorldDef with_twice_the_rows(WorldDef def);

/// Repeats a run with 2 and 4 times the substeps, with noise in the starting positions, and with
/// twice the rows and columns, tick by tick beside the run, which it does not change. The error of
/// the mesh is the difference between the two meshes, because its order is not known.
template <class Real>
class RunError {
 public:
  /// @param def  which `run` was built from
  /// @param run  at its start
  /// Throws DefinitionError if the steps cannot be refined.
  RunError(const WorldDef& def, const Runtime& runtime, const World<Real>& run);

  /// Estimated cost of the repetitions, as a multiple of that of the run without contact.
  double relative_cost(const World<Real>& run) const;

  /// Steps the repetitions by the tick that the run has just passed, and compares.
  void note_tick(const World<Real>& run);

  /// Errors in time of positions, strain and energy, up to the present tick.
  std::vector<QuantityError> in_time() const;

  /// Differences in space of heights, strain and energy, of positions before anything folds, and of
  /// the drape test at the present tick; empty if it is not measured.
  /// @param run  at the tick that was noted last
  std::vector<QuantityError> in_space(const World<Real>& run) const;
  /// Why the error in space is not measured; empty: it is.
  const std::string& space_forbidden() const { return space_forbidden_; }

  /// Whether the run or a repetition has stopped; nothing is compared from then on.
  bool broke_off() const { return broke_off_; }

 private:
  /// Scalars of a world at an instant.
  struct Reading {
    double strain = 0, energy = 0;             ///< largest [1], total [J]
    double mean_height = 0, least_height = 0;  ///< against gravity [m]
  };
  enum Quantity { kPositions, kStrain, kEnergy, kMeanHeight, kLeastHeight, kQuantities };
  using Differences = std::array<double, kQuantities>;

  static Reading read(const World<Real>& world);
  static Differences differences(const World<Real>& a, const World<Real>& b);
  void add_noise();
  void build_finer_mesh(const WorldDef& def, const Runtime& runtime);
  void compare_steps(const World<Real>& run);
  void compare_rows(const World<Real>& run);
  ErrorFigure drape_figure(const World<Real>& run) const;
  double distance_to_finer(const World<Real>& run) const;

  std::unique_ptr<World<Real>> twice_, four_, noisy_;
  std::unique_ptr<World<Real>> finer_;  ///< twice the rows; null: space is not measured
  std::string space_forbidden_;
  std::array<ErrorWatch, kQuantities> time_, space_;
  Differences noise_ = {};  ///< at present
  bool folded_ = false, broke_off_ = false;
};

extern template class RunError<float>;
extern template class RunError<double>;

}  // namespace weft
