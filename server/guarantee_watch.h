#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/clock.h"
#include "server/translate_guarantee.h"

namespace weft::server {

/// Watches a world's promise that nothing crosses: counts crossings from time to time, and knows
/// when the promise ends and is back. Looks only, and so changes no bit of the motion.
class GuaranteeWatch {
 public:
  /// Something that people shall be told.
  struct News {
    proto::NoticeLevel level = proto::NoticeLevel::info;
    const char* code = "";
    std::string message;
  };

  /// @param pause  ticks between two counts; 0: counts only when it is asked. They are also at
  ///               least a hundred times as far apart as one takes, so that a large cloth does not
  ///               stop for them.
  /// @param clock  [s], for that alone
  GuaranteeWatch(std::uint32_t pause, Clock clock) : pause_(pause), clock_(std::move(clock)) {}

  /// Another world, at its start.
  /// @param starts  what its first tick will find where it should not be
  void start(const ServedWorld& world, ComingStarts starts);
  /// The same world is back at its start.
  void restart();

  /// After a tick that changed the cloth or an object.
  void note_tick(const ServedWorld& world);
  /// Counts if a count is due.
  /// @returns whether the number of crossings has changed
  bool count_if_due(const ServedWorld& world);
  /// Counts if the state has changed since it was counted, as one that stays does once.
  /// @returns whether it did
  bool count_if_stale(const ServedWorld& world);

  /// Of the present state: counted now, unless it was.
  const proto::Crossings& count(const ServedWorld& world);

  /// As counted last, if it ever was.
  const std::optional<proto::Crossings>& crossings() const { return crossings_; }
  /// Not held while anything crosses that was counted last.
  proto::Guarantee guarantee(const ServedWorld& world) const;

  /// What has happened since this was asked.
  std::vector<News> take_news();

 private:
  void look(const ServedWorld& world);
  void tell_bad_starts(BadStarts found);

  std::uint32_t pause_;
  Clock clock_;
  ServedCrossings counter_;
  std::optional<proto::Crossings> crossings_, crossings_at_start_;
  std::uint32_t uncounted_ = 0;      ///< ticks since the last count
  double next_count_ = 0;            ///< not before this [s]
  ComingStarts starts_;              ///< as the look ahead found
  BadStarts bad_starts_;             ///< that were told, and what else crosses
  std::vector<Meeting> meetings_;    ///< who crosses whom, as counted last or at the start
  bool began_ = false;               ///< there was a tick since the start
  bool displaced_ = false;           ///< the scene put particles elsewhere since the last count
  bool late_ = false;                ///< what crosses did not start so
  std::vector<std::string> voided_;  ///< objects that were told of
  std::vector<News> news_;
};

}  // namespace weft::server
