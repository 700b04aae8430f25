#pragma once

#include <string>
#include <vector>

namespace weft::bench {

/// What contact of a cloth with itself costs in one state: CPU milliseconds a tick.
struct ContactSpeed {
  std::string state, how;
  int n = 0;                   ///< particles a side
  int substeps = 0;            ///< a tick
  double pairs = 0, rows = 0;  ///< at the end of a tick
  double tick = 0;             ///< all of it
  double elastic = 0;          ///< springs, bending, integration, energies
  double broad_phase = 0;      ///< boxes of patches
  double pair_tests = 0;       ///< features of near patches against each other
  double regions = 0;          ///< certified room of each particle
  double row_making = 0;       ///< closest points of rows
  double repulsion = 0;        ///< solving rows without friction
  double friction = 0;         ///< what solving takes more than without it
  double ticks = 0;            ///< of a run
  int runs = 0;
  double crossings = 0;  ///< at the end of all
  std::string missing;   ///< why there is no figure; empty if there is one
};

/// Measures flat, wrinkled, folded and crumpled cotton of 129 x 129 and 257 x 257 particles.
/// @param quick  33 x 33 instead
std::vector<ContactSpeed> measure_contact_speed(bool quick);

}  // namespace weft::bench
