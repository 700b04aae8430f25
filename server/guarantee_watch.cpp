#include "server/guarantee_watch.h"

#include <algorithm>
#include <utility>

namespace weft::server {
namespace {

constexpr double kCountShare = 0.01;  // of the time may go into counting
constexpr double kCountPatience = 1;  // what a count is taken to need that was given up [s]

bool contains(const std::vector<std::string>& list, const std::string& text) {
  return std::find(list.begin(), list.end(), text) != list.end();
}

}  // namespace

void GuaranteeWatch::start(const ServedWorld& world, BadStarts bad_starts) {
  counter_ = {};
  crossings_.reset();
  crossings_at_start_.reset();
  bad_starts_at_start_ = std::move(bad_starts);
  if (pause_ > 0) crossings_at_start_ = count(world);
  restart();
}

void GuaranteeWatch::restart() {
  crossings_ = crossings_at_start_;
  uncounted_ = 0;
  bad_starts_ = {};
  voided_.clear();
  news_.clear();
  tell_bad_starts(bad_starts_at_start_, false);
}

void GuaranteeWatch::note_tick(const ServedWorld& world) {
  ++uncounted_;
  std::vector<std::string> voided = voiding_colliders(world);
  for (const std::string& name : voided) {
    if (contains(voided_, name)) continue;
    news_.push_back(
        {proto::NoticeLevel::warning, "guarantee_void",
         name + " was forced through the cloth: that nothing crosses is no longer promised"});
  }
  voided_ = std::move(voided);
  tell_bad_starts({world.bad_starts(), world.open_pairs()}, !voided_.empty());
}

/// Says once what started where nothing can be promised about it, and when all is clear.
void GuaranteeWatch::tell_bad_starts(BadStarts found, bool voided) {
  for (const std::string& what : found.what) {
    if (contains(bad_starts_.what, what)) continue;
    news_.push_back({proto::NoticeLevel::warning, "guarantee_void",
                     what + ": until it is out, that nothing crosses is not promised there"});
  }
  if (found.what.empty() && !bad_starts_.what.empty() && !voided)
    news_.push_back({proto::NoticeLevel::info, "guarantee_back",
                     "what started inside is out: nothing crosses from now on"});
  bad_starts_ = std::move(found);
}

const proto::Crossings& GuaranteeWatch::count(const ServedWorld& world) {
  if (crossings_ && uncounted_ == 0) return *crossings_;
  const double start = clock_();
  // Where it takes too long it is tried again as late as if it had been done.
  next_count_ = start + kCountPatience / kCountShare;
  crossings_ = crossings_of(world, counter_);
  const double end = clock_();
  uncounted_ = 0;
  next_count_ = end + (end - start) / kCountShare;
  return *crossings_;
}

bool GuaranteeWatch::count_if_due(const ServedWorld& world) {
  if (pause_ == 0 || uncounted_ < pause_ || clock_() < next_count_) return false;
  const std::uint64_t before = crossings_ ? crossings_->count : 0;
  return count(world).count != before;
}

bool GuaranteeWatch::count_if_stale(const ServedWorld& world) {
  if (pause_ == 0 || uncounted_ == 0) return false;
  count(world);
  return true;
}

std::vector<GuaranteeWatch::News> GuaranteeWatch::take_news() {
  return std::exchange(news_, {});
}

}  // namespace weft::server
