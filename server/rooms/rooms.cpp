#include "server/rooms/rooms.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <spdlog/spdlog.h>

#include "proto/room_name.h"
#include "server/constants.h"
#include "server/room/refusals.h"

namespace weft::server {
namespace {

using proto::ErrorCode;

/// Rooms at a time that count for one maker. More: few viewers take all rooms. Fewer: copies of
/// copies cannot be compared.
constexpr std::size_t kMostRoomsOfMaker = 4;

/// Shares of what all rooms may cost: of one maker's, so that any one room is possible, and of all
/// makers', so that something is left for operators.
constexpr double kShareOfMaker = 0.5, kShareOfMakers = 0.75;

proto::Error name_error(ErrorCode code, const std::string& name, std::string message,
                        std::string hint) {
  proto::Error error = proto::make_error(code, std::move(message), std::move(hint));
  error.field = "name";
  error.value = proto::quoted_value(name);
  return error;
}

proto::Error unknown_room(const std::string& name) {
  return name_error(ErrorCode::unknown_room, name, "there is no room of this name",
                    "list_rooms tells those that there are");
}

proto::Error over(const char* whose, const char* what, double sum, double most) {
  proto::Error error = proto::make_error(
      ErrorCode::too_costly,
      std::string(whose) + " would have " + std::to_string(std::llround(sum)) + " " + what,
      "close a room, or take a lighter scene");
  error.limit = proto::Limit{};
  error.limit->maximum = most;
  return error;
}

}  // namespace

class Rooms::Reserved : public RoomName {
 public:
  Reserved(Rooms& rooms, std::string name) : rooms_(rooms), name_(std::move(name)) {}
  ~Reserved() override {
    const std::lock_guard lock(rooms_.mutex_);
    rooms_.reserved_.erase(name_);
    if (rooms_.rooms_.contains(name_)) return;
    rooms_.costs_.erase(name_);  // opening it failed
    rooms_.makers_.erase(name_);
  }
  const std::string& text() const override { return name_; }

 private:
  Rooms& rooms_;
  std::string name_;
};

Rooms::Rooms(const RoomsOptions& options, RoomOptions usual, SceneSource scenes,
             OutputMaker outputs, Clock clock, Metrics& whole)
    : options_(options), usual_(std::move(usual)), scenes_(std::move(scenes)),
      outputs_(std::move(outputs)), clock_(std::move(clock)), whole_(whole), pool_(options.threads),
      shared_pool_(pool_,
                   [this] { return !Scheduler::on_patient_thread() && scheduler_.running() <= 1; }),
      scheduler_(options.threads, clock_), builders_(kSceneBuilders) {
  usual_.others = this;
}

Rooms::~Rooms() {
  stop();
  while (!stands()) std::this_thread::yield();
  cancel_builds();
}

HostServices Rooms::services() {
  return {clock_,
          whole_,
          scheduler_,
          builders_,
          watch_,
          options_.threads > 1 ? &shared_pool_ : nullptr,
          options_.tick_limit,
          options_.waiting_commands};
}

void Rooms::open_default() {
  auto room = std::make_shared<HostedRoom>(proto::kDefaultRoom, services());
  room->begin(usual_, scenes_, outputs_(room->metrics()), std::nullopt);
  const std::lock_guard lock(mutex_);
  costs_[room->name()] = room->cost();
  rooms_[room->name()] = std::move(room);
}

void Rooms::start() {
  for (const auto& room : all()) scheduler_.add(room);
}

std::shared_ptr<HostedRoom> Rooms::find(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto found = rooms_.find(name);
  return found == rooms_.end() ? nullptr : found->second;
}

std::vector<std::shared_ptr<HostedRoom>> Rooms::all() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::shared_ptr<HostedRoom>> list;
  for (const auto& [name, room] : rooms_) list.push_back(room);
  return list;
}

proto::Readiness Rooms::readiness_of(const HostedRoom& room) const {
  const proto::RoomInfo info = room.info();
  proto::Readiness readiness;
  readiness.room = info.name;
  readiness.scene = info.scene;
  readiness.tick = info.tick;
  readiness.real_time_factor = info.real_time_factor;
  const double overdue = scheduler_.overdue(room);
  if (overdue > kStallSeconds) readiness.stalled = overdue;
  readiness.ready = room.keeps_up() && readiness.stalled == 0;
  return readiness;
}

proto::Readiness Rooms::readiness() const {
  proto::Readiness worst = readiness_of(*find(proto::kDefaultRoom));
  for (const auto& room : all()) {
    const proto::Readiness next = readiness_of(*room);
    if (next.stalled > worst.stalled || (worst.ready && !next.ready)) worst = next;
  }
  return worst;
}

std::string Rooms::metrics_text() const {
  const auto rooms = all();
  std::vector<std::pair<std::string, const Metrics*>> each;
  for (const auto& room : rooms) each.emplace_back(room->name(), &room->metrics());
  return whole_.text(each);
}

void Rooms::close_empty() {
  if (options_.idle_seconds <= 0) return;
  for (const auto& room : all()) {
    if (room->name() == proto::kDefaultRoom) continue;
    if (clock_() - room->empty_since() < options_.idle_seconds) continue;
    spdlog::info("room {} has been empty for {} s", room->name(), options_.idle_seconds);
    shut(room->name());
  }
}

void Rooms::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  scheduler_.stop();
  for (const auto& room : all()) room->stop();
}

void Rooms::cancel_builds() {
  for (const auto& room : all()) room->cancel_build();
}

proto::ListRoomsReply Rooms::list() const {
  proto::ListRoomsReply reply;
  for (const auto& room : all()) reply.rooms.push_back(room->info());
  reply.most = static_cast<std::uint32_t>(options_.most);
  return reply;
}

/// Why there may be no further room. Under the lock.
std::optional<proto::Error> Rooms::check_count(const std::string& maker) const {
  if (rooms_.size() + reserved_.size() >= options_.most)
    return too_many("rooms at a time", options_.most, "close one that is no longer used");
  if (maker.empty()) return std::nullopt;
  const auto own = std::count_if(makers_.begin(), makers_.end(),
                                 [&](const auto& entry) { return entry.second == maker; });
  if (static_cast<std::size_t>(own) >= kMostRoomsOfMaker)
    return too_many("rooms at a time of one viewer that is no operator of the server",
                    kMostRoomsOfMaker, "close one of them, or ask an operator for a room");
  const std::size_t most = options_.most - options_.most / 4;
  if (makers_.size() >= most)
    return too_many("rooms at a time of viewers that are no operators of the server", most,
                    "ask an operator for a room, or to close one");
  return std::nullopt;
}

proto::Result<std::shared_ptr<RoomName>> Rooms::reserve(const std::string& name,
                                                        const std::string& maker) {
  const std::lock_guard lock(mutex_);
  if (rooms_.contains(name) || reserved_.contains(name))
    return name_error(ErrorCode::room_exists, name, "there is a room of this name",
                      "take another name, or connect to it");
  if (auto error = check_count(maker)) return *std::move(error);
  reserved_.insert(name);
  if (!maker.empty()) makers_[name] = maker;
  return std::shared_ptr<RoomName>(std::make_shared<Reserved>(*this, name));
}

proto::Result<proto::RoomInfo> Rooms::open(const std::shared_ptr<RoomName>& name,
                                           BuiltScene&& scene, bool paused) {
  if (auto error = admit(name->text(), scene.world->cost_in(scene.world->environment())))
    return *std::move(error);
  RoomOptions options = usual_;
  options.paused = paused;
  options.rests_when_empty = true;
  auto room = std::make_shared<HostedRoom>(name->text(), services());
  room->begin(std::move(options), scenes_, outputs_(room->metrics()), std::move(scene));
  {
    const std::lock_guard lock(mutex_);
    if (stopped_) return proto::make_error(ErrorCode::busy, "the server stops");
    rooms_[room->name()] = room;
  }
  scheduler_.add(room);
  spdlog::info("room {} is open with scene {}", room->name(), room->info().scene);
  return room->info();
}

/// @returns false if there is no such room
bool Rooms::shut(const std::string& name) {
  std::shared_ptr<HostedRoom> room;
  {
    const std::lock_guard lock(mutex_);
    const auto found = rooms_.find(name);
    if (found == rooms_.end()) return false;
    room = std::move(found->second);
    rooms_.erase(found);
    costs_.erase(name);
    makers_.erase(name);
    options_.on_closed(name);
  }
  room->close();
  scheduler_.remove(*room);
  spdlog::info("room {} is closed", name);
  return true;
}

std::optional<proto::Error> Rooms::close(const std::string& name) {
  if (name == proto::kDefaultRoom)
    return name_error(ErrorCode::not_allowed, name, "the default room is always there",
                      "reset it, or load another scene");
  if (!shut(name)) return unknown_room(name);
  return std::nullopt;
}

bool Rooms::others_have_viewers(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  return std::any_of(rooms_.begin(), rooms_.end(), [&](const auto& entry) {
    return entry.first != name && entry.second->empty_since() == kNever;
  });
}

/// Why a room may not cost so much beside others, within a share of what all may. Under the lock.
/// @param counts  whether another room is one of them
/// @param whose   they are, as the error tells
std::optional<proto::Error> Rooms::check_sum(const std::string& room, const TickCost& cost,
                                             const std::function<bool(const std::string&)>& counts,
                                             const char* whose, double share) const {
  double particles = cost.particles, updates = cost.updates() * cost.tick_rate;
  for (const auto& [name, other] : costs_) {
    if (name == room || !counts(name)) continue;
    particles += other.particles;
    updates += other.updates() * other.tick_rate;
  }
  const double most = share * kMostParticlesOfRooms, most_updates = share * kMostUpdatesOfRooms;
  if (particles > most) return over(whose, "particles", particles, most);
  if (updates > most_updates)
    return over(whose, "updates of particles a second", updates, most_updates);
  return std::nullopt;
}

std::optional<proto::Error> Rooms::admit(const std::string& room, const TickCost& cost) {
  const std::lock_guard lock(mutex_);
  // A room that has been closed during its turn costs nothing any more.
  if (!rooms_.contains(room) && !reserved_.contains(room)) return std::nullopt;
  const auto any = [](const std::string&) { return true; };
  if (auto error = check_sum(room, cost, any, "all rooms together", 1)) return error;
  if (const auto made = makers_.find(room); made != makers_.end()) {
    const auto own = [&](const std::string& name) {
      const auto other = makers_.find(name);
      return other != makers_.end() && other->second == made->second;
    };
    const auto anyones = [this](const std::string& name) { return makers_.contains(name); };
    if (auto error = check_sum(room, cost, own, "the rooms of one viewer", kShareOfMaker))
      return error;
    if (auto error = check_sum(room, cost, anyones, "the rooms of all viewers", kShareOfMakers))
      return error;
  }
  costs_[room] = cost;
  return std::nullopt;
}

}  // namespace weft::server
