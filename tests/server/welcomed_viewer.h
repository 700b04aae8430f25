#pragma once

#include "server/net/hub.h"
#include "tests/server/fakes.h"

// A viewer of a room of 60 ticks a second, as the hub knows it.

namespace weft::server {

/// The hub of a room with one viewer, number 1, which has been sent all that precedes frames.
struct WelcomedViewer {
  FakeClock fake;
  Metrics metrics;
  Hub hub{fake.clock(), 60, {}, metrics};
  FakeStream stream;

  WelcomedViewer() {
    stream.channel = &hub.add(1, stream);
    hub.welcome_done(1);
  }
};

}  // namespace weft::server
