// Grounds, cloths and meshes for built-in scenes.

#include "core/scenes/scene_parts.h"

#include <cassert>

#include "core/scenes/built_in_meshes.h"

namespace weft {

ColliderDef ground() {
  return {"ground", PlaneDef{}};
}

ClothDef hanging_cloth(int rows, int columns, double width, double height, double top,
                       double depth) {
  assert(rows >= 2 && columns >= 2 && width > 0 && height > 0);
  ClothDef cloth;
  cloth.rows = rows;
  cloth.columns = columns;
  cloth.width = width;
  cloth.height = height;
  cloth.origin = Vec3d(-width / 2, top, depth);
  return cloth;
}

ClothDef lying_cloth(int particles, double side, double height) {
  assert(particles >= 2 && side > 0);
  ClothDef cloth;
  cloth.rows = cloth.columns = particles;
  cloth.width = cloth.height = side;
  cloth.origin = Vec3d(-side / 2, height, -side / 2);
  cloth.v = Vec3d::UnitZ();
  return cloth;
}

MeshDef mesh_object(const std::string& name, const std::string& mesh_directory,
                    MeshPlacement placement) {
  placement.source = name;
  return {placed(built_in_mesh(name, mesh_directory).mesh, placement), placement};
}

}  // namespace weft
