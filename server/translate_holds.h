#pragma once

#include "server/translate.h"

// What holds the cloth, pins and hands, between the wire's types and those of the physics.

namespace weft::server {

proto::PinInfo pin_info(const ServedWorld& world, const Pin& pin, proto::ViewerId owner);

/// The pin of this id; null if there is none.
const Pin* find_pin(const ServedWorld& world, PinId id);

/// The command for a pin; an error if it cannot be there in the time that it is given.
proto::Result<PinMove> pin_move(const ServedWorld& world, const Pin& pin,
                                const proto::MovePin& command);

proto::GrabInfo grab_info(const ServedWorld& world, const Grab<float>& grab, proto::ViewerId owner,
                          std::uint32_t drag);
proto::GrabSample grab_sample(const ServedWorld& world, const Grab<float>& grab,
                              proto::ViewerId owner);

}  // namespace weft::server
