#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "proto/codec/order.h"
#include "proto/types.h"

namespace weft::server {

/// Immutable bytes that many viewers share.
class SharedBytes {
 public:
  SharedBytes() = default;

  /// Takes over a string or a vector of bytes.
  template <class Container>
  explicit SharedBytes(Container content) {
    auto owned = std::make_shared<const Container>(std::move(content));
    data_ = owned->data();
    size_ = owned->size();
    owner_ = std::move(owned);
  }

  const void* data() const { return data_; }
  std::size_t size() const { return size_; }
  explicit operator bool() const { return owner_ != nullptr; }

 private:
  std::shared_ptr<const void> owner_;
  const void* data_ = nullptr;
  std::size_t size_ = 0;
};

/// The subject of a message, as far as that decides its fate in a queue. All but the first and the
/// last describe a complete state, so that a newer one replaces an older one that waits.
enum class Topic : std::uint8_t {
  none,  ///< must arrive
  state,
  roster,
  pins,
  grabs,
  mesh,       ///< its announcement; drops waiting `mesh_data`, `state`, `pins`, `grabs` of the last
  mesh_data,  ///< of any size
  frame,      ///< one that must arrive; its sender bounds how many are in flight
};

/// What the codec `packed` has to know of a mesh.
struct PackedMesh {
  std::uint32_t epoch = 0;
  std::shared_ptr<const proto::codec::CodingOrder> order = {};  ///< null: frames stay float32
};

/// One WebSocket message.
struct Message {
  SharedBytes bytes;
  bool binary = false;
  Topic topic = Topic::none;
  /// Held until the message has been written, so that its sender can count those in flight.
  std::shared_ptr<const void> ticket = {};
  bool jump = false;  ///< of a frame: its viewer has not been shown yet that the state was replaced
};

inline Message text_message(std::string text, Topic topic = Topic::none) {
  return {SharedBytes(std::move(text)), false, topic};
}

template <class Container>
Message binary_message(Container bytes) {
  return {SharedBytes(std::move(bytes)), true};
}

/// An encoded frame; all viewers with the same wishes share the bytes.
struct Frame {
  SharedBytes bytes;
  std::uint32_t sequence = 0;
  SharedBytes with_forces = {};  ///< the same with contacts and reactions; empty if not wanted
  bool at_once = false;          ///< not delayed for the viewer's `hz`
  proto::ViewerId only_to = 0;   ///< 0: to all viewers
  proto::ViewerId not_to = 0;    ///< 0: excludes none
  bool jump = false;             ///< the state was replaced
  bool owes_jump = false;        ///< the viewer that it excludes has not been shown that
};

}  // namespace weft::server
