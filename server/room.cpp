#include "server/room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include <spdlog/spdlog.h>

#include "core/error.h"
#include "server/translate_forces.h"
#include "server/translate_holds.h"

namespace weft::server {
namespace {

constexpr double kStatePause = 0.25;            // between two `state` while ticks pass [s]
constexpr double kLongestSleep = 0.25;          // [s]
constexpr double kShortestTelling = 1.0 / 240;  // between two of what has changed [s]
constexpr double kTellingRate = 2e6;            // of one viewer, in the long run [bytes/s]
constexpr long kFramesOnWay = 4;                // of an `advance`, that its viewer has not taken
constexpr double kStalled = 2;                  // without taking any it does not read [s]
constexpr std::size_t kTickTimes = 120;         // for the median
constexpr double kSlow = 0.9;            // part of the wanted speed that counts as slow motion
constexpr double kSlowPatience = 2;      // [s]
constexpr double kSlowNoticePause = 10;  // [s]

constexpr std::array<const char*, 8> kColors = {"#e4572e", "#2e86e4", "#2ea84f", "#b04fd1",
                                                "#d99a00", "#00a3a3", "#d13f7c", "#6b7a1f"};

}  // namespace

Room::Room(RoomOptions options, SceneSource scenes, RoomOutput& output, Clock clock,
           Metrics& metrics, Executor* executor)
    : options_(std::move(options)), scenes_(std::move(scenes)), output_(output),
      clock_(std::move(clock)), metrics_(metrics), executor_(executor), paused_(options_.paused),
      guarantee_(options_.count_pause, clock_) {
  WorldDef def = options_.scene_def ? *options_.scene_def : definition_of(options_.scene);
  if (options_.tick_rate > 0) def.tick_rate = options_.tick_rate;
  for (const auto& [key, value] : options_.settings) set_field(def, key, value);
  start_world(build_scene(def, executor_, options_.limit ? options_.limit->seconds() : 0));
  meter_.restart(clock_());
}

WorldDef Room::definition_of(const std::string& scene) const {
  WorldDef def = scenes_(scene);
  def.name = scene;
  if (options_.tick_rate > 0) def.tick_rate = options_.tick_rate;
  return def;
}

/// Puts a scene in the place of the present one; nothing of it can fail.
void Room::start_world(BuiltScene&& scene) {
  world_ = std::move(scene.world);
  measures_forces_ = false;
  hands_.clear();
  pin_owners_.clear();
  pins_on_way_.clear();
  scene_grabs_.clear();
  tick_times_.clear();
  next_tick_time_ = 0;
  ++epoch_;
  mesh_ = std::move(scene.mesh);
  mesh_.epoch = epoch_;
  mesh_bytes_ = std::move(scene.mesh_bytes);
  output_.offer_mesh(mesh_.hash, mesh_bytes_);
  wanted_softness_ = 1;
  budget_.restart(world_->def().budget, {});
  guarantee_.start(*world_, std::move(scene.bad_starts));
  output_.set_frame_rate(world_->def().tick_rate * speed());
}

void Room::take_now(Inbound item) {
  if (const auto* joining = std::get_if<Join>(&item.what)) return join(item.viewer, *joining);
  if (std::holds_alternative<Leave>(item.what)) return leave(item.viewer);
  const auto found = viewers_.find(item.viewer);
  if (found == viewers_.end()) return;
  found->second.applied = item.number;
  if (const auto* request = std::get_if<proto::Request>(&item.what)) {
    const double before = options_.cpu_clock();
    handle(item.viewer, *request);
    charge(item.viewer, options_.cpu_clock() - before);
    on_finished(item.viewer);
    return;
  }
  const Noted& noted = std::get<Noted>(item.what);
  if (noted.forces) found->second.wants_forces = *noted.forces;
  if (noted.wants_frame) found->second.wants_frame = true;
}

void Room::join(proto::ViewerId id, const Join& join) {
  Viewer& viewer = viewers_[id];
  viewer.info = {id, "viewer " + std::to_string(id), kColors[id % kColors.size()], "operator", {}};
  viewer.mesh_over_http = join.mesh_over_http;
  roster_changed_ = true;
  tell_changes_if_due(clock_());

  proto::Welcome welcome;
  welcome.version = options_.version;
  welcome.session = options_.session;
  welcome.viewer = id;
  welcome.name = viewer.info.name;
  welcome.color = viewer.info.color;
  welcome.role = viewer.info.role;
  welcome.scene = world_->def().name;
  welcome.tick_rate = world_->def().tick_rate;
  welcome.clock = clock_();
  welcome.limits = options_.limits;
  welcome.capabilities = {"pick",  "drag", "pin",      "camera",  "step", "advance",
                          "query", "move", "move_pin", "gripper", "load"};
  output_.send(id, text_message(proto::encode_welcome(welcome)));
  send_mesh(id, viewer);
  output_.send(id, text_message(proto::encode_state(state()), Topic::state));
  output_.send(id, text_message(proto::encode_roster(roster()), Topic::roster));
  output_.send(id, text_message(proto::encode_pins(world_->tick(), pins()), Topic::pins));
  output_.send(id, text_message(proto::encode_grabs(world_->tick(), grabs(false)), Topic::grabs));
  output_.welcome_done(id);
  viewer.wants_frame = true;
  if (!in_tick_) show_to(id);
}

void Room::send_mesh(proto::ViewerId to, const Viewer& viewer) {
  output_.send(to, text_message(proto::encode_mesh(mesh_), Topic::mesh));
  if (!viewer.mesh_over_http) output_.send(to, {mesh_bytes_, true, Topic::mesh_data});
}

void Room::leave(proto::ViewerId viewer) {
  if (viewers_.erase(viewer) == 0) return;
  for (std::size_t i = hands_.size(); i-- > 0;) {
    if (hands_[i].viewer == viewer)
      end_hand(hands_.begin() + static_cast<std::ptrdiff_t>(i), CommandOrigin::leave);
  }
  roster_changed_ = true;
}

/// Measures them as long as a viewer wants them.
void Room::measure_forces() {
  bool wanted = output_.wants_forces();
  if (advance_ &&
      advance_->frames.value_or(proto::AdvanceFrames::none) != proto::AdvanceFrames::none) {
    const auto caller = viewers_.find(advance_->viewer);
    wanted = wanted || (caller != viewers_.end() && caller->second.wants_forces);
  }
  if (wanted == measures_forces_) return;
  measures_forces_ = wanted;
  within_limit([this] { world_->measure_forces(measures_forces_); });
}

/// @returns what it took [s]; nothing if the tick was given up
std::optional<double> Room::step_world() {
  measure_forces();
  const double start = clock_();
  gives_up_ = over_limit_ = false;
  in_tick_ = true;
  // A tick that is ended throws nothing: its report tells.
  within_limit([this] { world_->step(); });
  in_tick_ = false;
  const TickReport& report = world_->report();
  last_tick_done_ = clock_();
  const double seconds = last_tick_done_ - start;
  if (report.halted) {
    note_halt();
    return std::nullopt;
  }
  metrics_.count_tick(seconds, report.rested);
  if (tick_times_.size() < kTickTimes) tick_times_.resize(tick_times_.size() + 1);
  tick_times_[next_tick_time_++ % tick_times_.size()] = seconds;
  if (next_tick_time_ == kTickTimes) next_tick_time_ = 0;
  if (!report.rested) guarantee_.note_tick(*world_);
  // What rests is counted once: nothing will change it.
  const bool fell_asleep = tell_sleep() && world_->sleep().all_asleep();
  within_limit([&] {
    if (report.rested || fell_asleep ? guarantee_.count_if_stale(*world_)
                                     : guarantee_.count_if_due(*world_))
      state_changed_ = true;
  });
  if (report.rested) return seconds;
  tell_guarantee();
  tell_pins();
  tell_grabs();
  if (!report.divergence) return seconds;
  const std::string what = describe(*report.divergence);
  spdlog::warn("scene {}: {}", world_->def().name, what);
  jumped_ = jumped_ || report.divergence->remedy == DivergenceRemedy::stopped_cloth;
  notify(proto::NoticeLevel::warning, "recovered", what);
  return seconds;
}

void Room::tick() {
  const std::optional<double> seconds = step_world();
  if (!seconds) return;
  meter_.add(world_->tick_seconds(), clock_());
  if (!world_->report().rested) {
    ticked_ = true;
    keep_budget(*seconds);
  }
  if (paused_ && steps_left_ > 0 && --steps_left_ == 0) state_changed_ = true;
}

void Room::advance_until(double deadline) {
  while (advance_ && advance_->left > 0) {
    if (advance_waits()) {
      if (clock_() - advance_->taken < kStalled) break;
      viewers_.at(advance_->viewer).stalled = true;
      return finish_advance(stalled_error());
    }
    advance_->taken = clock_();
    const bool shown = shows_next_tick();
    if (!step_world()) return;  // it was told, and the advance ended if nothing replaces it
    --advance_->left;
    advanced_ = advanced_ || !world_->report().rested;
    if (shown) show_advanced();
    if (clock_() >= deadline) break;
  }
  if (advance_ && advance_->left == 0) finish_advance();
}

/// Whether as many frames of its own `advance` as may be are on their way to a viewer.
bool Room::frames_wait(const Viewer& viewer) const {
  return viewer.ticket.use_count() > kFramesOnWay;
}

/// Whether the viewer that advances asked for the frame of the coming tick.
bool Room::shows_next_tick() const {
  return advance_->frames == proto::AdvanceFrames::all ||
         (advance_->frames == proto::AdvanceFrames::last && advance_->left == 1);
}

bool Room::advance_waits() const {
  return advance_ && shows_next_tick() && frames_wait(viewers_.at(advance_->viewer));
}

void Room::show_advanced() {
  const Viewer& viewer = viewers_.at(advance_->viewer);
  const Frame frame = encode_frame();
  const bool full = viewer.wants_forces && frame.with_forces;
  output_.send(advance_->viewer,
               {full ? frame.with_forces : frame.bytes, true, Topic::frame, viewer.ticket});
}

/// An `advance` whose viewer takes no frame of it does not hold up the room.
proto::Error Room::stalled_error() const {
  proto::Error error = proto::make_error(
      proto::ErrorCode::stalled,
      "the frames of this advance were not read for " + proto::number_text(kStalled) + " s",
      "it ended at tick " + std::to_string(world_->tick()) + "; read faster or ask for the last");
  error.command = "advance";
  if (advance_) error.id = advance_->id;
  return error;
}

void Room::finish_advance(const std::optional<proto::Error>& error) {
  const Advance done = *advance_;
  advance_.reset();
  if (error)
    output_.send(done.viewer, text_message(proto::encode_error(*error)));
  else
    answer(done.viewer, done.id, proto::AdvanceReply{world_->tick(), world_->hash()});
  state_changed_ = true;
}

double Room::real_time_factor() const {
  return ticking() ? meter_.factor(clock_(), speed()) : 0;
}

void Room::finish_turn() {
  work_off();
  const double now = clock_();
  end_leases();
  if (ticking() && now >= next_state_) {
    state_changed_ = state_changed_ || !world_->report().rested;
    tell_slow_motion(now);
  }
  const bool stands = !ticking() && !advance_ && now - last_tick_done_ >= kStatePause;
  if (stands) {
    within_limit([this] {
      if (guarantee_.count_if_stale(*world_)) state_changed_ = true;
    });
  }
  tell_changes_if_due(now);
  if (now >= next_frame()) publish(now);
  if (now >= next_idle_frame_) show_to_those_who_lack(now);
}

void Room::show_to_those_who_lack(double now) {
  for (auto& [id, viewer] : viewers_) {
    if (!viewer.wants_frame) continue;
    show_to(id);
    next_idle_frame_ = now + world_->tick_seconds();
  }
}

double Room::next_wake() const {
  const double now = clock_();
  double wake = std::min(now + kLongestSleep, next_frame());
  if (has_news()) wake = std::min(wake, next_telling_);
  if (!waiting_.empty()) wake = std::min(wake, next_turn());
  for (const auto& [id, viewer] : viewers_)
    if (viewer.wants_frame) wake = std::min(wake, next_idle_frame_);
  return wake;
}

/// Whether ticks make no frames now: none pass by the clock, or all cloth sleeps.
bool Room::frames_stand() const {
  return !ticking() || world_->report().rested;
}

/// When a frame to all is due [s]; infinity if nothing that frames show has changed. Ticks of the
/// clock make one each, whatever commands come between them. What else changes it has at most one
/// in a tick's time, but for the first after the state was replaced.
double Room::next_frame() const {
  double next = std::numeric_limits<double>::infinity();
  if (!output_.wants_frames()) return next;
  if (ticked_) return -next;
  if (jumped_) next = next_jump_;
  if (advanced_ || jumped_ || (frame_wanted_ && frames_stand()))
    next = std::min(next, next_idle_frame_);
  return next;
}

void Room::end_leases() {
  const double now = clock_();
  for (std::size_t i = hands_.size(); i-- > 0;) {
    // Lock-step and standing still do not count against a hand.
    if (paused_ || advance_) hands_[i].heard = now;
    if (now - hands_[i].heard < options_.limits.lease_seconds) continue;
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%g", options_.limits.lease_seconds);
    notify(proto::NoticeLevel::warning, "lease_expired",
           "drag " + std::to_string(hands_[i].drag) + " was released after " + seconds +
               " s without a target",
           hands_[i].viewer, hands_[i].drag);
    end_hand(hands_.begin() + static_cast<std::ptrdiff_t>(i), CommandOrigin::lease);
  }
}

void Room::tell_slow_motion(double now) {
  const double factor = real_time_factor();
  metrics_.set_real_time_factor(factor);
  if (factor >= kSlow * speed()) {
    slow_since_ = -1;
    return;
  }
  if (slow_since_ < 0) slow_since_ = now;
  if (now - slow_since_ < kSlowPatience || now < next_slow_notice_) return;
  next_slow_notice_ = now + kSlowNoticePause;
  notify(proto::NoticeLevel::warning, "slow_motion",
         "the cloth is too heavy for its tick rate and moves in slow motion", 0, {}, factor);
}

bool Room::has_news() const {
  return state_changed_ || roster_changed_ || pins_changed_ || grabs_changed_ || !notices_.empty();
}

/// Whatever changes is told together, at most once in a tick's time, so that no viewer can flood
/// the others by changing it. Long lists of pins are told less often.
void Room::tell_changes_if_due(double now) {
  if (has_news() && now >= next_telling_) tell_changes();
}

void Room::tell_changes() {
  std::size_t bytes = 0;
  const auto tell = [&](std::string text, Topic topic) {
    bytes += text.size();
    output_.broadcast(text_message(std::move(text), topic));
  };
  const double now = clock_();
  for (const proto::Notice& notice : std::exchange(notices_, {}))
    tell(proto::encode_notice(notice), Topic::none);
  if (state_changed_) {
    tell(proto::encode_state(state()), Topic::state);
    next_state_ = now + kStatePause;
  }
  if (roster_changed_) tell(proto::encode_roster(roster()), Topic::roster);
  if (pins_changed_) tell(proto::encode_pins(world_->tick(), pins()), Topic::pins);
  if (grabs_changed_) tell(proto::encode_grabs(world_->tick(), grabs(false)), Topic::grabs);
  state_changed_ = roster_changed_ = pins_changed_ = grabs_changed_ = false;
  next_telling_ = now + std::max({world_->tick_seconds(), kShortestTelling,
                                  static_cast<double>(bytes) / kTellingRate});
}

/// The newest frame, to all whom it tells something.
void Room::publish(double now) {
  Frame frame = encode_frame();
  frame.at_once = jumped_;
  // What `advance` made is its viewer's by what it asked for, until something else changes.
  if (!frame_wanted_ && !ticked_) frame.not_to = advance_for_;
  if (jumped_) next_jump_ = now + world_->tick_seconds();
  next_idle_frame_ = now + world_->tick_seconds();
  for (auto& [id, viewer] : viewers_)
    if (id != frame.not_to) viewer.wants_frame = false;
  if (frame.not_to == 0) advance_for_ = 0;
  frame_wanted_ = ticked_ = advanced_ = jumped_ = false;
  output_.offer_frame(std::move(frame));
}

/// A frame to a viewer that lacks the present one.
void Room::show_to(proto::ViewerId viewer) {
  Frame frame = encode_frame();
  frame.at_once = true;
  frame.only_to = viewer;
  viewers_.at(viewer).wants_frame = false;
  output_.offer_frame(std::move(frame));
}

/// A frame of the present state.
Frame Room::encode_frame() {
  measure_forces();
  within_limit([this] { world_->measure_present_forces(); });
  grab_samples_.clear();
  for (const Grab<float>& grab : world_->grabs().list) {
    const auto hand = std::find_if(hands_.begin(), hands_.end(),
                                   [&](const Hand& h) { return h.grab == grab.id; });
    grab_samples_.push_back(grab_sample(*world_, grab, hand == hands_.end() ? 0 : hand->viewer));
  }
  applied_.clear();
  for (const auto& [id, viewer] : viewers_)
    if (viewer.applied > 0) applied_.push_back({id, viewer.applied});

  proto::FrameView view;
  view.header.flags = static_cast<std::uint8_t>(
      proto::kFrameKey | (jumped_ ? proto::kFrameJump : 0) | (paused_ ? proto::kFramePaused : 0));
  view.header.tick = world_->tick();
  view.header.time = static_cast<double>(world_->tick()) * world_->tick_seconds();
  view.header.server_time = last_tick_done_;
  view.header.sequence = view.header.reference = ++sequence_;
  view.header.epoch = epoch_;
  view.positions = floats_of(world_->state().x);
  view.grabs = grab_samples_;
  view.applied = applied_;
  pose_samples(*world_, pose_samples_);
  view.poses = pose_samples_;
  proto::Bytes bytes, with_forces;
  proto::encode_frame(view, bytes);
  Frame frame{SharedBytes(std::move(bytes)), sequence_};
  if (world_->reactions()) {
    contact_samples_ = contact_samples(*world_);
    reaction_samples_ = reaction_samples(*world_);
    view.contacts = contact_samples_;
    view.reactions = reaction_samples_;
    proto::encode_frame(view, with_forces);
    frame.with_forces = SharedBytes(std::move(with_forces));
  }
  ++frames_encoded_;
  return frame;
}

void Room::notify(proto::NoticeLevel level, const char* code, std::string message,
                  proto::ViewerId viewer, std::optional<std::uint32_t> drag,
                  std::optional<double> value) {
  proto::Notice notice;
  notice.level = level;
  notice.code = code;
  notice.message = std::move(message);
  notice.tick = world_->tick();
  if (viewer != 0) notice.viewer = viewer;
  notice.drag = drag;
  notice.value = value;
  // Once, and the newest, however often the same thing happens before it is told.
  std::erase_if(notices_, [&notice](const proto::Notice& told) {
    return told.code == notice.code && told.message == notice.message &&
           told.viewer == notice.viewer && told.drag == notice.drag;
  });
  notices_.push_back(std::move(notice));
}

proto::State Room::state() const {
  proto::State state = state_of(*world_);
  state.paused = paused_;
  state.speed = wanted_speed_;
  state.pace = budget_.setting().pace;
  state.softness = world_->softness();
  state.budget_ms = budget_.budget().milliseconds;
  state.over_budget = to_wire(budget_.budget().remedy);
  state.real_time_factor = real_time_factor();
  state.guarantee = guarantee_.guarantee(*world_);
  state.crossings = guarantee_.crossings();
  if (!tick_times_.empty()) {
    std::vector<double> times = tick_times_;
    const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::nth_element(times.begin(), middle, times.end());
    state.step_ms = *middle * 1000;
  }
  return state;
}

std::vector<proto::ViewerInfo> Room::roster() const {
  std::vector<proto::ViewerInfo> list;
  for (const auto& [id, viewer] : viewers_) list.push_back(viewer.info);
  return list;
}

std::vector<proto::PinInfo> Room::pins() const {
  std::vector<proto::PinInfo> list;
  for (const Pin& pin : world_->pins().list) {
    const auto owner = pin_owners_.find(pin.id);
    list.push_back(pin_info(*world_, pin, owner == pin_owners_.end() ? 0 : owner->second));
  }
  return list;
}

std::vector<proto::GrabInfo> Room::grabs(bool with_force) const {
  std::vector<proto::GrabInfo> list;
  for (const Grab<float>& grab : world_->grabs().list) {
    if (const auto own = world_->scene_hand(grab.id))
      list.push_back(grab_info(*world_, grab, 0, static_cast<std::uint32_t>(*own)));
    for (const Hand& hand : hands_) {
      if (hand.grab == grab.id) list.push_back(grab_info(*world_, grab, hand.viewer, hand.drag));
    }
  }
  if (!with_force) {
    for (proto::GrabInfo& grab : list) grab.force.reset();
  }
  return list;
}

}  // namespace weft::server
