#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

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

/// One WebSocket message.
struct Message {
  SharedBytes bytes;
  bool binary = false;
};

inline Message text_message(std::string text) {
  return {SharedBytes(std::move(text)), false};
}

template <class Container>
Message binary_message(Container bytes) {
  return {SharedBytes(std::move(bytes)), true};
}

/// An encoded frame; the same bytes for all viewers that ask for the same.
struct Frame {
  SharedBytes bytes;
  std::uint32_t sequence = 0;
  SharedBytes with_forces = {};  ///< the same with contacts and reactions; empty if nobody asked
};

}  // namespace weft::server
