#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/world/world.h"
#include "proto/commands.h"
#include "proto/data.h"
#include "proto/events.h"
#include "proto/frame.h"
#include "proto/mesh.h"
#include "proto/replies.h"

// The only place where the wire's types meet those of the physics.

namespace weft::server {

/// The world that is served.
using ServedWorld = World<float>;

proto::Vec3 to_wire(const Vec3d& v);
proto::Vec3f to_wire_float(const Vec3f& v);
Vec3d from_wire(const proto::Vec3& v);

/// Three numbers a vertex, without copying.
std::span<const float> floats_of(const Vec3Array<float>& vectors);

/// Checks that the index exists and gives the triangle with weights (for a particle: one of its
/// triangles with all weight on it).
proto::Result<proto::SurfacePoint> resolve_hold(const ServedWorld& world, const proto::Hold& hold);

/// The corner with the greatest weight.
Index nearest_corner(const ServedWorld& world, const proto::SurfacePoint& point);

/// @param target  where to pull; absent: where the point is now
GrabDef grab_def(const ServedWorld& world, const proto::DragStart& start,
                 const proto::SurfacePoint& point);

/// The environment with what the command sets.
EnvironmentDef with_settings(EnvironmentDef environment, const proto::Set& set);

/// The budget with what the command sets.
BudgetDef with_settings(BudgetDef budget, const proto::Set& set);
proto::OverBudget to_wire(OverBudget remedy);

std::optional<proto::ClothHit> to_wire(const std::optional<ClothHit>& hit);
proto::Energy to_wire(const Energies& energies);
proto::State state_of(const ServedWorld& world);  ///< without what only the room knows
std::vector<proto::StageWork> work_of(const ServedWorld& world);
std::vector<proto::TreeInfo> trees_of(ServedWorld& world);

/// What the scene's test measures, e.g. the drape coefficient.
proto::Measurements measurements_of(const ServedWorld& world);

/// Colliders that are not as they were told; replaces what is in `samples`.
void pose_samples(const ServedWorld& world, std::vector<proto::PoseSample>& samples);
std::vector<proto::ColliderPose> collider_poses(const ServedWorld& world);

/// The first collider of this name.
proto::Result<std::size_t> find_collider(const ServedWorld& world, const std::string& name);

/// The command in full: what it does not tell stays as it is.
MoveDef move_def(const ServedWorld& world, std::size_t collider, const proto::Move& move);

/// The gripper of this name.
proto::Result<std::size_t> find_gripper(const ServedWorld& world, const std::string& name);
GripperCommand gripper_command(const proto::Gripper& command);
std::vector<proto::GripperInfo> grippers_of(const ServedWorld& world);

proto::SceneMesh scene_mesh(const ServedWorld& world);
/// Without epoch, hash and bytes.
proto::MeshAnnouncement mesh_announcement(const ServedWorld& world);

/// A refused definition, as the wire tells it.
proto::Error to_wire(const DefinitionError& error);

}  // namespace weft::server
