// Links crossings and decides how each contour is undone.

#include "core/contact/tangles/tangle_contours.h"

#include <algorithm>
#include <cassert>

#include "core/geometry/triangle_sides.h"

namespace weft {
namespace {

std::uint64_t key_of_triangles(Index a, Index b) {
  const auto [low, high] = std::minmax(a, b);
  return (static_cast<std::uint64_t>(low) << 32) | static_cast<std::uint64_t>(high);
}

constexpr std::array<Index, 2> kNoParticles = {kNone, kNone};

}  // namespace

template <class Real>
TangleContours::TangleContours(const ClothModel<Real>& model)
    : edges_(model.edges), triangles_(model.triangles), regions_(model) {
  const std::vector<TriangleSide> sides = sorted_sides(triangles_);
  for (const Edge& edge : model.edges) {
    auto found = std::lower_bound(
        sides.begin(), sides.end(), edge,
        [](const TriangleSide& side, const Edge& ends) { return side.ends < ends; });
    std::array<Index, 2> at = {kNone, kNone};
    for (std::size_t k = 0; k < 2 && found != sides.end() && found->ends == edge; ++k, ++found)
      at[k] = found->triangle;
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

/// Two triangles intersect in a segment, both ends of which are crossings of an edge of one with
/// the other; only one end is if they share a particle.
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

/// Collects a contour, starting at one of its crossings.
void TangleContours::follow(std::vector<TangleCrossing>& crossings, Index first) {
  assert(crossings[static_cast<std::size_t>(first)].contour == kNone);
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
      // Edges of the other sheet pass through the same triangle.
      d.side = d.triangle == c.triangle ? c.side : static_cast<std::uint8_t>(1 - c.side);
      break;
    }
    at = next;
  }
  contour.end = order_.size();
  contours_.push_back(contour);
}

/// Cuts the first sheet along a contour, or the second one, or both.
ContourRegions::Part TangleContours::cut(const std::vector<TangleCrossing>& crossings,
                                         const std::vector<char>& is_held,
                                         const TangleContour& contour, bool first, bool second) {
  assert(contour.begin < contour.end && contour.end <= order_.size());
  const std::array<Index, 2> folds = {
      fold_at(crossings[static_cast<std::size_t>(order_[contour.begin])]),
      fold_at(crossings[static_cast<std::size_t>(order_[contour.end - 1])])};
  cuts_.clear();
  for (std::size_t k = contour.begin; k < contour.end; ++k) {
    const TangleCrossing& c = crossings[static_cast<std::size_t>(order_[k])];
    if (c.side == 0 ? first : second) cuts_.push_back({c.edge, c.along, c.above});
  }
  return regions_.smaller_part(cuts_, first && second ? folds : kNoParticles, is_held);
}

void TangleContours::decide(const std::vector<TangleCrossing>& crossings,
                            const std::vector<char>& is_held, TangleContour& contour) {
  const TangleCrossing& first = crossings[static_cast<std::size_t>(order_[contour.begin])];
  const TangleCrossing& last = crossings[static_cast<std::size_t>(order_[contour.end - 1])];
  const auto is_fold = [&](const TangleCrossing& c) {
    return c.link[1] == kNone && triangles_of(c.edge)[1] != kNone && fold_at(c) != kNone;
  };
  // Between two folds both halves of the contour lie in one sheet and enclose a part of it.
  if (is_fold(first) && is_fold(last)) {
    const ContourRegions::Part part = cut(crossings, is_held, contour, true, true);
    if (part.side != 0) {
      contour.motion = TangleMotion::unfold;
      contour.wrong = part.side;
      return set_free(crossings, contour);
    }
  }
  const ContourRegions::Part parts[2] = {cut(crossings, is_held, contour, true, false),
                                         cut(crossings, is_held, contour, false, true)};
  if (parts[0].side != 0 || parts[1].side != 0) {
    contour.motion = TangleMotion::back;
    const bool take_first =
        parts[1].side == 0 || (parts[0].side != 0 && parts[0].area <= parts[1].area);
    contour.sheet = take_first ? 0 : 1;
    contour.wrong = parts[contour.sheet].side;
    if (take_first) cut(crossings, is_held, contour, true, false);
    return set_free(crossings, contour);
  }
  // At a fold both ends slide towards it.
  const bool from_fold = triangles_of(first.edge)[1] != kNone;
  contour.sheet = from_fold ? static_cast<std::uint8_t>(1 - last.side) : first.side;
  set_free(crossings, contour);
}

/// Lists the particles of the crossing features; of the sheet that was cut last only those on the
/// wrong side.
void TangleContours::set_free(const std::vector<TangleCrossing>& crossings,
                              TangleContour& contour) {
  contour.free_begin = free_.size();
  const auto add = [&](std::uint8_t sheet, const auto& particles) {
    const bool moves_back = contour.motion == TangleMotion::back && sheet == contour.sheet;
    const auto is_wrong = [&](Index i) { return regions_.is_on(i, contour.wrong); };
    // An edge that crosses twice has no end there.
    const bool some = moves_back && std::any_of(particles.begin(), particles.end(), is_wrong);
    for (const Index i : particles) {
      if (!some || is_wrong(i)) free_.push_back({sheet, i});
    }
  };
  for (std::size_t k = contour.begin; k < contour.end; ++k) {
    const TangleCrossing& c = crossings[static_cast<std::size_t>(order_[k])];
    add(c.side, edges_[static_cast<std::size_t>(c.edge)]);
    add(static_cast<std::uint8_t>(1 - c.side), triangles_[static_cast<std::size_t>(c.triangle)]);
  }
  contour.free_end = free_.size();
}

void TangleContours::join(std::vector<TangleCrossing>& crossings,
                          const std::vector<char>& is_held) {
  // Capacity for crossings that arise while it is undone, so that steps do not allocate.
  const std::size_t capacity = 4 * crossings.size();
  if (order_.capacity() < 2 * crossings.size()) {
    keys_.reserve(2 * capacity);
    contours_.reserve(capacity);
    order_.reserve(capacity);
    free_.reserve(5 * capacity);
    cuts_.reserve(capacity);
  }
  contours_.clear();
  order_.clear();
  free_.clear();
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
