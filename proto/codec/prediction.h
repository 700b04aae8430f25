#pragma once

#include <cstdint>
#include <span>

#include "proto/codec/lattice.h"
#include "proto/codec/order.h"

// What a vertex is expected to be: from earlier frames, and from its neighbours in this one.
// README.md section 10.

namespace weft::proto::codec {

/// From which frames a difference is formed.
enum class Base : std::uint8_t {
  none = 0,      ///< the numbers themselves
  step = 1,      ///< minus those of the reference
  straight = 2,  ///< minus those on the straight line through the two last frames
};

/// From which neighbours' differences one is predicted.
enum class Spatial : std::uint8_t {
  none = 0,
  mean = 1,    ///< of a and b
  corner = 2,  ///< of the parallelogram, a + b - c
  blend = 3,   ///< halfway between: 3/4 a + 3/4 b - 1/2 c, less moved by noise
};

struct Prediction {
  Base base = Base::none;
  Spatial spatial = Spatial::corner;
  bool operator==(const Prediction&) const = default;
};

/// Frames that both sides hold; null where there is none.
struct References {
  const Integers* last = nullptr;
  const Integers* before = nullptr;  ///< as many ticks before `last` as that is before the frame
};

inline std::uint32_t zigzag(std::uint32_t residual) {
  return (residual << 1U) ^ (0U - (residual >> 31U));
}
inline std::uint32_t unzigzag(std::uint32_t value) {
  return (value >> 1U) ^ (0U - (value & 1U));
}

/// Prediction of a value from its neighbours' values; arithmetic is modulo 2^32.
/// @param none  the place of what is missing
inline std::uint32_t predict(Spatial spatial, const std::uint32_t* values, const Neighbours& near,
                             std::uint32_t none) {
  if (spatial == Spatial::none) return 0;
  if (spatial == Spatial::corner) return values[near.a] + values[near.b] - values[near.c];
  if (near.b == none) return values[near.a];
  const std::uint32_t sum = values[near.a] + values[near.b];
  const auto halved = [](std::uint32_t value, int times) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(value) >> times);
  };
  return spatial == Spatial::mean ? halved(sum, 1) : halved(3 * sum - 2 * values[near.c] + 2, 2);
}

/// The difference of one component to its base, for all places and the missing one.
/// @param out  room for `count + 1`
void difference(Base base, const Integers& now, const References& references, int component,
                std::uint32_t* out);

/// Residuals, zigzag, of one component; the missing place gets 0.
void residuals_of(Spatial spatial, std::span<const Neighbours> neighbours,
                  const std::uint32_t* differences, std::uint32_t* out);

/// Undoes `residuals_of` and `difference`.
void restore(const Prediction& prediction, std::span<const Neighbours> neighbours,
             const References& references, int component, const std::uint32_t* residuals,
             std::uint32_t* differences, Integers& out);

/// The prediction that leaves least, judged by every 17th vertex.
Prediction choose_prediction(std::span<const Neighbours> neighbours, const Integers& now,
                             const References& references);

}  // namespace weft::proto::codec
