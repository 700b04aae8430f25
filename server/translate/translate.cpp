#include "server/translate/translate.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/diagnostics/strain.h"
#include "core/error.h"
#include "server/translate/translate_energy.h"
#include "server/translate/translate_settings.h"

namespace weft::server {
namespace {

// Positions are sent as they lie in memory.
static_assert(sizeof(Vec3f) == 3 * sizeof(float));

std::vector<float> floats_copied(const std::vector<Vec3d>& vectors) {
  std::vector<float> out;
  out.reserve(vectors.size() * 3);
  for (const Vec3d& v : vectors)
    for (int axis = 0; axis < 3; ++axis) out.push_back(static_cast<float>(v[axis]));
  return out;
}

std::vector<std::uint32_t> indices_of(const std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> out;
  out.reserve(triangles.size() * 3);
  for (const Triangle& triangle : triangles)
    for (const Index corner : triangle) out.push_back(static_cast<std::uint32_t>(corner));
  return out;
}

/// Fabric coordinates of each cloth, scaled to 0..1 in each direction.
std::vector<float> uv_of(const ClothModel<float>& model) {
  std::vector<float> out;
  out.reserve(model.material.size() * 2);
  for (const ClothPart<float>& part : model.parts) {
    const std::span points(model.material.data() + part.particles.first,
                           static_cast<std::size_t>(part.particles.count));
    std::array<float, 2> low = {INFINITY, INFINITY}, high = {-INFINITY, -INFINITY};
    for (const auto& point : points) {
      for (std::size_t i = 0; i < 2; ++i) {
        low[i] = std::min(low[i], point[i]);
        high[i] = std::max(high[i], point[i]);
      }
    }
    for (const auto& point : points)
      for (std::size_t i = 0; i < 2; ++i) out.push_back((point[i] - low[i]) / (high[i] - low[i]));
  }
  return out;
}

struct ShapeWriter {
  decltype(proto::ColliderInfo::shape) operator()(const PlaneDef& plane) const {
    return proto::PlaneInfo{to_wire(plane.point), to_wire(Vec3d(plane.normal.normalized()))};
  }
  decltype(proto::ColliderInfo::shape) operator()(const SphereDef& sphere) const {
    return proto::SphereInfo{to_wire(sphere.centre), sphere.radius};
  }
  decltype(proto::ColliderInfo::shape) operator()(const CapsuleDef& capsule) const {
    return proto::CapsuleInfo{to_wire(capsule.a), to_wire(capsule.b), capsule.radius};
  }
  decltype(proto::ColliderInfo::shape) operator()(const BoxDef& box) const {
    const Eigen::Quaterniond q = box.orientation.normalized();
    return proto::BoxInfo{
        to_wire(box.centre), to_wire(box.half_extents), {q.x(), q.y(), q.z(), q.w()}};
  }
  decltype(proto::ColliderInfo::shape) operator()(const MeshDef& mesh) const {
    return proto::MeshInfo{static_cast<std::uint32_t>(mesh.mesh.positions.size()),
                           static_cast<std::uint32_t>(mesh.mesh.triangles.size())};
  }
};

proto::Error index_error(const char* field, std::uint32_t index, std::size_t count) {
  return proto::range_error(field, index, {0, static_cast<double>(count) - 1});
}

}  // namespace

proto::Vec3 to_wire(const Vec3d& v) {
  return {v[0], v[1], v[2]};
}
proto::Vec3f to_wire_float(const Vec3f& v) {
  return {v[0], v[1], v[2]};
}
Vec3d from_wire(const proto::Vec3& v) {
  return {v[0], v[1], v[2]};
}

std::span<const float> floats_of(const Vec3Array<float>& vectors) {
  return {vectors.empty() ? nullptr : vectors.front().data(), vectors.size() * 3};
}

proto::Result<proto::SurfacePoint> resolve_hold(const ServedWorld& world, const proto::Hold& hold) {
  const ClothModel<float>& model = world.model();
  if (const auto* point = std::get_if<proto::SurfacePoint>(&hold)) {
    if (point->triangle >= model.triangles.size())
      return index_error("triangle", point->triangle, model.triangles.size());
    proto::SurfacePoint exact = *point;
    // The wire allows a rounded sum; the physics needs weights that sum to one.
    const double sum = exact.barycentric[0] + exact.barycentric[1] + exact.barycentric[2];
    for (double& weight : exact.barycentric) weight /= sum;
    return exact;
  }
  const std::uint32_t particle = std::get<proto::Particle>(hold).index;
  if (particle >= model.mass.size()) return index_error("particle", particle, model.mass.size());
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      if (model.triangles[t][corner] != static_cast<Index>(particle)) continue;
      proto::SurfacePoint point{static_cast<std::uint32_t>(t), {0, 0, 0}};
      point.barycentric[corner] = 1;
      return point;
    }
  }
  return proto::make_error(proto::ErrorCode::internal, "the particle belongs to no triangle");
}

Index nearest_corner(const ServedWorld& world, const proto::SurfacePoint& point) {
  const auto heaviest = std::max_element(point.barycentric.begin(), point.barycentric.end());
  return world.model()
      .triangles[point.triangle][static_cast<std::size_t>(heaviest - point.barycentric.begin())];
}

GrabDef grab_def(const ServedWorld& world, const proto::DragStart& start,
                 const proto::SurfacePoint& point) {
  GrabDef def;
  def.triangle = static_cast<Index>(point.triangle);
  def.barycentric = point.barycentric;
  def.radius = start.radius;
  def.stiffness = start.stiffness;
  def.max_force = start.max_force;
  def.mode = start.mode == proto::DragMode::sling ? GrabMode::sling : GrabMode::live;
  if (start.target) {
    def.target = from_wire(*start.target);
    return def;
  }
  const Triangle& corners = world.model().triangles[point.triangle];
  for (std::size_t i = 0; i < 3; ++i)
    def.target +=
        point.barycentric[i] * world.state().x[static_cast<std::size_t>(corners[i])].cast<double>();
  return def;
}

std::optional<proto::ClothHit> to_wire(const std::optional<ClothHit>& hit) {
  if (!hit) return std::nullopt;
  proto::ClothHit out;
  out.point.triangle = static_cast<std::uint32_t>(hit->triangle);
  out.point.barycentric = hit->barycentric;
  out.position = to_wire(hit->position);
  out.particle = static_cast<std::uint32_t>(hit->nearest_particle);
  out.distance = hit->distance;
  return out;
}

proto::Energy to_wire(const Energies& energies) {
  return {energies.kinetic, energies.stretch, energies.bending, energies.gravity, energies.total()};
}

proto::State state_of(const ServedWorld& world) {
  proto::State state;
  state.tick = world.tick();
  state.time = static_cast<double>(world.tick()) * world.tick_seconds();
  state.scene = world.def().name;
  state.tick_rate = world.def().tick_rate;
  tell_settings(world, state);
  state.solver = solver_name(world.def());
  state.substeps = static_cast<std::uint32_t>(world.report().substeps);
  state.particles = static_cast<std::uint32_t>(world.model().mass.size());
  const Sleep<float>& sleep = world.sleep();
  for (std::size_t p = 0; p < world.model().parts.size(); ++p) {
    if (!sleep.is_asleep(p)) continue;
    state.sleeping.cloths.push_back(world.def().cloths[p].name);
    state.sleeping.islands += sleep.island_of(p) == p ? 1U : 0U;
  }
  thread_local std::vector<float> scratch;
  const StrainStatistics strain = strain_statistics(world.model(), world.state().x, scratch);
  state.strain = {strain.largest, strain.p99};
  state.energy = to_wire(world.report().energies);
  state.balance = balance_of(world);
  return state;
}

std::vector<proto::TreeInfo> trees_of(ServedWorld& world) {
  std::vector<proto::TreeInfo> trees;
  for (const std::string& name : world.debug_tree_names())
    trees.push_back({name, static_cast<std::uint32_t>(world.debug_tree_levels(name))});
  return trees;
}

proto::Measurements measurements_of(const ServedWorld& world) {
  proto::Measurements result;
  for (const NamedNumber& m : world.measurements()) result.values.emplace_back(m.name, m.value);
  return result;
}

std::vector<proto::StageWork> work_of(const ServedWorld& world) {
  std::vector<proto::StageWork> work;
  for (std::size_t i = 0; i < kStageCount; ++i) {
    const StageProfile& stage = world.report().profile.stages[i];
    work.push_back({kStageNames[i], stage.seconds * 1000, stage.work});
  }
  return work;
}

void pose_samples(const ServedWorld& world, std::vector<proto::PoseSample>& samples) {
  samples.clear();
  for (std::size_t k = 0; k < world.colliders().size(); ++k) {
    const Pose& pose = world.colliders()[k].pose;
    if (pose == rest_pose(world.def().colliders[k].shape)) continue;
    const Eigen::Quaternionf q = pose.rotation.cast<float>();
    samples.push_back({static_cast<std::uint32_t>(k),
                       to_wire_float(pose.position.cast<float>()),
                       {q.x(), q.y(), q.z(), q.w()}});
  }
}

std::vector<proto::ColliderPose> collider_poses(const ServedWorld& world) {
  std::vector<proto::ColliderPose> poses;
  for (std::size_t k = 0; k < world.colliders().size(); ++k) {
    const ColliderState& state = world.colliders()[k];
    const Eigen::Quaterniond& q = state.pose.rotation;
    poses.push_back({world.def().colliders[k].name,
                     to_wire(state.pose.position),
                     {q.x(), q.y(), q.z(), q.w()},
                     to_wire(state.force),
                     state.blocked,
                     state.voided});
  }
  return poses;
}

proto::Result<std::size_t> find_collider(const ServedWorld& world,
                                         const proto::ColliderRef& wanted) {
  const std::vector<ColliderDef>& colliders = world.def().colliders;
  if (const auto* index = std::get_if<std::uint32_t>(&wanted)) {
    if (*index < colliders.size()) return *index;
    proto::Error error =
        proto::make_error(proto::ErrorCode::unknown_collider, "the scene has no such collider",
                          "see the list of mesh");
    error.field = "collider";
    error.value = std::to_string(*index);
    error.limit = proto::Limit{0, static_cast<double>(colliders.size()) - 1, {}, {}};
    return error;
  }
  const auto& name = std::get<std::string>(wanted);
  std::vector<std::string> names;
  const std::size_t movable = colliders.size() - 2 * world.grippers().size();  // then come jaws
  for (std::size_t k = 0; k < colliders.size(); ++k) {
    if (colliders[k].name == name) return k;
    if (k < movable && std::find(names.begin(), names.end(), colliders[k].name) == names.end())
      names.push_back(colliders[k].name);
  }
  proto::Error error = proto::word_error("collider", name, std::move(names));
  error.code = proto::ErrorCode::unknown_collider;
  return error;
}

MoveDef move_def(const ServedWorld& world, std::size_t collider, const proto::Move& move) {
  MoveDef def{world.colliders()[collider].pose, move.speed, move.turn_speed, move.force};
  if (move.position) def.target.position = from_wire(*move.position);
  if (move.rotation) {
    const proto::Quat& q = *move.rotation;
    def.target.rotation = Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
  }
  return def;
}

proto::SceneMesh scene_mesh(const ServedWorld& world) {
  proto::SceneMesh mesh;
  const ClothModel<float>& model = world.model();
  const std::span<const float> rest = floats_of(model.rest_positions);
  mesh.rest_positions.assign(rest.begin(), rest.end());
  mesh.triangles = indices_of(model.triangles);
  mesh.uv = uv_of(model);
  const std::vector<ColliderDef>& colliders = world.def().colliders;
  for (std::size_t i = 0; i < colliders.size(); ++i) {
    if (const auto* shape = std::get_if<MeshDef>(&colliders[i].shape))
      mesh.colliders.push_back({static_cast<std::uint16_t>(i), floats_copied(shape->mesh.positions),
                                indices_of(shape->mesh.triangles)});
  }
  return mesh;
}

proto::LookInfo look_of(const ClothDef& cloth) {
  proto::LookInfo look{look_name(cloth), {}, {}};
  if (cloth.look) {
    look.color = cloth.look->color;
    look.back = cloth.look->back;
  }
  return look;
}

proto::MeshAnnouncement mesh_announcement(const ServedWorld& world) {
  proto::MeshAnnouncement announcement;
  const ClothModel<float>& model = world.model();
  announcement.scene = world.def().name;
  announcement.vertices = static_cast<std::uint32_t>(model.mass.size());
  announcement.triangles = static_cast<std::uint32_t>(model.triangles.size());
  const auto count = [](Index value) { return static_cast<std::uint32_t>(value); };
  for (std::size_t k = 0; k < model.parts.size(); ++k) {
    const ClothPart<float>& part = model.parts[k];
    announcement.cloths.push_back(
        {part.name, count(part.particles.first), count(part.particles.count),
         count(part.triangles.first), count(part.triangles.count), count(part.rows),
         count(part.columns), part.fabric.thickness, look_of(world.def().cloths[k])});
  }
  if (const std::optional<ViewDef>& view = world.def().view)
    announcement.view = {to_wire(view->target), to_wire(view->direction.normalized()),
                         view->radius};
  for (const ColliderDef& collider : world.def().colliders)
    announcement.colliders.push_back({collider.name, std::visit(ShapeWriter{}, collider.shape),
                                      to_wire(pivot_of(collider.shape))});
  return announcement;
}

std::shared_ptr<const proto::codec::CodingOrder> give_order(
    proto::SceneMesh& mesh, const proto::MeshAnnouncement& announcement) {
  std::vector<proto::codec::ClothRange> ranges;
  for (const proto::ClothInfo& cloth : announcement.cloths)
    ranges.push_back({cloth.first_vertex, cloth.vertices, cloth.first_triangle, cloth.triangles,
                      cloth.rows, cloth.columns});
  auto order = std::make_shared<proto::codec::CodingOrder>(
      proto::codec::make_order(mesh.rest_positions, mesh.triangles, ranges));
  if (!proto::codec::all_grids(ranges)) mesh.order = proto::codec::order_words(*order);
  return order;
}

proto::Error to_wire(const DefinitionError& error) {
  const bool cost = dynamic_cast<const CostError*>(&error) != nullptr;
  proto::Error out =
      proto::make_error(cost ? proto::ErrorCode::too_costly : proto::ErrorCode::out_of_range,
                        error.what(), error.hint);
  out.field = error.field;
  double number = 0;
  const char* const end = error.value.data() + error.value.size();
  const auto [stop, status] = std::from_chars(error.value.data(), end, number);
  const bool is_number = status == std::errc() && stop == end && std::isfinite(number);
  out.value = is_number ? proto::number_text(number) : proto::quoted_value(error.value);
  if (error.range) out.limit = proto::Limit{error.range->minimum, error.range->maximum, {}, {}};
  return out;
}

}  // namespace weft::server
