#pragma once

#include <string>

#include "core/definition.h"

// Material parameters of fabric.

namespace weft {

/// The `poisson` of a fabric that has none of its own.
inline constexpr double kPoissonOfGrid = -1;

/// The material of a cloth in physical units, independent of any mesh: doubling the resolution does
/// not change the cloth.
///
/// Membrane: the plane-stress tensor has C11 = stretch_warp, C22 = stretch_weft and C66 = shear.
/// C12 is poisson * stretch_weft on a mesh, and on a grid, or without a Poisson's ratio, the same
/// as C66. The uniaxial modulus along the warp is C11 - C12^2/C22. Bending: energy per area B/2
/// (warp), B/2 (weft) times curvature squared; B in every direction if both are equal.
///
/// Damping (Kelvin and Voigt): stress is that of the strain plus a relaxation time tau times its
/// rate, one tau each for stretch, shear and bending; on a grid C12 has that of shear. A wave or
/// mode of angular frequency omega then decays by omega^2 tau / 2 a second, whatever the mesh.
/// `damping_ratio` is what stability needs besides, of the mesh's highest mode; stretch and shear
/// have the larger of both.
///
/// Locking (biphasic stretch): beyond the strain `locking_strain` a thread is `locking_factor`
/// times as stiff, so the energy per area grows by (factor - 1) Y (e - e_L)^2 / 2. Of verlet alone.
struct FabricDef {
  double areal_density = 0.2;       ///< sigma [kg/m^2]
  double stretch_warp = 400;        ///< Y_w [N/m], along u, the direction of a row
  double stretch_weft = 400;        ///< Y_f [N/m], along v, the direction of a column
  double shear = 40;                ///< G [N/m]
  double poisson = kPoissonOfGrid;  ///< nu: what it narrows along v when pulled along u, per
                                    ///< strain; of a mesh, below the root of Y_w / Y_f
  double bending_warp = 1e-5;       ///< B_w [N m], curvature along u
  double bending_weft = 1e-5;       ///< B_f [N m], curvature along v
  double locking_strain = 0;        ///< e_L [1]; 0: it does not lock
  double locking_factor = 10;       ///< [1]; substeps grow as its root
  double damping_ratio = 0.05;      ///< dashpot of the membrane, as a ratio of the highest mode
  double stretch_damping = 0;       ///< tau of stretch [s]
  double shear_damping = 0;         ///< tau of shear [s]
  double bending_damping = 0;       ///< tau of bending [s]
  double thickness = 0.004;         ///< contact distance of the mid-surface from objects [m]
  double friction = 0.4;            ///< Coulomb coefficient against objects
  double restitution = 0;           ///< k_diss of the seed's eq. (10), 0 <= k < 1
  double air_normal = 1.28;         ///< C_n, drag coefficient of a plate across the wind
  double air_tangential = 0.01;     ///< c_t, skin friction per area and speed [kg/(m^2 s)]
  std::string preset;  ///< name of the preset that its values began as; no physics reads it
};

/// Passes each field to `visit(info, value)`; see definition.h.
template <class Def, class Visitor>
void visit_fields_of_fabric(Def& f, Visitor&& visit) {
  visit(FieldInfo{"areal_density", kArealDensityRange, "kg/m^2", "mass per area"}, f.areal_density);
  visit(FieldInfo{"stretch_warp", kStretchRange, "N/m", "stretch stiffness along u"},
        f.stretch_warp);
  visit(FieldInfo{"stretch_weft", kStretchRange, "N/m", "stretch stiffness along v"},
        f.stretch_weft);
  visit(FieldInfo{"shear", kStretchRange, "N/m", "shear stiffness"}, f.shear);
  visit(FieldInfo{"poisson", kPoissonRange, "",
                  "of a mesh: narrowing along v per strain along u; -1: as on a grid"},
        f.poisson);
  visit(FieldInfo{"bending_warp", kBendingRange, "N m", "bending rigidity along u"},
        f.bending_warp);
  visit(FieldInfo{"bending_weft", kBendingRange, "N m", "bending rigidity along v"},
        f.bending_weft);
  visit(FieldInfo{"locking_strain", kLockingStrainRange, "",
                  "strain of a thread from which it is stiffer; 0: none"},
        f.locking_strain);
  visit(FieldInfo{"locking_factor", kLockingFactorRange, "", "how many times as stiff it then is"},
        f.locking_factor);
  visit(FieldInfo{"damping_ratio", kDampingRatioRange, "", "damping of the highest membrane mode"},
        f.damping_ratio);
  visit(FieldInfo{"stretch_damping", kRelaxationTimeRange, "s", "relaxation time of stretch"},
        f.stretch_damping);
  visit(FieldInfo{"shear_damping", kRelaxationTimeRange, "s",
                  "relaxation time of shear, and on a grid of what couples stretch along u and v"},
        f.shear_damping);
  visit(FieldInfo{"bending_damping", kRelaxationTimeRange, "s", "relaxation time of bending"},
        f.bending_damping);
  visit(FieldInfo{"thickness", kThicknessRange, "m", "contact distance from objects"}, f.thickness);
  visit(FieldInfo{"friction", kFrictionRange, "",
                  "Coulomb friction; between two cloths the mean of both"},
        f.friction);
  visit(FieldInfo{"restitution", kRestitutionRange, "",
                  "fraction of the impact velocity that returns"},
        f.restitution);
  visit(FieldInfo{"air_normal", kAirNormalRange, "", "drag coefficient across the wind"},
        f.air_normal);
  visit(FieldInfo{"air_tangential", kAirTangentialRange, "kg/(m^2 s)",
                  "skin friction along the wind"},
        f.air_tangential);
}

}  // namespace weft
