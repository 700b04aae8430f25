#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "core/cloth/softening.h"
#include "core/world/budget.h"

namespace weft::server {

/// Watches tick times and decides how to keep to a budget: the fraction of the wanted speed at
/// which time passes, and the softness of the springs. It decides by the median of a window of
/// ticks, so that one slow tick changes nothing, and leaves a margin in both directions, so that it
/// does not oscillate.
class BudgetKeeper {
 public:
  static constexpr std::size_t kStretch = 30;  ///< ticks between two decisions

  /// Applies to the coming ticks.
  struct Setting {
    double pace = 1;      ///< fraction of the wanted speed, kLeastPace to 1
    double softness = 1;  ///< of the springs, kLeastSoftness to 1
    bool operator==(const Setting&) const = default;
  };
  static constexpr double kLeastPace = 0.01;

  /// Starts afresh from the current setting.
  /// @param most_softness  requested softness; recovery stops there
  void restart(const BudgetDef& budget, const Setting& setting, double most_softness = 1) {
    budget_ = budget;
    setting_ = setting;
    most_softness_ = most_softness;
    count_ = 0;
  }

  const BudgetDef& budget() const { return budget_; }
  const Setting& setting() const { return setting_; }

  /// @param seconds  duration of a tick
  /// @param may_soften  whether softer springs would reduce the number of substeps
  /// @returns the new setting, if it differs
  std::optional<Setting> add(double seconds, bool may_soften) {
    if (budget_.milliseconds <= 0) return std::nullopt;
    times_[count_++] = seconds;
    if (count_ < kStretch) return std::nullopt;
    count_ = 0;
    const auto middle = times_.begin() + kStretch / 2;
    std::nth_element(times_.begin(), middle, times_.end());
    const Setting next = decide(*middle * 1000, may_soften);
    if (next == setting_) return std::nullopt;
    setting_ = next;
    return next;
  }

 private:
  // Smaller changes are not worth a command; the budget is given back only with room to spare.
  static constexpr double kSlack = 0.05, kRoom = 0.7, kAim = 0.9;
  static constexpr double kFastestSoftening = 0.25;  // in one decision, and likewise in recovery

  /// Two significant digits, so that a person can read the setting.
  static double rounded(double value) {
    // A division, not a product: 70 / 1000 is 0.07, and 70 * 0.001 is not.
    const double per_unit = std::pow(10.0, 1 - std::floor(std::log10(value)));
    return std::floor(value * per_unit + 1e-9) / per_unit;
  }

  Setting decide(double milliseconds, bool may_soften) const {
    Setting next = setting_;
    const double part = budget_.milliseconds / milliseconds;
    if (budget_.remedy == OverBudget::soften && may_soften && setting_.pace >= 1) {
      // The substeps, and with them the time, scale with the root of the stiffness.
      const double wanted = setting_.softness * kAim * part * kAim * part;
      if (part < 1 - kSlack && setting_.softness > kLeastSoftness) {
        next.softness =
            rounded(std::max({wanted, setting_.softness * kFastestSoftening, kLeastSoftness}));
        return next;
      }
      if (part * kRoom > 1 && setting_.softness < most_softness_) {
        const double most = std::min(setting_.softness / kFastestSoftening, most_softness_);
        next.softness = wanted >= most ? most : rounded(wanted);
        return next;
      }
      if (part > 1 - kSlack) return next;
    }
    const double pace = std::clamp(part, kLeastPace, 1.0);
    const bool slower = pace < setting_.pace * (1 - kSlack);
    const bool faster = kAim * pace > setting_.pace || (pace >= 1 && part * kAim > 1);
    if (slower || faster) next.pace = pace >= 1 ? 1 : rounded(pace);
    return next;
  }

  BudgetDef budget_;
  Setting setting_;
  double most_softness_ = 1;
  std::array<double, kStretch> times_{};
  std::size_t count_ = 0;
};

}  // namespace weft::server
