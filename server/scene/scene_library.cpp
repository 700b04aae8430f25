#include "server/scene/scene_library.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "core/scenes/built_in_meshes.h"
#include "server/scene/mesh_child.h"

namespace weft::server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFolderFiles = 64;  // of each kind

bool is_plain(const std::string& name) {
  return !name.empty() && name.size() <= 64 && name[0] != '.' &&
         std::all_of(name.begin(), name.end(), [](char x) {
           return (x >= '0' && x <= '9') || (x >= 'a' && x <= 'z') || (x >= 'A' && x <= 'Z') ||
                  x == '.' || x == '_' || x == '-';
         });
}

bool is_built_in(const std::string& mesh) {
  const auto& names = built_in_mesh_names();
  return std::find(names.begin(), names.end(), mesh) != names.end();
}

/// A whole file of at most kMostSceneBytes, or one byte more.
std::string text_of(const fs::path& path, const std::string& field) {
  std::error_code error;
  std::ifstream file;
  if (fs::is_regular_file(path, error)) file.open(path, std::ios::binary);
  if (!file.is_open()) throw DefinitionError(field, path.string(), "a scene file that can be read");
  std::string text(kMostSceneBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

}  // namespace

SceneLibrary::SceneLibrary(std::string mesh_directory, const std::string& scene_directory)
    : mesh_directory_(std::move(mesh_directory)) {
  if (!scene_directory.empty()) read_folder(scene_directory);
}

void SceneLibrary::read_folder(const std::string& directory) {
  std::error_code error;
  std::vector<fs::path> scene_files, mesh_files;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    const std::string name = entry.path().filename().string();
    const bool is_scene = name.ends_with(".json"), is_mesh = is_mesh_file_name(name);
    if (!is_scene && !is_mesh) continue;
    if (!is_plain(name))
      problems_.push_back(name + ": not a plain name");
    else
      (is_scene ? scene_files : mesh_files).push_back(entry.path());
  }
  if (error)
    throw DefinitionError("--scenes", directory, "a directory that can be read", error.message());
  for (std::vector<fs::path>* files : {&scene_files, &mesh_files}) {
    std::sort(files->begin(), files->end());
    if (files->size() <= kMostFolderFiles) continue;
    problems_.push_back("only the first " + std::to_string(kMostFolderFiles) + " of " +
                        std::to_string(files->size()) + " files of each kind are taken");
    files->resize(kMostFolderFiles);
  }
  const auto attempt = [this](const fs::path& path, auto&& read) {
    try {
      read();
    } catch (const DefinitionError& problem) {
      const std::string name = path.filename().string();
      problems_.push_back(name + ": " + problem.what());
      faults_.emplace(name, problem);
    }
  };
  for (const fs::path& path : mesh_files)
    attempt(path, [&] { meshes_[path.filename().string()] = read_mesh_apart(path.string()); });
  for (const fs::path& path : scene_files) {
    attempt(path, [&] {
      WorldDef def = from_client(text_of(path, "scene"));
      def.name = path.stem().string();
      scenes_[def.name] = std::move(def);
    });
  }
}

MeshFile SceneLibrary::mesh_of_folder(const std::string& name) const {
  if (is_built_in(name)) return built_in_mesh(name, mesh_directory_);
  const auto found = meshes_.find(name);
  if (found != meshes_.end()) return found->second;
  if (const auto fault = faults_.find(name); fault != faults_.end()) throw fault->second;
  std::string names;
  for (const std::string& each : built_in_mesh_names()) names += each + ", ";
  for (const auto& [each, mesh] : meshes_) names += each + ", ";
  throw DefinitionError("mesh", name, "one of " + names.substr(0, names.size() - 2),
                        "a scene from a client names meshes, never a path");
}

WorldDef SceneLibrary::named(const std::string& name) const {
  const auto found = scenes_.find(name);
  if (found != scenes_.end()) return found->second;
  for (const SceneInfo& scene : scenes()) {
    if (scene.name == name) return make_scene(name, mesh_directory_);
  }
  std::string names;
  for (const SceneInfo& scene : list()) names += (names.empty() ? "" : ", ") + scene.name;
  throw DefinitionError("scene", name, "one of " + names + ", or a file that ends in .json");
}

WorldDef SceneLibrary::opened(const std::string& name_or_path) const {
  if (!name_or_path.ends_with(".json")) {
    const auto fault = faults_.find(name_or_path + ".json");
    if (fault == faults_.end()) return named(name_or_path);
    throw fault->second.renamed(fault->first + ": " + fault->second.field);
  }
  const fs::path path = name_or_path;
  const auto beside = [&](const std::string& name) {
    if (is_built_in(name)) return built_in_mesh(name, mesh_directory_);
    return read_mesh_apart((path.parent_path() / name).string());
  };
  try {
    WorldDef def = read_scene(text_of(path, "--scene"), beside);
    if (def.name == WorldDef{}.name && is_plain(path.stem().string()))
      def.name = path.stem().string();
    return def;
  } catch (const DefinitionError& error) {
    if (error.field == "--scene") throw;
    throw error.renamed(path.filename().string() + ": " + error.field);
  }
}

WorldDef SceneLibrary::from_client(std::string_view json) const {
  return read_scene(json, [this](const std::string& name) { return mesh_of_folder(name); });
}

std::vector<SceneInfo> SceneLibrary::list() const {
  std::vector<SceneInfo> all = scenes();
  for (const auto& own : scenes_) {
    const auto same = std::find_if(all.begin(), all.end(),
                                   [&](const SceneInfo& scene) { return scene.name == own.first; });
    if (same != all.end())
      same->description = own.second.description;
    else
      all.push_back({own.first, own.second.description, {}});
  }
  return all;
}

std::string beside_program(const char* directory) {
  std::error_code error;
  const auto program = fs::read_symlink("/proc/self/exe", error);
  return error ? std::string() : (program.parent_path() / directory).string();
}

}  // namespace weft::server
