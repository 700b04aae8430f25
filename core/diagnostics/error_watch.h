#pragma once

// The error of one quantity of a run, from differences between repetitions of that run.

namespace weft {

/// Differences of one quantity between a run and its repetitions, in its unit, each at least 0.
struct RunDifferences {
  double once_twice = 0;  ///< between 1 and 2 times the substeps
  double twice_four = 0;  ///< between 2 and 4 times
  double once_four = 0;   ///< between 1 and 4 times
  double noise = 0;       ///< between starts that differ by noise
};

/// An error at the largest differences so far.
struct ErrorEstimate {
  double error = 0;
  double order = 0;  ///< observed power of the step; 0: none, `error` is then a lower bound
};

/// Richardson's extrapolation. If a difference from the limit falls with the power p of the step, p
/// is log2(once_twice / twice_four), and the run differs from the limit by once_four / (1 - 4^-p).
/// No order below kLeastOrder counts: such runs do not approach each other.
ErrorEstimate extrapolate(const RunDifferences& differences);

/// The error of a quantity over a run.
struct ErrorFigure {
  bool measured = false;
  ErrorEstimate estimate;  ///< the largest error from the start to `until`
  double noise = 0;        ///< what the noise had become by then
  double until = 0;        ///< [s]
  bool chaotic = false;    ///< noise ended it
  double chaotic_at = 0;   ///< [s]
};

/// Follows a quantity through a run. A figure holds until noise has grown beyond kNoiseGrowth times
/// its start and beyond kNoiseFraction of the error: from then on runs differ by chance.
class ErrorWatch {
 public:
  /// @param noise_at_start  difference that the noise makes at the start
  explicit ErrorWatch(double noise_at_start = 0) : noise_at_start_(noise_at_start) {}

  /// Error in time, from runs with 1, 2 and 4 times the substeps.
  /// @param time  later than before [s]
  void note_steps(double time, const RunDifferences& now);

  /// Error in space, of which only one refinement is known: the difference itself, without order.
  void note_rows(double time, double difference, double noise);

  const ErrorFigure& figure() const { return figure_; }

 private:
  bool noise_rules(double time, double error);

  double noise_at_start_ = 0;
  RunDifferences most_;  ///< so far
  ErrorFigure figure_;
};

}  // namespace weft
