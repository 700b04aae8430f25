// Error of a quantity from repetitions of a run.

#include "core/diagnostics/error_watch.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/diagnostics/constants.h"

namespace weft {

ErrorEstimate extrapolate(const RunDifferences& d) {
  assert(d.once_twice >= 0 && d.twice_four >= 0 && d.once_four >= 0);
  if (!(d.once_twice > 0 && d.twice_four > 0)) return {d.once_four, 0};
  const double order = std::log2(d.once_twice / d.twice_four);
  if (order < kLeastOrder) return {d.once_four, 0};
  return {d.once_four / (1 - std::pow(4, -order)), order};
}

bool ErrorWatch::noise_rules(double time, double error) {
  if (most_.noise <= kNoiseGrowth * noise_at_start_ || most_.noise <= kNoiseFraction * error)
    return false;
  figure_.chaotic = true;
  figure_.chaotic_at = time;
  return true;
}

void ErrorWatch::note_steps(double time, const RunDifferences& now) {
  assert(time > figure_.until);
  if (figure_.chaotic) return;
  most_.once_twice = std::max(most_.once_twice, now.once_twice);
  most_.twice_four = std::max(most_.twice_four, now.twice_four);
  most_.once_four = std::max(most_.once_four, now.once_four);
  most_.noise = std::max(most_.noise, now.noise);
  const ErrorEstimate estimate = extrapolate(most_);
  if (noise_rules(time, estimate.error) || estimate.order == 0) return;
  figure_.measured = true;
  figure_.estimate = estimate;
  figure_.noise = most_.noise;
  figure_.until = time;
}

void ErrorWatch::note_rows(double time, double difference, double noise) {
  assert(time > figure_.until && difference >= 0);
  if (figure_.chaotic) return;
  most_.once_twice = std::max(most_.once_twice, difference);
  most_.noise = std::max(most_.noise, noise);
  if (noise_rules(time, most_.once_twice)) return;
  figure_.measured = true;
  figure_.estimate = {most_.once_twice, 0};
  figure_.noise = most_.noise;
  figure_.until = time;
}

}  // namespace weft
