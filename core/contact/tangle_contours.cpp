#include "core/contact/tangle_contours.h"

#include <algorithm>

namespace weft {
namespace {

std::uint64_t key_of_triangles(Index a, Index b) {
  const auto [low, high] = std::minmax(a, b);
  return (static_cast<std::uint64_t>(low) << 32) | static_cast<std::uint64_t>(high);
}

}  // namespace

template <class Real>
TangleContours::TangleContours(const ClothModel<Real>& model)
    : triangles_(model.triangles), regions_(model) {
  std::vector<std::pair<Edge, Index>> sides;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(triangles_[t][k], triangles_[t][(k + 1) % 3]);
      sides.push_back({{a, b}, static_cast<Index>(t)});
    }
  }
  std::sort(sides.begin(), sides.end());
  for (const Edge& e : model.edges) {
    const auto [a, b] = std::minmax(e[0], e[1]);
    const Edge sorted = {a, b};
    auto found = std::lower_bound(sides.begin(), sides.end(), std::pair<Edge, Index>{sorted, 0});
    std::array<Index, 2> at = {kNone, kNone};
    for (std::size_t k = 0; k < 2 && found != sides.end() && found->first == sorted; ++k, ++found)
      at[k] = found->second;
    triangles_of_.push_back(at);
  }
}

Index TangleContours::fold_at(const TangleCrossing& crossing) const {
  const Triangle& through = triangles_[static_cast<std::size_t>(crossing.triangle)];
  for (const Index t : triangles_of(crossing.edge)) {
    if (t == kNone) continue;
    for (const Index i : triangles_[static_cast<std::size_t>(t)]) {
      if (std::find(through.begin(), through.end(), i) != through.end()) return i;
    }
  }
  return kNone;
}

/// Two triangles meet in a piece of line, both ends of which are crossings of an edge of the one
/// with the other; only one is, where they share a particle.
void TangleContours::link(std::vector<TangleCrossing>& crossings) {
  keys_.clear();
  for (std::size_t c = 0; c < crossings.size(); ++c) {
    for (const Index t : triangles_of(crossings[c].edge)) {
      if (t != kNone)
        keys_.push_back({key_of_triangles(t, crossings[c].triangle), static_cast<Index>(c)});
    }
  }
  std::sort(keys_.begin(), keys_.end());
  const auto tie = [&](Index from, Index to) {
    auto& link = crossings[static_cast<std::size_t>(from)].link;
    link[link[0] == kNone ? 0 : 1] = to;
  };
  for (std::size_t k = 0; k + 1 < keys_.size(); ++k) {
    if (keys_[k].first != keys_[k + 1].first || keys_[k].second == keys_[k + 1].second) continue;
    tie(keys_[k].second, keys_[k + 1].second);
    tie(keys_[k + 1].second, keys_[k].second);
    ++k;
  }
}

/// Collects a contour from one of its crossings on.
void TangleContours::follow(std::vector<TangleCrossing>& crossings, Index first) {
  TangleContour contour;
  contour.begin = order_.size();
  const auto number = static_cast<Index>(contours_.size());
  crossings[static_cast<std::size_t>(first)].side = 0;
  for (Index at = first; at != kNone;) {
    TangleCrossing& c = crossings[static_cast<std::size_t>(at)];
    c.contour = number;
    order_.push_back(at);
    Index next = kNone;
    for (const Index to : c.link) {
      if (to == kNone || crossings[static_cast<std::size_t>(to)].contour != kNone) continue;
      next = to;
      TangleCrossing& d = crossings[static_cast<std::size_t>(to)];
      // Through the same triangle go edges of the other sheet.
      d.side = d.triangle == c.triangle ? c.side : static_cast<std::uint8_t>(1 - c.side);
      break;
    }
    at = next;
  }
  contour.end = order_.size();
  contours_.push_back(contour);
}

void TangleContours::decide(const std::vector<TangleCrossing>& crossings,
                            const std::vector<char>& is_held, TangleContour& contour) {
  double least = 0;
  for (std::uint8_t side = 0; side < 2; ++side) {
    cuts_.clear();
    for (std::size_t k = contour.begin; k < contour.end; ++k) {
      const TangleCrossing& c = crossings[static_cast<std::size_t>(order_[k])];
      if (c.side == side) cuts_.push_back({c.edge, c.along, c.above});
    }
    const ContourRegions::Part part = regions_.smaller_part(cuts_, is_held);
    if (part.side == 0 || (contour.wrong != 0 && part.area >= least)) continue;
    contour.wrong = part.side;
    contour.sheet = side;
    least = part.area;
  }
  const TangleCrossing& first = crossings[static_cast<std::size_t>(order_[contour.begin])];
  const TangleCrossing& last = crossings[static_cast<std::size_t>(order_[contour.end - 1])];
  // At a fold both ends slide towards it.
  const bool from_fold = triangles_of(first.edge)[1] != kNone;
  contour.slides = from_fold ? static_cast<std::uint8_t>(1 - last.side) : first.side;
}

void TangleContours::join(std::vector<TangleCrossing>& crossings,
                          const std::vector<char>& is_held) {
  contours_.clear();
  order_.clear();
  link(crossings);
  const auto is_free = [&](std::size_t c) { return crossings[c].contour == kNone; };
  for (std::size_t c = 0; c < crossings.size(); ++c) {
    if (is_free(c) && crossings[c].link[1] == kNone) follow(crossings, static_cast<Index>(c));
  }
  for (std::size_t c = 0; c < crossings.size(); ++c) {
    if (is_free(c)) follow(crossings, static_cast<Index>(c));
  }
  for (TangleContour& contour : contours_) decide(crossings, is_held, contour);
}

template TangleContours::TangleContours(const ClothModel<float>&);
template TangleContours::TangleContours(const ClothModel<double>&);

}  // namespace weft
