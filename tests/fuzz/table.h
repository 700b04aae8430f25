#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tests/fuzz/apart.h"
#include "tests/fuzz/run.h"

namespace weft::fuzz {

/// What all runs together have shown.
class Table {
 public:
  /// @param name  how it is repeated, e.g. "--seed 1 --scene 2"
  void add(const std::string& name, const Outcome& outcome, const Ending& ending);

  /// So many words on each failure, and the sums.
  std::string text() const;

  /// Whether nothing crashed, hung, failed within, told something that is not finite or took longer
  /// than it may, and at most one scene in fifty met the tick limit.
  bool good() const;

  std::uint64_t runs() const { return runs_; }

 private:
  struct Longest {
    double seconds = 0;
    std::string name;

    void take(double candidate, const std::string& of) {
      if (candidate > seconds) *this = {candidate, of};
    }
  };

  std::uint64_t runs_ = 0, refused_ = 0, bare_refusals_ = 0, commands_ = 0, errors_ = 0, ticks_ = 0;
  std::uint64_t crashes_ = 0, hangs_ = 0, ticks_over_ = 0, waits_over_ = 0, recoveries_ = 0;
  std::uint64_t halted_runs_ = 0, halts_ = 0, not_finite_ = 0, false_promises_ = 0;
  std::uint64_t internal_ = 0, problems_ = 0;
  double cpu_ = 0;
  Longest tick_, wait_, build_;
  std::map<std::string, int> refusals_, halt_causes_;  ///< by kind
  std::vector<std::string> failures_, slow_, halted_;
};

}  // namespace weft::fuzz
