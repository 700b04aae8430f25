#pragma once

#include "core/cloth/cloth_model.h"

// Cloths from triangle meshes.

namespace weft {

/// Builds a cloth from a triangle mesh as a model with one part.
///
/// Every triangle is a membrane of constant strain with the fabric's tensor (forces/membrane.h), at
/// rest as it lies in the mesh; its threads run as the material coordinates do. With the membrane
/// model `springs` every edge is a spring instead, with k = Y(a) sum A / l^2 over its one or two
/// triangles (approximate, exact in the mean over directions for equilateral triangles), with Y(a)
/// = Y_w cos^4 a + Y_f sin^4 a + 6 G sin^2 a cos^2 a, the stiffness of the fabric's tensor along
/// the edge. A mesh bends by mesh_bending.h. With a rest angle, or if hinges were asked for, hinges
/// over all inner edges have B l^2 / (A1 + A2); their rest angle is that of the mesh plus the
/// cloth's.
/// Mass: a third of each triangle to its corners, or equal. Particles are renumbered breadth-first,
/// so that neighbours lie near each other in memory.
///
/// Material coordinates are those of mesh_uv.h. At seams each triangle has those of its own
/// corners; over an edge there hinges have the mean of both triangles' rigidities.
///
/// With the rest shape `uv` a mesh without seams is built as it lies there, flat. With seams each
/// of its triangles rests as its corners lie there (ClothPart::rests_by_triangle), and it is
/// flat at rest across the seams too.
///
/// The definition must be valid, except for its mesh. Throws DefinitionError on "cloth.mesh...." if
/// a vertex is unused, two vertices coincide, a triangle has no area or appears twice, or an edge
/// has more than two triangles.
template <class Real>
ClothModel<Real> build_mesh_cloth(const ClothDef& def);

/// Old index for each position in the new order: breadth-first from vertex 0 over edges, neighbours
/// in the order of their old indices; further connected components follow.
std::vector<Index> breadth_first_order(std::size_t vertices,
                                       const std::vector<Triangle>& triangles);

}  // namespace weft
