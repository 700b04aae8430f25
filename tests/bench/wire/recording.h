#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "proto/codec/order.h"

namespace weft::bench {

/// Frames of a cloth in motion, in the order of one mesh.
struct Recording {
  std::string motion, mesh;                ///< "gusts" or "calm"; "grid", "mesh", "random"
  double mean_speed = 0;                   ///< of all vertices over all frames [m/s]
  std::vector<std::vector<float>> frames;  ///< three per vertex [m]
  std::vector<std::uint32_t> triangles;
  proto::codec::ClothRange cloth;
};

/// Square cloths of `side` x `side` particles in the wind: strong gusts, and a breath of air that
/// moves it by millimetres a second.
/// @param frames  at 60 a second, after two seconds to get going
Recording record_motion(const std::string& motion, int side, int frames);

/// A cloth of the same size in the same wind that comes from a mesh: about as many vertices, moved
/// off a grid's by up to a fifth of its cell, diagonals drawn at random, triangles with one strain
/// each.
Recording record_random_mesh(const std::string& motion, int side, int frames);

/// The same motion as if the cloth were an imported mesh: diagonals both ways, vertices numbered at
/// random.
Recording as_mesh(const Recording& grid);

}  // namespace weft::bench
