#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "proto/error.h"
#include "proto/field.h"
#include "proto/limits.h"
#include "proto/messages/right.h"
#include "proto/types.h"

// The command `query`: reads something from the state between two ticks.

namespace weft::proto {

enum class QueryWhat : std::uint8_t {
  positions,
  velocities,
  energies,
  strain,
  pins,
  grabs,
  camera,
  roster,
  state,
  work,
  trees,
  boxes,
  colliders,
  measurements,
  contacts,
  reactions,
  grippers,
  crossings,
  balance
};
template <>
inline constexpr std::array<const char*, 19> kWords<QueryWhat> = {
    "positions", "velocities", "energies", "strain",    "pins",   "grabs",     "camera",
    "roster",    "state",      "work",     "trees",     "boxes",  "colliders", "measurements",
    "contacts",  "reactions",  "grippers", "crossings", "balance"};

enum class QueryFormat : std::uint8_t { json, f32, f64 };
template <>
inline constexpr std::array<const char*, 3> kWords<QueryFormat> = {"json", "f32", "f64"};

struct Query {
  QueryWhat what = QueryWhat::positions;
  QueryFormat format = QueryFormat::json;
  std::optional<ViewerId> viewer;
  std::optional<std::string> tree;
  std::optional<std::uint32_t> level;  ///< 0, if absent
  bool operator==(const Query&) const = default;

  static constexpr const char* kOp = "query";
  static constexpr Right kRight = Right::look;
  static constexpr FurtherRight kFurther{"`contacts`, `reactions`, `crossings`, `balance`",
                                         Right::operate};
  /// What is computed for it alone takes the time of all.
  constexpr Right right() const {
    const bool computed = what == QueryWhat::contacts || what == QueryWhat::reactions ||
                          what == QueryWhat::crossings || what == QueryWhat::balance;
    return computed ? kFurther.right : kRight;
  }
  static void describe(auto& io, auto& query) {
    io.required(Field{"what", "what to read; see the table below"}, query.what);
    io.optional(Field{"format", "binary ones are for positions, velocities and boxes alone"},
                query.format);
    io.optional(Field{"viewer", "of `camera`: that one alone", kIdRange}, query.viewer);
    const bool boxes = query.what == QueryWhat::boxes;
    const bool numbers =
        boxes || query.what == QueryWhat::positions || query.what == QueryWhat::velocities;
    io.rule(query.format == QueryFormat::json || numbers, ErrorCode::conflicting_fields, "format",
            "only positions, velocities and boxes have binary formats");
    io.rule(!query.viewer || query.what == QueryWhat::camera, ErrorCode::conflicting_fields,
            "viewer", "viewer is only for camera");
    io.only_if(boxes, "boxes",
               Field{"tree", "one that `trees` lists", {1, kMostTreeBytes}, "bytes", Form::bytes},
               query.tree, true);
    io.only_if(boxes, "boxes", Field{"level", "0: one box around everything", kLevelRange},
               query.level, false);
  }
};

}  // namespace weft::proto
