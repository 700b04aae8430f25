#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "proto/frames/frame.h"
#include "server/room/room_output.h"
#include "tests/fuzz/run.h"

namespace weft::fuzz {

using nlohmann::json;

template <std::size_t N>
void put(char (&out)[N], const std::string& text) {
  std::snprintf(out, N, "%s", text.c_str());
}

inline bool all_finite(const auto& numbers) {
  for (const auto number : numbers)
    if (!std::isfinite(number)) return false;
  return true;
}

/// Listens to a room: counts answers and looks at each frame.
class Listener : public server::RoomOutput {
 public:
  explicit Listener(Outcome& outcome) : outcome_(outcome) {}

  void send(proto::ViewerId viewer, server::Message message) override {
    if (!message.binary) hear(viewer, message);
    if (message.topic == server::Topic::frame) look(message.bytes);
  }
  void broadcast(server::Message message) override { hear(0, message); }
  void set_frame_rate(double) override {}
  void offer_mesh(std::uint64_t, server::SharedBytes, server::PackedMesh) override {}
  void welcome_done(proto::ViewerId) override {}
  bool wants_frames() const override { return true; }
  bool wants_forces() const override { return forces; }
  void offer_frame(server::Frame frame) override {
    look(frame.bytes);
    if (frame.with_forces) look(frame.with_forces);
  }
  void close() override {}

  void problem(const std::string& what) {
    if (outcome_.problems++ == 0) put(outcome_.problem, what + " (" + outcome_.doing + ")");
  }

  bool forces = false;
  std::map<std::pair<proto::ViewerId, json>, int> answers;  ///< so many of each id
  std::uint64_t recoveries_told = 0, halts_told = 0;
  json last_answer;

 private:
  void hear(proto::ViewerId viewer, const server::Message& message) {
    const json text =
        json::parse(static_cast<const char*>(message.bytes.data()),
                    static_cast<const char*>(message.bytes.data()) + message.bytes.size());
    const std::string op = text["op"];
    if (op == "notice" && text["code"] == "recovered") ++recoveries_told;
    if (op == "notice" && text["code"] == "halted") ++halts_told;
    if (op == "state" && !all_finite_numbers(text["energy"]))
      problem("a state tells an energy that is not finite");
    if (op != "result" && op != "error") return;
    last_answer = text;
    if (text.contains("id")) ++answers[{viewer, text["id"]}];
    if (op == "result") return;
    ++outcome_.errors;
    if (text["code"] != "internal") return;
    ++outcome_.internal_errors;
    problem("internal error: " + text.value("message", ""));
  }

  static bool all_finite_numbers(const json& object) {
    for (const auto& [key, value] : object.items())
      if (value.is_null()) return false;  // which is how JSON tells them
    return true;
  }

  void look(const server::SharedBytes& bytes) {
    const auto frame =
        proto::decode_frame({static_cast<const std::byte*>(bytes.data()), bytes.size()});
    bool finite = static_cast<bool>(frame);
    if (frame) {
      finite = all_finite(frame->positions) && std::isfinite(frame->header.time);
      for (const auto& grab : frame->grabs)
        finite =
            finite && all_finite(grab.held) && all_finite(grab.target) && std::isfinite(grab.force);
      for (const auto& pose : frame->poses)
        finite = finite && all_finite(pose.position) && all_finite(pose.rotation);
      for (const auto& contact : frame->contacts)
        finite = finite && all_finite(contact.point) && all_finite(contact.normal) &&
                 std::isfinite(contact.gap) && std::isfinite(contact.normal_force) &&
                 all_finite(contact.friction);
      for (const auto& reaction : frame->reactions) finite = finite && all_finite(reaction.force);
    }
    if (finite) return;
    ++outcome_.not_finite_frames;
    problem(frame ? "a frame is not finite" : "a frame is refused: " + frame.error().message);
  }

  Outcome& outcome_;
};

}  // namespace weft::fuzz
