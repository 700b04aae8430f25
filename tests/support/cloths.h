#pragma once

#include "core/cloth/cloth_def.h"
#include "core/cloth/cloth_model.h"
#include "tests/support/random.h"

namespace weft::test {

/// A square metre of a soft fabric, flat in the plane y = 0. On square cells its structural springs
/// have 200 N/m and its shear springs 20 N/m.
inline ClothDef flat_cloth(int rows, int columns, double width = 1, double height = 1) {
  ClothDef def;
  def.rows = rows;
  def.columns = columns;
  def.width = width;
  def.height = height;
  def.u = Vec3d::UnitX();
  def.v = Vec3d::UnitZ();
  def.fabric.stretch_warp = def.fabric.stretch_weft = 220;
  def.fabric.shear = 20;
  return def;
}

/// The rest positions with every coordinate moved at random by up to `size` [m].
template <class Real>
Vec3Array<Real> shaken(const ClothModel<Real>& model, double size, Random& random) {
  Vec3Array<Real> x = model.rest_positions;
  for (Vec3<Real>& p : x) p += random.vector(size).template cast<Real>();
  return x;
}

template <class Real>
Vec3Array<Real> random_velocities(const ClothModel<Real>& model, double size, Random& random) {
  Vec3Array<Real> v(model.mass.size());
  for (Vec3<Real>& p : v) p = random.vector(size).template cast<Real>();
  return v;
}

}  // namespace weft::test
