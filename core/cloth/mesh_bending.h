#pragma once

#include "core/cloth/cloth_model.h"

// Bending of a mesh.

namespace weft {

/// Links of the quadratic form with the energy density 1/2 (B_w |x_uu|^2 + B_f |x_vv|^2 + (B_w +
/// B_f) |x_uv|^2), the same as that of a grid; between particles counted from the part's first.
///
/// Each triangle has one curvature, which follows from the slopes across the middles of its edges
/// (Morley 1968; as mid-edge normals Grinspun, Gingold, Reisman, Zorin 2006). Here the slopes are
/// no unknowns: they follow from nearby particles, exactly for quadratic fields, and are the same
/// for both triangles at an edge. So a constant curvature has the continuum's energy in any
/// direction on any triangles and no force inside, a shape without energy is flat, and every fold
/// has at least a part of the energy that hinges would give it.
///
/// A mesh that is curved at rest is unfolded around each edge. Its triangles' curvatures at rest
/// lie along their normals, as those of a surface do in a chart that keeps lengths; what a mesh
/// leaves along the triangle is taken off by the triangle's own gradient, so that it is at rest as
/// it lies, on any triangles. Its energy is that of the curvatures' difference from these, which
/// the part's rest curves complete (forces/rest_curve.h). A fold at rest is a curvature too: a fold
/// by the angle theta is exact to theta^2.
///
/// A mesh whose triangles rest on their own is unfolded too: their (u, v) give their shapes, and
/// all is flat at rest, across the seams too.
///
/// A held strip does not bend: a triangle inside it has its slope, and what lies beside it turns
/// about their common edge. A triangle that the border cuts bends only beyond that, where it has
/// the curvature of the whole turn: its rigidity is divided by its free part.
///
/// Gives the part its links and rest curves, and the curvatures that these are made of if it damps
/// bending.
/// @param part  of the model, with `curved_at_rest` set; its `material` gives the threads
template <class Real>
void bend_by_links(const ClothModel<Real>& model, ClothPart<Real>& part);

}  // namespace weft
