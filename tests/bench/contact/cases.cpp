// The cases of the comparison of two versions' contact.

#include "tests/bench/contact/cases.h"

#include <cmath>
#include <initializer_list>
#include <numbers>
#include <utility>

#include "core/scenes/dress_form.h"
#include "core/scenes/scene_parts.h"

namespace weft::bench {
namespace {

using std::numbers::pi;
using Settings = std::initializer_list<std::pair<const char*, const char*>>;

constexpr int kTicksASecond = 60;

/// A scene of one square metre of cotton without objects; nothing falls asleep.
/// @param n          particles a side
/// @param thickness  in parts of the edge length
WorldDef cotton(int n, double thickness, const Settings& settings) {
  WorldDef def;
  set_field(def, "fabric", "cotton");
  def.cloths[0].rows = def.cloths[0].columns = n;
  def.cloths[0].fabric.thickness = thickness / (n - 1);
  set_field(def, "contact.self", "guard");
  for (const auto& [key, text] : settings) set_field(def, key, text);
  return def;
}

/// Where it hangs upright, a little aslant.
WorldDef upright(int n, double thickness, double top, const Settings& settings) {
  WorldDef def = cotton(n, thickness, settings);
  ClothDef& cloth = def.cloths[0];
  cloth.origin = Vec3d(-0.5, top, 0);
  cloth.u = Vec3d::UnitX();
  cloth.v = Vec3d(0, -1, -0.12).normalized();
  return def;
}

/// It falls upright on the ground, on which it crumples.
WorldDef pile(int n, double thickness) {
  WorldDef def = upright(n, thickness, 1.1, {{"environment.drag", "0.5"}});
  def.colliders = {ground()};
  return def;
}

WorldDef lying(int n, double height, const Settings& settings) {
  WorldDef def = cotton(n, 0.25, settings);
  def.cloths[0].origin = Vec3d(-0.5, height, -0.5);
  def.cloths[0].u = Vec3d::UnitX();
  def.cloths[0].v = Vec3d::UnitZ();
  return def;
}

WorldDef on_sphere(int n, const Settings& settings = {}) {
  WorldDef def = lying(n, 1.02, settings);
  def.colliders = {ground(), {"ball", SphereDef{Vec3d(0, 0.7, 0), 0.3}}};
  return def;
}

WorldDef on_form(const Settings& settings) {
  WorldDef def = lying(64, 1.56, settings);
  def.colliders = {ground(), {"form", MeshDef{make_dress_form()}}};
  return def;
}

WorldDef scene(const char* name, const Settings& settings = {}) {
  WorldDef def = make_scene(name);
  set_field(def, "sleep.after", "0");
  for (const auto& [key, text] : settings) set_field(def, key, text);
  return def;
}

/// To and fro along a line.
/// @param way    one leg of it [m]
/// @param speed  [m/s]
std::function<Vec3d(double)> to_and_fro(const Vec3d& way, double speed) {
  const double leg = way.norm();
  return [=](double time) -> Vec3d {
    const double distance = std::fmod(speed * time, 2 * leg);
    return way * ((distance < leg ? distance : 2 * leg - distance) / leg);
  };
}

/// Four sheets in layers over a ball, whose corners are pulled across it, two by two against each
/// other.
ContactCase fight() {
  ContactCase c{"fight",
                "four cloths of 33 x 33 over a ball, a corner of each pulled across",
                {},
                2 * kTicksASecond,
                kTicksASecond,
                0};
  c.def = cotton(33, 0.25, {});
  ClothDef sheet = c.def.cloths[0];
  c.def.cloths.clear();
  for (int k = 0; k < 4; ++k) {
    const double turn = k * pi / 8, s = std::sin(turn), t = std::cos(turn);
    sheet.name = "sheet" + std::to_string(k);
    sheet.u = Vec3d(t, 0, s);
    sheet.v = Vec3d(-s, 0, t);
    sheet.origin = Vec3d(0, 0.73 + 0.03 * k, 0) - (sheet.u + sheet.v) / 2;
    c.def.cloths.push_back(sheet);
  }
  c.def.colliders = {ground(), {"ball", SphereDef{Vec3d(0, 0.4, 0), 0.3}}};
  for (int k = 0; k < 4; ++k) {
    const Vec3d out(std::cos(k * pi / 2 + pi / 4), 0, std::sin(k * pi / 2 + pi / 4));
    c.hands.push_back({out, 1000, 100, to_and_fro(Vec3d(-1.2 * out + Vec3d(0, 0.5, 0)), 3)});
  }
  return c;
}

/// Ten hands at 20 m/s.
ContactCase many_hands() {
  ContactCase c{"hands",           "ten hands at 20 m/s in a crumpled 33 x 33",
                pile(33, 0.25),    2 * kTicksASecond,
                kTicksASecond / 2, 0};
  for (int k = 0; k < 10; ++k) {
    const double angle = 2 * pi * k / 10;
    const Vec3d out(std::cos(angle), 0.2 * (k % 3), std::sin(angle));
    c.hands.push_back({out, 1000, 50, to_and_fro(Vec3d(-0.8 * out + Vec3d(0, 0.4, 0)), 20)});
  }
  return c;
}

/// Twenty sheets that start nearer to each other than their thickness.
ContactCase near_sheets() {
  ContactCase c{"near-sheets", "twenty 17 x 17 that start at half their thickness", {}, 0, 8, 0};
  c.def = lying(17, 0.05, {});
  ClothDef sheet = c.def.cloths[0];
  sheet.fabric.thickness = 0.5 / 16;
  c.def.cloths.clear();
  for (int k = 0; k < 20; ++k) {
    sheet.name = "sheet" + std::to_string(k);
    sheet.origin[1] = 0.05 + 0.5 * sheet.fabric.thickness * k;
    c.def.cloths.push_back(sheet);
  }
  c.def.colliders = {ground()};
  return c;
}

ContactCase hand_in(const char* name, const char* how, double thickness) {
  return {name,
          how,
          pile(64, thickness),
          5 * kTicksASecond,
          kTicksASecond,
          10,
          {{Vec3d::UnitX(), 1000, 50, to_and_fro(Vec3d(-0.5, 0, 0), 2)}}};
}

void add_without_contact(std::vector<ContactCase>& cases) {
  const auto both = [&](const std::string& name, const std::string& how, const WorldDef& def,
                        int ticks) {
    cases.push_back({name, how, def, 0, ticks, 0});
    cases.push_back({name + "-alone", how + ", without contact with itself", def, 0, ticks, 0});
    set_field(cases.back().def, "contact.self", "none");
  };
  both("flag", "in its wind, 10 s", scene("flag"), 600);
  both("falling", "64 x 64 upright, until it is at the ground",
       upright(64, 0.25, 3.5, {{"environment.drag", "0.5"}}), 40);
  both("falling-in-wind", "the same in gusts of 2 m/s",
       upright(64, 0.25, 3.5,
               {{"environment.drag", "0.5"},
                {"environment.wind", "2,0,2"},
                {"environment.gust_speed", "2"}}),
       40);
  both("default", "10 s", scene("default"), 600);
  both("curtain", "in its wind, 10 s", scene("curtain"), 600);
}

}  // namespace

std::vector<ContactCase> contact_cases() {
  std::vector<ContactCase> cases;
  add_without_contact(cases);
  cases.push_back(hand_in("hand", "a hand at 2 m/s through a pile of 64 x 64", 0.25));
  cases.push_back({"pile", "64 x 64 dropped upright", pile(64, 0.25), 0, 120, 10});
  cases.push_back({"pile-rest", "64 x 64 at rest", pile(64, 0.25), 5 * kTicksASecond, 60, 0});
  cases.push_back({"pile-thick", "the same as thick as an edge is long", pile(64, 1), 0, 120, 10});
  cases.push_back({"form", "64 x 64 dropped on the dress form", on_form({}), 0, 120, 10});
  cases.push_back({"form-alone", "the same without contact with itself",
                   on_form({{"contact.self", "none"}}), 0, 120, 10});
  cases.push_back({"sphere", "128 x 128 falls on a ball", on_sphere(128), 0, 90, 10});
  cases.push_back({"sphere-rest", "128 x 128 lies on a ball", on_sphere(128), 180, 30, 0});
  cases.push_back({"sphere-implicit", "the same with the solver implicit",
                   on_sphere(128, {{"solver.kind", "implicit"}}), 180, 30, 0});
  cases.push_back({"crumple", "128 x 128 dropped upright", pile(128, 0.25), 0, 80, 10});
  cases.push_back(fight());
  cases.push_back(many_hands());
  cases.push_back(near_sheets());
  return cases;
}

}  // namespace weft::bench
