#pragma once

#include <vector>

#include "core/scenes/scene_parts.h"

// The scenes of the seed's paper.

namespace weft {

/// The figures and experiments of H.-H. Cheng, "Interactive Cloth Simulation", with its model
/// (`model: seed`): Figs. 4, 8, 9, 10 (experiment V.B.1), 11 (V.B.2), 12 (V.B.3), 14 (V.B.4), 15
/// (V.B.5) and 16 (V.B.6). Numbers that the paper does not give are ours.
std::vector<SceneEntry> seed_scenes();

}  // namespace weft
