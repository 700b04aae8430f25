// Takes the meshes of cloths out of their common model.

#include "core/cloth/cloth_meshes.h"

#include "core/cloth/corner_places.h"

namespace weft {

template <class Real>
std::vector<NamedMesh> cloth_meshes(const ClothModel<Real>& model, const Vec3Array<Real>& x) {
  std::vector<NamedMesh> meshes;
  for (const ClothPart<Real>& part : model.parts) {
    NamedMesh& named = meshes.emplace_back();
    named.name = part.name;
    for (Index i = part.particles.first; i < part.particles.end(); ++i)
      named.mesh.positions.push_back(x[static_cast<std::size_t>(i)].template cast<double>());
    for (Index t = part.triangles.first; t < part.triangles.end(); ++t) {
      Triangle corners = model.triangles[static_cast<std::size_t>(t)];
      for (Index& i : corners) i -= part.particles.first;
      named.mesh.triangles.push_back(corners);
      named.corner_uv.push_back(corner_places(model, t));
    }
  }
  return meshes;
}

template std::vector<NamedMesh> cloth_meshes(const ClothModel<float>&, const Vec3Array<float>&);
template std::vector<NamedMesh> cloth_meshes(const ClothModel<double>&, const Vec3Array<double>&);

}  // namespace weft
