#pragma once

#include <functional>
#include <string>
#include <vector>

#include "proto/messages/http.h"
#include "server/clock.h"
#include "server/metrics.h"
#include "server/net/connection_count.h"
#include "server/net/hub.h"
#include "server/net/mailbox.h"
#include "server/net/static_files.h"
#include "server/options.h"

namespace weft::server {

/// Shared state of all connections. Lives on the network thread and outlives all connections.
struct ServiceContext {
  const ServerOptions& options;
  Hub& hub;
  Mailbox& mailbox;
  Metrics& metrics;
  const StaticFiles& files;
  Clock clock;
  proto::VersionInfo version;
  std::vector<proto::SceneListing> scenes;
  std::function<proto::Readiness()> readiness;
  ConnectionCount connections;
  proto::ViewerId next_viewer = 1;
  int port = 0;  ///< the port that the server listens on
  bool stopping = false;
};

}  // namespace weft::server
