#pragma once

#include <cstddef>

#include "core/types.h"

// Vector code that finds the features of a mesh within reach of a few features of the cloth, chosen
// for the processor when the program runs. Each pair is computed by itself, so the choice does not
// change a bit.

namespace weft {

/// Features of a mesh come in blocks of so many; no vector is longer.
inline constexpr std::size_t kFeatureLanes = 8;

/// Each of the cloth's features against blocks of the mesh's.
template <class Real>
struct FeatureTable {
  std::size_t count = 0;              ///< features of the cloth
  const Real* cloth = nullptr;        ///< their numbers, one feature after the other
  const Real* cloth_boxes = nullptr;  ///< six numbers each: least and largest coordinates [m]
  const Real* reach2 = nullptr;       ///< of each: squared distance of a pair [m^2]
  std::size_t stride = 0;             ///< blocks, padded to a multiple of kFeatureLanes
  const Index* blocks = nullptr;      ///< their numbers
  const Real* boxes =
      nullptr;                 ///< number k of the box of block n at k * stride + n; padding is far
  const Real* mesh = nullptr;  ///< features: number k of block b from (b * numbers + k) * lanes on
  Index* hits = nullptr;       ///< takes block * lanes + lane of what is within reach, by features
  Real* hits2 = nullptr;       ///< takes their squared distances [m^2]
  Index* ends = nullptr;       ///< takes of each of the cloth's features where its hits end
  Real* beyond2 = nullptr;     ///< takes a bound of what is beyond reach of each, squared [m^2]
};

/// Segments; six numbers each: an end, and the way to the other end [m].
/// @return blocks looked at feature by feature
template <class Real>
std::size_t measure_segments(const FeatureTable<Real>& table);

/// Numbers of a triangle of a mesh: a corner and the ways to the other two, which are given [m],
/// and eight that prepare_triangles computes from them.
inline constexpr std::size_t kTriangleNumbers = 17;

/// Completes blocks of triangles.
template <class Real>
void prepare_triangles(std::size_t blocks, Real* values);

/// Points of the cloth (three numbers) and prepared triangles of the mesh.
template <class Real>
std::size_t measure_points_from_triangles(const FeatureTable<Real>& table);

/// Triangles of the cloth (nine numbers, not prepared) and points of the mesh.
template <class Real>
std::size_t measure_triangles_from_points(const FeatureTable<Real>& table);

}  // namespace weft
