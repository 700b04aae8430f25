#pragma once

#include <string>

#include "core/world/world.h"
#include "server/commands/npy.h"
#include "server/output.h"

namespace weft::server {

/// Writes what happens in a world into one .npy file, a record for its start and for every so many
/// ticks: numpy.load gives an array with a field for each column of kColumns in series.cpp, and x
/// and v of all particles [m, m/s]. Forces are those of reactions.h; at the start, before any tick,
/// they are NaN.
template <class Real>
class Series {
 public:
  /// Writes the start. The world measures forces from now on, which changes no result.
  /// @param every  ticks between two records, at least 1
  /// @param ticks  of the run, after which the file is whole
  /// Throws OutputError, as do the others.
  Series(const std::string& path, World<Real>& world, int every, int ticks);

  /// After each tick.
  void note_tick(const World<Real>& world);
  /// Once, at the end.
  void finish() { file_.finish(); }

 private:
  void write_record(const World<Real>& world);

  NewFile file_;
  NpyTable table_;
  int every_, passed_ = 0;  ///< ticks since the last record
  double work_ = 0;         ///< of these [J]
  std::string record_;
};

}  // namespace weft::server
