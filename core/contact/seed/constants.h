#pragma once

#include <cstddef>

// The numbers that the seed's contact assumes.

namespace weft {

/// Particles of one cloth within this many thicknesses in the fabric are neighbours [1]. Larger:
/// sharp folds pass through themselves. Smaller: contact between them pushes the cloth apart.
inline constexpr double kSeedNeighbourhood = 1.5;

/// Faces that bend outwards by less than this form no sharp edge [cosine of 20 degrees]. Larger:
/// more edges to test, also on round meshes. Smaller: an edge may cut into cloth between its
/// particles.
inline constexpr double kSharpEdgeCosine = 0.94;

/// Edges that are closest this near to an end, as a fraction of their length, form no pair [1]: the
/// particle or vertex there represents them. Larger: edges may pass each other near their ends.
/// Smaller: one contact counts as edge and as particle.
inline constexpr double kSeedEdgeEnd = 0.01;

/// Initial capacity for pairs, per particle [1]; it grows on demand. Larger: more memory. Smaller:
/// the list grows in the midst of a tick.
inline constexpr std::size_t kSeedPairsPerParticle = 8;

}  // namespace weft
