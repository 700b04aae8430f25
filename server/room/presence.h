#pragma once

#include <optional>
#include <vector>

#include "proto/messages/events.h"

namespace weft::server {

/// Where a viewer points and looks, of which nothing enters the log.
struct Presence {
  std::optional<proto::Vec3> cursor;    ///< [m]
  std::optional<proto::Camera> camera;  ///< as last told
  proto::ViewerId follows = 0;          ///< whose camera it sees by; 0: its own
  bool stays = false;                   ///< it has left a camera that it was brought to
  bool cursor_news = false, camera_news = false, follows_news = false;
  double told = 0;  ///< when others were told last [s]

  void point(const std::optional<proto::Vec3>& place);
  void look(const proto::Camera& from);
  void follow(proto::ViewerId viewer);
};

/// A viewer's presence with its number.
struct Present {
  proto::ViewerId viewer = 0;
  Presence* presence = nullptr;
};

/// Takes what is told now, at most kMostPresences viewers: the followed cameras first, then those
/// that have waited for longest.
/// @param more  set if others wait
std::vector<proto::PresenceInfo> take_news(const std::vector<Present>& all, double now, bool& more);

}  // namespace weft::server
