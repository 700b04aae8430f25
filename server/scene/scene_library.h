#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/scenes/scenes.h"
#include "core/world/world_def.h"
#include "server/scene/scene_file.h"

namespace weft::server {

/// All scenes that a server can load: the built-in ones, those of its folder, files named on its
/// command line, and those that clients send.
///
/// The folder is read once, at the start: its meshes are parsed then, each in a separate process,
/// and its scenes checked. So a client's `load` never opens a file, and no path from a client
/// reaches the disk. Invalid files of the folder are left out and listed in `problems`; a
/// request for one by name is answered with its own reason.
class SceneLibrary {
 public:
  /// @param mesh_directory   of the built-in meshes that are files
  /// @param scene_directory  with <name>.json and mesh files; empty: none
  explicit SceneLibrary(std::string mesh_directory, const std::string& scene_directory = {});

  /// A built-in scene or one of the folder. Throws DefinitionError on an unknown name.
  WorldDef named(const std::string& name) const;

  /// Opens the argument of `--scene`: a name, or a path that ends in .json, whose meshes are
  /// built-in ones or files beside it. Throws DefinitionError; that of a file of the folder that
  /// has this name and is invalid, also where a built-in scene has it too.
  WorldDef opened(const std::string& name_or_path) const;

  /// Reads a scene that a client sent as JSON: its meshes are built-in ones or plain names of the
  /// folder. Throws DefinitionError.
  /// Throws DefinitionError.
  WorldDef from_client(std::string_view json) const;

  /// Names and descriptions of all scenes that `named` accepts.
  std::vector<SceneInfo> list() const;

  const std::vector<std::string>& problems() const { return problems_; }

 private:
  void read_folder(const std::string& directory);
  MeshFile mesh_of_folder(const std::string& name) const;

  std::string mesh_directory_;
  std::map<std::string, MeshFile> meshes_;  ///< of the folder, by file name
  std::map<std::string, WorldDef> scenes_;  ///< of the folder
  std::vector<std::string> problems_;
  std::map<std::string, DefinitionError> faults_;  ///< of invalid files, by file name
};

/// The directory of a file that comes with the program, e.g. "meshes"; empty if it is unknown.
std::string beside_program(const char* directory);

}  // namespace weft::server
