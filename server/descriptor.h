#pragma once

#include <unistd.h>

namespace weft::server {

/// Owns a file descriptor.
struct Descriptor {
  int number = -1;  ///< negative: none
  explicit Descriptor(int given) : number(given) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close_now(); }
  void close_now() {
    if (number >= 0) ::close(number);
    number = -1;
  }
};

}  // namespace weft::server
