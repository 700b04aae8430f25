#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proto/error.h"

// Errors by which commands are refused.

namespace weft::server {

/// One that names a field and its value.
proto::Error field_error(proto::ErrorCode code, std::string message, const char* field,
                         std::uint32_t value, std::string hint = {});

/// @param what   there may be no more of, in the plural
/// @param limit  so many may be
proto::Error too_many(const char* what, std::size_t limit, std::string hint = "end one first");

proto::Error unknown_pin(std::uint32_t pin);
proto::Error unknown_drag(std::uint32_t drag, std::string hint = {});
/// Nothing if it is one of the names.
std::optional<proto::Error> check_scene_name(const std::string& name,
                                             const std::vector<std::string>& names);
proto::Error unknown_viewer(proto::ViewerId viewer);
proto::Error not_paused();
/// Another viewer's `advance` runs.
proto::Error advancing_error();

}  // namespace weft::server
