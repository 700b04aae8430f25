// Finds the turning points of a swing, and its decay.

#include "core/diagnostics/swing.h"

#include <cassert>
#include <cmath>
#include <numbers>

#include "core/cloth/fabric_modes.h"
#include "core/diagnostics/constants.h"

namespace weft {

namespace {

using std::numbers::pi;

}  // namespace

void Swing::begin_anew() {
  seen_ = count_ = 0;
}

void Swing::look(double time, double deflection) {
  assert(seen_ == 0 || time > last_[2].time);
  last_ = {last_[1], last_[2], {time, deflection}};
  if (++seen_ < 3 || count_ == kMostTurns) return;
  // The top of the parabola through the three, if the middle one is farthest.
  const double before = last_[1].deflection - last_[0].deflection,
               after = last_[2].deflection - last_[1].deflection;
  if (!(before * after < 0)) return;
  const double bend = after - before, slope = (before + after) / 2;
  const Turn turn = {last_[1].time - slope / bend * (last_[2].time - last_[1].time),
                     last_[1].deflection - slope * slope / (2 * bend)};
  // A strip that trembles as it is let go turns without having swung through.
  if (count_ > 0 && turn.deflection * turns_[count_ - 1].deflection > 0) {
    if (std::abs(turn.deflection) > std::abs(turns_[count_ - 1].deflection))
      turns_[count_ - 1] = turn;
    return;
  }
  turns_[count_++] = turn;
}

double Swing::half_swing(std::size_t k) const {
  assert(k + 1 < count_);
  return std::abs(turns_[k + 1].deflection - turns_[k].deflection) / 2;
}

Swing::Decay Swing::decay() const {
  Decay found;
  // Least squares of ln(amplitude) = a - time / decay_time.
  double n = 0, t = 0, y = 0, tt = 0, ty = 0;
  std::size_t last = 1;
  for (std::size_t k = 1; k + 1 < count_; ++k) {
    if (half_swing(k) < kSmallestSwing * half_swing(1)) break;
    const double time = (turns_[k].time + turns_[k + 1].time) / 2 - turns_[1].time;
    const double log = std::log(half_swing(k));
    n += 1, t += time, y += log, tt += time * time, ty += time * log;
    last = k + 1;
  }
  if (last < kFewestTurns) return found;
  found.period = 2 * (turns_[last].time - turns_[1].time) / static_cast<double>(last - 1);
  const double slope = (n * ty - t * y) / (n * tt - t * t);
  if (slope < 0) found.decay_time = -1 / slope;
  return found;
}

double Swing::Decay::relaxation_time() const {
  return decay_time == 0 ? 0 : relaxation_of_decay(2 * pi / period, decay_time);
}

double Swing::Decay::loss_factor() const {
  return decay_time == 0 ? 0 : period / (pi * decay_time);
}

}  // namespace weft
