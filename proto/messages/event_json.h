#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "proto/messages/command_writer.h"
#include "proto/messages/events.h"

// Parts of events that answers to `query` repeat. Included only by the encoders.

namespace weft::proto {

template <Described Part>
nlohmann::ordered_json json_of(const Part& part) {
  return CommandWriter::json_of(part);
}

template <class Item>
nlohmann::ordered_json json_of(const std::vector<Item>& items) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Item& item : items) list.push_back(json_of(item));
  return list;
}

}  // namespace weft::proto
