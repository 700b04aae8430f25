#pragma once

#include <cstdint>

#include "proto/field.h"

// The cloth's energy on the wire, and where it came from and went [J].

namespace weft::proto {

struct Energy {
  double kinetic = 0, stretch = 0, bending = 0, gravity = 0, total = 0;

  static constexpr const char* kName = "Energy";
  static void describe(auto& io, auto& energy) {
    io.required(Field{"kinetic", "", {}, "J"}, energy.kinetic);
    io.required(Field{"stretch", "of the membrane", {}, "J"}, energy.stretch);
    io.required(Field{"bending", "", {}, "J"}, energy.bending);
    io.required(Field{"gravity", "above the height 0", {}, "J"}, energy.gravity);
    io.required(Field{"total", "", {}, "J"}, energy.total);
  }
};

/// Brought by what acts on the cloth; negative where the cloth did work on it.
struct EnergyWork {
  double hands = 0, slings = 0, pins = 0, objects = 0, grippers = 0, wind = 0, push_out = 0;
  double disturbances = 0, commands = 0;

  static constexpr const char* kName = "EnergyWork";
  static void describe(auto& io, auto& work) {
    io.required(Field{"hands", "", {}, "J"}, work.hands);
    io.required(Field{"slings", "", {}, "J"}, work.slings);
    io.required(Field{"pins", "moving ones, and pins that stop what they take hold of", {}, "J"},
                work.pins);
    io.required(Field{"objects", "moving ones", {}, "J"}, work.objects);
    io.required(Field{"grippers", "their jaws", {}, "J"}, work.grippers);
    io.required(Field{"wind", "force of the air times the speed of the air", {}, "J"}, work.wind);
    io.required(Field{"push_out", "contact: positions corrected without a velocity", {}, "J"},
                work.push_out);
    io.required(Field{"disturbances", "of the scene", {}, "J"}, work.disturbances);
    io.required(Field{"commands", "other gravity, softness or fabric, pins that stop", {}, "J"},
                work.commands);
  }
};

/// Taken from the cloth.
struct EnergyLosses {
  double damping = 0, drag = 0, air = 0, friction = 0, impacts = 0, self_contact = 0;
  double sleep = 0, recovery = 0, solver = 0;

  static constexpr const char* kName = "EnergyLosses";
  static void describe(auto& io, auto& losses) {
    io.required(Field{"damping", "of the fabric", {}, "J"}, losses.damping);
    io.required(Field{"drag", "of the scene", {}, "J"}, losses.drag);
    io.required(Field{"air", "its resistance", {}, "J"}, losses.air);
    io.required(Field{"friction", "of objects", {}, "J"}, losses.friction);
    io.required(Field{"impacts", "on objects", {}, "J"}, losses.impacts);
    io.required(Field{"self_contact", "of cloth with cloth, with friction", {}, "J"},
                losses.self_contact);
    io.required(Field{"sleep", "motion of cloth that fell asleep", {}, "J"}, losses.sleep);
    io.required(Field{"recovery", "of cloth that was stopped, as it diverged", {}, "J"},
                losses.recovery);
    io.required(Field{"solver", "what no cause explains; negative: brought by it", {}, "J"},
                losses.solver);
  }
};

/// start + sum of work - sum of losses = now.
struct EnergyBalance {
  std::uint64_t since = 0;
  double start = 0;
  EnergyWork work;
  EnergyLosses losses;
  double now = 0;

  static constexpr const char* kName = "EnergyBalance";
  static void describe(auto& io, auto& balance) {
    io.required(Field{"since", "tick at whose end measuring began"}, balance.since);
    io.required(Field{"start", "total then", {}, "J"}, balance.start);
    io.required(Field{"work", "of what acts on the cloth"}, balance.work);
    io.required(Field{"losses", "to what takes energy from it"}, balance.losses);
    io.required(Field{"now", "total", {}, "J"}, balance.now);
  }
};

}  // namespace weft::proto
