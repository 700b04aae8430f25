#pragma once

#include <array>

#include "core/cloth/cloth_model.h"

// Builds the membrane of a mesh and bounds its frequency.

namespace weft {

/// The fabric's C12 [N/m]: of its Poisson's ratio, or without one that of a grid, which is its
/// shear stiffness.
double membrane_coupling(const FabricDef& fabric);

/// Throws DefinitionError if the tensor is not positive definite: C12^2 must be below C11 C22, or
/// C12 zero.
void refuse_indefinite_membrane(const FabricDef& fabric);

/// Corners of a triangle in its rest shape [m].
using RestCorners = std::array<std::array<double, 2>, 3>;

/// The shape of a triangle in space, laid flat and turned such that its threads run along the axes.
/// @param x         corners in space [m]
/// @param material  their (u, v), whose scale does not matter; the turn is that of the polar
///                  decomposition, so that both threads deviate equally where (u, v) are distorted
RestCorners laid_flat(const std::array<Vec3d, 3>& x, const RestCorners& material);

/// A triangle that is at rest with these corners, which must enclose an area.
template <class Real>
MembraneTriangle<Real> membrane_triangle(const Triangle& particles, const RestCorners& corners);

/// Bounds the membrane's frequency and gives it the dashpot of the fabric's damping ratio.
///
/// Irons' bound: of all triangles the highest squared frequency, each on its own with its share of
/// its corners' masses. Any shares that add up to the masses are valid; those are taken that make
/// the bound low, where the doubled third of a triangle's mass would leave the worst triangle with
/// as little as the best. As for springs the bound holds for crushed cloth too, at any angle
/// between the threads; what stretching adds to it is in `membrane_shear_omega2`.
template <class Real>
void bound_membrane(const ClothModel<Real>& model, ClothPart<Real>& part);

/// Length of the most stretched thread of the part [1]: 1 at rest, 0 without a membrane.
template <class Real>
double longest_thread(const ClothModel<Real>& model, const ClothPart<Real>& part,
                      const Vec3Array<Real>& x);

/// Increase of a part's bound when its threads are stretched [1/s^2]: the shear strain grows with
/// the square of their length. 0 below kFreeStretch.
double stretched_membrane_omega2(const FrequencyBounds& bounds, double longest_thread);

}  // namespace weft
