#include "server/commands/table.h"

#include <cstdio>

namespace weft::server {
namespace {

void print_row(const std::string& name, const nlohmann::ordered_json& value) {
  if (value.is_number_float())
    std::printf("%-34s %.6g\n", name.c_str(), value.get<double>());
  else if (value.is_string())
    std::printf("%-34s %s\n", name.c_str(), value.get<std::string>().c_str());
  else
    std::printf("%-34s %s\n", name.c_str(), value.dump().c_str());
}

}  // namespace

void print_table(const nlohmann::ordered_json& object, const std::string& prefix) {
  for (const auto& [key, value] : object.items()) {
    if (value.is_object())
      print_table(value, prefix + key + ".");
    else
      print_row(prefix + key, value);
  }
}

}  // namespace weft::server
