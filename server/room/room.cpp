#include "server/room/room.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <spdlog/spdlog.h>

#include "core/error.h"
#include "server/translate/translate_settings.h"

namespace weft::server {
WorldDef first_scene(const RoomOptions& options, const SceneSource& scenes) {
  WorldDef def = options.scene_def ? *options.scene_def : scenes(options.scene);
  if (!options.scene_def) def.name = options.scene;
  if (options.tick_rate > 0) def.tick_rate = options.tick_rate;
  for (const auto& [key, value] : options.settings) set_field(def, key, value);
  return def;
}

Room::Room(RoomOptions options, SceneSource scenes, RoomOutput& output, Clock clock,
           Metrics& metrics, Executor* executor)
    : Room(options, scenes,
           build_scene(first_scene(options, scenes), executor,
                       options.limit ? options.limit->seconds() : 0),
           output, std::move(clock), metrics, executor) {}

Room::Room(RoomOptions options, SceneSource scenes, BuiltScene&& scene, RoomOutput& output,
           Clock clock, Metrics& metrics, Executor* executor)
    : options_(std::move(options)), scenes_(std::move(scenes)), output_(output),
      clock_(std::move(clock)), metrics_(metrics), executor_(executor),
      time_(options_.paused, clock_()), guarantee_(options_.count_pause, clock_) {
  start_world(std::move(scene));
  renew_told();
  time_.restart_meter(clock_());
}

/// Replaces the present scene; no part of it can fail.
void Room::start_world(BuiltScene&& scene) {
  world_ = std::move(scene.world);
  scene_notices_ = std::move(scene.notices);
  for (const SceneNotice& notice : scene_notices_)
    spdlog::log(notice.warns ? spdlog::level::warn : spdlog::level::info, "scene {}: {}",
                world_->def().name, notice.message);
  forces_ = {};
  saves_.clear();
  holds_.clear();
  told_.restart();
  ++epoch_;
  mesh_ = std::move(scene.mesh);
  mesh_.epoch = epoch_;
  mesh_bytes_ = std::move(scene.mesh_bytes);
  coding_order_ = std::move(scene.order);
  output_.offer_mesh(mesh_.hash, mesh_bytes_, {epoch_, coding_order_});
  if (scene.past) {
    go_on(*std::move(scene.past));
  } else {
    time_.begin_scene(world_->def().budget);
    within_limit([&] { guarantee_.start(*world_, std::move(scene.bad_starts)); }, kBetweenTicks);
  }
  output_.set_frame_rate(world_->def().tick_rate * speed());
}

/// From what another room was, in its present world.
void Room::go_on(RoomPast&& past) {
  const bool paused = options_.paused;
  time_ = past.time;
  time_.drop_steps();
  paused ? time_.pause() : time_.resume(clock_());
  order_.log = std::move(past.log);
  guarantee_ = std::move(past.guarantee);
  forces_ = past.forces;
  note_sleep(*world_, told_);
  note_pins(*world_, told_);
  note_grabs(*world_, told_);
}

/// Whether what a viewer's commands cost costs no other viewer, of this room or of others.
bool Room::is_alone() const {
  return viewers_.size() < 2 &&
         !(options_.others && options_.others->others_have_viewers(options_.name));
}

void Room::take_now(Inbound item) {
  if (const auto* joining = std::get_if<Join>(&item.what)) return join(item.viewer, *joining);
  if (std::holds_alternative<Leave>(item.what)) return leave(item.viewer);
  const auto found = viewers_.find(item.viewer);
  if (found == viewers_.end()) return;
  if (const auto* grant = std::get_if<Grant>(&item.what)) {
    admit(found->second, *grant);
    return on_finished(item.viewer);
  }
  found->second.applied = item.number;
  if (const auto* request = std::get_if<proto::Request>(&item.what)) {
    const bool charges = !is_alone();
    const double before = charges ? options_.cpu_clock() : 0;
    handle(item.viewer, *request);
    if (charges) charge(item.viewer, options_.cpu_clock() - before);
    on_finished(item.viewer);
    return;
  }
  const Noted& noted = std::get<Noted>(item.what);
  if (noted.forces) found->second.wants_forces = *noted.forces;
  if (noted.wants_frame) found->second.wants_frame = true;
}

/// The messages that a viewer is sent before its first frame.
void Room::welcome(proto::ViewerId id, Viewer& viewer) {
  proto::Welcome welcome;
  welcome.version = options_.version;
  welcome.session = options_.session;
  welcome.viewer = id;
  welcome.name = viewer.info.name;
  welcome.color = viewer.info.color;
  welcome.role = viewer.info.role;
  welcome.room = options_.name;
  welcome.scene = world_->def().name;
  welcome.tick_rate = world_->def().tick_rate;
  welcome.clock = clock_();
  welcome.limits = options_.limits;
  welcome.capabilities = {"pick",  "drag", "pin",      "camera",  "step", "advance",
                          "query", "move", "move_pin", "gripper", "load"};
  if (options_.others) welcome.capabilities.emplace_back("rooms");
  output_.send(id, text_message(proto::encode_welcome(welcome)));
  send_mesh(id, viewer);
  if (!tick_.runs) renew_told();
  output_.send(id, told_.state);
  output_.send(id, text_message(proto::encode_roster(roster()), Topic::roster));
  output_.send(id, told_.pins);
  output_.send(id, told_.grabs);
  for (const SceneNotice& notice : scene_notices_) output_.send(id, message_of(notice));
  output_.welcome_done(id);
  viewer.wants_frame = true;
  if (!tick_.runs) show_to(id);
}

void Room::send_mesh(proto::ViewerId to, const Viewer& viewer) {
  output_.send(to, text_message(proto::encode_mesh(mesh_), Topic::mesh));
  if (!viewer.mesh_over_http) output_.send(to, {mesh_bytes_, true, Topic::mesh_data});
}

/// @returns its duration [s]; nothing if the tick was given up
std::optional<double> Room::step_world() {
  measure_forces();
  measure_balance();
  const double start = clock_(), cpu = options_.cpu_clock();
  tick_.replaced = tick_.over_limit = false;
  tick_.runs = true;
  tick_.until = world_->tick() + 1;
  tick_.failure.clear();
  // A halted tick does not throw: its report says so.
  try {
    within_limit([this] { world_->step(); });
  } catch (const std::exception& error) {
    tick_.failure = error.what();
  }
  tick_.runs = false;
  const TickReport& report = world_->report();
  const double end = clock_(), seconds = end - start;
  const double cpu_seconds = options_.cpu_clock() - cpu;
  time_.note_end_of_tick(end);
  if (report.halted) {
    note_halt();
    return std::nullopt;
  }
  metrics_.count_tick(seconds, cpu_seconds, report.rested);
  time_.note_tick(seconds);
  if (!report.rested) guarantee_.note_tick(*world_);
  const bool fell_asleep = tell_sleep() && world_->sleep().all_asleep();
  count_crossings(report.rested || fell_asleep);
  if (report.rested) tell_guarantee();
  if (report.rested) return seconds;
  tell_guarantee();
  if (note_pins(*world_, told_)) news_.pins = true;
  if (note_grabs(*world_, told_)) news_.grabs = true;
  if (!report.divergence) return seconds;
  const std::string what = describe(*report.divergence);
  spdlog::warn("scene {}: {}", world_->def().name, what);
  if (report.divergence->remedy == DivergenceRemedy::stopped_cloth) frames_.note_break();
  notify(proto::NoticeLevel::warning, "recovered", what);
  return seconds;
}

/// Announces which cloths sleep, when that changes.
/// @returns whether it did
bool Room::tell_sleep() {
  if (!note_sleep(*world_, told_)) return false;
  metrics_.set_asleep(static_cast<int>(std::count(told_.asleep.begin(), told_.asleep.end(), 1)));
  news_.state = true;
  return true;
}

/// Counts crossings if it is time.
/// @param stays  whether the state stays as it is, so that it is counted once
void Room::count_crossings(bool stays) {
  // Most ticks end without a count, and should not pay for the clock of one.
  if (!(stays ? guarantee_.is_stale() : guarantee_.is_due())) return;
  bool news = true;  // as it is if the count does not end
  within_limit(
      [&] { news = stays ? guarantee_.count_if_stale(*world_) : guarantee_.count_if_due(*world_); },
      kBetweenTicks);
  news_.state = news_.state || news;
}

void Room::tick() {
  const std::optional<double> seconds = step_world();
  if (!seconds) return;
  time_.note_passed(world_->tick_seconds(), clock_());
  if (!world_->report().rested) {
    frames_.note_tick();
    keep_budget(*seconds);
  }
  if (time_.take_step()) news_.state = true;
}

double Room::real_time_factor() const {
  return ticking() ? time_.real_time_factor(clock_()) : 0;
}

void Room::finish_turn() {
  work_off();
  const double now = clock_();
  end_leases();
  if (now >= news_.next_state) {
    const bool ticks = ticking() && !world_->report().rested;
    news_.state = news_.state || ticks || news_.ticks;
    if (ticking()) tell_slow_motion(now);
  }
  const bool stands =
      !ticking() && !order_.advance && now - time_.last_tick_done() >= kStandingPause;
  if (stands) {
    count_crossings(true);
    tell_guarantee();
  }
  tell_changes_if_due(now);
  if (news_.presence && now >= news_.next_presence) tell_presence(now);
  if (now >= next_frame()) publish(now);
  if (now >= frames_.next_idle()) show_to_those_who_lack(now);
}

double Room::next_wake() const {
  const bool stands = rests() && order_.waiting.empty() && !order_.building;
  if (stands && viewers_.empty()) return std::numeric_limits<double>::infinity();
  // A room that rests shows what changes to viewers that glance, and nothing more wakes it.
  double wake = next_frame();
  if (!stands) wake = std::min(wake, clock_() + kLongestSleep);
  if (news_.any()) wake = std::min(wake, news_.next);
  if (news_.ticks) wake = std::min(wake, news_.next_state);
  if (news_.presence) wake = std::min(wake, news_.next_presence);
  if (!order_.waiting.empty()) wake = std::min(wake, next_turn());
  for (const auto& [id, viewer] : viewers_)
    if (viewer.wants_frame) wake = std::min(wake, frames_.next_idle());
  return wake;
}

void Room::end_leases() {
  const double now = clock_();
  const double lease = options_.limits.lease_seconds;
  // A hand does not time out in lock-step or while the room is paused.
  if (paused() || order_.advance) holds_.renew_leases(now);
  for (const Hand& hand : holds_.expired(now, lease)) {
    notify(proto::NoticeLevel::warning, "lease_expired",
           "drag " + std::to_string(hand.drag) + " was released after " +
               proto::number_text(lease) + " s without a target",
           hand.viewer, hand.drag);
    end_hand(hand, CommandOrigin::lease);
  }
}

void Room::tell_slow_motion(double now) {
  const double factor = time_.real_time_factor(now);
  metrics_.set_real_time_factor(factor);
  if (!time_.is_slow(now)) return;
  notify(proto::NoticeLevel::warning, "slow_motion",
         "the cloth is too heavy for its tick rate and moves in slow motion", 0, {}, factor);
}

Message Room::message_of(const SceneNotice& what) const {
  proto::Notice notice;
  notice.level = what.warns ? proto::NoticeLevel::warning : proto::NoticeLevel::info;
  notice.code = what.code;
  notice.message = what.message;
  notice.tick = world_->tick();
  return text_message(proto::encode_notice(notice));
}

proto::State Room::state() const {
  proto::State state = state_of(*world_);
  const BudgetKeeper& budget = time_.budget();
  state.paused = paused();
  state.policy = rights_.policy;
  state.speed = time_.wanted_speed();
  state.pace = budget.setting().pace;
  state.softness = world_->softness();
  state.budget_ms = budget.budget().milliseconds;
  state.over_budget = to_wire(budget.budget().remedy);
  state.real_time_factor = real_time_factor();
  state.guarantee = guarantee_.guarantee(*world_);
  state.crossings = guarantee_.crossings();
  if (const auto seconds = time_.median_tick()) state.step_ms = *seconds * 1000;
  return state;
}

}  // namespace weft::server
