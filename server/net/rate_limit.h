#pragma once

#include <algorithm>

namespace weft::server {

/// A token bucket: fills at a rate, and each message takes one token.
class RateLimit {
 public:
  /// @param rate   messages a second
  /// @param burst  messages at once after a quiet time
  RateLimit(double rate, double burst) : rate_(rate), burst_(burst), tokens_(burst) {}

  /// Whether one more message is within the limit.
  bool take(double now) {
    if (now > last_) tokens_ = std::max(tokens_, std::min(burst_, tokens_ + (now - last_) * rate_));
    last_ = std::max(last_, now);
    if (tokens_ < 1) return false;
    tokens_ -= 1;
    return true;
  }

  /// Adds one token, beyond rate and burst.
  void allow_one() { tokens_ += 1; }

 private:
  double rate_, burst_, tokens_;
  double last_ = 0;
};

}  // namespace weft::server
