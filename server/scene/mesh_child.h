#pragma once

#include <string>

#include "core/geometry/mesh_file.h"

namespace weft::server {

/// The name of the subcommand that parses one mesh; for `read_mesh_apart` alone.
inline constexpr const char* kMeshChildCommand = "mesh-child";

/// Limits of a mesh file in a folder, so that neither parsing nor contact takes long.
inline constexpr MeshFileLimits kFolderMeshLimits = {32 << 20, 200'000, 400'000};

/// Parses a mesh file in a separate process, because the library that knows the formats hangs on
/// some files and reads past the end of others. The child gets only the file on its standard input:
/// no environment, 5 s of processor time, 1 GiB of memory, no file to write, and from the moment it
/// starts to parse no system calls but those for memory, reading and writing (Linux on x86-64 and
/// ARM; elsewhere the other limits hold). Its output is checked like the file.
///
/// A parser of our own would be smaller, but GLB and the many variants of PLY are what such
/// libraries are for.
///
/// @param path  a regular file
/// Throws DefinitionError on field "mesh" if there is no such file or the child refuses it or
/// fails.
MeshFile read_mesh_apart(const std::string& path, const MeshFileLimits& limits = kFolderMeshLimits);

/// The child's side: parses standard input and answers on standard output.
/// @return exit code
int run_mesh_child(const std::string& name);

}  // namespace weft::server
