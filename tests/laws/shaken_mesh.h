#pragma once

#include "tests/laws/shaking.h"
#include "tests/support/sheets_of_triangles.h"

namespace weft::test {

// The shaken square as a mesh, whose membrane can be as hard to quieten as springs. In a cloth that
// may pass through itself a ball of all particles may open into a tuck that is a rest of its
// energy; how often is counted.

/// Noise of 20 m/s may ask for a tick with more substeps, as threads stretch within it beyond what
/// its start foretells; never for a stop.
inline void require_no_stop(const TickReport& report) {
  if (report.divergence) REQUIRE(report.divergence->remedy == DivergenceRemedy::more_substeps);
}

/// How many runs came back to the rest, to 2 % of the length.
struct MeshRecoveries {
  unsigned back = 0, all = 0;

  MeshRecoveries& operator+=(const MeshRecoveries& more) {
    back += more.back, all += more.all;
    return *this;
  }
};

struct ShakenMesh {
  Cut cut = Cut::irregular;
  double stiffness = 196;  ///< [N/m]
  BendingModel bending = BendingModel::automatic;

  WorldDef world(double damping) const {
    WorldDef def = hanging_square(25, stiffness, damping, {"verlet"});
    ClothDef& cloth = def.cloths[0];
    cloth.mesh = triangle_sheet(cut, 1, 1, 1.0 / 24).mesh;
    cloth.bending_model = bending;
    def.pins = upper_border(cloth);
    return def;
  }

  double least_energy() const {
    World<float> resting(world(5));
    advance(resting, 6);
    return energy_of(resting);
  }

  /// @param seeds  of the disturbance, from 20 on
  MeshRecoveries recoveries(Disturbance kind, unsigned seeds,
                            double noise_speed = kNoiseSpeed) const {
    World<float> resting(world(5));
    advance(resting, 6);
    MeshRecoveries count;
    for (unsigned seed = 20; seed < 20 + seeds; ++seed) {
      INFO(name_of(cut) << ", " << stiffness << " N/m, " << name_of(kind) << ", " << seed);
      World<float> shaken(world(5));
      advance(shaken, 1);
      REQUIRE(disturb(shaken, kind, seed, noise_speed).rescues == 0);
      for (int tick = 0; tick < 300; ++tick) require_no_stop(shaken.step());
      count += {distance_from(resting.state().x, shaken) < 0.02 ? 1U : 0U, 1U};
    }
    return count;
  }
};

}  // namespace weft::test
