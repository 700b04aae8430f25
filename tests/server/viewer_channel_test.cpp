#include <catch2/catch.hpp>

#include "server/net/close_codes.h"
#include "server/net/hub.h"
#include "tests/server/fakes.h"
#include "tests/server/welcomed_viewer.h"

namespace weft::server {
namespace {

std::string numbered(const char* name, int number) {
  return std::string(name).append(" ").append(std::to_string(number));
}

TEST_CASE("a viewer never has more than one write in flight") {
  OneViewer v;
  for (std::uint32_t i = 1; i <= 50; ++i) {
    v.channel.offer_frame(fake_frame(i));
    v.channel.send(text_message("text"));
    if (i % 3 == 0 && v.stream.in_flight > 0) v.stream.finish_write();
    v.channel.on_acknowledged(i);
    v.fake.now += 1.0 / 60;
  }
  v.stream.drain();
  CHECK(v.stream.most_in_flight == 1);
  CHECK(v.stream.written.size() > 50);
}

TEST_CASE("what is sent together is written one by one, each but the last with more to follow") {
  OneViewer v;
  v.channel.send({text_message("one"), text_message("two"), text_message("three")});
  for (const bool more : {true, true, false}) {
    CHECK(v.stream.more_follows == more);
    v.stream.finish_write();
  }
  CHECK(v.stream.written == std::vector<std::string>{"one", "two", "three"});
  CHECK(v.stream.most_in_flight == 1);
}

TEST_CASE("a stalled viewer gets the newest frame when it reads again, none of those between") {
  OneViewer v;
  v.channel.offer_frame(fake_frame(1));
  for (std::uint32_t i = 2; i <= 100; ++i) {
    v.fake.now += 1.0 / 60;
    v.channel.offer_frame(fake_frame(i));
  }
  v.stream.finish_write();
  CHECK(v.stream.written == std::vector<std::string>{"frame 1", "frame 100"});
  CHECK(v.channel.frames_dropped() == 98);
}

TEST_CASE("frames stop without acks and go on with them") {
  OneViewer v;
  for (std::uint32_t i = 1; i <= 10; ++i) {
    v.fake.now += 1;
    v.channel.offer_frame(fake_frame(i));
    v.stream.drain();
  }
  REQUIRE(v.stream.written.size() == FrameWindow::kLeast);
  v.channel.on_acknowledged(2);
  v.stream.drain();
  CHECK(v.stream.written.back() == "frame 10");
}

TEST_CASE("acks of frames that were never sent change nothing") {
  OneViewer v;
  v.channel.offer_frame(fake_frame(7));
  v.stream.drain();
  v.channel.on_acknowledged(8);
  v.channel.on_acknowledged(4000000000U);
  CHECK(v.channel.window().in_flight() == 1);
  v.channel.on_acknowledged(7);
  CHECK(v.channel.window().in_flight() == 0);
}

TEST_CASE("the window is ceil(least round trip * rate) + 1, from 2 to 12") {
  const auto window_after = [](double round_trip) {
    FrameWindow window(60);
    window.sent(1, 10);
    window.acknowledge(1, 10 + round_trip);
    return window.size();
  };
  CHECK(FrameWindow(60).size() == 2);
  CHECK(window_after(0.001) == 2);
  CHECK(window_after(0.03) == 3);
  CHECK(window_after(0.1) == 7);
  CHECK(window_after(5) == 12);
}

TEST_CASE("a round trip that became longer is believed after ten seconds") {
  FrameWindow window(60);
  double now = 10;
  std::uint32_t sequence = 0;
  const auto round_trip = [&](double seconds) {
    window.sent(++sequence, now);
    now += seconds;
    window.acknowledge(sequence, now);
  };
  round_trip(0.001);
  while (now < 12) round_trip(0.1);
  CHECK(window.size() == 2);
  while (now < 25) round_trip(0.1);
  CHECK(window.size() == 7);
}

TEST_CASE("text goes before frames and in its order") {
  OneViewer v;
  v.channel.send(text_message("a"));
  v.channel.offer_frame(fake_frame(1));
  v.channel.send(text_message("b"));
  v.channel.send(text_message("c"));
  v.stream.drain();
  CHECK(v.stream.written == std::vector<std::string>{"a", "b", "c", "frame 1"});
}

TEST_CASE("an overflowing queue of texts closes its viewer with 4000 at once") {
  ChannelLimits limits;
  limits.queued_messages = 10;
  OneViewer v(limits);
  for (int i = 0; i < 11; ++i) v.channel.send(text_message("x"));
  CHECK_FALSE(v.stream.closed);
  v.channel.send(text_message("one too many"));
  CHECK(v.stream.closed == kCloseViewerDoesNotRead);
  v.channel.send(text_message("later"));
  CHECK(v.stream.written.size() == 1);
}

TEST_CASE("the queue is bounded in bytes too, but for its largest message") {
  ChannelLimits limits;
  limits.queued_bytes = 1000;
  OneViewer v(limits);
  v.channel.send(text_message("in flight"));
  v.channel.send(text_message(std::string(500, 'a')));
  v.channel.send(text_message(std::string(5000, 'm')));
  v.channel.send(text_message(std::string(500, 'b')));
  CHECK_FALSE(v.stream.closed);
  v.channel.send(text_message("x"));
  CHECK(v.stream.closed == kCloseViewerDoesNotRead);
}

TEST_CASE("of what tells how something is, only the newest waits, and it closes nobody") {
  ChannelLimits limits;
  limits.queued_messages = 10;
  limits.queued_bytes = 1000;
  OneViewer v(limits);
  v.channel.send(text_message("in flight"));
  v.channel.send(text_message("answer 1"));
  const std::vector<std::pair<const char*, Topic>> kinds = {{"state", Topic::state},
                                                            {"pins", Topic::pins},
                                                            {"grabs", Topic::grabs},
                                                            {"roster", Topic::roster}};
  for (int k = 0; k <= 1000; ++k)
    for (const auto& [name, topic] : kinds) v.channel.send(text_message(numbered(name, k), topic));
  v.channel.send(text_message("answer 2"));
  v.channel.send(text_message("pins 1001", Topic::pins));
  CHECK_FALSE(v.stream.closed);
  v.stream.drain();
  CHECK(v.stream.written == std::vector<std::string>{"in flight", "answer 1", "state 1000",
                                                     "pins 1001", "grabs 1000", "roster 1000",
                                                     "answer 2"});
}

TEST_CASE("a mesh of any size passes, with all that is told around it") {
  ChannelLimits limits;
  limits.queued_bytes = 1000;
  OneViewer v(limits);
  const std::string mesh(1'000'000, 'm');
  v.channel.send(text_message("welcome"));
  v.channel.send(text_message("mesh", Topic::mesh));
  v.channel.send({SharedBytes(mesh), true, Topic::mesh_data});
  for (int k = 0; k < 3; ++k) v.channel.send(text_message(std::string(300, 'x')));
  CHECK_FALSE(v.stream.closed);
  v.stream.drain();
  CHECK(v.stream.written.size() == 6);
}

TEST_CASE("only the newest mesh waits, and nothing that was told of the ones before") {
  ChannelLimits limits;
  limits.queued_messages = 10;
  OneViewer v(limits);
  v.channel.send(text_message("in flight"));
  v.channel.send(text_message("roster", Topic::roster));
  for (int k = 1; k <= 100; ++k) {
    v.channel.send(text_message(numbered("mesh", k), Topic::mesh));
    v.channel.send({SharedBytes(numbered("data", k)), true, Topic::mesh_data});
    v.channel.send(text_message(numbered("state", k), Topic::state));
    v.channel.send(text_message(numbered("pins", k), Topic::pins));
    v.channel.send(text_message(numbered("grabs", k), Topic::grabs));
  }
  v.channel.send(text_message("answer"));
  CHECK_FALSE(v.stream.closed);
  v.stream.drain();
  CHECK(v.stream.written == std::vector<std::string>{"in flight", "roster", "mesh 100", "data 100",
                                                     "state 100", "pins 100", "grabs 100",
                                                     "answer"});
}

TEST_CASE("frames that must arrive keep their order with the answers, and hold their tickets") {
  ChannelLimits limits;
  limits.queued_bytes = 10;
  OneViewer v(limits);
  const auto ticket = std::make_shared<const int>();
  v.channel.offer_frame(fake_frame(1));
  v.channel.offer_frame(fake_frame(2));
  for (const char* text : {"kept 3", "kept 4", "kept 5"})
    v.channel.send({SharedBytes(std::string(text)), true, Topic::frame, ticket});
  v.channel.send(text_message("result"));
  CHECK_FALSE(v.stream.closed);
  v.fake.now += 1;
  CHECK(ticket.use_count() == 4);
  v.stream.finish_write();
  v.stream.finish_write();
  CHECK(ticket.use_count() == 2);
  v.stream.drain();
  CHECK(v.stream.written ==
        std::vector<std::string>{"frame 1", "kept 3", "kept 4", "kept 5", "result"});
  CHECK(v.channel.frames_sent() == 4);
}

TEST_CASE("a close waits for what is queued and says its last word") {
  OneViewer v;
  v.channel.offer_frame(fake_frame(1));
  v.channel.offer_frame(fake_frame(2));
  v.channel.send(text_message("waits"));
  v.channel.close(kCloseGoingAway, "the server stops", text_message("bye"));
  CHECK_FALSE(v.stream.closed);
  v.stream.drain();
  CHECK(v.stream.written == std::vector<std::string>{"frame 1", "waits", "bye"});
  CHECK(v.stream.closed == kCloseGoingAway);
}

TEST_CASE("a slow viewer does not delay the others") {
  FakeClock fake;
  Metrics metrics;
  Hub hub(fake.clock(), 60, {}, metrics);
  FakeStream slow, fast;
  slow.channel = &hub.add(1, slow);
  fast.channel = &hub.add(2, fast);
  hub.welcome_done(1);
  hub.welcome_done(2);
  for (std::uint32_t i = 1; i <= 60; ++i) {
    hub.offer_frame(fake_frame(i));
    fast.drain();
    fast.channel->on_acknowledged(i);
    fake.now += 1.0 / 60;
  }
  CHECK(fast.written.size() == 60);
  CHECK(slow.written.size() == 1);
}

TEST_CASE("a viewer hears nothing of the room before it is welcomed") {
  FakeClock fake;
  Metrics metrics;
  Hub hub(fake.clock(), 60, {}, metrics);
  FakeStream stream;
  stream.channel = &hub.add(1, stream);
  hub.broadcast(text_message("roster"));
  hub.offer_frame(fake_frame(1));
  CHECK(stream.written.empty());
  CHECK_FALSE(hub.wants_frames());
  hub.send(1, text_message("welcome"));
  hub.welcome_done(1);
  CHECK(hub.wants_frames());
  hub.broadcast(text_message("roster"));
  stream.drain();
  CHECK(stream.written == std::vector<std::string>{"welcome", "roster"});
}

TEST_CASE("a frame of the mesh before is not sent after a new mesh") {
  WelcomedViewer viewer;
  auto& [fake, metrics, hub, stream] = viewer;
  hub.offer_frame(fake_frame(1));
  hub.offer_frame(fake_frame(2));
  hub.offer_mesh(99, SharedBytes(std::string("mesh")));
  hub.send(1, text_message("mesh"));
  Frame first = fake_frame(3);
  first.at_once = true;
  hub.offer_frame(first);
  stream.drain();
  CHECK(stream.written == std::vector<std::string>{"frame 1", "mesh", "frame 3"});
  CHECK(hub.find_mesh(99));
  CHECK_FALSE(hub.find_mesh(98));
}

TEST_CASE("nobody wants frames when all viewers have asked for none or have gone") {
  WelcomedViewer viewer;
  auto& [fake, metrics, hub, stream] = viewer;
  CHECK(hub.wants_frames());
  hub.set_most_frames(1, 0);
  CHECK_FALSE(hub.wants_frames());
  hub.set_most_frames(1, 60);
  CHECK(hub.wants_frames());
  hub.remove(1);
  CHECK_FALSE(hub.wants_frames());
}

TEST_CASE("a viewer is told how many frames were left out for it") {
  WelcomedViewer viewer;
  auto& [fake, metrics, hub, stream] = viewer;
  hub.poll();
  for (std::uint32_t i = 1; i <= 40; ++i) {
    hub.offer_frame(fake_frame(i));
    fake.now += 1.0 / 60;
  }
  fake.now += 6;
  hub.poll();
  stream.drain();
  REQUIRE(stream.written.size() == 3);  // frame 1, the notice, frame 40
  const auto notice = nlohmann::json::parse(stream.written[1]);
  CHECK(notice["code"] == "frames_dropped");
  CHECK(notice["count"] == 38);
  CHECK(metrics.text().find("weft_frames_dropped_total 38") != std::string::npos);
}

}  // namespace
}  // namespace weft::server
