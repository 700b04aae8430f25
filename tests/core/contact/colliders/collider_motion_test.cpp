#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "core/contact/colliders/collider_plan.h"
#include "core/error.h"
#include "core/math/sine.h"

// Poses, keyframes and commands, without any cloth.

using namespace weft;

namespace {

constexpr double kPi = 3.14159265358979323846, kTick = 1.0 / 60;
const Vec3d kOrigin = Vec3d::Zero();

Pose pose(const Vec3d& position, double angle = 0, const Vec3d& axis = Vec3d::UnitY()) {
  return {position, Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()))};
}

Keyframe key(double time, const Vec3d& offset, double angle = 0) {
  return {time, offset, pose(offset, angle).rotation};
}

double angle_between(const Pose& a, const Pose& b) {
  return rotation_vector(a.rotation * b.rotation.conjugate()).norm();
}

ColliderDef ball(const MotionDef& motion = {}) {
  return {"ball", SphereDef{Vec3d(0, 1, 0), 0.2}, motion};
}

void run(const std::vector<ColliderDef>& defs, int ticks, ColliderStates& states) {
  for (int tick = 0; tick < ticks; ++tick) {
    plan_motion(defs, tick * kTick, kTick, states);
    for (ColliderState& state : states)
      for (int s = 0; s < 10; ++s) advance_collider(kTick / 10, kTick, state);
    finish_motion(defs, kTick, states);
  }
}

std::string refused_field(const MotionDef& motion) {
  try {
    validate(motion, "motion.");
  } catch (const DefinitionError& error) {
    return error.field;
  }
  return "";
}

}  // namespace

TEST_CASE("sine and cosine are right to 4e-16 (1 + |angle|)") {
  for (double angle = -40; angle < 40; angle += 0.0137) {
    const SineCosine sc = sine_cosine(angle);
    INFO(angle);
    CHECK(std::abs(sc.sine - std::sin(angle)) <= 4e-16 * (1 + std::abs(angle)));
    CHECK(std::abs(sc.cosine - std::cos(angle)) <= 4e-16 * (1 + std::abs(angle)));
  }
}

TEST_CASE("an angle that is infinite, beyond 1000 or not a number has no sine") {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double angle : {infinity, -infinity, 1001.0, -1e300, std::nan("")}) {
    CHECK(std::isnan(sine_cosine(angle).sine));
    CHECK(std::isnan(sine_cosine(angle).cosine));
  }
  CHECK(sine_cosine(1000).sine == Approx(std::sin(1000.0)));
}

TEST_CASE("a rotation vector and its rotation are inverse to each other up to half a turn") {
  for (const double angle : {0.0, 1e-12, 1e-3, 1.0, 3.0, kPi - 1e-9}) {
    const Vec3d v = Vec3d(1, -2, 0.5).normalized() * angle;
    CHECK((rotation_vector(rotation_by(v)) - v).norm() <= 1e-15 + 1e-7 * (angle > 3.1));
    const Eigen::Quaterniond q = rotation_by(v);
    const Eigen::Quaterniond same(-q.w(), -q.x(), -q.y(), -q.z());
    CHECK((rotation_vector(same) - rotation_vector(q)).norm() == 0);
  }
}

TEST_CASE("linear keyframes give constant velocity and turn, smooth ones rest at each keyframe") {
  MotionDef motion;
  motion.keyframes = {key(1, {0, 0, 0}), key(3, {2, 0, 0}, kPi / 2), key(4, {2, 1, 0})};
  CHECK(offset_at(motion, 0).position == Vec3d(0, 0, 0));
  CHECK(offset_at(motion, 9).position == Vec3d(2, 1, 0));
  for (const double s : {0.25, 0.5, 0.75}) {
    motion.interpolation = Interpolation::linear;
    CHECK((offset_at(motion, 1 + 2 * s).position - Vec3d(2 * s, 0, 0)).norm() < 1e-14);
    CHECK(angle_between(offset_at(motion, 1 + 2 * s), pose(kOrigin, s * kPi / 2)) < 1e-14);
    motion.interpolation = Interpolation::smooth;
    const double eased = s * s * (3 - 2 * s);
    CHECK((offset_at(motion, 1 + 2 * s).position - Vec3d(2 * eased, 0, 0)).norm() < 1e-14);
    CHECK(angle_between(offset_at(motion, 1 + 2 * s), pose(kOrigin, eased * kPi / 2)) < 1e-14);
  }
  const double h = 1e-6;
  const Vec3d v = (offset_at(motion, 3 + h).position - offset_at(motion, 3 - h).position) / (2 * h);
  CHECK(v.norm() < 1e-5);
}

TEST_CASE("a loop goes on from its last keyframe to its first, for ever") {
  MotionDef motion;
  motion.loop = true;
  for (int k = 0; k <= 4; ++k) motion.keyframes.push_back(key(k * 0.5, {0, 1, 0}, k * kPi / 2));
  validate(motion, "motion.");
  for (double t = 0; t < 2; t += 0.07) {
    CHECK(angle_between(offset_at(motion, t), offset_at(motion, t + 2)) < 1e-12);
    CHECK(angle_between(offset_at(motion, t), pose(kOrigin, t * kPi)) < 1e-12);
    CHECK(angle_between(offset_at(motion, t + 2e3), pose(kOrigin, t * kPi)) < 1e-9);
  }
}

TEST_CASE("keyframes that would be a jump, or are out of order or range, are refused by name") {
  MotionDef good;
  good.keyframes = {key(0, {0, 0, 0}), key(1, {1, 0, 0})};
  CHECK(refused_field(good).empty());
  const auto changed = [&](auto&& change) {
    MotionDef motion = good;
    change(motion);
    return refused_field(motion);
  };
  CHECK(changed([](MotionDef& m) { m.keyframes[1].time = 0; }) == "motion.keyframes[1].time");
  CHECK(changed([](MotionDef& m) { m.keyframes[1].time = 0.04; }) == "motion.keyframes[1].offset");
  CHECK(changed([](MotionDef& m) {
          m.keyframes[1] = key(0.04, {0, 0, 0}, 3);
        }) == "motion.keyframes[1].rotation");
  CHECK(changed([](MotionDef& m) { m.keyframes[0].offset[1] = NAN; }) ==
        "motion.keyframes[0].offset[1]");
  CHECK(changed([](MotionDef& m) { m.keyframes[0].rotation.w() = 0; }) ==
        "motion.keyframes[0].rotation");
  CHECK(changed([](MotionDef& m) { m.keyframes[1].time = INFINITY; }) ==
        "motion.keyframes[1].time");
  CHECK(changed([](MotionDef& m) { m.loop = true; }) == "motion.loop");
  CHECK(changed([](MotionDef& m) { m.keyframes.assign(1001, m.keyframes[0]); }) ==
        "motion.keyframes");
}

TEST_CASE("a command is followed at its speed and reached exactly, and a pose stays reached") {
  const std::vector<ColliderDef> defs = {ball()};
  ColliderStates states = initial_states(defs);
  const Pose goal = pose({0.5, 1, 0}, 1.2, {1, 1, 0});
  states[0].move = MoveDef{goal, 0.5, 60};
  run(defs, 30, states);
  CHECK(states[0].pose.position[0] == Approx(0.25));
  CHECK(angle_between(states[0].pose, pose(kOrigin)) == Approx(0.6));
  CHECK(states[0].is_moving());
  run(defs, 31, states);
  CHECK(states[0].pose == goal);
  CHECK_FALSE(states[0].is_active());
}

TEST_CASE("a collider on keyframes is exactly on them after each tick") {
  MotionDef motion;
  motion.keyframes = {key(0, {0, 0, 0}), key(1, {1, 0, 0}, 2), key(2, {0, 1, 0})};
  const std::vector<ColliderDef> defs = {ball(motion)};
  ColliderStates states = initial_states(defs);
  for (int tick = 0; tick < 150; ++tick) {
    plan_motion(defs, tick * kTick, kTick, states);
    for (int s = 0; s < 7; ++s) advance_collider(kTick / 7, kTick, states[0]);
    CHECK(states[0].pose == keyframed_pose(defs[0], tick * kTick + kTick));
  }
}

TEST_CASE("a plane may be moved and not turned, and a command is refused out of its range") {
  const ColliderDef plane{"ground", PlaneDef{}};
  CHECK_NOTHROW(check_may_turn(plane, pose({0, 1, 0}), ""));
  CHECK_THROWS_AS(check_may_turn(plane, pose({0, 1, 0}, 0.1), ""), DefinitionError);
  for (const MoveDef& move :
       {MoveDef{pose({1001, 0, 0}), 1, 1}, MoveDef{pose({0, NAN, 0}), 1, 1},
        MoveDef{pose(kOrigin), 20.1, 1}, MoveDef{pose(kOrigin), 0, 1},
        MoveDef{pose(kOrigin), 1, 61}, MoveDef{{Vec3d::Zero(), {0, 0, 0, 0}}, 1, 1}})
    CHECK_THROWS_AS(validate(move, "move."), DefinitionError);
}

TEST_CASE(
    "how resistance slows an object, and how it speeds up again, does not depend on the tick") {
  MotionDef motion;
  motion.keyframes = {key(0, {0, 0, 0}), key(10, {10, 0, 0})};
  ColliderDef def = ball(motion);
  def.max_force = 5;
  // Drag in proportion to the speed of the object, until it is gone.
  const auto paces = [&def](int rate) {
    ColliderStates states = initial_states({def});
    const double tick = 1.0 / rate;
    std::vector<double> seen;
    for (int k = 0; k < rate; ++k) {
      plan_motion({def}, k * tick, tick, states);
      const bool resisted = k < rate / 2;
      if (resisted) states[0].impulse = states[0].pushed = states[0].twist.linear * (8 * tick);
      advance_collider(tick, tick, states[0]);
      finish_motion({def}, tick, states);
      if ((k + 1) % (rate / 20) == 0) seen.push_back(states[0].pace.into);
    }
    return seen;
  };
  const std::vector<double> usual = paces(60);
  CHECK(usual[9] < 0.8);
  CHECK(usual[14] > usual[9]);
  for (const int rate : {120, 240, 1000}) {
    CAPTURE(rate);
    const std::vector<double> other = paces(rate);
    for (std::size_t k = 0; k < usual.size(); ++k) CHECK(other[k] == Approx(usual[k]).margin(0.03));
  }
}

TEST_CASE("what an object is pushed back by does not slow it along that, and the other way about") {
  ColliderDef def = ball({});
  def.max_force = 5;
  for (const bool pushed : {true, false}) {
    ColliderStates states = initial_states({def});
    states[0].move = MoveDef{pose({10, -9, 0}), 1, 1};
    for (int k = 0; k < 30; ++k) {
      plan_motion({def}, k * kTick, kTick, states);
      const Vec3d along(20 * kTick, 0, 0), down(0, -5.5 * kTick, 0);
      states[0].impulse = pushed ? down : Vec3d(along + down / 100);
      states[0].pushed = pushed ? down : Vec3d(down / 100);
      advance_collider(kTick, kTick, states[0]);
      finish_motion({def}, kTick, states);
    }
    plan_motion({def}, 0.5, kTick, states);
    const Vec3d v = states[0].twist.linear;
    INFO((pushed ? "pushed back" : "rubbed"));
    CHECK((pushed ? v[0] : -v[1]) == Approx(std::sqrt(0.5)).epsilon(0.1));
    CHECK((pushed ? -v[1] : v[0]) < 0.1);
  }
}

TEST_CASE(
    "an object comes back to its keyframes, also where these only turn, only shift or stand") {
  MotionDef motion;
  motion.loop = true;
  const int kind = GENERATE(0, 1, 2);
  CAPTURE(kind);
  if (kind == 0) motion.keyframes = {key(0, kOrigin), key(1, kOrigin, 1), key(2, kOrigin)};
  if (kind == 1) motion.keyframes = {key(0, kOrigin), key(1, Vec3d(0.3, 0, 0)), key(2, kOrigin)};
  if (kind == 2) motion = {.keyframes = {key(0, kOrigin)}};
  const ColliderDef def = ball(motion);
  ColliderStates states = initial_states({def});
  int tick = 0;
  const auto run = [&](int ticks) {
    for (const int end = tick + ticks; tick < end; ++tick) {
      plan_motion({def}, tick * kTick, kTick, states);
      advance_collider(kTick, kTick, states[0]);
      finish_motion({def}, kTick, states);
    }
  };
  run(30);
  MoveDef away;
  away.target = pose(states[0].pose.position + Vec3d(0, 0.05, 0.1), 0.8, Vec3d::UnitX());
  states[0].move = away;
  run(90);
  REQUIRE((states[0].pose.position - away.target.position).norm() < 1e-9);
  states[0].move.reset();
  run(120);
  const Pose wanted = keyframed_pose(def, tick * kTick);
  CHECK((states[0].pose.position - wanted.position).norm() < 1e-6);
  CHECK(angle_between(states[0].pose, wanted) < 1e-6);
}
