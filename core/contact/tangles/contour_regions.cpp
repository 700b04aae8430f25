// Floods a sheet from both sides of a line.

#include "core/contact/tangles/contour_regions.h"

#include <algorithm>
#include <cassert>

#include "core/contact/tangles/constants.h"

namespace weft {

template <class Real>
ContourRegions::ContourRegions(const ClothModel<Real>& model)
    : edges_(model.edges), neighbours_(model.mass.size(), model.edges) {
  const std::size_t n = model.mass.size();
  area_.assign(n, 0);
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    for (const Index i : model.triangles[t])
      area_[static_cast<std::size_t>(i)] += static_cast<double>(model.triangle_area[t]) / 3;
  }
  is_cut_.assign(edges_.size(), 0);
  reached_.assign(n, 0);
  for (Flood& flood : floods_) flood.particles.reserve(n);
}

void ContourRegions::seed(Index particle, std::size_t side, const std::vector<char>& is_held) {
  assert(side < 2);
  if (particle == through_[0] || particle == through_[1]) return;
  const auto i = static_cast<std::size_t>(particle);
  const std::uint32_t mark = 2 * search_ + static_cast<std::uint32_t>(side);
  if (reached_[i] == mark) return;
  if (reached_[i] / 2 == search_) {
    meet_ = true;
    return;
  }
  reached_[i] = mark;
  floods_[side].particles.push_back(particle);
  floods_[side].area += area_[i];
  floods_[side].held |= is_held[i] != 0;
}

/// Continues from one particle to its neighbours.
/// @return whether there was one left
bool ContourRegions::spread(std::size_t side, const std::vector<char>& is_held) {
  assert(side < 2);
  Flood& flood = floods_[side];
  if (flood.next == flood.particles.size()) return false;
  const auto i = static_cast<std::size_t>(flood.particles[flood.next++]);
  for (const auto& neighbour : neighbours_.of(i)) {
    if (is_cut_[static_cast<std::size_t>(neighbour.edge)] == search_) continue;
    seed(neighbour.particle, side, is_held);
  }
  return true;
}

bool ContourRegions::fill(std::size_t side, const std::vector<char>& is_held) {
  while (!meet_ && spread(side, is_held)) {
  }
  return !meet_;
}

void ContourRegions::begin() {
  ++search_;
  meet_ = false;
  for (Flood& flood : floods_) {
    flood.particles.clear();
    flood.next = 0;
    flood.area = 0;
    flood.held = false;
  }
}

ContourRegions::Part ContourRegions::smaller_part(std::vector<EdgeCut>& cuts,
                                                  const std::array<Index, 2>& through,
                                                  const std::vector<char>& is_held) {
  assert(is_held.size() == area_.size());
  if (cuts.empty()) return {};
  begin();
  through_ = through;
  std::sort(cuts.begin(), cuts.end(), [](const EdgeCut& a, const EdgeCut& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.along < b.along;
  });
  for (std::size_t k = 0, last = 0; k < cuts.size(); k = last + 1) {
    for (last = k; last + 1 < cuts.size() && cuts[last + 1].edge == cuts[k].edge;) ++last;
    const Edge& edge = edges_[static_cast<std::size_t>(cuts[k].edge)];
    // Only particles next to an end determine its side.
    const bool first = cuts[k].above, second = !cuts[last].above;
    if (first != second) is_cut_[static_cast<std::size_t>(cuts[k].edge)] = search_;
    seed(edge[0], first ? 1 : 0, is_held);
    seed(edge[1], second ? 1 : 0, is_held);
  }
  // From both sides in turn: the smaller part is known once it is exhausted.
  std::size_t small = 0;
  for (bool going = true; going && !meet_;) {
    for (small = 0; small < 2 && (going = spread(small, is_held)); ++small) {
    }
  }
  if (meet_) return {};
  if (floods_[small].held && !floods_[1 - small].particles.empty()) {
    if (!fill(1 - small, is_held)) return {};
    if (!floods_[1 - small].held) small = 1 - small;
  }
  const Flood& flood = floods_[small];
  return {small == 1 ? 1 : -1, flood.area + (flood.held ? kHeldPartArea : 0)};
}

template ContourRegions::ContourRegions(const ClothModel<float>&);
template ContourRegions::ContourRegions(const ClothModel<double>&);

}  // namespace weft
