#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/world/world.h"
#include "proto/codec/order.h"
#include "proto/frames/frame.h"
#include "proto/frames/mesh.h"
#include "proto/messages/commands.h"
#include "proto/messages/data.h"
#include "proto/messages/events.h"
#include "proto/messages/replies.h"

// The only place where the types of the wire meet those of the physics.

namespace weft::server {

/// The type of world that the server runs.
using ServedWorld = World<float>;

proto::Vec3 to_wire(const Vec3d& v);
proto::Vec3f to_wire_float(const Vec3f& v);
Vec3d from_wire(const proto::Vec3& v);

/// Three numbers per vertex, without copying.
std::span<const float> floats_of(const Vec3Array<float>& vectors);

/// Checks that the index exists and returns the triangle with weights (for a particle: one of its
/// triangles with all weight on it).
proto::Result<proto::SurfacePoint> resolve_hold(const ServedWorld& world, const proto::Hold& hold);

/// The corner with the largest weight.
Index nearest_corner(const ServedWorld& world, const proto::SurfacePoint& point);

/// @param target  of the pull; absent: the present position of the point
GrabDef grab_def(const ServedWorld& world, const proto::DragStart& start,
                 const proto::SurfacePoint& point);

std::optional<proto::ClothHit> to_wire(const std::optional<ClothHit>& hit);
proto::Energy to_wire(const Energies& energies);
proto::State state_of(const ServedWorld& world);  ///< without the room's own values
std::vector<proto::StageWork> work_of(const ServedWorld& world);
std::vector<proto::TreeInfo> trees_of(ServedWorld& world);

/// Measurements of the scene's test, e.g. the drape coefficient.
proto::Measurements measurements_of(const ServedWorld& world);

/// Colliders that differ from their last announced pose; overwrites `samples`.
void pose_samples(const ServedWorld& world, std::vector<proto::PoseSample>& samples);
std::vector<proto::ColliderPose> collider_poses(const ServedWorld& world);

/// The first collider of this name.
proto::Result<std::size_t> find_collider(const ServedWorld& world,
                                         const proto::ColliderRef& wanted);

/// The command in full: omitted values stay as they are.
MoveDef move_def(const ServedWorld& world, std::size_t collider, const proto::Move& move);

/// The gripper of this name.
proto::Result<std::size_t> find_gripper(const ServedWorld& world, const std::string& name);
GripperCommand gripper_command(const proto::Gripper& command);
std::vector<proto::GripperInfo> grippers_of(const ServedWorld& world);

proto::SceneMesh scene_mesh(const ServedWorld& world);
/// Without epoch, hash and bytes.
proto::MeshAnnouncement mesh_announcement(const ServedWorld& world);
/// The order in which packed frames have the vertices of a mesh. Writes it into the mesh if clients
/// cannot work it out by themselves.
std::shared_ptr<const proto::codec::CodingOrder> give_order(
    proto::SceneMesh& mesh, const proto::MeshAnnouncement& announcement);

/// A refused definition as an error of the wire.
proto::Error to_wire(const DefinitionError& error);

}  // namespace weft::server
