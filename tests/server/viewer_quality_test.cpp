#include "server/net/viewer_quality.h"

#include <cmath>
#include <deque>

#include <catch2/catch.hpp>

#include "server/net/hub.h"
#include "tests/server/fakes.h"

namespace weft::server {
namespace {

/// A viewer behind a link that needs a fixed time for each frame, in a room of 60 frames a second.
struct SlowViewer {
  SlowViewer() { channel.pack_with(packer, 1e-4, 4e-4); }

  /// @param seconds_a_frame  that the link needs
  void run(double seconds, double seconds_a_frame) {
    for (const double end = viewer.fake.now + seconds; viewer.fake.now < end;) {
      viewer.fake.now += 1e-3;
      const double now = viewer.fake.now;
      if (viewer.stream.in_flight > 0 && now >= free_at) {
        viewer.stream.finish_write();
        viewer.channel.on_acknowledged(last_sent());
        note_arrival(now);
      }
      if (now >= next_frame) {
        next_frame += 1.0 / 60;
        channel.offer_frame(fake_frame(++sequence));
      }
      if (now >= next_poll) {
        next_poll += 0.02;
        channel.poll();
        if (const auto change = channel.take_change()) changes.push_back(*change);
      }
      if (viewer.stream.in_flight > 0 && free_at <= now) free_at = now + seconds_a_frame;
    }
  }

  std::uint32_t last_sent() const {
    return static_cast<std::uint32_t>(std::stoul(viewer.stream.written.back().substr(6)));
  }
  void note_arrival(double now) {
    if (arrived > 0) longest_pause = std::max(longest_pause, now - arrived);
    arrived = now;
  }

  OneViewer viewer;
  ViewerChannel& channel = viewer.channel;
  FramePacker packer;
  std::vector<ViewerChannel::Sending> changes;
  std::uint32_t sequence = 0;
  double next_frame = 100, next_poll = 100, free_at = 0;
  double arrived = 0, longest_pause = 0;  ///< [s]
};

TEST_CASE("a link that takes 36 of 60 frames a second is soon sent 30 evenly, and drops none") {
  SlowViewer v;
  v.run(2.5, 1.0 / 36);
  REQUIRE(v.changes.size() == 1);
  CHECK(v.changes[0].hz == 30);
  CHECK(v.changes[0].error == 1e-4);
  const std::uint64_t dropped = v.channel.frames_dropped(), sent = v.channel.frames_sent();
  v.longest_pause = 0;
  v.run(3, 1.0 / 36);
  CHECK(v.channel.frames_dropped() == dropped);
  CHECK(v.channel.frames_sent() - sent >= 89);
  CHECK(v.longest_pause < 1.4 / 30);
}

TEST_CASE("frames get fewer before they get coarser, and never coarser than the viewer allows") {
  SlowViewer v;
  v.run(20, 1.0 / 10);
  REQUIRE(v.changes.size() == 3);
  CHECK(v.changes[0].hz == 30);
  CHECK(v.changes[1].hz == 20);
  CHECK(v.changes[2].hz == 20);
  CHECK(v.changes[1].error == 1e-4);
  CHECK(v.changes[2].error == 4e-4);

  SlowViewer strict;
  strict.channel.pack_with(strict.packer, 1e-5, 5e-5);
  strict.run(20, 1.0 / 10);
  REQUIRE(strict.changes.size() == 2);
  CHECK(strict.changes[1].error == 1e-5);
}

TEST_CASE("a link that recovers brings all frames back") {
  SlowViewer v;
  v.run(20, 1.0 / 10);
  v.run(40, 1.0 / 200);
  CHECK(v.changes.back().hz == 60);
  CHECK(v.changes.back().error == 1e-4);
  const std::uint64_t sent = v.channel.frames_sent();
  v.run(1, 1.0 / 200);
  CHECK(v.channel.frames_sent() - sent >= 59);
}

TEST_CASE("what failed is tried ever less often: few frames are dropped in the long run") {
  SlowViewer v;
  v.run(120, 1.0 / 36);
  const std::size_t changes = v.changes.size();
  const std::uint64_t dropped = v.channel.frames_dropped(), sent = v.channel.frames_sent();
  v.run(600, 1.0 / 36);
  // A trial takes 2 to 3 s, in which 24 of 60 frames are dropped each second; one comes in 64 s.
  CHECK(v.changes.size() - changes <= 2 * (600 / 64 + 1));
  CHECK(v.channel.frames_dropped() - dropped <= (600 / 64 + 1) * 3 * 30);
  CHECK(v.channel.frames_sent() - sent >= 600 * 29);
}

TEST_CASE("short pauses change nothing") {
  SlowViewer v;
  for (int k = 0; k < 20; ++k) {
    v.run(2.7, 1.0 / 200);
    v.run(0.3, 0.3);
  }
  CHECK(v.changes.empty());
}

TEST_CASE("a viewer that asks for fewer frames than its link takes keeps its quality") {
  SlowViewer v;
  v.channel.set_most_frames(20);
  v.run(20, 1.0 / 36);
  CHECK(v.changes.empty());
  v.channel.set_most_frames(240);
  v.run(4, 1.0 / 36);
  REQUIRE(v.changes.size() == 1);
  // What it asks for anew begins at full quality.
  v.channel.set_most_frames(240);
  const std::uint64_t sent = v.channel.frames_sent();
  v.run(1, 1.0 / 200);
  CHECK(v.channel.frames_sent() - sent >= 58);
}

TEST_CASE("the viewer alone is told of its quality") {
  FakeClock fake;
  Metrics metrics;
  Hub hub(fake.clock(), 60, {}, metrics);
  FakeStream slow, fast;
  slow.channel = &hub.add(1, slow);
  fast.channel = &hub.add(2, fast);
  hub.welcome_done(1);
  hub.welcome_done(2);
  for (std::uint32_t i = 1; i <= 240; ++i) {
    hub.offer_frame(fake_frame(i));
    fast.drain();
    fast.channel->on_acknowledged(i);
    if (i % 12 == 0) {
      slow.finish_write();
      slow.channel->on_acknowledged(i);
    }
    fake.now += 1.0 / 60;
    hub.poll();
  }
  slow.drain();
  const auto told = [](const FakeStream& stream) {
    return std::count_if(stream.written.begin(), stream.written.end(), [](const auto& text) {
      return text.find("\"quality\"") != std::string::npos;
    });
  };
  CHECK(told(slow) >= 1);
  CHECK(told(fast) == 0);
}

}  // namespace
}  // namespace weft::server
