#pragma once

#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "proto/error.h"
#include "proto/limits.h"

namespace weft::proto {

/// Parses one JSON object as README.md section 3 allows it: at most `most_bytes` of UTF-8, at most
/// kMostDepth levels, no duplicate key, finite numbers, nothing after it. Never throws on the text.
/// Errors: too_large, bad_utf8, bad_json, not_finite, duplicate_key, not_an_object.
Result<nlohmann::json> parse_object(std::string_view text,
                                    std::size_t most_bytes = kMostMessageBytes);

}  // namespace weft::proto
