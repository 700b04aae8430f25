#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/cloth/fabric_presets.h"
#include "core/error.h"
#include "core/geometry/mesh_file.h"
#include "core/world/world_def.h"

// The format of a scene file, described once. The reader, the writer and the JSON Schema walk this
// description, and its ranges are those of the definitions themselves, so they cannot disagree.
// Each walker `Io` has
//
//   fields(walk)                         numbers, vectors, flags, words: walk(visit) calls
//                                        visit(FieldInfo, value&) for each
//   text(TextInfo, value&)               a string
//   orientation(name, meaning, value&)   a quaternion [x, y, z, w]
//   preset(fabric&)                      the key "preset"; true if nothing else has to be told
//   bending_lengths(fabric&)             the keys in place of the bending rigidities
//   object(name, meaning, describe)      describe(Io&) of what is inside
//   optional(name, meaning, value&, describe)   an object that may be absent
//   list(ListInfo, vector&, describe)    describe(Io&, element&)
//   tagged(TagInfo, index, describe)     a word that decides what else is there: describe(Io&, i);
//                                        called last, as everything before is common to all
//   mesh(placement, take)                take(MeshFile) with the mesh that the placement names

namespace weft::server {

struct TextInfo {
  const char* name;
  std::size_t least, most;  ///< characters
  bool plain;               ///< only letters, digits, `.`, `_`, `-`, not beginning with a dot
  bool required;
  const char* meaning;
  bool color = false;  ///< a colour as "#rrggbb"
};

struct ListInfo {
  const char* name;
  std::size_t least, most;
  const char* meaning;
};

struct TagInfo {
  FieldInfo choice;
  bool required;  ///< false: the default is the first word
};

inline constexpr std::size_t kMostColliders = 64;
inline constexpr std::size_t kMostScenePins = 1024;

/// All fields that `visit_fields_of_world` gives with this path.
template <class Io>
void describe_group(Io& io, WorldDef& def, const std::string& group) {
  io.fields([&](auto&& visit) {
    visit_fields_of_world(def, [&](const std::string& path, const FieldInfo& info, auto& value) {
      if (path == group) visit(info, value);
    });
  });
}

template <class Io>
void describe_placement(Io& io, MeshPlacement& placement) {
  io.text({"source", 1, 200, false, true, "name of a mesh: dress-form, gable, bunny, or a file"},
          placement.source);
  io.fields([&](auto&& visit) { visit_fields_of_placement(placement, visit); });
  io.orientation("orientation", "how it is turned", placement.orientation);
}

/// A fabric measured by ASTM D1388 may give its bending lengths in place of its rigidities.
struct BendingLength {
  FieldInfo info;
  const char* instead_of;
  double FabricDef::*rigidity;
};
inline constexpr BendingLength kBendingLengths[] = {
    {{"bending_length_warp", 0, kLongestBendingLength, "m",
      "measured along u, in place of bending_warp: the rigidity is areal_density g c^3"},
     "bending_warp",
     &FabricDef::bending_warp},
    {{"bending_length_weft", 0, kLongestBendingLength, "m",
      "measured along v, in place of bending_weft: the rigidity is areal_density g c^3"},
     "bending_weft",
     &FabricDef::bending_weft}};

template <class Io>
void describe_fabric(Io& io, FabricDef& fabric) {
  if (io.preset(fabric)) return;
  io.fields([&](auto&& visit) { visit_fields_of_fabric(fabric, visit); });
  io.bending_lengths(fabric);
}

template <class Io>
void describe_look(Io& io, LookDef& look) {
  io.fields([&](auto&& visit) { visit_fields_of_look(look, visit); });
  io.text({"color", 7, 7, false, false,
           "of the front, #rrggbb: the side from which its triangles are clockwise; a grid is "
           "seen from there with u to the right and v down",
           true},
          look.color);
  io.text({"back", 7, 7, false, false, "of the other side, #rrggbb", true}, look.back);
}

template <class Io>
void describe_cloth(Io& io, ClothDef& cloth) {
  io.text({"name", 1, 64, true, false, "pins name their cloth by it"}, cloth.name);
  io.object("fabric", "material", [&](Io& in) { describe_fabric(in, cloth.fabric); });
  io.optional("look", "how viewers draw it", cloth.look,
              [](Io& in, LookDef& look) { describe_look(in, look); });
  io.fields([&](auto&& visit) { visit_fields_of_any_cloth(cloth, visit); });
  io.tagged({choice("form", "grid|mesh", "a rectangle, or the vertices of a mesh"), false},
            cloth.mesh ? 1 : 0, [&](Io& in, int form) {
              if (form == 0) {
                cloth.mesh.reset();
                in.fields([&](auto&& visit) { visit_fields_of_grid(cloth, visit); });
                in.optional("direct_springs", "stiffness by hand instead of the fabric's",
                            cloth.direct_springs, [](Io& inner, DirectSprings& springs) {
                              inner.fields([&](auto&& visit) {
                                visit_fields_of_direct_springs(springs, visit);
                              });
                            });
                return;
              }
              if (!cloth.mesh) cloth.mesh.emplace();
              in.object("mesh", "where it comes from", [&](Io& inner) {
                ClothMesh& mesh = *cloth.mesh;
                describe_placement(inner, mesh.placement);
                inner.mesh(mesh.placement, [&](const MeshFile& file) {
                  if (!file.flat_face.empty())
                    throw DefinitionError("mesh", mesh.placement.source, "faces with an area",
                                          file.flat_face);
                  mesh.mesh = placed(file.mesh, mesh.placement);
                  mesh.uv = file.uv;
                  mesh.corner_uv = file.corner_uv;
                });
              });
            });
}

/// Makes alternative `index` of a variant the present one, unless it is already.
template <std::size_t K = 0, class Variant>
void choose_alternative(Variant& variant, int index) {
  if constexpr (K < std::variant_size_v<Variant>) {
    if (static_cast<int>(K) != index) return choose_alternative<K + 1>(variant, index);
    if (variant.index() != K) variant.template emplace<K>();
  }
}

template <class Io, class Shape>
void describe_shape(Io& io, Shape& shape) {
  if constexpr (std::is_same_v<Shape, MeshDef>) {
    describe_placement(io, shape.placement);
    io.mesh(shape.placement,
            [&](const MeshFile& file) { shape.mesh = placed(file.mesh, shape.placement); });
  } else {
    io.fields([&](auto&& visit) { visit_fields_of_shape(shape, visit); });
    if constexpr (std::is_same_v<Shape, BoxDef>)
      io.orientation("orientation", "how the box is turned", shape.orientation);
  }
}

template <class Io>
void describe_motion(Io& io, MotionDef& motion) {
  io.fields([&](auto&& visit) { visit_fields_of_motion(motion, visit); });
  io.list(ListInfo{"keyframes", 1, kMostKeyframes, "its poses, in order of time"}, motion.keyframes,
          [](Io& in, Keyframe& keyframe) {
            in.fields([&](auto&& visit) { visit_fields_of_keyframe(keyframe, visit); });
            in.orientation("rotation",
                           "turn about the pivot from how it is defined: the centre of a sphere or "
                           "box, the middle of a capsule, the point of a plane, the middle of the "
                           "box along the axes around a mesh where it is placed",
                           keyframe.rotation);
          });
}

template <class Io>
void describe_collider(Io& io, ColliderDef& collider) {
  io.text({"name", 1, 64, true, false, "commands name it by this"}, collider.name);
  io.fields([&](auto&& visit) { visit_fields_of_collider(collider, visit); });
  std::optional<MotionDef> motion;
  if (!collider.motion.keyframes.empty()) motion = collider.motion;
  io.optional("motion", "how it moves by itself", motion,
              [](Io& in, MotionDef& keyframed) { describe_motion(in, keyframed); });
  collider.motion = motion.value_or(MotionDef{});
  io.tagged({choice("shape", "plane|sphere|capsule|box|mesh", "what it is"), true},
            static_cast<int>(collider.shape.index()), [&](Io& in, int shape) {
              choose_alternative(collider.shape, shape);
              std::visit([&](auto& present) { describe_shape(in, present); }, collider.shape);
            });
}

template <class Io>
void describe_hand(Io& io, HandDef& hand) {
  io.text({"cloth", 1, 64, true, false, "name of the cloth; without it the first"}, hand.cloth);
  io.fields([&](auto&& visit) { visit_fields_of_hand(hand, visit); });
  io.list(
      ListInfo{"path", 1, kMostHandKeys,
               "targets of its pull, in order of time; it takes hold at the first time and lets "
               "go after the last, so with one target alone after a single tick"},
      hand.path, [](Io& in, HandKey& key) {
        in.fields([&](auto&& visit) { visit_fields_of_hand_key(key, visit); });
      });
}

template <class Io>
void describe_gripper(Io& io, GripperDef& gripper) {
  io.text({"name", 1, 56, true, false, "its jaws are the objects NAME.left and NAME.right"},
          gripper.name);
  io.fields([&](auto&& visit) { visit_fields_of_gripper(gripper, visit); });
  io.orientation("orientation", "how it is turned; its jaws close along its x axis",
                 gripper.orientation);
  io.list(ListInfo{"steps", 0, kMostGripperSteps, "its scheduled actions, in order of time"},
          gripper.steps, [](Io& in, GripperStep& step) {
            in.fields([&](auto&& visit) { visit_fields_of_gripper_step(step, visit); });
            in.orientation("rotation", "turn about its middle from how it is defined",
                           step.rotation);
          });
}

template <class Io>
void describe_pin(Io& io, PinDef& pin) {
  io.text({"cloth", 1, 64, true, false, "name of the cloth; without it the first"}, pin.cloth);
  io.fields([&](auto&& visit) { visit_fields_of_pin(pin, visit); });
  io.tagged({choice("place", "particle|corner|edge|point", "how the place is given"), true},
            static_cast<int>(pin.place.index()), [&](Io& in, int place) {
              choose_alternative(pin.place, place);
              in.fields([&](auto&& visit) {
                if (auto* particle = std::get_if<Index>(&pin.place))
                  visit_field_of_particle(*particle, visit);
                else if (auto* corner = std::get_if<Corner>(&pin.place))
                  visit_field_of_corner(*corner, visit);
                else if (auto* strip = std::get_if<EdgeStrip>(&pin.place))
                  visit_fields_of_strip(*strip, visit);
                else
                  visit_fields_of_point(std::get<MaterialPoint>(pin.place), visit);
              });
            });
}

/// Describes an object of fields, by its path.
inline const char* meaning_of_group(const std::string& path) {
  if (path == "environment.") return "gravity and air";
  if (path == "solver.") return "how the cloths are moved from tick to tick";
  if (path == "contact.") return "what keeps the cloths off objects and themselves";
  if (path == "verdict.") return "what a hard case must keep to";
  if (path == "relaxation.") return "settings of the solver relaxation";
  if (path == "implicit.") return "settings of the solver implicit";
  return "see the fields";
}

template <class Io>
void describe_fans(Io& io, std::vector<FanDef>& fans) {
  io.list(ListInfo{"fans", 0, kMostFans, "local winds"}, fans, [](Io& in, FanDef& fan) {
    in.fields([&](auto&& visit) { visit_fields_of_fan(fan, visit); });
  });
}

template <class Io>
void describe_scene(Io& io, WorldDef& def) {
  io.text({"name", 1, 64, true, false, "plain name of the scene"}, def.name);
  io.text({"description", 0, 500, false, false, "one sentence on what to look at"},
          def.description);
  io.optional("view", "where it is best looked at from", def.view, [](Io& in, ViewDef& view) {
    in.fields([&](auto&& visit) { visit_fields_of_view(view, visit); });
  });
  std::vector<std::string> groups;
  visit_fields_of_world(def, [&](const std::string& path, const FieldInfo&, auto&) {
    if (groups.empty() || groups.back() != path) groups.push_back(path);
  });
  for (const std::string& group : groups) {
    if (group.empty()) {
      describe_group(io, def, group);
      continue;
    }
    io.object(group.substr(0, group.size() - 1).c_str(), meaning_of_group(group), [&](Io& in) {
      describe_group(in, def, group);
      if (group == "environment.") describe_fans(in, def.environment.fans);
    });
  }
  io.list(ListInfo{"cloths", 1, kMostCloths, "what is simulated"}, def.cloths,
          [](Io& in, ClothDef& cloth) { describe_cloth(in, cloth); });
  io.list(ListInfo{"colliders", 0, kMostColliders, "what the cloths cannot enter"}, def.colliders,
          [](Io& in, ColliderDef& collider) { describe_collider(in, collider); });
  io.list(ListInfo{"pins", 0, kMostScenePins, "what is held at the start"}, def.pins,
          [](Io& in, PinDef& pin) { describe_pin(in, pin); });
  io.list(ListInfo{"hands", 0, kMostSceneHands, "hands that the scene has itself"}, def.hands,
          [](Io& in, HandDef& hand) { describe_hand(in, hand); });
  io.list(ListInfo{"insults", 0, kMostDisturbances, "what is done to it at once"}, def.disturbances,
          [](Io& in, DisturbanceDef& disturbance) {
            in.fields([&](auto&& visit) { visit_fields_of_disturbance(disturbance, visit); });
          });
  io.list(ListInfo{"winds", 0, kMostWinds, "winds that blow one after the other"}, def.winds,
          [](Io& in, WindKey& key) {
            in.fields([&](auto&& visit) { visit_fields_of_wind_key(key, visit); });
          });
  io.list(ListInfo{"grippers", 0, kMostGrippers, "pairs of jaws that close with bounded force"},
          def.grippers, [](Io& in, GripperDef& gripper) { describe_gripper(in, gripper); });
}

}  // namespace weft::server
