#pragma once

#include "proto/commands.h"
#include "proto/field_reader.h"

// Commands that move objects, pins and grippers; only for parse_request.

namespace weft::proto {

Command read_move(FieldReader& in);
Command read_gripper(FieldReader& in);

}  // namespace weft::proto
