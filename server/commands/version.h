#pragma once

#include "proto/messages/http.h"

namespace weft::server {

/// Version, commit, compiler, and the vector instructions that the physics uses on this processor.
proto::VersionInfo version_info();

}  // namespace weft::server
