#pragma once

#include <string>

#include "core/world/start.h"

namespace weft::server {

/// Reads where a scene begins from a .npy file: the last record of a series (series.h), or an array
/// of particles x 3 positions [m] or particles x 6 positions and velocities [m/s].
/// Throws OptionError on "--start" if the file cannot be read or is neither.
StartDef read_start(const std::string& path);

}  // namespace weft::server
