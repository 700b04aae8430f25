#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "proto/error.h"
#include "proto/messages/events.h"
#include "server/room/guarantee_watch.h"
#include "server/room/measured_forces.h"
#include "server/translate/translate.h"

namespace weft::server {

/// A state of a room's scene to go back to.
struct Save {
  std::unique_ptr<const ServedWorld> world;
  GuaranteeWatch<float> guarantee;
  proto::MeshAnnouncement mesh;  ///< with the thickness of its fabrics
  MeasuredForces forces;
  std::map<PinId, proto::ViewerId> pin_owners;
  double wanted_softness = 1;  ///< which a budget may have lowered in `world`
};

/// States that a room keeps in memory, by name; all of its present scene.
class Saves {
 public:
  /// Why a world of so many particles may not be kept under this name; nothing if it may.
  std::optional<proto::Error> check(const std::string& name, std::size_t particles) const;
  void keep(const std::string& name, Save save) { saves_.insert_or_assign(name, std::move(save)); }
  proto::Result<const Save*> find(const std::string& name) const;
  void clear() { saves_.clear(); }

 private:
  std::map<std::string, Save> saves_;
};

}  // namespace weft::server
