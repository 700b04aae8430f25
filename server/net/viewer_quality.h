#pragma once

#include <cstdint>

namespace weft::server {

/// What a viewer is sent that does not keep up: first fewer frames at even spacing, then coarser
/// ones too.
struct ViewerQuality {
  int pace = 1;     ///< the room's frames to one of the viewer
  int coarser = 0;  ///< steps of the error bound beyond the usual one
  bool operator==(const ViewerQuality&) const = default;
};

/// Chooses the quality by the share of a viewer's frames that were dropped. Frames that were
/// dropped come unevenly and late; fewer frames that all arrive look better and are newer.
class QualitySteps {
 public:
  static constexpr double kPeriod = 1;            ///< frames are counted in periods of [s]
  static constexpr double kBadShare = 0.1;        ///< of frames dropped in a bad period
  static constexpr int kBadPeriods = 2;           ///< in a row lower the quality
  static constexpr double kPatience = 4;          ///< without a bad period raises it [s]
  static constexpr double kLongestPatience = 64;  ///< doubled where raising it failed, up to [s]
  static constexpr int kSlowestPace = 3;

  /// Begins to count; call often, at least ten times a period.
  /// @param now       never goes back [s]
  /// @param sent      frames sent so far
  /// @param dropped   and dropped
  /// @param coarsest  steps of the error that the viewer allows
  /// @return whether the quality changed
  bool update(double now, std::uint64_t sent, std::uint64_t dropped, int coarsest);

  /// The viewer asked for something else: the full quality again.
  void restart();

  ViewerQuality quality() const;

 private:
  bool end_period(double now, double share, int coarsest);
  bool move_to(int step, double now);

  int step_ = 0;  ///< 0: full quality; paces come before errors
  int bad_ = 0;   ///< periods in a row
  double period_end_ = -1, last_bad_ = 0, raised_ = -1;  ///< [s]; negative: never
  double patience_ = kPatience;                          ///< [s]
  std::uint64_t sent_ = 0, dropped_ = 0;                 ///< when the period began
};

}  // namespace weft::server
