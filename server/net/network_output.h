#pragma once

#include <memory>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>

#include "proto/messages/events.h"
#include "server/net/close_codes.h"
#include "server/net/hub.h"
#include "server/room/room_output.h"
#include "server/rooms/hosted_room.h"

namespace weft::server {

/// Passes a room's output to its hub on the network thread, in order.
class NetworkOutput : public RoomOutput {
 public:
  NetworkOutput(boost::asio::io_context& io, std::shared_ptr<Hub> hub)
      : io_(io), hub_(std::move(hub)) {}

  void send(proto::ViewerId viewer, Message message) override {
    post([viewer, message = std::move(message)](Hub& hub) { hub.send(viewer, message); });
  }
  void send(proto::ViewerId viewer, std::vector<Message> messages) override {
    post([viewer, messages = std::move(messages)](Hub& hub) { hub.send(viewer, messages); });
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
  void set_role(proto::ViewerId viewer, proto::Role role) override {
    post([viewer, role](Hub& hub) { hub.set_role(viewer, role); });
  }
  void set_glance(proto::ViewerId viewer) override {
    post([viewer](Hub& hub) { hub.set_glance(viewer); });
  }
  bool wants_frames() const override { return hub_->wants_frames(); }
  bool wants_forces() const override { return hub_->wants_forces(); }
  void offer_frame(Frame frame) override {
    post([frame = std::move(frame)](Hub& hub) { hub.offer_frame(frame); });
  }
  void close() override {
    post([](Hub& hub) {
      const proto::Bye bye{kCloseRoomClosed, "the room is closed"};
      hub.close_all(bye.code, bye.reason, text_message(proto::encode_bye(bye)));
    });
  }

  /// Of the network thread.
  Hub& hub() const { return *hub_; }

 private:
  /// The hub stays until all that was posted is done, also if its room is gone.
  template <class Action>
  void post(Action action) {
    boost::asio::post(io_, [hub = hub_, action = std::move(action)] { action(*hub); });
  }

  boost::asio::io_context& io_;
  std::shared_ptr<Hub> hub_;
};

/// Every room of a server with a network has an output to it.
inline Hub& hub_of(const HostedRoom& room) {
  return static_cast<NetworkOutput&>(room.output()).hub();
}

}  // namespace weft::server
