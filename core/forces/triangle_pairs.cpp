// Finds partners among the triangles of a membrane.

#include "core/forces/triangle_pairs.h"

#include <algorithm>
#include <cassert>
#include <map>

#include "core/cloth/membrane_gradient.h"

namespace weft {
namespace {

/// The triangles beside each triangle that have no partner yet.
class Singles {
 public:
  template <class Real>
  explicit Singles(std::span<const MembraneTriangle<Real>> triangles)
      : beside_(triangles.size(), {kNone, kNone, kNone}), single_(triangles.size(), true) {
    std::map<Edge, std::array<std::size_t, 2>> first;  // triangle and side that first had an edge
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = triangles[t].x[k], b = triangles[t].x[(k + 1) % 3];
        const auto [there, is_new] = first.insert({{std::min(a, b), std::max(a, b)}, {t, k}});
        if (is_new) continue;
        const auto [other, side] = there->second;
        beside_[t][k] = static_cast<Index>(other);
        beside_[other][side] = static_cast<Index>(t);
      }
    }
  }

  bool is_single(std::size_t t) const { return single_[t]; }

  int choices(std::size_t t) const {
    return static_cast<int>(std::count_if(beside_[t].begin(), beside_[t].end(),
                                          [&](Index other) { return is_free(other); }));
  }

  /// The partner with the fewest other choices; kNone if there is none.
  Index best_for(std::size_t t) const {
    Index best = kNone;
    for (const Index other : beside_[t]) {
      if (is_free(other) && (best == kNone || choices(static_cast<std::size_t>(other)) <
                                                  choices(static_cast<std::size_t>(best))))
        best = other;
    }
    return best;
  }

  /// Takes a triangle, and appends those beside it that now have one choice.
  void take(std::size_t t, std::vector<std::size_t>& pressed) {
    single_[t] = false;
    for (const Index other : beside_[t]) {
      if (is_free(other) && choices(static_cast<std::size_t>(other)) == 1)
        pressed.push_back(static_cast<std::size_t>(other));
    }
  }

 private:
  bool is_free(Index t) const { return t != kNone && single_[static_cast<std::size_t>(t)]; }

  std::vector<std::array<Index, 3>> beside_;
  std::vector<char> single_;
};

/// u1, u2, v1 and v2 with the corners in the given order.
template <class Real>
void write_shape(const MembraneTriangle<Real>& t, Index second, Index third, Real* to) {
  const CornerGradients<Real> b = corner_gradients<Real>(t);
  const auto place = [&](Index particle) {
    return static_cast<std::size_t>(std::find(t.x.begin(), t.x.end(), particle) - t.x.begin());
  };
  to[0] = b.u[place(second)], to[1] = b.u[place(third)];
  to[2] = b.v[place(second)], to[3] = b.v[place(third)];
}

template <class Real>
TrianglePair<Real> pair_of(const MembraneTriangle<Real>& t, const MembraneTriangle<Real>& other) {
  const auto is_corner = [](const MembraneTriangle<Real>& of, Index i) {
    return std::find(of.x.begin(), of.x.end(), i) != of.x.end();
  };
  std::size_t k = 0;  // the corner of t that the other has not
  while (is_corner(other, t.x[k])) ++k;
  TrianglePair<Real> pair;
  pair.x = {t.x[(k + 1) % 3], t.x[(k + 2) % 3], t.x[k], kNone};
  for (const Index i : other.x) {
    if (!is_corner(t, i)) pair.x[3] = i;
  }
  assert(pair.x[3] != kNone && "one common edge");
  write_shape(t, pair.x[1], pair.x[2], pair.shape.data());
  write_shape(other, pair.x[1], pair.x[3], pair.shape.data() + 4);
  return pair;
}

}  // namespace

template <class Real>
Index TrianglePair<Real>::earliest() const {
  return *std::min_element(x.begin(), x.end());
}

template <class Real>
std::vector<TrianglePair<Real>> pair_triangles(std::span<const MembraneTriangle<Real>> triangles) {
  std::vector<TrianglePair<Real>> pairs;
  Singles singles(triangles);
  std::vector<std::size_t> pressed;
  const auto settle = [&](std::size_t t) {
    if (!singles.is_single(t)) return;
    const Index other = singles.best_for(t);
    singles.take(t, pressed);
    if (other != kNone) {
      singles.take(static_cast<std::size_t>(other), pressed);
      pairs.push_back(pair_of(triangles[t], triangles[static_cast<std::size_t>(other)]));
      return;
    }
    TrianglePair<Real>& alone = pairs.emplace_back();
    alone.x = {triangles[t].x[0], triangles[t].x[1], triangles[t].x[2], triangles[t].x[0]};
    write_shape(triangles[t], alone.x[1], alone.x[2], alone.shape.data());
  };
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (singles.choices(t) == 1) pressed.push_back(t);
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    while (!pressed.empty()) {
      const std::size_t next = pressed.back();
      pressed.pop_back();
      settle(next);
    }
    settle(t);
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const auto& a, const auto& b) { return a.earliest() < b.earliest(); });
  return pairs;
}

#define WEFT_INSTANTIATE(Real)        \
  template struct TrianglePair<Real>; \
  template std::vector<TrianglePair<Real>> pair_triangles(std::span<const MembraneTriangle<Real>>);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
