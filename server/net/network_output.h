#pragma once

#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>

#include "server/net/hub.h"
#include "server/room/room_output.h"

namespace weft::server {

/// Passes the room's output to the network thread, in order.
class NetworkOutput : public RoomOutput {
 public:
  NetworkOutput(boost::asio::io_context& io, Hub& hub) : io_(io), hub_(hub) {}

  void send(proto::ViewerId viewer, Message message) override {
    post([viewer, message = std::move(message)](Hub& hub) { hub.send(viewer, message); });
  }
  void broadcast(Message message) override {
    post([message = std::move(message)](Hub& hub) { hub.broadcast(message); });
  }
  void set_frame_rate(double frame_rate) override {
    post([frame_rate](Hub& hub) { hub.set_frame_rate(frame_rate); });
  }
  void offer_mesh(std::uint64_t hash, SharedBytes bytes, PackedMesh packed) override {
    post([hash, bytes = std::move(bytes), packed = std::move(packed)](Hub& hub) {
      hub.offer_mesh(hash, bytes, packed);
    });
  }
  void welcome_done(proto::ViewerId viewer) override {
    post([viewer](Hub& hub) { hub.welcome_done(viewer); });
  }
  bool wants_frames() const override { return hub_.wants_frames(); }
  bool wants_forces() const override { return hub_.wants_forces(); }
  void offer_frame(Frame frame) override {
    post([frame = std::move(frame)](Hub& hub) { hub.offer_frame(frame); });
  }

 private:
  template <class Action>
  void post(Action action) {
    boost::asio::post(io_, [this, action = std::move(action)] { action(hub_); });
  }

  boost::asio::io_context& io_;
  Hub& hub_;
};

}  // namespace weft::server
