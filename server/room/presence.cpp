// Which of the cursors and cameras that have moved are told next.

#include "server/room/presence.h"

#include <algorithm>
#include <cmath>

#include "server/constants.h"

namespace weft::server {
namespace {

/// To a tenth of a millimetre, so that it is short as text.
double rounded(double metres) {
  constexpr double kPerMetre = 1e4;
  return std::round(metres * kPerMetre) / kPerMetre;
}
proto::Vec3 rounded(const proto::Vec3& point) {
  return {rounded(point[0]), rounded(point[1]), rounded(point[2])};
}

/// The viewers whose cameras others see by, sorted.
std::vector<proto::ViewerId> followed_of(const std::vector<Present>& all) {
  std::vector<proto::ViewerId> list;
  for (const Present& one : all)
    if (one.presence->follows != 0) list.push_back(one.presence->follows);
  std::sort(list.begin(), list.end());
  return list;
}

/// What is to be told of one viewer.
struct Telling {
  proto::ViewerId viewer;
  Presence* presence;
  bool camera;  ///< it is followed, and has moved
};

std::vector<Telling> tellings_of(const std::vector<Present>& all) {
  const std::vector<proto::ViewerId> followed = followed_of(all);
  std::vector<Telling> list;
  for (const auto& [viewer, presence] : all) {
    const bool camera = presence->camera_news && presence->camera &&
                        std::binary_search(followed.begin(), followed.end(), viewer);
    if (camera || presence->cursor_news || presence->follows_news)
      list.push_back({viewer, presence, camera});
  }
  return list;
}

}  // namespace

void Presence::point(const std::optional<proto::Vec3>& place) {
  cursor_news = cursor_news || cursor != place;
  cursor = place;
}

void Presence::look(const proto::Camera& from) {
  camera_news = camera_news || camera != from;
  camera = from;
}

void Presence::follow(proto::ViewerId viewer) {
  follows_news = follows_news || follows != viewer;
  follows = viewer;
}

std::vector<proto::PresenceInfo> take_news(const std::vector<Present>& all, double now,
                                           bool& more) {
  std::vector<Telling> list = tellings_of(all);
  std::stable_sort(list.begin(), list.end(), [](const Telling& a, const Telling& b) {
    if (a.camera != b.camera) return a.camera;
    return a.presence->told < b.presence->told;
  });
  more = list.size() > kMostPresences;
  if (more) list.resize(kMostPresences);
  std::vector<proto::PresenceInfo> told;
  for (const auto& [viewer, presence, camera] : list) {
    proto::PresenceInfo& info = told.emplace_back();
    info.viewer = viewer;
    if (presence->cursor_news && presence->cursor) info.cursor = rounded(*presence->cursor);
    if (presence->cursor_news && !presence->cursor) info.away = true;
    if (presence->follows_news) info.follows = presence->follows;
    if (camera) {
      info.camera = presence->camera;
      info.camera->position = rounded(info.camera->position);
      info.camera->target = rounded(info.camera->target);
      presence->camera_news = false;
    }
    presence->cursor_news = presence->follows_news = false;
    presence->told = now;
  }
  return told;
}

}  // namespace weft::server
