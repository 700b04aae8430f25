#pragma once

#include "proto/commands.h"
#include "proto/field_reader.h"

// Commands that send something somewhere; for parse_request alone.

namespace weft::proto {

Command read_move(FieldReader& in);
Command read_gripper(FieldReader& in);

}  // namespace weft::proto
