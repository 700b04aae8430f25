// Reads and writes mesh files; the only file that includes assimp.

#include "core/geometry/mesh_file.h"

#include <cassert>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <span>
#include <sstream>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "core/definition.h"
#include "core/error.h"
#include "core/geometry/constants.h"
#include "core/geometry/mesh_seams.h"
#include "core/geometry/polygon_cut.h"

namespace weft {
namespace {

/// Assimp's name of the format for the extension; OBJ without a separate material file.
std::string format_of(const std::string& path) {
  const auto ends_with = [&](const std::string& ending) {
    return path.size() > ending.size() &&
           path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
  };
  if (ends_with(".obj")) return "objnomtl";
  if (ends_with(".ply")) return "ply";
  throw DefinitionError("out", path, "a name that ends in .obj or .ply");
}

aiVector3D to_assimp(const Vec3d& p) {
  return {static_cast<ai_real>(p[0]), static_cast<ai_real>(p[1]), static_cast<ai_real>(p[2])};
}

/// Without vertices.
std::unique_ptr<aiMesh> named_faces(const std::string& name, std::size_t triangles) {
  auto result = std::make_unique<aiMesh>();
  result->mName = name;
  result->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  result->mNumFaces = static_cast<unsigned>(triangles);
  result->mFaces = new aiFace[triangles];
  for (std::size_t t = 0; t < triangles; ++t) {
    result->mFaces[t].mNumIndices = 3;
    result->mFaces[t].mIndices = new unsigned[3];
  }
  return result;
}

/// Each vertex once, without uv.
std::unique_ptr<aiMesh> by_vertices(const NamedMesh& named) {
  const TriangleMesh& mesh = named.mesh;
  auto result = named_faces(named.name, mesh.triangles.size());
  result->mNumVertices = static_cast<unsigned>(mesh.positions.size());
  result->mVertices = new aiVector3D[mesh.positions.size()];
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    result->mVertices[i] = to_assimp(mesh.positions[i]);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k)
      result->mFaces[t].mIndices[k] = static_cast<unsigned>(mesh.triangles[t][k]);
  }
  return result;
}

/// A vertex for each corner of a triangle, with its uv.
std::unique_ptr<aiMesh> by_corners(const NamedMesh& named) {
  const TriangleMesh& mesh = named.mesh;
  const std::size_t corners = 3 * mesh.triangles.size();
  auto result = named_faces(named.name, mesh.triangles.size());
  result->mNumVertices = static_cast<unsigned>(corners);
  result->mVertices = new aiVector3D[corners];
  result->mTextureCoords[0] = new aiVector3D[corners];
  result->mNumUVComponents[0] = 2;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = 3 * t + k;
      const auto& [u, v] = named.corner_uv[t][k];
      result->mVertices[i] =
          to_assimp(mesh.positions[static_cast<std::size_t>(mesh.triangles[t][k])]);
      result->mTextureCoords[0][i] = to_assimp(Vec3d(u, v, 0));
      result->mFaces[t].mIndices[k] = static_cast<unsigned>(i);
    }
  }
  return result;
}

/// In lower case, without the dot.
std::string ending_of(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) return {};
  std::string ending(name.substr(dot + 1));
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

DefinitionError unreadable(const std::string& name, const std::string& why) {
  return {"mesh", name, "a whole OBJ, PLY, STL or GLB file", why};
}

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
  assert(at + 4 <= bytes.size());
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k)
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + k])) << (8 * k);
  return value;
}

/// Whether the head of a PLY counts more of anything than the file has bytes: assimp makes room for
/// all that it counts.
bool counts_too_many(std::string_view head, std::size_t bytes) {
  constexpr std::string_view kElement = "\nelement ";
  for (std::size_t at = head.find(kElement); at != head.npos; at = head.find(kElement, at + 1)) {
    const std::string_view line = head.substr(at + 1, head.find('\n', at + 1) - at - 1);
    const std::size_t space = line.rfind(' ');
    if (std::strtod(std::string(line.substr(space)).c_str(), nullptr) > static_cast<double>(bytes))
      return true;
  }
  return false;
}

/// Checks the parts common to every file of the format; assimp reads past the end of files without
/// them.
void check_head(std::string_view bytes, const std::string& ending, const std::string& name) {
  if (ending == "glb") {
    constexpr std::size_t kHead = 20;
    if (bytes.size() < kHead || !bytes.starts_with("glTF") ||
        little_endian(bytes, 8) != bytes.size() || little_endian(bytes, 12) > bytes.size() - kHead)
      throw unreadable(name, "its head does not tell its own size");
  } else if (ending == "stl") {
    constexpr std::size_t kHead = 84, kTriangle = 50;
    const bool binary = bytes.size() >= kHead &&
                        bytes.size() == kHead + kTriangle * std::size_t(little_endian(bytes, 80));
    const bool text = bytes.starts_with("solid") && bytes.find("endsolid") != bytes.npos;
    if (!binary && !text) throw unreadable(name, "it is neither text nor as long as its head says");
  } else if (ending == "ply") {
    if (!bytes.starts_with("ply") || bytes.find("end_header") == bytes.npos)
      throw unreadable(name, "it has no PLY header");
    if (counts_too_many(bytes.substr(0, bytes.find("end_header")), bytes.size()))
      throw unreadable(name, "its header counts more than the file can hold");
  }
}

/// Whether the line of an OBJ that begins at `at` has numbers: v, vn or vt.
bool has_numbers(std::string_view text, std::size_t at) {
  while (at < text.size() && (text[at] == ' ' || text[at] == '\t')) ++at;
  return at < text.size() && text[at] == 'v';
}

/// The text of an OBJ in a form that assimp reads correctly: numbers have a digit before their
/// point, and no line continues after a backslash. Assimp silently drops a vertex `v 0 1 .5`, and
/// all faces then refer to other vertices.
std::string plain_obj(std::string_view text, const std::string& name) {
  std::string plain;
  plain.reserve(text.size() + text.size() / 16);
  bool numbers = has_numbers(text, 0);
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    const bool returns = k + 2 < text.size() && text[k + 1] == '\r' && text[k + 2] == '\n';
    if (c == '\\' && k + 1 < text.size() && (text[k + 1] == '\n' || returns)) {
      plain.push_back(' ');
      k += returns ? 2 : 1;
      continue;
    }
    if (c == '#') numbers = false;
    if (numbers && c == ',') throw unreadable(name, "a number has a comma; OBJ has points");
    const char last = plain.empty() ? '\n' : plain.back();
    const bool begins = last == ' ' || last == '\t' || last == '-' || last == '+';
    if (numbers && c == '.' && begins) plain.push_back('0');
    plain.push_back(c);
    if (c == '\n') numbers = has_numbers(text, k + 1);
  }
  return plain;
}

/// Merges the meshes of a scene, and vertices at the same position.
class Welder {
 public:
  Welder(MeshFile& file, const std::string& name, const MeshFileLimits& limits, bool has_one_part)
      : file_(file), name_(name), limits_(limits), has_one_part_(has_one_part) {}

  void add(const aiMesh& mesh) {
    const bool has_uv = mesh.HasTextureCoords(0);
    place_.assign(mesh.mNumVertices, kNone);
    std::size_t number = 0;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices < 3) continue;
      const std::span<const unsigned> corners(face.mIndices, face.mNumIndices);
      for (const unsigned i : corners) {
        if (i >= mesh.mNumVertices) throw unreadable(name_, "a face names no vertex");
      }
      add_face(mesh, corners, ++number, has_uv);
      any_has_uv_ = any_has_uv_ || has_uv;
    }
  }

  /// A face without uv has all its corners in one place; its vertices have the uv of another face.
  void finish() {
    if (!any_has_uv_) {
      file_.uv.clear();
      file_.corner_uv.clear();
    }
    std::vector<bool> known(file_.uv.size(), false);
    for (std::size_t t = 0; t < file_.corner_uv.size(); ++t) {
      const CornerUv& corners = file_.corner_uv[t];
      if (corners[0] == corners[1] && corners[1] == corners[2]) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto vertex = static_cast<std::size_t>(file_.mesh.triangles[t][k]);
        if (!known[vertex]) file_.uv[vertex] = corners[k];
        known[vertex] = true;
      }
    }
  }

 private:
  void check(const char* what, std::size_t count, std::size_t most) const {
    if (count > most)
      throw DefinitionError("mesh", name_, "at most " + std::to_string(most) + " " + what);
  }

  /// @param number  of the face in its mesh, from 1
  void add_face(const aiMesh& mesh, std::span<const unsigned> corners, std::size_t number,
                bool has_uv) {
    if (corners.size() == 3)
      return add_triangle(mesh, {corners[0], corners[1], corners[2]}, has_uv);
    std::vector<Vec3d> places;
    for (const unsigned i : corners) {
      const aiVector3D& p = mesh.mVertices[i];
      check_place(p);
      places.emplace_back(p.x, p.y, p.z);
    }
    const PolygonCut cut = cut_polygon(places);
    if (!cut.limit.empty())
      throw DefinitionError("mesh", name_, cut.limit, face_name(number, places));
    if (!cut.has_area && file_.flat_face.empty()) file_.flat_face = face_name(number, places);
    for (const Triangle& t : cut.triangles) {
      const auto corner = [&](std::size_t k) { return corners[static_cast<std::size_t>(t[k])]; };
      add_triangle(mesh, {corner(0), corner(1), corner(2)}, has_uv);
    }
  }

  /// Tells where the face is found in the file. Assimp joins the objects of a material under the
  /// name of the last, so that names would mislead.
  std::string face_name(std::size_t number, const std::vector<Vec3d>& places) const {
    std::ostringstream text;
    text << "face " << number << (has_one_part_ ? "" : " of its material");
    text << ", with " << places.size() << " corners, the first at (" << places[0][0] << ", "
         << places[0][1] << ", " << places[0][2] << ")";
    return text.str();
  }

  void add_triangle(const aiMesh& mesh, const std::array<unsigned, 3>& corners, bool has_uv) {
    Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      Index& place = place_[corners[k]];
      if (place == kNone) place = weld(mesh, corners[k], has_uv);
      triangle[k] = place;
    }
    add_corners(mesh, corners, triangle, has_uv);
    file_.mesh.triangles.push_back(triangle);
    check("triangles", file_.mesh.triangles.size(), limits_.triangles);
  }

  void check_place(const aiVector3D& p) const {
    for (const float x : {p.x, p.y, p.z}) {
      if (!(std::abs(x) <= kFarthestFileVertex))
        throw unreadable(name_, "a vertex is not finite or far away");
    }
  }

  /// (u, v) of the corners as their vertices have them.
  CornerUv of_vertices(const Triangle& triangle) const {
    CornerUv corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = file_.uv[static_cast<std::size_t>(triangle[k])];
    return corners;
  }

  /// Keeps the uv of the next triangle's corners from the first seam on.
  void add_corners(const aiMesh& mesh, const std::array<unsigned, 3>& vertices,
                   const Triangle& triangle, bool has_uv) {
    CornerUv corners = {};
    for (std::size_t k = 0; has_uv && k < 3; ++k) corners[k] = uv_of(mesh, vertices[k]);
    if (file_.corner_uv.empty() && corners == of_vertices(triangle)) return;
    if (file_.corner_uv.empty()) {
      for (const Triangle& earlier : file_.mesh.triangles)
        file_.corner_uv.push_back(of_vertices(earlier));
    }
    file_.corner_uv.push_back(corners);
  }

  static std::array<double, 2> uv_of(const aiMesh& mesh, unsigned i) {
    return {mesh.mTextureCoords[0][i].x, mesh.mTextureCoords[0][i].y};
  }

  Index weld(const aiMesh& mesh, unsigned i, bool has_uv) {
    const aiVector3D& p = mesh.mVertices[i];
    // Before the search, because NaN has no place in an order.
    check_place(p);
    // Adding zero makes -0 and 0 equal.
    const std::array<float, 3> key = {p.x + 0.0F, p.y + 0.0F, p.z + 0.0F};
    const auto [there, is_new] =
        places_.insert({key, static_cast<Index>(file_.mesh.positions.size())});
    if (!is_new) return there->second;
    file_.mesh.positions.emplace_back(key[0], key[1], key[2]);
    file_.uv.push_back({0, 0});
    if (has_uv) file_.uv.back() = uv_of(mesh, i);
    check("vertices", file_.mesh.positions.size(), limits_.vertices);
    return there->second;
  }

  MeshFile& file_;
  const std::string& name_;
  const MeshFileLimits& limits_;
  const bool has_one_part_;
  std::map<std::array<float, 3>, Index> places_;
  std::vector<Index> place_;  // of the present mesh's vertices
  bool any_has_uv_ = false;
};

}  // namespace

bool is_mesh_file_name(std::string_view name) {
  const std::string ending = ending_of(name);
  return ending == "obj" || ending == "ply" || ending == "stl" || ending == "glb";
}

MeshFile read_mesh(std::string_view bytes, const std::string& name, const MeshFileLimits& limits) {
  if (!is_mesh_file_name(name))
    throw DefinitionError("mesh", name, "a name that ends in .obj, .ply, .stl or .glb");
  if (bytes.size() > limits.bytes)
    throw DefinitionError("mesh", name, "at most " + std::to_string(limits.bytes) + " bytes",
                          "it has " + std::to_string(bytes.size()));
  if (bytes.empty()) throw unreadable(name, "it is empty");
  // Many editors begin a text with this mark, which is no part of it.
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  const std::string ending = ending_of(name);
  check_head(bytes, ending, name);
  const std::string plain = ending == "obj" ? plain_obj(bytes, name) : std::string();
  if (ending == "obj") bytes = plain;
  Assimp::Importer importer;
  // Polygons stay whole: assimp's own triangles may reach outside them.
  const aiScene* scene = importer.ReadFileFromMemory(
      bytes.data(), bytes.size(), aiProcess_PreTransformVertices, ending.c_str());
  if (!scene) throw unreadable(name, importer.GetErrorString());
  MeshFile file;
  Welder welder(file, name, limits, scene->mNumMeshes == 1);
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) welder.add(*scene->mMeshes[m]);
  welder.finish();
  if (file.mesh.triangles.empty()) throw unreadable(name, "it has no triangles");
  close_seams(file);
  return file;
}

std::string encode_meshes(const std::vector<NamedMesh>& meshes, const std::string& name) {
  const std::string format = format_of(name);
  // Assimp's scene owns its members.
  aiScene scene;
  scene.mRootNode = new aiNode();
  scene.mMaterials = new aiMaterial* [1] { new aiMaterial() };
  scene.mNumMaterials = 1;
  scene.mNumMeshes = scene.mRootNode->mNumMeshes = static_cast<unsigned>(meshes.size());
  scene.mMeshes = new aiMesh*[meshes.size()];
  scene.mRootNode->mMeshes = new unsigned[meshes.size()];
  for (unsigned m = 0; m < meshes.size(); ++m) {
    const bool has_uv = format != "ply" && !meshes[m].corner_uv.empty();
    scene.mMeshes[m] = (has_uv ? by_corners(meshes[m]) : by_vertices(meshes[m])).release();
    scene.mRootNode->mMeshes[m] = m;
  }
  Assimp::Exporter exporter;
  const aiExportDataBlob* const blob = exporter.ExportToBlob(&scene, format);
  if (!blob) throw DefinitionError("out", name, "a mesh that fits", exporter.GetErrorString());
  return {static_cast<const char*>(blob->data), blob->size};
}

}  // namespace weft
