#pragma once

#include "server/options.h"

namespace weft::server {

/// Serves until SIGINT, SIGTERM or `max_seconds`. Prints one line of JSON with the addresses to
/// standard output when it listens.
/// @return exit code
/// Throws OptionError or DefinitionError before it listens.
int serve(const ServerOptions& options);

}  // namespace weft::server
