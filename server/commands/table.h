#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace weft::server {

/// Prints each value of an object on a line of its own, behind the path to it, such as
/// "energy.total".
/// @param prefix  of all paths, such as "energy."
void print_table(const nlohmann::ordered_json& object, const std::string& prefix);

}  // namespace weft::server
