#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "proto/types.h"

namespace weft::server {

/// Bytes that many viewers share and nobody changes.
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

/// What a message tells, as far as that decides what becomes of it in a queue. All but the first
/// and the last tell how something is as a whole, so that a newer one replaces an older one that
/// waits.
enum class Topic : std::uint8_t {
  none,  ///< must arrive
  state,
  roster,
  pins,
  grabs,
  mesh,       ///< its announcement; `mesh_data`, `state`, `pins` and `grabs` of the mesh before go
  mesh_data,  ///< of any size
  frame,      ///< one that must arrive; its sender bounds how many are on their way
};

/// One WebSocket message.
struct Message {
  SharedBytes bytes;
  bool binary = false;
  Topic topic = Topic::none;
  /// Kept until the message has been written, so that its sender can count those on their way.
  std::shared_ptr<const void> ticket = {};
};

inline Message text_message(std::string text, Topic topic = Topic::none) {
  return {SharedBytes(std::move(text)), false, topic};
}

template <class Container>
Message binary_message(Container bytes) {
  return {SharedBytes(std::move(bytes)), true};
}

/// An encoded frame; the same bytes for all viewers that ask for the same.
struct Frame {
  SharedBytes bytes;
  std::uint32_t sequence = 0;
  SharedBytes with_forces = {};  ///< the same with contacts and reactions; empty if none were asked
  bool at_once = false;          ///< not to be kept back for the viewer's `hz`
  proto::ViewerId only_to = 0;   ///< 0: to everybody
  proto::ViewerId not_to = 0;    ///< 0: none is left out
};

}  // namespace weft::server
