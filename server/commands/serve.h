#pragma once

#include "server/options.h"

namespace weft::server {

/// Serves until SIGINT, SIGTERM or `max_seconds`. Once it listens, it prints one line of JSON with
/// the addresses to standard output.
/// @return exit code
/// Throws OptionError or DefinitionError before it listens.
int serve(const ServerOptions& options);

}  // namespace weft::server
