#pragma once

#include <array>
#include <cstddef>

// The free swing of a strip, from which the decay test reads the fabric's damping.

namespace weft {

/// Follows a deflection tick by tick from when it is let go, and keeps its turning points.
class Swing {
 public:
  static constexpr std::size_t kMostTurns = 64;

  /// Forgets all; call while something holds the strip.
  void begin_anew();

  /// @param time        [s], greater than that of the last call
  /// @param deflection  [m]
  void look(double time, double deflection);

  /// Half the distance between the last two turning points [m]; 0 before there are two.
  double amplitude() const { return count_ > 1 ? half_swing(count_ - 2) : 0; }

  /// Decay by the turning points: between each two of them lies half a period. Those below
  /// kSmallestSwing of the largest are left out, and so is the first, at which the strip may still
  /// have been held. All 0 while there are fewer than kFewestTurns.
  struct Decay {
    double period = 0;      ///< [s]
    double decay_time = 0;  ///< in which the amplitude falls to 1/e, by least squares [s]; 0: it
                            ///< does not fall
    double relaxation_time() const;  ///< of what it deforms: 2 / (omega^2 decay time) [s]
    double loss_factor() const;      ///< 2 / (omega decay time) [1]
  };
  Decay decay() const;

 private:
  struct Turn {
    double time = 0, deflection = 0;
  };
  double half_swing(std::size_t k) const;

  std::array<Turn, 3> last_{};  ///< the present deflection and the two before
  std::size_t seen_ = 0;
  std::array<Turn, kMostTurns> turns_{};  ///< the first ones
  std::size_t count_ = 0;
};

}  // namespace weft
