#include "server/net/frame_window.h"

#include <algorithm>
#include <cmath>

namespace weft::server {
namespace {

constexpr double kPeriod = 5;  // [s]

}  // namespace

int FrameWindow::size() const {
  double least = least_now_;
  if (least < 0 || (least_before_ >= 0 && least_before_ < least)) least = least_before_;
  if (least < 0) return kLeast;
  const double wanted = std::ceil(least * frame_rate_) + 1;
  return static_cast<int>(std::clamp<double>(wanted, kLeast, kMost));
}

void FrameWindow::sent(std::uint32_t sequence, double now) {
  unacknowledged_.push_back({sequence, now});
}

void FrameWindow::acknowledge(std::uint32_t sequence, double now) {
  const auto found = std::find_if(unacknowledged_.begin(), unacknowledged_.end(),
                                  [&](const Sent& sent) { return sent.sequence == sequence; });
  if (found == unacknowledged_.end()) return;
  note_round_trip(now - found->time, now);
  unacknowledged_.erase(unacknowledged_.begin(), found + 1);
}

void FrameWindow::note_round_trip(double seconds, double now) {
  if (now >= period_end_) {
    least_before_ = least_now_;
    least_now_ = -1;
    period_end_ = now + kPeriod;
  }
  if (least_now_ < 0 || seconds < least_now_) least_now_ = seconds;
}

}  // namespace weft::server
