#pragma once

#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "proto/error.h"

namespace weft::proto {

/// Reads one JSON object as README.md section 3 allows it: at most kMostMessageBytes of UTF-8, at
/// most kMostDepth levels, no key twice, finite numbers, nothing after it. Never throws on the
/// text. Errors: too_large, bad_utf8, bad_json, not_finite, duplicate_key, not_an_object.
Result<nlohmann::json> parse_object(std::string_view text);

}  // namespace weft::proto
