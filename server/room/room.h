#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "proto/error.h"
#include "proto/frames/frame.h"
#include "proto/messages/events.h"
#include "proto/messages/replies.h"
#include "server/clock.h"
#include "server/constants.h"
#include "server/metrics.h"
#include "server/room/frame_maker.h"
#include "server/room/frame_turns.h"
#include "server/room/guarantee_watch.h"
#include "server/room/holds.h"
#include "server/room/measured_forces.h"
#include "server/room/news.h"
#include "server/room/order.h"
#include "server/room/other_rooms.h"
#include "server/room/presence.h"
#include "server/room/rights.h"
#include "server/room/room_clock.h"
#include "server/room/room_output.h"
#include "server/room/saves.h"
#include "server/translate/translate.h"
#include "server/work_limit.h"

namespace weft::server {

/// Makes the definition of a scene. Throws DefinitionError if there is none of this name.
using SceneSource = std::function<WorldDef(const std::string&)>;

struct RoomOptions {
  std::string name = "default";
  std::string scene = "default";              ///< name of the first scene
  std::shared_ptr<const WorldDef> scene_def;  ///< the first scene itself, if no name leads to it
  double tick_rate = 0;                       ///< [1/s]; 0: as each scene says
  std::vector<std::pair<std::string, std::string>>
      settings;                          ///< of the first scene; core's set_field
  std::vector<std::string> scene_names;  ///< suggested for mistyped names
  /// Reads a scene that a client sends as JSON; throws DefinitionError. Null: no client may send
  /// one.
  std::function<WorldDef(const std::string&)> read_scene;
  bool paused = false;
  bool rests_when_empty = false;  ///< its time stands while it has no viewers
  bool linked = false;            ///< others than the people of this machine reach it
  bool has_tokens = false;        ///< viewers are let in by token
  /// Makes a token that grants this. Null: no links can be made.
  std::function<std::string(const Grant&)> make_token;
  std::uint32_t count_pause = 60;  ///< ticks between two counts of crossings; 0: none by itself
  std::string version, session;    ///< for `welcome`
  proto::ServerLimits limits;
  /// Bounds a tick, and queries that look one tick ahead; outlives the room. Null: no bound.
  WorkLimit* limit = nullptr;
  OtherRooms* others = nullptr;  ///< outlives the room; null: there are none
  double build_limit = 0;        ///< of CPU for building a scene [s]; 0: no bound
  /// CPU time of the room's thread, by which viewers of expensive commands are made to wait [s];
  /// the default makes none wait.
  Clock cpu_clock = [] { return 0.0; };
  /// Runs a job on another thread; the default runs it at once. The room checks for its end in each
  /// turn.
  std::function<void(std::function<void()>)> beside = [](const std::function<void()>& job) {
    job();
  };
};

/// The scene with which the options begin. Throws DefinitionError if there is none.
WorldDef first_scene(const RoomOptions& options, const SceneSource& scenes);

/// One shared cloth with its clock, its hands and its order of commands. Everything happens on the
/// thread that has its turn; input arrives through `take` and output leaves through RoomOutput. The
/// state changes only between ticks, by commands in the log.
class Room {
 public:
  /// Throws DefinitionError if the scene cannot be built.
  Room(RoomOptions options, SceneSource scenes, RoomOutput& output, Clock clock, Metrics& metrics,
       Executor* executor = nullptr);
  /// A room of a scene that has been built.
  Room(RoomOptions options, SceneSource scenes, BuiltScene&& scene, RoomOutput& output, Clock clock,
       Metrics& metrics, Executor* executor = nullptr);

  /// Called when a taken command is finished, or a token that was told.
  std::function<void(proto::ViewerId)> on_finished = [](proto::ViewerId) {};

  /// Takes an item of a viewer, between two ticks, and runs everything whose turn it is. While an
  /// `advance` runs, other commands of its viewer wait for its end; those of other viewers run
  /// between its ticks.
  void take(Inbound item);

  /// The same during a tick: runs at once what needs nothing of the cloth but its state before the
  /// tick, and queues the rest.
  void take_meanwhile(Inbound item);
  /// Whether the current work should end, because it exceeds its limit or a command has made it
  /// worthless. Polled by the owner of the stop signal.
  bool gives_up();
  /// The signal that ends the current work; null if nothing can.
  StopSignal* stop_signal() { return options_.limit ? &options_.limit->signal() : nullptr; }

  /// Cancels the scene that a `load` is building, before the room is destroyed.
  void cancel_build() {
    if (order_.building) order_.building->build->cancel();
  }

  bool advancing() const { return order_.advance.has_value(); }
  /// Runs ticks of the current `advance` until it is done or the clock passes `deadline`.
  void advance_until(double deadline);

  /// Whether ticks follow the clock: the room runs, or `step` asked for some.
  bool ticking() const { return !order_.advance && time_.runs() && !rests(); }
  double tick_interval() const { return world_->tick_seconds() / speed(); }  ///< real time [s]
  void tick();

  /// Whether `advance_until` would do nothing now, because its viewer has not yet taken its frames.
  bool advance_waits() const;

  /// Call after ticks and commands: ends leases, announces changes, sends the newest frame.
  void finish_turn();
  /// Latest time of the next `finish_turn`, even if nothing happens [s]; infinity while it rests.
  double next_wake() const;

  const ServedWorld& world() const { return *world_; }
  const CommandLog& log() const { return order_.log; }
  /// Those that are in it; those that glance at it are not.
  std::size_t viewers() const { return viewers_.size() - glances_; }
  bool paused() const { return time_.paused(); }
  /// Simulated per real time: the wanted speed, reduced if a time budget requires it.
  double speed() const { return time_.speed(); }
  double real_time_factor() const;
  std::uint32_t epoch() const { return epoch_; }
  std::uint64_t frames_encoded() const { return frame_maker_.count(); }

 private:
  struct Viewer {
    proto::ViewerInfo info;
    bool mesh_over_http = false;
    bool glances = false;        ///< see Join
    bool wants_frame = false;    ///< it lacks the present one
    bool wants_forces = false;   ///< in its frames
    bool wants_balance = false;  ///< of energy: it has asked for it
    std::uint32_t applied = 0;   ///< number of its last text message that was taken
    /// Every frame of its own `advance` that is in flight holds a copy.
    std::shared_ptr<const int> ticket = std::make_shared<int>();
    bool stalled = false;  ///< it took none for too long, and has not taken one since
    double next_turn = 0;  ///< its commands wait until then, after an expensive one [s]
    HandRight hand = HandRight::by_policy;
    bool by_token = false;
    bool by_link = false;     ///< its token counts in one room
    bool named = false;       ///< its token is one person's
    std::uint64_t token = 0;  ///< number of its token; 0: none
    std::string maker;        ///< see Grant
    double next_name = 0;     ///< it may change its name from then on [s]
    Presence presence;
  };

  /// Who may hold the cloth.
  struct Rights {
    proto::Policy policy = proto::Policy::everybody;
    bool chosen = false;  ///< by an operator
    /// How many that were muted have left, by the number of their token.
    std::map<std::uint64_t, std::uint32_t> muted_away;
    /// What persons that have left were last, by the number of their token.
    std::map<std::uint64_t, proto::ViewerId> left_as;
  };

  /// The tick that runs, or the last one.
  struct RunningTick {
    bool runs = false;
    std::uint64_t until = 0;  ///< the world's tick at its end
    bool replaced = false;    ///< a command that replaces the state ends it
    bool over_limit = false;  ///< it exceeds its limit
    std::string failure;      ///< what it threw; empty: nothing
  };

  using Outcome = proto::Result<proto::Reply>;

  bool rests() const { return options_.rests_when_empty && viewers() == 0; }
  bool is_alone() const;

  // room_order.cpp: the order of commands
  bool must_wait(const Inbound& item) const;
  bool may_run_meanwhile(const Inbound& item) const;
  bool replaces_state(const Inbound& item) const;
  void work_off();
  void let_go(proto::ViewerId viewer);
  double next_turn() const;
  void charge(proto::ViewerId viewer, double cost);
  void start_build(proto::ViewerId viewer, std::function<WorldDef()> definition);
  void finish_build();
  void replace_scene(const Building& done);
  void open_room(const Building& done);
  void note_halt();
  void end_advance(proto::ErrorCode code, const std::string& why, const char* hint);
  template <class Work>
  bool within_limit(Work&& work, double share = 1);

  // room_people.cpp: viewers that come and go, and what they may do
  void join(proto::ViewerId id, const Join& join);
  void admit(Viewer& viewer, const Grant& grant);
  void take_token(Viewer& viewer, const Grant& grant);
  void take_pins_back(const Viewer& viewer);
  void follow_person(const Viewer& changed);
  void leave_mute(const Viewer& viewer);
  bool comes_muted(const Grant& grant);
  void ask_newcomer(Viewer& viewer);
  void leave(proto::ViewerId viewer);
  void pass_on_operation();
  bool may_hold(const Viewer& viewer) const;
  bool leads(const Viewer& viewer) const;
  bool only_looks(const Viewer& viewer) const;
  void let_go_forbidden(proto::ViewerId viewer);
  std::optional<proto::Error> check_owner(proto::ViewerId viewer, PinId pin) const;
  std::optional<proto::Error> check_shared_hold(proto::ViewerId viewer, Index particle,
                                                double radius, std::size_t pinned) const;
  std::optional<proto::Error> set_hand(proto::ViewerId by, proto::ViewerId viewer, HandRight right,
                                       bool set);
  std::vector<proto::ViewerInfo> roster() const;
  void tell_presence(double now);
  void show_camera(proto::ViewerId viewer);

  // room.cpp: ticks, and what is told of them
  void welcome(proto::ViewerId id, Viewer& viewer);
  void take_now(Inbound item);
  std::optional<double> step_world();
  void count_crossings(bool stays);
  void tell_guarantee();  // room_queries.cpp
  bool tell_sleep();
  void keep_budget(double seconds);
  void ask_for_budget(const BudgetDef& budget);
  double softness_after(const proto::Set& command) const;
  void log_softness();
  void follow_speed();
  void end_leases();
  void start_world(BuiltScene&& scene);
  void go_on(RoomPast&& past);
  void tell_loaded(proto::ViewerId viewer);
  void tell_jump(const char* code, std::string message, proto::ViewerId viewer);
  void send_mesh(proto::ViewerId to, const Viewer& viewer);
  void tell_slow_motion(double now);
  Message message_of(const SceneNotice& what) const;
  proto::State state() const;
  WorldDef definition_of(const std::string& scene) const;
  WorldDef definition_of(const std::string& name, const std::string& json) const;

  // room_advance.cpp
  bool frames_wait(const Viewer& viewer) const;
  bool shows_next_tick() const;
  void show_advanced();
  Message observation();
  proto::Error stalled_error() const;
  bool advance_wants_forces() const;
  void finish_advance(const std::optional<proto::Error>& error = {});
  void end_paused_advance();

  // room_telling.cpp: frames and announcements
  void change(bool News::*what);
  void renew_told();
  Message state_message();
  Message pins_message();
  Message grabs_message();
  void tell_changes();
  void tell_changes_if_due(double now);
  void notify(proto::NoticeLevel level, const char* code, std::string message,
              proto::ViewerId viewer = 0, std::optional<std::uint32_t> drag = {},
              std::optional<double> value = {});
  void measure_forces();
  void measure_balance();
  bool frames_stand() const;
  double next_frame() const;
  FrameMaker::Facts frame_facts(bool jumped);
  Frame encode_frame(bool jumped);
  void publish(double now);
  void show_to(proto::ViewerId viewer);
  void show_to_those_who_lack(double now);

  // room_commands.cpp: one function per command
  void handle(proto::ViewerId viewer, const proto::Request& request);
  void answer(proto::ViewerId viewer, const std::optional<proto::Id>& id,
              const proto::Reply& reply);
  void refuse(proto::ViewerId viewer, const proto::Request& request, proto::Error error);
  Outcome apply(proto::ViewerId viewer, const proto::Hello& command);
  Outcome apply(proto::ViewerId viewer, const proto::Pick& command);
  Outcome apply(proto::ViewerId viewer, const proto::DragStart& command);
  Outcome apply(proto::ViewerId viewer, const proto::DragMove& command);
  Outcome apply(proto::ViewerId viewer, const proto::DragEnd& command);
  Outcome apply(proto::ViewerId viewer, const proto::Pin& command);
  Outcome apply(proto::ViewerId viewer, const proto::ReleasePin& command);
  Outcome apply(proto::ViewerId viewer, const proto::ReleaseParticle& command);
  Outcome apply(proto::ViewerId viewer, const proto::ReleaseAll& command);
  Outcome apply(proto::ViewerId viewer, const proto::Camera& command);
  Outcome apply(proto::ViewerId viewer, const proto::Pause& command);
  Outcome apply(proto::ViewerId viewer, const proto::Resume& command);
  Outcome apply(proto::ViewerId viewer, const proto::Step& command);
  Outcome apply(proto::ViewerId viewer, const proto::Reset& command);
  Outcome apply(proto::ViewerId viewer, const proto::Save& command);
  Outcome apply(proto::ViewerId viewer, const proto::Restore& command);
  Outcome apply(proto::ViewerId viewer, const proto::Speed& command);
  Outcome apply(proto::ViewerId viewer, const proto::Move& command);
  Outcome apply(proto::ViewerId viewer, const proto::MoveEnd& command);
  Outcome apply(proto::ViewerId viewer, const proto::MovePin& command);
  Outcome apply(proto::ViewerId viewer, const proto::StopPin& command);
  Outcome apply(proto::ViewerId viewer, const proto::Gripper& command);
  Outcome apply(proto::ViewerId viewer, const proto::Set& command);
  Outcome apply(proto::ViewerId viewer, const proto::Advance& command);
  Outcome apply(proto::ViewerId viewer, const proto::Query& command);
  Outcome apply(proto::ViewerId viewer, const proto::Hash& command);
  Outcome apply(proto::ViewerId viewer, const proto::Load& command);
  Outcome apply(proto::ViewerId viewer, const proto::Ping& command);
  Outcome apply(proto::ViewerId viewer, const proto::View& command);
  Outcome apply(proto::ViewerId viewer, const proto::SetPolicy& command);
  Outcome apply(proto::ViewerId viewer, const proto::Mute& command);
  Outcome apply(proto::ViewerId viewer, const proto::GiveHand& command);
  Outcome apply(proto::ViewerId viewer, const proto::Presence& command);
  Outcome apply(proto::ViewerId viewer, const proto::Follow& command);
  Outcome apply(proto::ViewerId viewer, const proto::Lead& command);
  Outcome apply(proto::ViewerId viewer, const proto::Invite& command);
  Outcome apply(proto::ViewerId viewer, const proto::Halt& command);
  Outcome apply(proto::ViewerId viewer, const proto::CreateRoom& command);
  Outcome apply(proto::ViewerId viewer, const proto::ListRooms& command);
  Outcome apply(proto::ViewerId viewer, const proto::CloseRoom& command);
  Outcome apply(proto::ViewerId viewer, const proto::Fork& command);
  BuiltScene fork() const;
  bool operates_here_alone(proto::ViewerId viewer) const;
  std::string maker_of(proto::ViewerId viewer) const;
  Outcome query_numbers(const proto::Query& command, std::span<const float> values,
                        std::uint32_t components);
  Outcome query_boxes(const proto::Query& command);
  const Reactions& present_reactions();
  Outcome release_pins(const std::vector<std::uint32_t>& ids);
  void end_hand(const Hand& hand, CommandOrigin origin);

  RoomOptions options_;
  SceneSource scenes_;
  RoomOutput& output_;
  Clock clock_;
  Metrics& metrics_;
  Executor* executor_;

  std::unique_ptr<ServedWorld> world_;
  std::uint32_t epoch_ = 0;
  proto::MeshAnnouncement mesh_;
  SharedBytes mesh_bytes_;
  std::shared_ptr<const proto::codec::CodingOrder> coding_order_;  // of packed frames

  RoomClock time_;
  Order order_;
  RunningTick tick_;

  std::map<proto::ViewerId, Viewer> viewers_;
  std::size_t glances_ = 0;  ///< how many of them glance
  Rights rights_;
  Holds holds_;

  News news_;
  Told told_;
  FrameTurns frames_;
  FrameMaker frame_maker_;
  MeasuredForces forces_;
  GuaranteeWatch<float> guarantee_;
  std::vector<SceneNotice> scene_notices_;
  Saves saves_;

  std::uint32_t transfers_ = 0;
  std::vector<float> box_values_;     // of the current answer, lowest and highest corners
  std::optional<Message> follow_up_;  // binary message that follows the current answer
};

/// Runs work that the limit, or a share of it, may end.
/// @returns false if it did
template <class Work>
bool Room::within_limit(Work&& work, double share) {
  try {
    std::optional<WorkLimit::Scope> scope;
    if (options_.limit) scope.emplace(*options_.limit, share);
    work();
    return true;
  } catch (const Stopped&) {
    return false;
  }
}

}  // namespace weft::server
