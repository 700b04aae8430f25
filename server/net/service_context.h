#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "proto/messages/http.h"
#include "server/clock.h"
#include "server/net/connection_count.h"
#include "server/net/static_files.h"
#include "server/net/tokens.h"
#include "server/options.h"
#include "server/proxies.h"
#include "server/rooms/rooms.h"

namespace weft::server {

/// Shared state of all connections. Lives on the network thread and outlives all connections.
struct ServiceContext {
  const ServerOptions& options;
  Rooms& rooms;
  const Tokens& tokens;
  const StaticFiles& files;
  Clock clock;
  proto::VersionInfo version;
  std::vector<proto::SceneListing> scenes = {};
  std::vector<AddressRange> trusted_proxies = {};
  ConnectionCount connections = {};
  std::size_t viewers = 0;  ///< of all rooms
  proto::ViewerId next_viewer = 1;
  int port = 0;  ///< the port that the server listens on
  bool stopping = false;

  bool trusts(const boost::asio::ip::address& peer) const {
    return std::any_of(trusted_proxies.begin(), trusted_proxies.end(),
                       [&](const AddressRange& network) { return network.contains(peer); });
  }
};

}  // namespace weft::server
