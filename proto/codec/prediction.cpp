#include "proto/codec/prediction.h"

#include <array>
#include <bit>
#include <cassert>
#include <cstddef>

namespace weft::proto::codec {
namespace {

constexpr std::uint32_t kSampleStride = 17;
// What a residual costs, in tenths of a bit: a zero 0.6, another its length and 1.3.
constexpr std::uint32_t kZeroCost = 6, kBitCost = 10, kSignCost = 13;

constexpr std::array<Spatial, 4> kSpatials = {Spatial::none, Spatial::mean, Spatial::corner,
                                              Spatial::blend};
using Costs = std::array<std::uint64_t, kSpatials.size()>;

/// Views on one component of a frame and of its references.
struct Component {
  const std::int32_t* now;
  const std::int32_t* last;
  const std::int32_t* before;

  std::uint32_t at(Base base, std::uint32_t place) const {
    const auto k = static_cast<std::uint32_t>(now[place]);
    if (base == Base::none) return k;
    const auto k1 = static_cast<std::uint32_t>(last[place]);
    if (base == Base::step) return k - k1;
    return k - 2 * k1 + static_cast<std::uint32_t>(before[place]);
  }
};

/// Without a branch, as whether a residual is 0 is as good as random.
std::uint32_t cost_of(std::uint32_t residual) {
  const std::uint32_t sign = 0U - (residual >> 31U);
  const std::uint32_t magnitude = (residual ^ sign) - sign;
  const auto bits = static_cast<std::uint32_t>(std::bit_width(magnitude | 1U));
  return magnitude == 0 ? kZeroCost : kBitCost * bits + kSignCost;
}

/// Adds to the costs of each spatial prediction what one vertex costs.
void add_costs(const Component& component, Base base, std::uint32_t place, const Neighbours& near,
               std::uint32_t none, Costs& costs) {
  const std::uint32_t value = component.at(base, place);
  // The place behind them is that of what is missing.
  const std::array<std::uint32_t, 4> around = {
      component.at(base, near.a), component.at(base, near.b), component.at(base, near.c), 0};
  const Neighbours local{0, near.b == none ? 3U : 1U, 2};
  for (std::size_t s = 0; s < kSpatials.size(); ++s)
    costs[s] += cost_of(value - predict(kSpatials[s], around.data(), local, 3));
}

}  // namespace

void difference(Base base, const Integers& now, const References& references, int component,
                std::uint32_t* out) {
  const Component planes{now.plane(component),
                         references.last ? references.last->plane(component) : nullptr,
                         references.before ? references.before->plane(component) : nullptr};
  const std::uint32_t end = now.count + 1;
  if (base == Base::none)
    for (std::uint32_t i = 0; i < end; ++i) out[i] = planes.at(Base::none, i);
  else if (base == Base::step)
    for (std::uint32_t i = 0; i < end; ++i) out[i] = planes.at(Base::step, i);
  else
    for (std::uint32_t i = 0; i < end; ++i) out[i] = planes.at(Base::straight, i);
}

void residuals_of(Spatial spatial, std::span<const Neighbours> neighbours,
                  const std::uint32_t* differences, std::uint32_t* out) {
  const auto none = static_cast<std::uint32_t>(neighbours.size());
  const auto fill = [&](auto&& prediction) {
    for (std::uint32_t i = 0; i < none; ++i)
      out[i] = zigzag(differences[i] - prediction(neighbours[i]));
  };
  if (spatial == Spatial::none)
    fill([](const Neighbours&) { return 0U; });
  else if (spatial == Spatial::mean)
    fill([&](const Neighbours& near) { return predict(Spatial::mean, differences, near, none); });
  else if (spatial == Spatial::corner)
    fill([&](const Neighbours& near) { return predict(Spatial::corner, differences, near, none); });
  else
    fill([&](const Neighbours& near) { return predict(Spatial::blend, differences, near, none); });
  out[none] = 0;
}

void restore(const Prediction& prediction, std::span<const Neighbours> neighbours,
             const References& references, int component, const std::uint32_t* residuals,
             std::uint32_t* differences, Integers& out) {
  const auto none = static_cast<std::uint32_t>(neighbours.size());
  differences[none] = 0;
  const auto sum_up = [&](Spatial spatial) {
    for (std::uint32_t i = 0; i < none; ++i)
      differences[i] = unzigzag(residuals[i]) + predict(spatial, differences, neighbours[i], none);
  };
  if (prediction.spatial == Spatial::none)
    sum_up(Spatial::none);
  else if (prediction.spatial == Spatial::mean)
    sum_up(Spatial::mean);
  else if (prediction.spatial == Spatial::corner)
    sum_up(Spatial::corner);
  else
    sum_up(Spatial::blend);
  const std::int32_t* const last = references.last ? references.last->plane(component) : nullptr;
  const std::int32_t* const before =
      references.before ? references.before->plane(component) : nullptr;
  std::int32_t* const plane = out.plane(component);
  for (std::uint32_t i = 0; i < none; ++i) {
    std::uint32_t k = differences[i];
    if (prediction.base != Base::none) k += static_cast<std::uint32_t>(last[i]);
    if (prediction.base == Base::straight)
      k += static_cast<std::uint32_t>(last[i]) - static_cast<std::uint32_t>(before[i]);
    plane[i] = static_cast<std::int32_t>(k);
  }
}

Prediction choose_prediction(std::span<const Neighbours> neighbours, const Integers& now,
                             const References& references) {
  assert(!references.before || references.last);
  const auto none = static_cast<std::uint32_t>(neighbours.size());
  std::array<Costs, 3> costs{};
  for (int c = 0; c < 3; ++c) {
    const Component component{now.plane(c), references.last ? references.last->plane(c) : nullptr,
                              references.before ? references.before->plane(c) : nullptr};
    for (std::uint32_t i = 1; i < none; i += kSampleStride) {
      add_costs(component, Base::none, i, neighbours[i], none, costs[0]);
      if (references.last) add_costs(component, Base::step, i, neighbours[i], none, costs[1]);
      if (references.before) add_costs(component, Base::straight, i, neighbours[i], none, costs[2]);
    }
  }
  // Without a reference neighbours always span a corner; with one it decides by cost.
  Prediction best{Base::none, Spatial::corner};
  std::uint64_t least = costs[0][2];
  const std::size_t bases = references.before ? 3 : references.last ? 2 : 1;
  for (std::size_t b = 1; b < bases; ++b)
    for (std::size_t s = 0; s < kSpatials.size(); ++s) {
      if (costs[b][s] >= least) continue;
      least = costs[b][s];
      best = {static_cast<Base>(b), kSpatials[s]};
    }
  return best;
}

}  // namespace weft::proto::codec
