#pragma once

#include <optional>

#include <nlohmann/json_fwd.hpp>

#include "core/world/world.h"
#include "proto/messages/energy.h"

// Where the cloth's energy came from and went, in types of the wire.

namespace weft::server {

/// Nothing unless it is measured.
template <class Real>
std::optional<proto::EnergyBalance> balance_of(const World<Real>& world);

/// As in the message.
nlohmann::ordered_json json_of(const proto::EnergyBalance& balance);

}  // namespace weft::server
