#include "server/room/saves.h"

#include <utility>
#include <vector>

#include "server/constants.h"
#include "server/room/refusals.h"

namespace weft::server {

std::optional<proto::Error> Saves::check(const std::string& name, std::size_t particles) const {
  if (!saves_.contains(name) && saves_.size() >= kMostSaves)
    return too_many("saves of a room", kMostSaves, "save in place of one, under its name");
  std::size_t all = particles;
  for (const auto& [other, save] : saves_)
    if (other != name) all += save.world->model().mass.size();
  if (all > kMostSavedParticles) {
    return too_many("particles in all saves", kMostSavedParticles,
                    "save in place of one, under its name");
  }
  return std::nullopt;
}

proto::Result<const Save*> Saves::find(const std::string& name) const {
  const auto found = saves_.find(name);
  if (found != saves_.end()) return &found->second;
  std::vector<std::string> names;
  for (const auto& [each, save] : saves_) names.push_back(each);
  proto::Error error = proto::word_error("name", name, std::move(names));
  error.code = proto::ErrorCode::unknown_save;
  return error;
}

}  // namespace weft::server
