// Sizes the arrays of verlet.

#include <cassert>
#include <utility>

#include "core/solver/verlet.h"

namespace weft {

template <class Real>
void VerletWorkspace<Real>::prepare(const ClothModel<Real>& model, const SolverDef& solver,
                                    Executor* threads) {
  executor = threads;
  grids.clear();
  grids.resize(model.parts.size());
  meshes.assign(model.parts.size(), {});
  at_rest.assign(model.parts.size(), {});
  all_grids = true;
  bool listed = solver.damping_sweeps > 1;  // whether the model's force arrays are needed
  for (std::size_t p = 0; p < grids.size(); ++p) {
    grids[p].prepare(model.parts[p]);
    if (executor && grids[p].fits()) grids[p].allocate_bands();
    if (!grids[p].fits()) meshes[p].prepare(model, model.parts[p]);
    all_grids = all_grids && grids[p].fits();
    listed = listed || !kicks_at_once(model, p);
  }
  external.clear();
  remainder.assign(model.mass.size(), Vec3<Real>::Zero());
  internal.assign(listed ? model.mass.size() : 0, Vec3<Real>::Zero());
  velocity.assign(solver.damping_sweeps > 1 ? model.mass.size() : 0, Vec3<Real>::Zero());
  if (solver.damping_sweeps > 1) allocate_external(model, false, true);
}

template <class Real>
void VerletWorkspace<Real>::allocate_external(const ClothModel<Real>& model, bool air,
                                              bool impulses) {
  if (!air && !impulses) return;
  assert(grids.size() == model.parts.size() && "prepared for this model");
  for (GridPass<Real>& grid : grids) {
    if (grid.fits()) grid.allocate_external(air);
  }
  if (impulses || !all_grids) external.resize(model.mass.size(), Vec3<Real>::Zero());
}

template <class Real>
void VerletWorkspace<Real>::allocate_paths() {
  if (!all_grids) return;
  for (GridPass<Real>& grid : grids) grid.allocate_paths();
  loaded_paths = 0;
}

template <class Real>
void VerletWorkspace<Real>::load_paths(const CalmPaths<Real>& paths) {
  assert(all_grids && paths.number != 0);
  if (std::exchange(loaded_paths, paths.number) == paths.number) return;
  for (GridPass<Real>& grid : grids) grid.load_paths(paths.base, paths.velocity);
}

template <class Real>
std::size_t VerletWorkspace<Real>::bytes() const {
  std::size_t sum = 0;
  for (const Vec3Array<Real>* array : {&internal, &external, &velocity, &remainder})
    sum += array->capacity() * sizeof(Vec3<Real>);
  for (const GridPass<Real>& grid : grids) sum += grid.bytes();
  for (const MeshPass<Real>& mesh : meshes) sum += mesh.bytes();
  return sum;
}

template struct VerletWorkspace<float>;
template struct VerletWorkspace<double>;

}  // namespace weft
