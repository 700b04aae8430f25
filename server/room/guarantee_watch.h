#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/clock.h"
#include "server/translate/translate_guarantee.h"

namespace weft::server {

/// Something of it that viewers should be told.
struct GuaranteeNews {
  proto::NoticeLevel level = proto::NoticeLevel::info;
  const char* code = "";
  std::string message;
};

/// Watches a world's promise that nothing crosses: counts crossings from time to time, and reports
/// when the promise ends or is restored. It only observes, so it changes no bit of the motion.
template <class Real>
class GuaranteeWatch {
 public:
  /// @param pause  ticks between two counts; 0: counts only on request. Counts are also at least a
  ///               hundred times as far apart as one takes, so that a large cloth does not stall.
  /// @param clock  [s], for spacing the counts
  GuaranteeWatch(std::uint32_t pause, Clock clock) : pause_(pause), clock_(std::move(clock)) {}

  /// Takes another world, at its start. A stop signal of the thread ends only its first count.
  /// @param starts  faults that its first tick will find
  void start(const World<Real>& world, ComingStarts starts);
  /// The same world is back at its start.
  void restart();

  /// Call after a tick that changed the cloth or an object.
  void note_tick(const World<Real>& world);
  /// Whether `count_if_due`, or `count_if_stale`, would count now.
  bool is_due() const;
  bool is_stale() const;
  /// Counts if a count is due.
  /// @returns whether more is known, or another number of crossings. A stop signal of the thread
  /// that ends a count makes it, and the others, throw Stopped.
  bool count_if_due(const World<Real>& world);
  /// Counts if the state has changed since the last count.
  /// @returns whether it counted
  bool count_if_stale(const World<Real>& world);

  /// Crossings of the present state: counted now unless the count is up to date.
  const proto::Crossings& count(const World<Real>& world);

  /// The last count, if there was one.
  const std::optional<proto::Crossings>& crossings() const { return crossings_; }
  /// Not held while anything crosses in the last count, or if that was given up.
  proto::Guarantee guarantee(const World<Real>& world) const;

  /// News since the last call.
  std::vector<GuaranteeNews> take_news();

 private:
  void look(const World<Real>& world);
  void tell_bad_starts(BadStarts found);

  std::uint32_t pause_;
  Clock clock_;
  CrossingCounter<Real> counter_;
  std::optional<proto::Crossings> crossings_, crossings_at_start_;
  std::uint32_t uncounted_ = 0;      ///< ticks since the last count
  double next_count_ = 0;            ///< earliest time of the next one [s]
  bool unfinished_ = false;          ///< the last one was given up, so nothing is known
  ComingStarts starts_;              ///< found by the look-ahead
  BadStarts bad_starts_;             ///< announced starts, and other crossings
  std::vector<Meeting> meetings_;    ///< which pairs cross, as last counted or at the start
  bool began_ = false;               ///< at least one tick since the start
  bool displaced_ = false;           ///< the scene has moved particles since the last count
  bool late_ = false;                ///< the crossings appeared after the start
  std::vector<std::string> voided_;  ///< objects already announced
  std::vector<GuaranteeNews> news_;
};

extern template class GuaranteeWatch<float>;
extern template class GuaranteeWatch<double>;

}  // namespace weft::server
