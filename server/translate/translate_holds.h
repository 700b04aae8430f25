#pragma once

#include "server/translate/translate.h"

// Pins and hands, translated between the wire and the physics.

namespace weft::server {

proto::PinInfo pin_info(const ServedWorld& world, const Pin& pin, proto::ViewerId owner);

/// The pin of this id; null if there is none.
const Pin* find_pin(const ServedWorld& world, PinId id);

/// The command for a pin; an error if the pin cannot arrive in the given time.
proto::Result<PinMove> pin_move(const ServedWorld& world, const Pin& pin,
                                const proto::MovePin& command);

proto::GrabInfo grab_info(const ServedWorld& world, const Grab<float>& grab, proto::ViewerId owner,
                          std::uint32_t drag);
proto::GrabSample grab_sample(const ServedWorld& world, const Grab<float>& grab,
                              proto::ViewerId owner);

}  // namespace weft::server
