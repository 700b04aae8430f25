#include "tests/fuzz/scene_rules.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/cloth/cloth_def.h"
#include "core/cloth/fabric_presets.h"
#include "core/contact/colliders/collider_motion.h"

namespace weft::fuzz {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLeastPause = 1e-3;  // between two instants of a list [s]
constexpr double kLastTime = 3600;    // [s]

Vec3d vector_of(const Json& object, const char* name, const Vec3d& otherwise) {
  if (!object.contains(name)) return otherwise;
  const Json& v = object[name];
  return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()};
}
Json json_of(const Vec3d& v) {
  return {v[0], v[1], v[2]};
}

Eigen::Quaterniond rotation_of(const Json& object) {
  if (!object.contains("rotation")) return Eigen::Quaterniond::Identity();
  const Json& q = object["rotation"];
  return {q[3].get<double>(), q[0].get<double>(), q[1].get<double>(), q[2].get<double>()};
}

double time_of(const Json& key) {
  return key.value("time", 0.0);
}

FabricDef preset_of(const Json& fabric) {
  for (const FabricPreset& preset : fabric_presets())
    if (fabric.value("preset", "") == preset.name) return preset.fabric;
  return {};
}

/// Makes most cells square, and their shear no stiffer than cells of their shape can have.
void keep_cells(Dice dice, Json& cloth) {
  const double rows = cloth.value("rows", ClothDef{}.rows) - 1;
  const double columns = cloth.value("columns", ClothDef{}.columns) - 1;
  if (dice.chance(0.7)) {
    const double width = cloth.value("width", ClothDef{}.width);
    cloth["height"] = std::clamp(width * rows / columns, 1e-3, 100.0);
  }
  const double cell_u = cloth.value("width", ClothDef{}.width) / columns;
  const double ratio2 = std::pow(cell_u * rows / cloth.value("height", ClothDef{}.height), 2);
  const Json told = cloth.value("fabric", Json::object());
  const FabricDef preset = preset_of(told);
  const double most = std::min(told.value("stretch_warp", preset.stretch_warp) / ratio2,
                               told.value("stretch_weft", preset.stretch_weft) * ratio2);
  if (told.value("shear", preset.shear) > most)
    cloth["fabric"]["shear"] = most * (dice.chance(0.5) ? 0.999 : dice.uniform(0, 0.999));
}

/// Whether the scene's solver takes springs as rigid, and so has no membrane triangles.
bool relaxes_rigidly(const Json& scene) {
  const Json solver = scene.value("solver", Json::object());
  const std::string kind = solver.value("kind", "automatic");
  const bool relaxes =
      kind == "automatic" ? scene.value("model", "") == "seed" : kind == "relaxation";
  const Json relaxation = scene.value("relaxation", Json::object());
  return relaxes && relaxation.value("compliance", 0.0) == 0;
}

/// Keeps to membranes that the cloth can have, and their tensor positive definite.
void keep_membrane(const Dice& dice, bool rigid, Json& cloth) {
  const std::string model = cloth.value("membrane_model", "automatic");
  const bool mesh = cloth.value("form", "") == "mesh";
  if (model == "triangles" && (rigid || !mesh)) cloth.erase("membrane_model");
  Json told = cloth.value("fabric", Json::object());
  if (!mesh || rigid || model == "springs") {
    if (told.contains("poisson")) cloth["fabric"].erase("poisson");
    return;
  }
  const FabricDef preset = preset_of(told);
  const double warp = told.value("stretch_warp", preset.stretch_warp),
               weft = told.value("stretch_weft", preset.stretch_weft);
  const double share = Dice(dice).uniform(0, 0.999);
  const bool own = told.value("poisson", kPoissonOfGrid) != kPoissonOfGrid;
  if (own && weft > 0)
    cloth["fabric"]["poisson"] = std::min(100.0, share * std::sqrt(warp / weft));
  else if (own)
    cloth["fabric"].erase("poisson");
  if ((!own || !(weft > 0)) && told.value("shear", preset.shear) >= std::sqrt(warp * weft))
    cloth["fabric"]["shear"] = share * std::sqrt(warp * weft);
}

/// Whether verlet steps the scene, which alone has threads that lock.
bool has_locks(const Json& scene) {
  const Json solver = scene.value("solver", Json::object());
  const std::string kind = solver.value("kind", "automatic");
  return kind == "verlet" || (kind == "automatic" && scene.value("model", "") != "seed");
}

/// Keeps to rest shapes and threads that the cloth can have.
void keep_threads(bool locks, Json& cloth) {
  const bool mesh = cloth.value("form", "") == "mesh";
  if (!mesh) cloth.erase("rest_shape");
  const bool springs = mesh ? cloth.value("membrane_model", "automatic") == "springs"
                            : cloth.contains("direct_springs");
  if ((!locks || springs) && cloth.contains("fabric")) cloth["fabric"].erase("locking_strain");
}

void keep_cloth(const Dice& dice, bool rigid, Json& cloth) {
  if (cloth.value("form", "") != "mesh") keep_cells(dice, cloth);
  keep_membrane(dice, rigid, cloth);
  const Json fabric = cloth.value("fabric", Json::object());
  const bool bends_flat = !cloth.contains("rest_angle") && !fabric.contains("preset");
  if (cloth.value("bending_model", "") == "quadratic" && !bends_flat) cloth.erase("bending_model");
  if (cloth.value("outline", "") == "ellipse") {
    cloth.erase("skip_stiffness");
    cloth.erase("direct_springs");
  }
  if (!cloth.contains("u") && !cloth.contains("v")) return;
  const Vec3d u = vector_of(cloth, "u", Vec3d::UnitX()).normalized();
  Vec3d v = vector_of(cloth, "v", -Vec3d::UnitY());
  v -= u * u.dot(v);
  if (!(u.norm() > 0.5) || !(v.norm() > 1e-3)) {
    cloth.erase("u");
    cloth.erase("v");
    return;
  }
  v /= std::max(1.0, v.norm() / 1e3);
  v -= u * u.dot(v);
  cloth["v"] = json_of(v);
}

/// Times that grow from one to the next; what would be later than the last one allowed is left out.
void keep_times(Json& list) {
  std::vector<Json> keys(list.begin(), list.end());
  std::stable_sort(keys.begin(), keys.end(),
                   [](const Json& a, const Json& b) { return time_of(a) < time_of(b); });
  list = Json::array();
  for (Json& key : keys) {
    if (!list.empty()) key["time"] = std::max(time_of(key), time_of(list.back()) + kLeastPause);
    if (time_of(key) <= kLastTime) list.push_back(std::move(key));
  }
}

/// The least time from one pose to another without a jump [s].
double least_pause(const Json& from, const Json& to) {
  const Vec3d step =
      vector_of(to, "offset", Vec3d::Zero()) - vector_of(from, "offset", Vec3d::Zero());
  const double turn = rotation_of(to).angularDistance(rotation_of(from));
  const double steepest = 1.51;  // of motion that is at rest at each keyframe
  return kLeastPause +
         steepest * std::max(step.norm() / kMostColliderSpeed, turn / kMostColliderTurnSpeed);
}

void keep_motion(Json& motion, bool may_turn) {
  Json& keys = motion["keyframes"];
  if (!may_turn) {
    for (Json& key : keys) key.erase("rotation");
  }
  keep_times(keys);
  Json kept = Json::array();
  const bool loops = motion.value("loop", false);
  if (loops) {
    keys.push_back(keys[0]);
    keys.back()["time"] = 0;
  }
  for (Json& key : keys) {
    if (!kept.empty())
      key["time"] = std::max(time_of(key), time_of(kept.back()) + least_pause(kept.back(), key));
    if (time_of(key) <= kLastTime) kept.push_back(std::move(key));
  }
  keys = std::move(kept);
  if (loops)
    motion["loop"] = keys.size() > 1 && least_pause(keys.front(), keys.back()) <= kLeastPause;
}

int particles_of_cloth(const Json& cloth) {
  constexpr int kMeshGuess = 6;
  if (cloth.value("form", "") == "mesh") return kMeshGuess;
  const int all = cloth.value("rows", ClothDef{}.rows) * cloth.value("columns", ClothDef{}.columns);
  return cloth.value("outline", "") == "ellipse" ? (all + 1) / 2 : all;
}

/// A particle's number is one of its cloth, or of all cloths if none is named.
void keep_pin(const Json& scene, Json& pin) {
  if (pin.value("place", "") != "particle" || !pin.contains("particle")) return;
  int count = particles_of(scene);
  for (const Json& cloth : scene["cloths"])
    if (pin.contains("cloth") && cloth.value("name", "") == pin["cloth"])
      count = particles_of_cloth(cloth);
  pin["particle"] = pin["particle"].get<int>() % count;
}

bool is_seed_contact(const Json& scene) {
  const std::string contact = scene.contains("contact") ? scene["contact"].value("model", "") : "";
  if (contact == "weft" || contact == "seed") return contact == "seed";
  return scene.value("model", "") == "seed";
}

void keep_contact(Json& scene) {
  const bool seed = is_seed_contact(scene);
  if (seed) {
    scene.erase("grippers");
    if (scene.contains("colliders"))
      for (Json& collider : scene["colliders"]) collider.erase("friction_factor");
  }
  if (!scene.contains("contact")) return;
  Json& contact = scene["contact"];
  const std::string self = contact.value("self", "automatic");
  if (seed ? self == "guard" : self != "guard" && self != "none") contact.erase("self");
  const double depth = contact.value("fold_depth", 0.02);
  if (contact.value("correction", "") == "fold_map" && !(contact.value("lift", 0.0) < depth))
    contact["lift"] = depth / 2;
}

}  // namespace

void make_legal(const Dice& dice, Json& scene) {
  for (std::size_t k = 0; k < scene["cloths"].size(); ++k) {
    keep_cloth(dice.of("cloths").of(k), relaxes_rigidly(scene), scene["cloths"][k]);
    keep_threads(has_locks(scene), scene["cloths"][k]);
  }
  if (scene.contains("colliders")) {
    for (Json& collider : scene["colliders"]) {
      if (collider.contains("motion"))
        keep_motion(collider["motion"], collider.value("shape", "") != "plane");
    }
  }
  for (const char* list : {"hands", "grippers"}) {
    if (!scene.contains(list)) continue;
    for (Json& each : scene[list]) {
      for (const char* keys : {"path", "steps"})
        if (each.contains(keys)) keep_times(each[keys]);
    }
  }
  if (scene.contains("pins")) {
    for (Json& pin : scene["pins"]) keep_pin(scene, pin);
  }
  if (scene.contains("winds")) keep_times(scene["winds"]);
  keep_contact(scene);
  // A textile test is for cloth that does not sleep; one of them goes.
  if (scene.value("test", "none") != "none" && scene.contains("sleep"))
    scene.erase(dice.of("sleep").chance(0.5) ? "sleep" : "test");
}

int particles_of(const Json& scene) {
  int count = 0;
  for (const Json& cloth : scene["cloths"]) count += particles_of_cloth(cloth);
  return count;
}

}  // namespace weft::fuzz
