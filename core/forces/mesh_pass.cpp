#include "core/forces/mesh_pass.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/forces/bending_stencil.h"
#include "core/forces/mesh_kernels.h"

namespace weft {
namespace {

/// Of one particle. The hub of a wheel would leave nearly all slots of its group free.
constexpr std::size_t kMostSprings = 64;

}  // namespace

template <class Real>
bool MeshPass<Real>::collect_springs(const ClothModel<Real>& model, const ClothPart<Real>& part,
                                     Real damping_per_stiffness, Rows& rows) {
  for (Index n = part.springs.first; n < part.springs.end(); ++n) {
    const Spring<Real>& s = model.springs[static_cast<std::size_t>(n)];
    const Real expected = damping_per_stiffness * s.stiffness;
    if (!(std::abs(s.damping - expected) <= Real(1e-5) * expected)) return false;
    const auto add = [&](Index own, Index other) {
      rows[static_cast<std::size_t>(own - part.particles.first)].near.push_back(
          {other, s.rest_length, s.stiffness, 0});
    };
    add(s.i, s.j);
    add(s.j, s.i);
  }
  return true;
}

/// Entries k w_i w_j of the bending matrix. Those of a row add up to zero, so its own is not
/// needed: the force is minus the sum of entries times ways to the neighbours.
template <class Real>
void MeshPass<Real>::collect_bending(const ClothPart<Real>& part, Rows& rows) {
  const auto link_to = [](Row& row, Index other) -> Link& {
    for (std::vector<Link>* links : {&row.near, &row.far}) {
      for (Link& link : *links) {
        if (link.neighbour == other) return link;
      }
    }
    return row.far.emplace_back(Link{other, 0, 0, 0});
  };
  visit_bending_stencils(part, [&](Real k, const Index* corners, const double* weights, int count) {
    for (int a = 0; a < count; ++a) {
      Row& row = rows[static_cast<std::size_t>(corners[a] - part.particles.first)];
      for (int b = 0; b < count; ++b) {
        if (a == b) continue;
        link_to(row, corners[b]).bending_weight += static_cast<double>(k) * weights[a] * weights[b];
      }
    }
  });
}

template <class Real>
void MeshPass<Real>::add_group(const Rows& rows, const Members& members, std::size_t block) {
  MeshGroup group;
  const auto lead_to = [&](Index particle) {
    const std::ptrdiff_t ahead = particle - (view_.first + static_cast<std::ptrdiff_t>(block));
    in_reach_ = in_reach_ && ahead == static_cast<MeshWay>(ahead);
    group.meets_last = group.meets_last || particle == view_.last;
    ways_.push_back(static_cast<MeshWay>(ahead));
  };
  const auto own = [&](std::size_t member) {
    return static_cast<Index>(view_.first) + static_cast<Index>(member);
  };
  const auto add_slots = [&](std::vector<Link> Row::*links, bool springs) {
    std::size_t slots = 0;
    for (const std::size_t i : members) slots = std::max(slots, (rows[i].*links).size());
    for (std::size_t s = 0; s < slots; ++s) {
      std::array<Link, kMeshGroup> lanes;
      for (std::size_t k = 0; k < kMeshGroup; ++k) {
        const std::vector<Link>& row = rows[members[k]].*links;
        lanes[k] = s < row.size() ? row[s] : Link{own(members[k]), 0, 0, 0};
        lead_to(lanes[k].neighbour);
      }
      if (springs) {
        for (const Link& link : lanes) numbers_.push_back(link.rest_length);
        for (const Link& link : lanes) numbers_.push_back(link.stiffness);
      }
      for (const Link& link : lanes) numbers_.push_back(static_cast<Real>(link.bending_weight));
    }
    return static_cast<int>(slots);
  };
  for (const std::size_t i : members) lead_to(own(i));
  group.near = add_slots(&Row::near, true);
  group.far = add_slots(&Row::far, false);
  groups_.push_back(group);
}

/// Particles of a block that have as many neighbours share a group, so that few slots stay free.
template <class Real>
void MeshPass<Real>::lay_out(const Rows& rows) {
  places_.resize(rows.size());
  for (std::size_t block = 0; block < rows.size(); block += kMeshBlock) {
    std::vector<std::size_t> order(std::min<std::size_t>(kMeshBlock, rows.size() - block));
    std::iota(order.begin(), order.end(), block);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(rows[a].near.size(), rows[a].far.size()) <
             std::pair(rows[b].near.size(), rows[b].far.size());
    });
    for (std::size_t k = 0; k < order.size(); ++k) places_[order[k]] = static_cast<std::uint8_t>(k);
    // Lanes without a particle repeat the last one.
    for (std::size_t k = 0; k < order.size(); k += kMeshGroup) {
      Members members;
      for (std::size_t lane = 0; lane < kMeshGroup; ++lane)
        members[lane] = order[std::min(k + lane, order.size() - 1)];
      add_group(rows, members, block);
    }
  }
}

template <class Real>
void MeshPass<Real>::prepare(const ClothModel<Real>& model, const ClothPart<Real>& part) {
  *this = MeshPass();
  if (part.springs.count == 0) return;
  const Spring<Real>& one = model.springs[static_cast<std::size_t>(part.springs.first)];
  const Real damping = one.stiffness > 0 ? one.damping / one.stiffness : Real(0);
  Rows rows(static_cast<std::size_t>(part.particles.count));
  if (!collect_springs(model, part, damping, rows)) return;
  const auto is_hub = [](const Row& row) { return row.near.size() > kMostSprings; };
  if (std::any_of(rows.begin(), rows.end(), is_hub)) return;
  collect_bending(part, rows);
  view_.first = part.particles.first;
  view_.last = model.particle_count() - 1;
  view_.damping_per_stiffness = damping;
  lay_out(rows);
  ways_.shrink_to_fit();
  numbers_.shrink_to_fit();
  if (!in_reach_) {
    *this = MeshPass();
    return;
  }
  view_.group = groups_.data();
  view_.way = ways_.data();
  view_.number = numbers_.data();
  view_.place = places_.data();
  view_.count = part.particles.count;
}

template <class Real>
void MeshPass<Real>::compute_forces(const Vec3Array<Real>& x, const Vec3Array<Real>& v,
                                    Vec3Array<Real>& force) {
  mesh_forces(view_, x.data()->data(), v.data()->data(), force.data()->data());
}

template <class Real>
std::size_t MeshPass<Real>::bytes() const {
  return groups_.capacity() * sizeof(MeshGroup) + ways_.capacity() * sizeof(MeshWay) +
         numbers_.capacity() * sizeof(Real) + places_.capacity();
}

template class MeshPass<float>;
template class MeshPass<double>;

}  // namespace weft
