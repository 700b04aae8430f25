#pragma once

#include <cstddef>

namespace weft {

// Vector code that measures the distances between a few features of the cloth and a few of a mesh,
// chosen for the processor when the program runs. Each pair is computed by itself, so the choice
// does not change a bit.

/// Columns of a mesh are padded to a multiple of this, with features far away; no vector is longer.
inline constexpr std::size_t kFeaturePadding = 8;

/// Each of the cloth's features against each of the mesh's.
template <class Real>
struct FeatureTable {
  std::size_t count = 0;         ///< features of the cloth
  const Real* cloth = nullptr;   ///< their numbers, one feature after the other
  std::size_t stride = 0;        ///< features of the mesh, padded
  const Real* mesh = nullptr;    ///< their numbers, number k of feature n at k * stride + n
  const Real* reach2 = nullptr;  ///< of each of the cloth's: squared distance of a pair [m^2]
  Real* distance2 = nullptr;     ///< of cloth's f and mesh's n at f * stride + n [m^2]
  Real* nearest2 = nullptr;      ///< least of each of the cloth's [m^2]
  Real* beyond2 = nullptr;       ///< least of those that are beyond reach [m^2]
};

/// Squared distances of segments; six numbers each: an end, and the way to the other end [m].
void measure_segments(const FeatureTable<float>& table);
void measure_segments(const FeatureTable<double>& table);

/// Numbers of a triangle as a column: a corner and the ways to the other two, which are given [m],
/// and eight that prepare_triangles computes from them.
inline constexpr std::size_t kTriangleNumbers = 17;

/// Completes columns of triangles.
void prepare_triangles(std::size_t stride, float* columns);
void prepare_triangles(std::size_t stride, double* columns);

/// Squared distances of points of the cloth (three numbers) from prepared triangles of the mesh.
void measure_points_from_triangles(const FeatureTable<float>& table);
void measure_points_from_triangles(const FeatureTable<double>& table);

/// The same with the triangles on the cloth (nine numbers, not prepared) and the points on the
/// mesh.
void measure_triangles_from_points(const FeatureTable<float>& table);
void measure_triangles_from_points(const FeatureTable<double>& table);

}  // namespace weft
