#pragma once

#include <string>

namespace weft::server {

/// All options of `weft scenes`.
struct ScenesOptions {
  std::string name;     ///< with `json`: this scene as a file; empty: the list
  bool json = false;    ///< machine-readable
  bool schema = false;  ///< the JSON Schema of scene files
};

/// Prints the built-in scenes, one of them as a scene file, or the schema of such files.
/// Throws OptionError or DefinitionError.
int list_scenes(const ScenesOptions& options);

}  // namespace weft::server
