#pragma once

#include <cstdint>
#include <string>

namespace weft::proto {

/// 16 hexadecimal digits, the form of hashes in messages and URLs.
std::string hash_text(std::uint64_t hash);

}  // namespace weft::proto
