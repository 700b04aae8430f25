#include "core/geometry/mesh_file.h"

#include <memory>

#include <assimp/Exporter.hpp>
#include <assimp/scene.h>

#include "core/error.h"

// The only file that includes assimp.

namespace weft {
namespace {

/// Assimp's name of the format that the ending stands for; OBJ without a material file beside it.
std::string format_of(const std::string& path) {
  const auto ends_with = [&](const std::string& ending) {
    return path.size() > ending.size() &&
           path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
  };
  if (ends_with(".obj")) return "objnomtl";
  if (ends_with(".ply")) return "ply";
  throw DefinitionError("out", path, "a name that ends in .obj or .ply");
}

std::unique_ptr<aiMesh> to_assimp(const TriangleMesh& mesh) {
  auto result = std::make_unique<aiMesh>();
  result->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  result->mNumVertices = static_cast<unsigned>(mesh.positions.size());
  result->mVertices = new aiVector3D[mesh.positions.size()];
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3d& p = mesh.positions[i];
    result->mVertices[i] = aiVector3D(static_cast<ai_real>(p[0]), static_cast<ai_real>(p[1]),
                                      static_cast<ai_real>(p[2]));
  }
  result->mNumFaces = static_cast<unsigned>(mesh.triangles.size());
  result->mFaces = new aiFace[mesh.triangles.size()];
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    result->mFaces[t].mNumIndices = 3;
    result->mFaces[t].mIndices = new unsigned[3];
    for (std::size_t k = 0; k < 3; ++k)
      result->mFaces[t].mIndices[k] = static_cast<unsigned>(mesh.triangles[t][k]);
  }
  return result;
}

}  // namespace

void write_mesh(const TriangleMesh& mesh, const std::string& path) {
  const std::string format = format_of(path);
  // Assimp's scene owns what it points to.
  aiScene scene;
  scene.mRootNode = new aiNode();
  scene.mMaterials = new aiMaterial* [1] { new aiMaterial() };
  scene.mNumMaterials = 1;
  scene.mMeshes = new aiMesh* [1] { to_assimp(mesh).release() };
  scene.mNumMeshes = 1;
  scene.mRootNode->mMeshes = new unsigned[1]{0};
  scene.mRootNode->mNumMeshes = 1;
  Assimp::Exporter exporter;
  if (exporter.Export(&scene, format, path) != aiReturn_SUCCESS)
    throw DefinitionError("out", path, "a file that can be written", exporter.GetErrorString());
}

}  // namespace weft
