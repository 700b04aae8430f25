#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "proto/events.h"

// Parts of events that answers to `query` repeat. Included only by the encoders.

namespace weft::proto {

nlohmann::ordered_json json_of(const Strain& strain);
nlohmann::ordered_json json_of(const Energy& energy);
nlohmann::ordered_json json_of(const Crossings& crossings);
nlohmann::ordered_json json_of(const State& state);
nlohmann::ordered_json json_of(const ViewerInfo& viewer);
nlohmann::ordered_json json_of(const PinInfo& pin);
nlohmann::ordered_json json_of(const GrabInfo& grab);

template <class Item>
nlohmann::ordered_json json_of(const std::vector<Item>& items) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Item& item : items) list.push_back(json_of(item));
  return list;
}

}  // namespace weft::proto
