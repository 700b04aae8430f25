#include "server/room/guarantee_watch.h"

#include <algorithm>
#include <utility>

namespace weft::server {
namespace {

constexpr double kCountShare = 0.01;  // share of the time that counting may take
constexpr double kCountPatience = 1;  // assumed duration of a count that was given up [s]

/// Ticks between two counts while a named crossing lasts, so that its end is announced soon, even
/// where no regular counts are made.
constexpr std::uint32_t kPauseWhileThrough = 10;

bool contains(const std::vector<std::string>& list, const std::string& text) {
  return std::find(list.begin(), list.end(), text) != list.end();
}

}  // namespace

template <class Real>
void GuaranteeWatch<Real>::start(const World<Real>& world, ComingStarts starts) {
  counter_ = {};
  crossings_.reset();
  crossings_at_start_.reset();
  began_ = false;
  starts_ = std::move(starts);
  try {
    if (pause_ > 0) crossings_at_start_ = count(world);
  } catch (const Stopped&) {  // it took too long, and is tried again when there is time
  }
  restart();
}

template <class Real>
void GuaranteeWatch<Real>::restart() {
  crossings_ = crossings_at_start_;
  uncounted_ = crossings_ ? 0 : 1;
  unfinished_ = pause_ > 0 && !crossings_;
  bad_starts_ = {};
  voided_.clear();
  news_.clear();
  began_ = late_ = displaced_ = false;
  meetings_ = starts_.meetings;
  tell_bad_starts({starts_.what, starts_.pairs});
}

template <class Real>
void GuaranteeWatch<Real>::note_tick(const World<Real>& world) {
  ++uncounted_;
  began_ = true;
  displaced_ = displaced_ || world.report().brought != 0;
  std::vector<std::string> voided = voiding_colliders(world);
  for (const std::string& name : voided) {
    if (contains(voided_, name)) continue;
    news_.push_back(
        {proto::NoticeLevel::warning, "guarantee_void",
         name + " was forced through the cloth: it is no longer promised that nothing crosses"});
  }
  voided_ = std::move(voided);
  look(world);
}

/// Compares what contact knows now with the last count.
template <class Real>
void GuaranteeWatch<Real>::look(const World<Real>& world) {
  BadStarts found{world.bad_starts(), world.open_pairs()};
  const std::size_t known = found.what.size();
  if (bad_starts_.what.empty()) late_ = true;
  add_meetings(world, meetings_, late_ ? "passes through" : "started through", bad_starts_.what,
               found);
  late_ = late_ && known < found.what.size();
  tell_bad_starts(std::move(found));
}

/// Announces once each start about which nothing can be promised, and when all are clear.
template <class Real>
void GuaranteeWatch<Real>::tell_bad_starts(BadStarts found) {
  for (const std::string& what : found.what) {
    if (contains(bad_starts_.what, what)) continue;
    news_.push_back({proto::NoticeLevel::warning, "guarantee_void",
                     what + ": until it is out, it is not promised that nothing crosses there"});
  }
  if (found.what.empty() && !bad_starts_.what.empty() && voided_.empty())
    news_.push_back({proto::NoticeLevel::info, "guarantee_back",
                     "what started inside is out: nothing crosses from now on"});
  bad_starts_ = std::move(found);
}

template <class Real>
const proto::Crossings& GuaranteeWatch<Real>::count(const World<Real>& world) {
  if (crossings_ && uncounted_ == 0) return *crossings_;
  const double start = clock_();
  // A count that is given up is tried again as late as if it had finished.
  next_count_ = start + kCountPatience / kCountShare;
  unfinished_ = true;
  std::vector<Meeting> meetings;
  const proto::Crossings counted = crossings_of(world, counter_, meetings);
  if (began_ && !bad_starts_.what.empty()) counter_.find_in_rounds(world, meetings);
  crossings_ = counted;
  uncounted_ = 0;
  unfinished_ = false;
  displaced_ = false;
  // Before the first tick the look-ahead knows more.
  if (began_) {
    meetings_ = std::move(meetings);
    look(world);
  }
  const double end = clock_();
  next_count_ = end + (end - start) / kCountShare;
  return *crossings_;
}

template <class Real>
bool GuaranteeWatch<Real>::is_due() const {
  const std::uint32_t pause =
      bad_starts_.what.empty() || meetings_.empty() ? pause_ : kPauseWhileThrough;
  const bool may = clock_() >= next_count_;
  if (pause != 0 && uncounted_ >= pause && may) return true;
  // Particles moved by the scene bypass contact, which then knows of no start.
  return displaced_ && (!unfinished_ || may);
}

template <class Real>
bool GuaranteeWatch<Real>::is_stale() const {
  if (pause_ == 0 || uncounted_ == 0) return false;
  return !unfinished_ || clock_() >= next_count_;
}

template <class Real>
bool GuaranteeWatch<Real>::count_if_due(const World<Real>& world) {
  if (!is_due()) return false;
  const bool unknown = unfinished_;
  const std::uint64_t before = crossings_ ? crossings_->count : 0;
  return count(world).count != before || unknown;
}

template <class Real>
bool GuaranteeWatch<Real>::count_if_stale(const World<Real>& world) {
  if (!is_stale()) return false;
  count(world);
  return true;
}

template <class Real>
proto::Guarantee GuaranteeWatch<Real>::guarantee(const World<Real>& world) const {
  proto::Guarantee guarantee = guarantee_of(world, bad_starts_);
  if (guarantee.state == proto::GuaranteeState::bad_start && late_)
    guarantee.state = proto::GuaranteeState::broken;
  const bool crosses = crossings_ && crossings_->count > 0;
  if (guarantee.state != proto::GuaranteeState::held || (!crosses && !unfinished_))
    return guarantee;
  guarantee.state = proto::GuaranteeState::broken;
  if (!crosses) {
    guarantee.reasons.emplace_back("the last count of crossings took too long to end");
    return guarantee;
  }
  guarantee.pairs = crossings_->count;
  guarantee.reasons.emplace_back(has_guard(world.def())
                                     ? "edges pass through triangles, as counted"
                                     : "cloth passes through cloth, which nothing prevents here");
  return guarantee;
}

template <class Real>
std::vector<GuaranteeNews> GuaranteeWatch<Real>::take_news() {
  return std::exchange(news_, {});
}

template class GuaranteeWatch<float>;
template class GuaranteeWatch<double>;

}  // namespace weft::server
