#include "tests/fuzz/command_draw.h"

#include <algorithm>
#include <utility>

#include "proto/limits.h"
#include "tests/fuzz/field_draw.h"

namespace weft::fuzz {
namespace {

using namespace proto;  // NOLINT(google-build-using-namespace): the wire's ranges and commands

constexpr std::uint32_t kDrags = 3;  // numbers that a viewer gives its drags

/// Draws each kind of command; one that the wire gains does not compile until it is here.
class CommandDraw {
 public:
  CommandDraw(const Dice& dice, const RoomFacts& facts) : dice_(dice), facts_(facts) {
    wild_ = dice_.chance(0.5) ? 0.1 : 0.7;
  }

  void operator()(Hello& hello) {
    if (some()) hello.name = std::string(1 + dice_.below(kMostNameCharacters), 'n');
    if (some()) hello.color = "#2e86e4";
    if (some()) hello.token = std::string(dice_.below(kMostTokenBytes + 1), 't');
  }
  void operator()(Pick& pick) {
    pick.origin = place();
    pick.direction = direction();
  }
  void operator()(DragStart& start) {
    start.drag = drag();
    start.hold = hold();
    if (some()) start.mode = DragMode::sling;
    if (some()) start.target = place();
    if (some()) start.radius = number(kRadiusRange, 0.05);
    if (some()) start.stiffness = number(kStiffnessRange, 150);
    if (some()) start.max_force = number(kForceRange, 50);
  }
  void operator()(DragMove& move) {
    move.drag = drag();
    move.target = place();
  }
  void operator()(DragEnd& end) {
    end.drag = drag();
    end.fire = some();
  }
  void operator()(Pin& pin) {
    pin.hold = hold();
    if (some()) pin.radius = number(kRadiusRange, 0.05);
  }
  void operator()(ReleasePin& release) { release.pin = pin(); }
  void operator()(ReleaseParticle& release) { release.particle = particle(); }
  void operator()(ReleaseAll&) {}
  void operator()(Camera& camera) {
    camera.position = place();
    camera.target = place();
    camera.target[0] += camera.target == camera.position ? 1 : 0;
    camera.fov = number(kFovRange, 45);
  }
  void operator()(Pause&) {}
  void operator()(Resume&) {}
  void operator()(Step& step) { step.n = count(kStepRange, 5); }
  void operator()(Reset&) {}
  void operator()(Speed& speed) { speed.speed = number(kSpeedRange, 1); }
  void operator()(Move& move) {
    move.collider = collider();
    if (some()) move.position = vector(kPivotRange);
    if (some() || !move.position) move.rotation = dice_.rotation();
    if (some()) move.speed = number(kMoveSpeedRange, 0.5);
    if (some()) move.turn_speed = number(kTurnSpeedRange, 2);
    move.force = dice_.chance(0.2);
  }
  void operator()(MoveEnd& end) { end.collider = collider(); }
  void operator()(MovePin& move) {
    move.pin = pin();
    move.position = place();
    if (some())
      move.speed = number(kMoveSpeedRange, 2);
    else if (some())
      move.seconds = number(kMoveSecondsRange, 0.5);
    if (some()) move.max_force = number(kForceRange, 50);
  }
  void operator()(StopPin& stop) { stop.pin = pin(); }
  void operator()(Gripper& gripper) {
    const auto& names = facts_.scene.grippers;
    gripper.gripper = names.empty() ? "gripper" : names[dice_.below(names.size())];
    gripper.opening = number(kOpeningRange, 0.01);
    if (some()) gripper.force = number(kGripRange, 5);
    if (some()) gripper.position = vector(kPivotRange);
    if (some()) gripper.rotation = dice_.rotation();
    if (some()) gripper.speed = number(kMoveSpeedRange, 0.25);
    if (some()) gripper.turn_speed = number(kTurnSpeedRange, 2);
  }
  void operator()(Set& set) {
    FieldDraw fields(dice_, wild_);
    Set::describe(fields, set);
  }
  void operator()(Advance& advance) {
    FieldDraw fields(dice_, wild_);
    Advance::describe(fields, advance);
    advance.n = count(kAdvanceRange, 8);
  }
  void operator()(Query& query) {
    query.what = static_cast<QueryWhat>(dice_.below(static_cast<int>(kWords<QueryWhat>.size())));
    if (query.what == QueryWhat::positions || query.what == QueryWhat::velocities)
      query.format = static_cast<QueryFormat>(dice_.below(3));
    if (query.what == QueryWhat::camera && some()) query.viewer = viewer();
    if (query.what != QueryWhat::boxes) return;
    constexpr const char* kTrees[] = {"particles", "edges", "triangles", "object:colliders-0"};
    query.tree = kTrees[dice_.below(std::size(kTrees))];
    if (some()) query.level = static_cast<std::uint32_t>(dice_.below(12));
  }
  void operator()(Hash&) {}
  void operator()(Ping& ping) { ping.t = number({-1e300, 1e300}, 0); }
  void operator()(Load& load) { load.scene = "nowhere"; }
  void operator()(CreateRoom& create) { create.name = "other"; }
  void operator()(Save& save) { save.name.assign(1, some() ? 'a' : 'b'); }
  void operator()(Restore& restore) { restore.name.assign(1, some() ? 'a' : 'b'); }
  void operator()(Fork& fork) { fork.name = "other"; }
  void operator()(ListRooms&) {}
  void operator()(CloseRoom& close) { close.name = "other"; }
  void operator()(View& view) {
    view.hz = number(kFrameRateRange, 60);
    view.forces = some();
    if (some()) view.codec = some() ? Codec::packed : Codec::f32;
    if (some()) view.error = number(kPackedErrorRange, 1e-4);
  }
  // Mostly so that viewers hold: what is refused tries nothing.
  void operator()(SetPolicy& set) {
    set.policy = dice_.chance(0.8) ? Policy::everybody : static_cast<Policy>(dice_.below(2));
  }
  void operator()(Mute& mute) {
    mute.viewer = viewer();
    mute.muted = dice_.chance(0.2);
  }
  void operator()(GiveHand& give) {
    give.viewer = viewer();
    give.given = dice_.chance(0.8);
  }
  void operator()(Presence& presence) {
    if (some())
      presence.cursor = place();
    else
      presence.away = some();
    if (some()) (*this)(presence.camera.emplace());
  }
  void operator()(Follow& follow) { follow.viewer = some() ? viewer() : 0; }
  void operator()(Lead& lead) { lead.on = some(); }
  void operator()(Invite& invite) { invite.right = static_cast<Invitation>(dice_.below(3)); }
  void operator()(Halt&) {}  // of logs alone

 private:
  bool some() { return dice_.chance(0.5); }
  double number(const Range& range, double usual) {
    return dice_.number(range.minimum, range.maximum, usual, wild_);
  }
  Vec3 vector(const Range& range) {
    Vec3 v;
    for (double& each : v) each = number(range, 0);
    return v;
  }
  /// Mostly near the cloths.
  Vec3 place() {
    Vec3 v;
    const double wild = dice_.chance(0.7) ? 0 : wild_;
    for (double& each : v)
      each = dice_.number(kPositionRange.minimum, kPositionRange.maximum, 0, wild);
    return v;
  }
  Vec3 direction() {
    Vec3 v = place();
    const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
    if (largest < kLeastDirection) v[dice_.below(3)] = kLeastDirection;
    return v;
  }
  std::uint32_t count(const Range& range, double usual) {
    return static_cast<std::uint32_t>(
        std::clamp(number(range, usual), range.minimum, range.maximum));
  }
  std::uint32_t drag() { return static_cast<std::uint32_t>(dice_.below(kDrags)); }
  std::uint32_t particle() {
    return static_cast<std::uint32_t>(
        dice_.below(static_cast<std::size_t>(std::max(1, facts_.scene.particles))));
  }
  std::uint32_t pin() {
    return 1 + static_cast<std::uint32_t>(
                   dice_.below(facts_.scene.pins + facts_.pins_made + std::size_t{1}));
  }
  ViewerId viewer() { return 1 + static_cast<ViewerId>(dice_.below(facts_.most_viewers)); }
  Hold hold() {
    if (some()) return Particle{particle()};
    const double a = dice_.uniform(0, 1), b = dice_.uniform(0, 1 - a);
    return SurfacePoint{particle(), {a, b, 1 - a - b}};
  }
  std::string collider() {
    const auto& names = facts_.scene.colliders;
    const auto& grippers = facts_.scene.grippers;
    const std::size_t which = dice_.below(names.size() + grippers.size() + 1);
    if (which < names.size()) return names[which];
    if (which < names.size() + grippers.size()) return grippers[which - names.size()] + ".left";
    return "nothing";
  }

  Dice dice_;
  const RoomFacts& facts_;
  double wild_;
};

/// The alternative of this number, with what its struct says.
template <std::size_t K = 0>
Command command_of_kind(std::size_t kind) {
  if constexpr (K + 1 < std::variant_size_v<Command>) {
    if (kind != K) return command_of_kind<K + 1>(kind);
  }
  return Command(std::in_place_index<K>);
}

}  // namespace

proto::Command draw_command(const Dice& dice, const RoomFacts& facts) {
  Command command = command_of_kind(dice.of("kind").below(std::variant_size_v<Command>));
  if (std::holds_alternative<Halt>(command)) command = Hash{};
  std::visit(CommandDraw(dice.of("fields"), facts), command);
  return command;
}

}  // namespace weft::fuzz
