#include <cmath>
#include <functional>
#include <random>

#include <catch2/catch.hpp>

#include "tests/server/fakes.h"

// How many frames a viewer is sent, in real time.

namespace weft::server {
namespace {

/// Offers frames, with jitter, of a room that makes `rate` a second, and acknowledges them.
struct WatchedRoom : OneViewer {
  std::vector<double> times;  // at which frames were sent
  std::uint32_t sequence = 0;
  std::mt19937 random{20261124};

  /// @param jitter  by which they come too early or too late [parts of the time between two]
  void run(
      double rate, double seconds, double jitter, const std::function<void()>& before = [] {}) {
    const double start = fake.now;
    double polled = fake.now;
    for (int k = 1; k < seconds * rate; ++k) {
      const double shift = jitter * std::uniform_real_distribution<double>(-1, 1)(random);
      const double at = std::max(fake.now, start + (k + shift) / rate);
      while (polled + 0.01 < at) {  // as the network thread does
        fake.now = std::max(fake.now, polled += 0.01);
        channel.poll();
        take();
      }
      fake.now = at;
      before();
      channel.offer_frame(fake_frame(++sequence));
      take();
    }
  }
  void take() {
    while (stream.in_flight > 0) {
      times.push_back(fake.now);
      stream.finish_write();
      channel.on_acknowledged(sequence);
    }
  }
  /// The most frames in any second.
  std::size_t most_in_a_second() const {
    std::size_t most = 0;
    for (std::size_t i = 0, first = 0; i < times.size(); ++i) {
      while (times[i] - times[first] >= 1) ++first;
      most = std::max(most, i - first + 1);
    }
    return most;
  }
};

TEST_CASE("no viewer gets more frames in a second than its hz and one, at any rate of the room") {
  for (const double rate : {10.0, 60.0, 600.0, 1000.0}) {
    for (const double hz : {0.5, 1.0, 24.0, 30.0, 59.94, 60.0, 144.0, 240.0}) {
      for (const double jitter : {0.0, 0.2, 0.5}) {
        CAPTURE(rate, hz, jitter);
        WatchedRoom v;
        v.channel.set_most_frames(hz);
        v.run(rate, 10, jitter);
        CHECK(v.most_in_a_second() <= static_cast<std::size_t>(std::ceil(hz)) + 1);
        CHECK(static_cast<double>(v.times.size()) >= 0.8 * std::min(hz, rate) * 10 - 2);
      }
    }
  }
  WatchedRoom v;  // that did not say how many
  v.run(1000, 3, 0.1);
  CHECK(v.most_in_a_second() <= 241);
}

TEST_CASE(
    "a viewer whose hz is the room's rate sees every tick, come they a tenth too early or late") {
  WatchedRoom v;
  v.channel.set_most_frames(60);
  v.run(60, 20, 0.1);
  CHECK(v.times.size() == v.sequence);
}

TEST_CASE("asking again and again for another hz brings no more frames than the highest") {
  WatchedRoom v;
  int k = 0;
  v.run(1000, 5, 0.1, [&] { v.channel.set_most_frames(++k % 2 == 0 ? 30 : 20); });
  CHECK(v.most_in_a_second() <= 31);
}

TEST_CASE("a higher hz holds at once after a low one") {
  OneViewer v;
  v.channel.set_most_frames(0.01);
  v.channel.offer_frame(fake_frame(1));
  v.stream.drain();
  v.channel.on_acknowledged(1);
  v.channel.set_most_frames(60);
  v.fake.now += 0.02;
  v.channel.offer_frame(fake_frame(2));
  CHECK(v.stream.written.back() == "frame 2");
}

TEST_CASE("a frame that comes at once does not wait for hz, but many of them do") {
  OneViewer v;
  v.channel.set_most_frames(1);
  std::uint32_t sequence = 0;
  const auto offer = [&](bool at_once) {
    Frame frame = fake_frame(++sequence);
    frame.at_once = at_once;
    v.channel.offer_frame(frame);
    v.stream.drain();
    v.channel.on_acknowledged(sequence);
  };
  offer(false);
  offer(false);
  CHECK(v.channel.frames_sent() == 1);
  v.fake.now += 0.1;
  offer(true);
  CHECK(v.channel.frames_sent() == 2);
  for (int k = 0; k < 1000; ++k) {
    v.fake.now += 0.01;
    offer(true);
  }
  CHECK(v.channel.frames_sent() <= 2 + 2 * 10);
}

TEST_CASE(
    "a viewer that asks for 30 frames a second gets every other of 60, none counted as dropped") {
  OneViewer v;
  v.channel.set_most_frames(30);
  for (std::uint32_t i = 1; i <= 120; ++i) {
    v.channel.offer_frame(fake_frame(i));
    v.stream.drain();
    v.channel.on_acknowledged(i);
    v.fake.now += 1.0 / 60;
  }
  CHECK(v.channel.frames_sent() >= 59);
  CHECK(v.channel.frames_sent() <= 61);
  CHECK(v.channel.frames_dropped() == 0);
}

TEST_CASE("the last frame before a pause reaches a viewer with a lower rate") {
  OneViewer v;
  v.channel.set_most_frames(10);
  v.channel.offer_frame(fake_frame(1));
  v.stream.drain();
  v.channel.offer_frame(fake_frame(2));
  CHECK(v.stream.written.size() == 1);
  v.fake.now += 0.11;
  v.channel.poll();
  CHECK(v.stream.written.back() == "frame 2");
}

}  // namespace
}  // namespace weft::server
