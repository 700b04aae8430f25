// Counts crossings, and finds cloth inside round objects.

#include "core/world/crossing_counter.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <utility>

#include "core/geometry/distance.h"
#include "core/world/constants.h"
#include "core/world/object_name.h"

namespace weft {
namespace {

/// Triangles of a collider as defined; empty for a shape without triangles.
TriangleMesh mesh_of(const ShapeDef& shape) {
  if (const auto* box = std::get_if<BoxDef>(&shape)) return world_mesh(*box);
  if (const auto* given = std::get_if<MeshDef>(&shape)) return given->mesh;
  return {};
}

void note(const Meeting& meeting, std::vector<Meeting>& list) {
  const auto known = std::find_if(list.begin(), list.end(),
                                  [&meeting](const Meeting& m) { return m.is_of(meeting); });
  if (known == list.end())
    list.push_back(meeting);
  else
    known->count += meeting.count;
}

/// Index of the cloth that contains a particle.
template <class Real>
Index cloth_of(const ClothModel<Real>& model, Index particle) {
  assert(particle >= 0 && particle < model.particle_count());
  Index cloth = 0;
  while (!model.parts[static_cast<std::size_t>(cloth)].particles.contains(particle)) ++cloth;
  return cloth;
}

double distance_of(const std::array<Vec3d, 3>& t, const Vec3d& a, const Vec3d& b) {
  const auto from = [&t](const Vec3d& p) {
    return (closest_on_triangle(p, t[0], t[1], t[2]).point - p).norm();
  };
  double least = std::min(from(a), from(b));
  for (std::size_t k = 0; k < 3; ++k) {
    const SegmentPoints<double> nearest = closest_of_segments(t[k], t[(k + 1) % 3], a, b);
    least = std::min(least, (nearest.p - nearest.q).norm());
  }
  return least;
}

/// Present distance of two features of cloths [m]: normals of rows date from their construction,
/// and a pair that has just come near has no row yet.
template <class Real>
double gap_of(const GuardedPair<Real>& pair, const Vec3Array<Real>& x) {
  std::array<Vec3d, 4> p;
  for (std::size_t k = 0; k < 4; ++k)
    p[k] = x[static_cast<std::size_t>(pair.particle[k])].template cast<double>();
  if (pair.kind == PairKind::vertex_triangle)
    return (p[0] - closest_on_triangle(p[0], p[1], p[2], p[3]).point).norm();
  const SegmentPoints<double> nearest = closest_of_segments(p[0], p[1], p[2], p[3]);
  return (nearest.p - nearest.q).norm();
}

}  // namespace

template <class Real>
void CrossingCounter<Real>::list_surfaces(const World<Real>& world) {
  cloth_.emplace(world.model().edges, world.model().triangles);
  objects_.clear();
  for (std::size_t k = 0; k < world.colliders().size(); ++k) {
    const ShapeDef& shape = world.def().colliders[k].shape;
    TriangleMesh mesh = mesh_of(shape);
    if (const auto* rod = std::get_if<CapsuleDef>(&shape))
      objects_.push_back({k, {rod->a, rod->b}, CrossingSurface({{0, 1}}, {}), {}});
    else if (!mesh.triangles.empty())
      objects_.push_back({k, mesh.positions, CrossingSurface(mesh), {}});
  }
}

template <class Real>
WorldCrossings CrossingCounter<Real>::count(const World<Real>& world,
                                            std::vector<Meeting>* meetings) {
  if (!cloth_) list_surfaces(world);
  const Vec3Array<Real>& x = world.state().x;
  cloth_->place(x.size(), [&x](std::size_t i) -> Vec3d { return x[i].template cast<double>(); });
  WorldCrossings found;
  const auto see = [&](Crossings& sum, Index one, Meeting meeting, const Crossings& how) {
    sum.proper += how.proper;
    sum.touching += how.touching;
    if (!meetings) return;
    meeting.cloth = cloth_of(world.model(), one);
    if (meeting.other != kNone) {
      meeting.other = cloth_of(world.model(), meeting.other);
      if (meeting.other < meeting.cloth) std::swap(meeting.cloth, meeting.other);
    }
    meeting.count = how.all();
    note(meeting, *meetings);
  };
  for_each_crossing(*cloth_, *cloth_, true,
                    [&](const Edge& edge, const Triangle& t, const Crossings& how) {
                      see(found.cloths, edge[0], {0, t[0], kNone, 0}, how);
                    });
  for (Object& object : objects_) {
    const Pose& pose = world.colliders()[object.collider].pose;
    if (!object.pose || !(*object.pose == pose)) {
      const ShapeDef& shape = world.def().colliders[object.collider].shape;
      // Bitwise at rest, because even a zero rotation would round.
      const bool rests = pose == rest_pose(shape);
      const Vec3d pivot = pivot_of(shape);
      object.surface.place(object.own.size(), [&](std::size_t i) -> Vec3d {
        return rests ? object.own[i] : pose.position + pose.rotation * (object.own[i] - pivot);
      });
      object.pose = pose;
    }
    const Meeting with{0, kNone, static_cast<Index>(object.collider), 0};
    for_each_crossing(*cloth_, object.surface, false,
                      [&](const Edge& edge, const Triangle&, const Crossings& how) {
                        see(found.objects, edge[0], with, how);
                      });
    for_each_crossing(object.surface, *cloth_, false,
                      [&](const Edge&, const Triangle& t, const Crossings& how) {
                        see(found.objects, t[0], with, how);
                      });
  }
  return found;
}

/// Finds triangles nearer to the centre of a ball or the axis of a capsule than its radius. The
/// cloth must have been placed.
template <class Real>
void CrossingCounter<Real>::find_in_rounds(const World<Real>& world,
                                           std::vector<Meeting>& meetings) const {
  assert(cloth_ && "a count comes first");
  for (std::size_t k = 0; k < world.colliders().size(); ++k) {
    const ShapeDef& shape = world.def().colliders[k].shape;
    const auto* ball = std::get_if<SphereDef>(&shape);
    const auto* rod = std::get_if<CapsuleDef>(&shape);
    if (!ball && !rod) continue;
    const Pose& pose = world.colliders()[k].pose;
    const Vec3d pivot = pivot_of(shape);
    const auto placed = [&](const Vec3d& p) -> Vec3d {
      return pose.position + pose.rotation * (p - pivot);
    };
    const Vec3d a = placed(ball ? ball->centre : rod->a), b = ball ? a : placed(rod->b);
    const double radius = (ball ? ball->radius : rod->radius) * (1 - kInRoundFraction);
    Aabb<double> box;
    for (const Vec3d& end : {a, b}) {
      box.add((end.array() - radius).matrix());
      box.add((end.array() + radius).matrix());
    }
    cloth_->tree().for_each_overlap(box, [&](Index number) {
      const Triangle& t = cloth_->triangles()[static_cast<std::size_t>(number)];
      std::array<Vec3d, 3> corners;
      for (std::size_t n = 0; n < 3; ++n)
        corners[n] = cloth_->positions()[static_cast<std::size_t>(t[n])];
      if (distance_of(corners, a, b) < radius)
        note({cloth_of(world.model(), t[0]), kNone, static_cast<Index>(k), 1}, meetings);
    });
  }
}

template <class Real>
void add_meetings(const World<Real>& world, const std::vector<Meeting>& meetings,
                  const std::string& verb, const std::vector<std::string>& known, BadStarts& to) {
  const WorldDef& def = world.def();
  const auto has = [](const std::vector<std::string>& list, const std::string& text) {
    return std::find(list.begin(), list.end(), text) != list.end();
  };
  if (contact_of(def) != ContactModel::certified) return;
  for (const Meeting& m : meetings) {
    const bool object = m.collider != kNone;
    if (!object && !has_guard(def)) continue;
    std::string through = cloth_name(def, m.cloth) + " " + verb + " ";
    if (object) {
      const auto k = static_cast<std::size_t>(m.collider);
      if (world.colliders()[k].voided) continue;  // it was forced there
      const std::string inside =
          cloth_name(def, m.cloth) + " started inside " + object_name(def, k);
      if (has(to.what, inside)) continue;
      through = has(known, inside) ? inside : through + object_name(def, k);
    } else {
      through += m.other == m.cloth ? "itself" : cloth_name(def, m.other);
    }
    if (has(to.what, through)) continue;
    to.what.push_back(through);
    to.pairs += m.count;
  }
}

template <class Real>
double smallest_gap(const World<Real>& world) {
  const Vec3Array<Real>& x = world.state().x;
  double smallest = std::numeric_limits<double>::infinity();
  for (const ContactRow<Real>& row : world.contact().rows()) {
    if (!row.responds) continue;
    smallest = std::min(smallest, static_cast<double>(world.contact().gap_of(row, x)));
  }
  if (!world.guard()) return smallest;
  for (const GuardedPair<Real>& pair : world.guard()->pairs()) {
    if (!pair.gone && !pair.open) smallest = std::min(smallest, gap_of(pair, x));
  }
  return smallest;
}

template void add_meetings(const World<float>&, const std::vector<Meeting>&, const std::string&,
                           const std::vector<std::string>&, BadStarts&);
template void add_meetings(const World<double>&, const std::vector<Meeting>&, const std::string&,
                           const std::vector<std::string>&, BadStarts&);
template class CrossingCounter<float>;
template class CrossingCounter<double>;
template double smallest_gap(const World<float>&);
template double smallest_gap(const World<double>&);

}  // namespace weft
