#include "server/net/viewer_quality.h"

#include <algorithm>
#include <cassert>

namespace weft::server {
namespace {

constexpr int kPaceSteps = QualitySteps::kSlowestPace - 1;

/// Fewer frames in a period tell nothing.
constexpr std::uint64_t kFewFrames = 5;

/// A higher quality has failed if frames are dropped again within this time [s].
constexpr double kProbation = 2 * QualitySteps::kPeriod * (QualitySteps::kBadPeriods + 1);

}  // namespace

ViewerQuality QualitySteps::quality() const {
  return {1 + std::min(step_, kPaceSteps), std::max(0, step_ - kPaceSteps)};
}

void QualitySteps::restart() {
  *this = {};
}

bool QualitySteps::update(double now, std::uint64_t sent, std::uint64_t dropped, int coarsest) {
  assert(sent >= sent_ && dropped >= dropped_ && coarsest >= 0);
  if (now < period_end_) return false;
  const std::uint64_t lost = dropped - dropped_, due = sent - sent_ + lost;
  const bool counted = period_end_ >= 0 && due >= kFewFrames;
  if (period_end_ < 0) last_bad_ = now;
  period_end_ = now + kPeriod;
  sent_ = sent;
  dropped_ = dropped;
  if (!counted) return false;
  return end_period(now, static_cast<double>(lost) / static_cast<double>(due), coarsest);
}

bool QualitySteps::end_period(double now, double share, int coarsest) {
  const int lowest = kPaceSteps + coarsest;
  if (step_ > lowest) return move_to(lowest, now);
  if (share > kBadShare) {
    last_bad_ = now;
    if (++bad_ < kBadPeriods || step_ == lowest) return false;
    const bool failed = raised_ >= 0 && now - raised_ < kProbation;
    patience_ = failed ? std::min(2 * patience_, kLongestPatience) : kPatience;
    return move_to(step_ + 1, now);
  }
  bad_ = 0;
  if (step_ == 0 || now - last_bad_ < patience_) return false;
  raised_ = now;
  return move_to(step_ - 1, now);
}

bool QualitySteps::move_to(int step, double now) {
  step_ = step;
  bad_ = 0;
  last_bad_ = now;
  return true;
}

}  // namespace weft::server
