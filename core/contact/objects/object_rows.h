#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include "core/cloth/cloth_state.h"
#include "core/contact/objects/clearance.h"
#include "core/contact/objects/contact_cloths.h"
#include "core/contact/objects/contact_row.h"
#include "core/contact/objects/corners.h"
#include "core/contact/objects/lone_rows.h"
#include "core/contact/objects/object_motion.h"
#include "core/contact/objects/object_pairs.h"
#include "core/contact/objects/object_shapes.h"
#include "core/contact/parts.h"
#include "core/executor.h"
#include "core/profile.h"
#include "core/types.h"

// Makes rows: planes between the features of cloths and objects, frozen for a few substeps.

namespace weft {

/// A plane with a convex feature of an object below it.
template <class Real>
struct ContactBarrier {
  Vec3<Real> normal = Vec3<Real>::UnitY();  ///< out of the object
  double top = 0;                           ///< normal.x of the feature's highest point [m]
  Real distance = 0;                        ///< of the cloth's feature from it [m]
  Real keep = 0;                            ///< height that particles keep besides [m]
};

/// Rows, and the cloths that started inside objects.
template <class Real>
struct RowList {
  std::vector<ContactRow<Real>> all;
  std::vector<MovingRow<Real>> moving;
  std::vector<BadStart<Real>> exits;

  /// Whether a row's cloth is just led out of the row's object, about which nothing is promised.
  bool leads_out(const ContactRow<Real>& row) const {
    return std::any_of(exits.begin(), exits.end(), [&row](const BadStart<Real>& exit) {
      return static_cast<Index>(exit.collider) == row.collider && exit.cloth == row.cloth;
    });
  }
};

/// All rows, and what is known of them together.
template <class Real>
struct ObjectRows : RowList<Real> {
  std::vector<RowRoom<Real>> rooms;  ///< of each row
  LoneRows<Real> lone;               ///< rows that no other row influences
  std::vector<std::size_t> joint;    ///< all others

  const MovingRow<Real>* moving_of(const ContactRow<Real>& row) const {
    return row.mover == kNone ? nullptr : &this->moving[at_index(row.mover)];
  }
  MovingRow<Real>* moving_of(const ContactRow<Real>& row) {
    return row.mover == kNone ? nullptr : &this->moving[at_index(row.mover)];
  }
};

/// Where rows were made, and how far particles may go from there.
template <class Real>
struct RowReach {
  bool made = false;
  Vec3Array<Real> x;          ///< positions then [m]
  std::vector<Real> reach;    ///< how far each may go until rows are made anew [m]
  std::vector<Real> travel2;  ///< squared displacement, now or after the drift [m^2]
};

/// What rows are made from.
template <class Real>
struct ObjectRowSource {
  const ContactCloths<Real>& cloths;
  const ObjectShapes<Real>& shapes;
  const ClothState<Real>& state;
  const Clearance<Real>& clearance;
  const NearFeatures<Real>& near;
  const ObjectPairs<Real>& pairs;
  const std::vector<Real>& reach;  ///< as RowReach has it [m]
  bool objects_move;
};

/// Rows that one part of the work has made, and what it needs for that.
template <class Real>
struct ObjectRowPart {
  RowList<Real> rows;
  std::vector<std::size_t> cursor;         ///< place in each mesh's particle pairs
  std::vector<MeshDistance<Real>> nearby;  ///< triangles near one particle
  std::uint64_t tests = 0;                 ///< closest points computed
};

/// What is known of particles and features while their rows are made.
template <class Real>
struct RowScratch {
  std::vector<Real> moved;    ///< by each particle since the collection [m]
  std::vector<Real> gap;      ///< of each from all meshes, at least [m]
  std::vector<Index> inside;  ///< of each the collider that it is inside of; see note_inside
  /// Of the near ones: no point of one is farther from its nearest corner, squared, even when
  /// pushed; a cheap bound for round objects [m^2].
  std::vector<Real> edge_spans2, triangle_spans2;
  /// Distance from the core of a round object that active particles keep while the rows hold [m].
  std::vector<Real> least_core;
  std::array<ObjectRowPart<Real>, kMostParts> parts;
};

/// Decides how far particles may go while the rows hold.
/// @param executor  runs parts of the work on its threads; may be null, here and below
/// @return whether the pairs hold for as long
template <class Real>
bool allow_rows(const ContactCloths<Real>& cloths, const ObjectShapes<Real>& shapes,
                const ObjectMotion<Real>& motion, const ClothState<Real>& state, Real dt,
                const Clearance<Real>& clearance, const NearFeatures<Real>& near,
                Executor* executor, std::vector<Real>& moved, std::vector<Real>& reach);

/// Adds a row. What its plane is worth is determined by the heights of the particles over it, in
/// double precision, whatever it was found by.
template <class Real>
void add_row(const ObjectRowSource<Real>& source, std::initializer_list<Index> particles,
             const std::array<Real, 3>& weights, const ContactBarrier<Real>& barrier,
             std::size_t collider, bool responds, RowList<Real>& rows);

/// Adds the rows of single particles with all objects.
template <class Real>
void add_particle_rows(const ObjectRowSource<Real>& source, Executor* executor,
                       RowScratch<Real>& scratch, RowList<Real>& rows, Profile& profile);

/// Adds the rows of edges and triangles with ridges and corners of meshes. Each pair that could
/// meet while the rows hold gets a plane that proves it apart; it also responds where particles
/// alone do not carry the cloth.
template <class Real>
void add_features_on_meshes(const ObjectRowSource<Real>& source, Executor* executor,
                            RowScratch<Real>& scratch, RowList<Real>& rows, Profile& profile);

/// Adds the rows of edges and triangles with balls and rods. On most of a smooth object particles
/// alone keep the cloth off, and a cheap bound proves it.
template <class Real>
void add_features_on_rounds(const ObjectRowSource<Real>& source, Executor* executor,
                            RowScratch<Real>& scratch, RowList<Real>& rows, Profile& profile);

/// What the corners of an edge or a triangle keep to while the rows hold.
template <class Real>
Corners<Real> corners_of(const ObjectRowSource<Real>& source, const std::vector<Real>& gap,
                         std::span<const Index> particles);

/// Height over the plane between it and a round object that a particle keeps while the rows hold,
/// so that edges and triangles are proved off by their corners. Where objects move none is kept.
/// @param distance  when the rows are made [m]
template <class Real>
Real kept_height(const ObjectRowSource<Real>& source, Index particle, Real distance);

/// Determines how far particles may go before each row matters, and sorts lone rows out.
template <class Real>
void finish_rows(const ContactCloths<Real>& cloths, std::size_t particles, Executor* executor,
                 ObjectRows<Real>& rows);

}  // namespace weft
