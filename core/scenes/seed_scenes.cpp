// Builds the figures and experiments of the seed's paper.

#include "core/scenes/seed_scenes.h"

#include <cassert>
#include <numbers>

namespace weft {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Common to all of them: the seed's model, particles of equal mass, and rigid springs.
void use_seed(WorldDef& def) {
  def.model = Model::seed;
  for (ClothDef& cloth : def.cloths) {
    cloth.mass_lumping = MassLumping::equal;
    cloth.bending_model = BendingModel::sine_hinges;
    cloth.fabric.bending_warp = cloth.fabric.bending_weft = 0;
    cloth.fabric.thickness = 0.01;
  }
  def.relaxation.substeps = 8;
  def.relaxation.sweeps = 10;
  def.relaxation.damping = 0.04;
  def.contact.seed.lift = 0.004;
  def.contact.seed.passes = 4;
}

/// A square cloth that falls on a ball, as in Figs. 4, 11 and 12.
void drop_on_ball(WorldDef& def, double side, const SphereDef& ball) {
  def.cloths[0] = lying_cloth(33, side, 1.1);
  // Turned over: positive rest angles curl the cloth downwards.
  def.cloths[0].origin[2] *= -1;
  def.cloths[0].v *= -1;
  use_seed(def);
  def.colliders = {ground(), {"ball", ball}};
}

/// Fig. 4: one cloth with different bending.
void build_fig4(WorldDef& def, double bending, double rest_angle) {
  assert(bending >= 0);
  drop_on_ball(def, 1.2, {Vec3d(0, 0.75, 0), 0.28});
  def.contact.seed.self = SelfContact::triangles;
  ClothDef& cloth = def.cloths[0];
  cloth.rest_angle = rest_angle;
  cloth.fabric.bending_warp = cloth.fabric.bending_weft = bending;
  cloth.fabric.bending_damping = bending > 0 ? 0.005 : 0;
}

void build_fig4_no_bending(WorldDef& def, const std::string&) {
  build_fig4(def, 0, 0);
}
void build_fig4_rest_angle(WorldDef& def, const std::string&) {
  build_fig4(def, 1e-3, 15 * kDegree);
}

/// Fig. 8: a cloth lowered on the ground edge first, which lies in folds.
void build_fig8(WorldDef& def, Correction correction) {
  def.cloths[0] = lying_cloth(33, 1.2, 0.35);
  use_seed(def);
  def.cloths[0].fabric.bending_warp = def.cloths[0].fabric.bending_weft = 2e-5;
  def.contact.seed.correction = correction;
  def.contact.seed.fold_depth = 0.05;
  def.contact.seed.self = SelfContact::triangles;
  def.colliders = {ground(), {"ball", SphereDef{Vec3d(0, 0.12, 0), 0.12}}};
}

void build_fig8_projection(WorldDef& def, const std::string&) {
  build_fig8(def, Correction::projection);
}
void build_fig8_fold_map(WorldDef& def, const std::string&) {
  build_fig8(def, Correction::fold_map);
}

/// Figs. 11 and 12: a cloth without bending that falls on itself in folds, on a ball so small that
/// they press together.
void build_self_collision(WorldDef& def, SelfContact self) {
  drop_on_ball(def, 1.4, {Vec3d(0, 0.86, 0), 0.16});
  def.contact.seed.self = self;
}

void build_fig11(WorldDef& def, const std::string&) {
  build_self_collision(def, SelfContact::particles);
}
void build_fig12(WorldDef& def, const std::string&) {
  build_self_collision(def, SelfContact::triangles);
}

/// Fig. 9: the default scene, with the seed's model.
void build_fig9(WorldDef& def, const std::string& mesh_directory) {
  const std::string name = def.name, description = def.description;
  def = make_scene("default", mesh_directory);
  def.name = name;
  def.description = description;
  use_seed(def);
  // Adds the third kind of springs. Rigid springs only need to exist.
  def.cloths[0].skip_stiffness = 1;
}

/// Fig. 10, experiment V.B.1: a cloth on a model with a sharp ridge.
void build_fig10(WorldDef& def, ObjectContact objects) {
  def.cloths[0] = lying_cloth(25, 1.1, 0.75);
  use_seed(def);
  def.contact.seed.objects = objects;
  def.contact.seed.self = SelfContact::triangles;
  def.colliders = {ground(), {"gable", mesh_object("gable", {}, {})}};
}

void build_fig10_sharp_edge(WorldDef& def, const std::string&) {
  build_fig10(def, ObjectContact::particles);
}
void build_fig10_edge_pairs(WorldDef& def, const std::string&) {
  build_fig10(def, ObjectContact::particles_and_edges);
}

/// A sheet in the air, for experiments with pins.
void hang_sheet(WorldDef& def, double height) {
  def.cloths[0] = lying_cloth(25, 1.0, height);
  use_seed(def);
  def.contact.seed.self = SelfContact::triangles;
  def.colliders = {ground()};
}

/// Figs. 13 and 14, experiment V.B.4: a sheet pinned at five particles.
void build_fig14(WorldDef& def, const std::string&) {
  hang_sheet(def, 1.3);
  for (const MaterialPoint point : {MaterialPoint{0.25, 0.25}, MaterialPoint{0.75, 0.25},
                                    MaterialPoint{0.25, 0.75}, MaterialPoint{0.75, 0.75}})
    def.pins.push_back({point, 0, {}});
}

/// Fig. 15, experiment V.B.5: a sheet pinned at its four corners.
void build_fig15(WorldDef& def, const std::string&) {
  hang_sheet(def, 1.5);
  for (const Corner corner :
       {Corner::top_left, Corner::top_right, Corner::bottom_left, Corner::bottom_right})
    def.pins.push_back({corner, 0, {}});
}

/// Fig. 16, experiment V.B.6: a hanging cloth to pull at.
void build_fig16(WorldDef& def, const std::string&) {
  def.cloths[0] = hanging_cloth(25, 25, 1.0, 1.0, 1.6, 0);
  use_seed(def);
  def.contact.seed.self = SelfContact::triangles;
  def.colliders = {ground()};
  for (const Corner corner : {Corner::top_left, Corner::top_right})
    def.pins.push_back({corner, 0, {}});
}

}  // namespace

std::vector<SceneEntry> seed_scenes() {
  return {
      {{"seed-fig4-no-bending",
        "A cloth without bending falls on a ball: it hangs in narrow folds with sharp wrinkles."},
       build_fig4_no_bending},
      {{"seed-fig4-rest-angle",
        "The same cloth with hinges at rest at 15 degrees: it curls, and wrinkles give way to "
        "round folds."},
       build_fig4_rest_angle},
      {{"seed-fig8-projection",
        "A cloth that sinks into the ground is projected onto it: watch its folds flatten."},
       build_fig8_projection},
      {{"seed-fig8-fold-map",
        "The same cloth, lifted by the map that keeps the order in depth: its folds stay."},
       build_fig8_fold_map},
      {{"seed-fig9-default",
        "The default scene by the seed's model: compare the cloth on the form with the default."},
       build_fig9},
      {{"seed-fig10-sharp-edge",
        "A cloth falls over a sharp ridge, held by its particles alone: the ridge cuts through."},
       build_fig10_sharp_edge},
      {{"seed-fig10-edge-pairs",
        "The same cloth with pairs of edges too, which the seed lacked: the ridge stays "
        "below."},
       build_fig10_edge_pairs},
      {{"seed-fig11-particle-pairs",
        "A cloth falls in folds upon itself, with pairs of particles: watch folds cut through "
        "folds below the ball."},
       build_fig11},
      {{"seed-fig12-triangle-pairs",
        "The same cloth with pairs of particles and triangles: its folds stay apart."},
       build_fig12},
      {{"seed-fig14-fixing",
        "A sheet is fixed at four particles: turn the view, and fix and free others with M."},
       build_fig14},
      {{"seed-fig15-corners",
        "A sheet hangs by its four corners: free them one by one with M, then drag what is left."},
       build_fig15},
      {{"seed-fig16-drag",
        "A cloth hangs by two corners: pull it anywhere and watch the pull run through it."},
       build_fig16},
  };
}

}  // namespace weft
