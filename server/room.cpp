#include "server/room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <spdlog/spdlog.h>

#include "core/error.h"
#include "server/translate_forces.h"
#include "server/translate_holds.h"

namespace weft::server {
namespace {

constexpr double kStatePause = 0.25;     // between two `state` while ticks pass [s]
constexpr double kLongestSleep = 0.25;   // [s]
constexpr std::size_t kTickTimes = 120;  // for the median
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
  start_world(def);
  meter_.restart(clock_());
}

WorldDef Room::definition_of(const std::string& scene) const {
  WorldDef def = scenes_(scene);
  def.name = scene;
  if (options_.tick_rate > 0) def.tick_rate = options_.tick_rate;
  return def;
}

void Room::start_world(const WorldDef& def) {
  Runtime runtime;
  runtime.executor = executor_;
  runtime.clock = &process_seconds;
  // Built before anything changes, because building may throw.
  auto world = std::make_unique<ServedWorld>(def, runtime);
  world_ = std::move(world);
  measures_forces_ = false;
  hands_.clear();
  pin_owners_.clear();
  pins_on_way_.clear();
  scene_grabs_.clear();
  tick_times_.clear();
  next_tick_time_ = 0;
  ++epoch_;
  proto::Bytes bytes = proto::encode_mesh_data(scene_mesh(*world_));
  mesh_ = mesh_announcement(*world_);
  mesh_.epoch = epoch_;
  mesh_.hash = proto::content_hash(bytes);
  mesh_.bytes = bytes.size();
  mesh_bytes_ = SharedBytes(std::move(bytes));
  output_.offer_mesh(mesh_.hash, mesh_bytes_);
  wanted_softness_ = 1;
  budget_.restart(world_->def().budget, {});
  guarantee_.start(*world_);
  output_.set_frame_rate(world_->def().tick_rate * speed());
}

void Room::take(Inbound item) {
  if (!advance_) return take_now(std::move(item));
  if (std::holds_alternative<Join>(item.what)) return take_now(std::move(item));
  const bool its_end = std::holds_alternative<Leave>(item.what) && item.viewer == advance_->viewer;
  deferred_.push_back(std::move(item));
  if (!its_end) return;
  advance_.reset();
  take_deferred();
}

void Room::take_deferred() {
  while (!advance_ && !deferred_.empty()) {
    Inbound item = std::move(deferred_.front());
    deferred_.pop_front();
    take_now(std::move(item));
  }
}

void Room::take_now(Inbound item) {
  if (const auto* joining = std::get_if<Join>(&item.what)) return join(item.viewer, *joining);
  if (std::holds_alternative<Leave>(item.what)) return leave(item.viewer);
  const auto found = viewers_.find(item.viewer);
  if (found == viewers_.end()) return;
  found->second.applied = item.number;
  if (const auto* request = std::get_if<proto::Request>(&item.what)) {
    handle(item.viewer, *request);
    on_finished(item.viewer);
  } else if (std::get<Noted>(item.what).wants_frame) {
    frame_wanted_ = true;
  }
}

void Room::join(proto::ViewerId id, const Join& join) {
  tell_changes();
  Viewer& viewer = viewers_[id];
  viewer.info = {id, "viewer " + std::to_string(id), kColors[id % kColors.size()], "operator", {}};
  viewer.mesh_over_http = join.mesh_over_http;
  const std::string roster_text = proto::encode_roster(roster());
  output_.broadcast(text_message(roster_text));

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
  output_.send(id, text_message(proto::encode_state(state())));
  output_.send(id, text_message(roster_text));
  output_.send(id, text_message(proto::encode_pins(world_->tick(), pins())));
  output_.send(id, text_message(proto::encode_grabs(world_->tick(), grabs(false))));
  output_.welcome_done(id);
  frame_wanted_ = true;
}

void Room::send_mesh(proto::ViewerId to, const Viewer& viewer) {
  output_.send(to, text_message(proto::encode_mesh(mesh_)));
  if (!viewer.mesh_over_http) output_.send(to, {mesh_bytes_, true});
}

void Room::leave(proto::ViewerId viewer) {
  if (viewers_.erase(viewer) == 0) return;
  for (std::size_t i = hands_.size(); i-- > 0;) {
    if (hands_[i].viewer == viewer)
      end_hand(hands_.begin() + static_cast<std::ptrdiff_t>(i), CommandOrigin::leave);
  }
  roster_changed_ = true;
}

/// Measures them as long as somebody wants them.
void Room::measure_forces() {
  if (output_.wants_forces() == measures_forces_) return;
  measures_forces_ = !measures_forces_;
  world_->measure_forces(measures_forces_);
}

/// @returns what it took [s]
double Room::step_world() {
  measure_forces();
  const double start = clock_();
  const TickReport& report = world_->step();
  last_tick_done_ = clock_();
  const double seconds = last_tick_done_ - start;
  metrics_.count_tick(seconds, report.rested);
  if (tick_times_.size() < kTickTimes) tick_times_.resize(tick_times_.size() + 1);
  tick_times_[next_tick_time_++ % tick_times_.size()] = seconds;
  if (next_tick_time_ == kTickTimes) next_tick_time_ = 0;
  if (!report.rested) guarantee_.note_tick(*world_);
  // What rests is counted once: nothing will change it.
  const bool fell_asleep = tell_sleep() && world_->sleep().all_asleep();
  if (report.rested || fell_asleep) {
    if (guarantee_.count_if_stale(*world_)) state_changed_ = true;
  } else if (guarantee_.count_if_due(*world_)) {
    state_changed_ = true;
  }
  if (report.rested) return seconds;
  frame_wanted_ = true;
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
  const double seconds = step_world();
  meter_.add(world_->tick_seconds(), clock_());
  if (!world_->report().rested) keep_budget(seconds);
  if (paused_ && steps_left_ > 0 && --steps_left_ == 0) state_changed_ = true;
}

void Room::advance_until(double deadline) {
  while (advance_ && advance_->left > 0) {
    step_world();
    --advance_->left;
    if (clock_() >= deadline) break;
  }
  if (advance_ && advance_->left == 0) finish_advance();
}

void Room::finish_advance() {
  const Advance done = *advance_;
  advance_.reset();
  answer(done.viewer, done.id, proto::AdvanceReply{world_->tick(), world_->hash()});
  state_changed_ = true;
  take_deferred();
}

double Room::real_time_factor() const {
  return ticking() ? meter_.factor(clock_(), speed()) : 0;
}

void Room::finish_turn() {
  const double now = clock_();
  end_leases();
  if (ticking() && now >= next_state_) {
    state_changed_ = state_changed_ || !world_->report().rested;
    tell_slow_motion(now);
  }
  const bool stands = !ticking() && !advance_ && now - last_tick_done_ >= kStatePause;
  if (stands && guarantee_.count_if_stale(*world_)) state_changed_ = true;
  tell_changes();
  // Where no ticks pass by the clock, commands and `advance` shall not make more frames than ticks
  // do.
  if (!frame_wanted_ || (!ticking() && now < next_idle_frame_) || !output_.wants_frames()) return;
  next_idle_frame_ = now + world_->tick_seconds();
  publish();
}

double Room::next_wake() const {
  const double now = clock_();
  const bool frame_waits = frame_wanted_ && output_.wants_frames();
  return frame_waits ? std::min(next_idle_frame_, now + kLongestSleep) : now + kLongestSleep;
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

void Room::tell_changes() {
  if (state_changed_) {
    output_.broadcast(text_message(proto::encode_state(state())));
    next_state_ = clock_() + kStatePause;
  }
  if (roster_changed_) output_.broadcast(text_message(proto::encode_roster(roster())));
  if (pins_changed_) output_.broadcast(text_message(proto::encode_pins(world_->tick(), pins())));
  if (grabs_changed_)
    output_.broadcast(text_message(proto::encode_grabs(world_->tick(), grabs(false))));
  state_changed_ = roster_changed_ = pins_changed_ = grabs_changed_ = false;
}

void Room::publish() {
  measure_forces();
  world_->measure_present_forces();
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
  output_.offer_frame(std::move(frame));
  ++frames_encoded_;
  frame_wanted_ = jumped_ = false;
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
  output_.broadcast(text_message(proto::encode_notice(notice)));
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
