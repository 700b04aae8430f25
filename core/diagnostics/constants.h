#pragma once

#include <cstddef>

// The numbers of the measurements.

namespace weft {

// The drape test.

/// Cusick's drape test (BS 5058): a round specimen of 30 cm lies centred on a disc of 18 cm, and
/// the overhang falls into folds. Larger or smaller: no longer the test of the literature, whose
/// coefficients the fabrics are compared with.
inline constexpr double kDrapeSupportRadius = 0.09;   ///< of the disc [m]
inline constexpr double kDrapeSpecimenRadius = 0.15;  ///< of the specimen [m]

/// Spacing of the points that sample the shadow [m]. Larger: a coarser coefficient. Smaller: time
/// and memory grow with the square.
inline constexpr double kShadowSpacing = 5e-4;

/// Directions around the hem [1]. More: a hem of few particles leaves gaps between them. Fewer:
/// narrow folds merge.
inline constexpr int kHemDirections = 180;

/// Particles of the hem that are nearer to its middle in the fabric, in radii of the disc [1], do
/// not count. Larger: less of an irregular hem is seen. Smaller: short overhangs, rescaled to a
/// round specimen, count as folds.
inline constexpr double kLeastHemRadius = 1.2;

/// Least rise of a fold on both sides [m]. Larger: shallow folds are not counted. Smaller: ripples
/// of the hem are.
inline constexpr double kLeastCrest = 2e-3;

// The cantilever test.

/// Largest sigma g L^3 / B of an elastica that is solved [1]. Larger: softer strips, which hang
/// nearly straight down, where the angle hardly depends on it. Smaller: soft strips count as
/// stiffer than they are.
inline constexpr double kLargestGamma = 1000;

/// Steps along an elastica, and halvings of the interval of its tip angle and of gamma [1]. More:
/// more exact (the angle is solved to 1e-5 rad), and slower: time is steps times halvings squared.
inline constexpr int kElasticaSteps = 500, kElasticaHalvings = 36;

// Errors from repetitions of a run.

/// Least observed order that is extrapolated [1]. Larger: contact, whose order is about a half, is
/// not measured. Smaller: runs that do not approach each other get an error all the same.
inline constexpr double kLeastOrder = 0.5;

/// An error is reported until noise exceeds both this fraction of it and this multiple of the noise
/// at the start [1]. Larger: reported errors are partly chance. Smaller: figures end while they
/// still hold.
inline constexpr double kNoiseFraction = 1.0 / 3, kNoiseGrowth = 10;

// The decay test.

/// Least amplitude that counts, as a fraction of the first [1]. Larger: fewer swings to average
/// over. Smaller: what rounding leaves counts.
inline constexpr double kSmallestSwing = 0.02;

/// Turning points from which a decay is computed [1]. Larger: later. Smaller: from too few.
inline constexpr std::size_t kFewestTurns = 4;

}  // namespace weft
