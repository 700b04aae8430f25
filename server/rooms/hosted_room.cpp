#include "server/rooms/hosted_room.h"

#include <utility>

namespace weft::server {

HostedRoom::HostedRoom(std::string name, const HostServices& services)
    : name_(std::move(name)), services_(services), metrics_(&services.whole),
      mailbox_(services.waiting_commands), limit_(services.tick_limit),
      empty_since_(services.clock()) {
  services_.watch.add(limit_);
}

HostedRoom::~HostedRoom() {
  services_.watch.remove(limit_);
}

void HostedRoom::begin(RoomOptions options, const SceneSource& scenes,
                       std::shared_ptr<RoomOutput> output, std::optional<BuiltScene> scene) {
  output_ = std::move(output);
  options.name = name_;
  options.limit = &limit_;
  options.cpu_clock = &thread_cpu_seconds;
  const auto wake = [this] {
    limit_.call();
    services_.scheduler.wake(*this);
  };
  options.beside = [this, wake](std::function<void()> job) {
    services_.builders.start([self = shared_from_this(), wake, job = std::move(job)] {
      job();
      wake();
    });
  };
  room_ = scene ? std::make_unique<Room>(std::move(options), scenes, *std::move(scene), *output_,
                                         services_.clock, metrics_, services_.executor)
                : std::make_unique<Room>(std::move(options), scenes, *output_, services_.clock,
                                         metrics_, services_.executor);
  room_->on_finished = [this](proto::ViewerId viewer) { mailbox_.finished(viewer); };
  mailbox_.on_arrival = wake;
  loop_.emplace(*room_, mailbox_, services_.clock);
  give_way_at_stop_points();
  post();
}

/// On a patient thread the signal is always raised, so that every stop point asks for the way.
void HostedRoom::give_way_at_stop_points() {
  StopSignal& signal = limit_.signal();
  signal.attend = [this, &signal, attend = std::move(signal.attend)] {
    const bool patient = Scheduler::on_patient_thread();
    if (patient) services_.scheduler.give_way();
    signal.lower();
    const bool ends = limit_.take_call() && attend();
    if (patient) signal.raise();
    return ends;
  };
}

proto::RoomInfo HostedRoom::info() const {
  const std::lock_guard lock(mutex_);
  return info_;
}

void HostedRoom::close() {
  closed_ = true;
  mailbox_.stop();
  output_->close();
}

void HostedRoom::cancel_build() {
  room_->cancel_build();
}

Turn HostedRoom::turn() {
  if (mailbox_.stopped()) return {};
  if (Scheduler::on_patient_thread()) limit_.signal().raise();
  Turn turn;
  turn.next = loop_->turn();
  turn.ticked = loop_->ticked();
  if (room_->advancing())
    turn.interval = 0;
  else if (room_->ticking())
    turn.interval = room_->tick_interval();
  if (turn.ticked) metrics_.count_late(loop_->late());
  post();
  return turn;
}

/// Tells other threads how the room is.
void HostedRoom::post() {
  const ServedWorld& world = room_->world();
  const double factor = room_->real_time_factor();
  keeps_up_ = !room_->ticking() || factor >= kSlow * room_->speed();
  if (room_->viewers() > 0)
    empty_since_ = kNever;
  else if (empty_since_ == kNever)
    empty_since_ = services_.clock();
  const std::lock_guard lock(mutex_);
  info_.name = name_;
  if (info_.scene != world.def().name) info_.scene = world.def().name;
  info_.particles = static_cast<std::uint32_t>(world.model().mass.size());
  info_.viewers = static_cast<std::uint32_t>(room_->viewers());
  info_.tick = world.tick();
  info_.paused = room_->paused();
  info_.real_time_factor = factor;
}

}  // namespace weft::server
