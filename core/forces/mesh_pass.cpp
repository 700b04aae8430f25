// Sorts a mesh's springs or triangles into the lists of its kernels.

#include "core/forces/mesh_pass.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <tuple>

#include "core/cloth/bending_stencil.h"
#include "core/forces/constants.h"
#include "core/forces/force_pass.h"
#include "core/forces/mesh_kernels.h"

namespace weft {
namespace {

/// Quads in the ring of pulls, limited by the 16 bits of an offset.
constexpr std::size_t kLongestRing = 65536 * kPullUnit / 4;

}  // namespace

template <class Real>
bool MeshPass<Real>::collect_springs(const ClothModel<Real>& model, const ClothPart<Real>& part,
                                     Real damping_per_stiffness, Rows& rows) {
  std::vector<std::size_t> springs(rows.size(), 0);
  for (Index n = part.springs.first; n < part.springs.end(); ++n) {
    const Spring<Real>& s = model.springs[static_cast<std::size_t>(n)];
    const Real expected = damping_per_stiffness * s.stiffness;
    if (!(std::abs(s.damping - expected) <= Real(kSameDamping) * expected)) return false;
    assert(part.particles.contains(s.i) && part.particles.contains(s.j));
    const auto [earlier, later] = std::minmax(s.i, s.j);
    for (const Index end : {earlier, later}) {
      if (++springs[static_cast<std::size_t>(end - part.particles.first)] > kMostSpringsAtParticle)
        return false;
    }
    rows[static_cast<std::size_t>(earlier - part.particles.first)].near.push_back(
        {later, s.rest_length, s.stiffness, 0});
  }
  return true;
}

/// Counts the pairs of triangles at each particle. @returns whether there are few enough
template <class Real>
bool MeshPass<Real>::count_pairs(const Pairs& pairs, const ClothPart<Real>& part, Rows& rows) {
  for (const TrianglePair<Real>& pair : pairs) {
    for (std::size_t c = 0; c < (pair.is_single() ? 3U : 4U); ++c) {
      assert(part.particles.contains(pair.x[c]));
      Row& row = rows[static_cast<std::size_t>(pair.x[c] - part.particles.first)];
      if (++row.pulled_by > kMostSpringsAtParticle) return false;
    }
  }
  return true;
}

/// Entries k w_i w_j of the bending matrix. Each row sums to zero, so its diagonal is not needed:
/// the force is minus the sum of entries times differences to the neighbours.
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
  visit_bending_stencils(
      part, [&](double k, const Index* corners, const double* weights, int count) {
        for (int a = 0; a < count; ++a) {
          Row& row = rows[static_cast<std::size_t>(corners[a] - part.particles.first)];
          for (int b = 0; b < count; ++b) {
            if (corners[a] < corners[b])
              link_to(row, corners[b]).bending_weight += k * weights[a] * weights[b];
          }
        }
      });
}

/// A number of slots as a group stores it. A mesh with a larger one does not fit.
template <class Real>
std::uint8_t MeshPass<Real>::stored_slots(std::size_t slots) {
  const auto stored = static_cast<std::uint8_t>(slots);
  in_reach_ = in_reach_ && stored == slots;
  return stored;
}

/// Lists of one group, by slot. Lanes without a particle repeat the last one.
template <class Real>
void MeshPass<Real>::add_group(Rows& rows, const Members& members, std::size_t block) {
  assert(!members.empty() && members.size() <= kMeshGroup);
  MeshGroup group;
  const auto member = [&](std::size_t lane) { return members[std::min(lane, members.size() - 1)]; };
  const auto own = [&](std::size_t lane) {
    return static_cast<Index>(view_.first) + static_cast<Index>(member(lane));
  };
  const auto lead_to = [&](Index particle) {
    const std::ptrdiff_t ahead =
        3 * (particle - (view_.first + static_cast<std::ptrdiff_t>(block)));
    in_reach_ = in_reach_ && ahead == static_cast<MeshOffset>(ahead);
    group.meets_last = group.meets_last || particle == view_.last;
    offsets_.push_back(static_cast<MeshOffset>(ahead));
  };
  const auto add_slots = [&](std::vector<Link> Row::*links, bool springs) {
    std::size_t slots = 0;
    for (const std::size_t i : members) slots = std::max(slots, (rows[i].*links).size());
    for (std::size_t s = 0; s < slots; ++s, pull_count_ += kMeshGroup) {
      std::array<Link, kMeshGroup> lanes;
      for (std::size_t k = 0; k < kMeshGroup; ++k) {
        const std::vector<Link>& row = rows[member(k)].*links;
        lanes[k] = s < row.size() ? row[s] : Link{own(k), 0, 0, 0};
        lead_to(lanes[k].neighbour);
        if (k < members.size() && s < row.size())
          rows[static_cast<std::size_t>(row[s].neighbour - view_.first)].earlier.push_back(
              pull_count_ + quad_of_lane(k));
      }
      if (springs) {
        for (const Link& link : lanes) numbers_.push_back(link.rest_length);
        for (const Link& link : lanes) numbers_.push_back(link.stiffness);
      }
      for (const Link& link : lanes)
        numbers_.push_back(static_cast<Real>(springs ? link.bending_weight : -link.bending_weight));
    }
    return stored_slots(slots);
  };
  for (std::size_t k = 0; k < kMeshGroup; ++k) lead_to(own(k));
  group.near = add_slots(&Row::near, true);
  group.far = add_slots(&Row::far, false);
  groups_.push_back(group);
}

/// Moves the bending between the corners of pairs from the rows, which need not lead to each other
/// then, to the first pair that has both.
template <class Real>
void MeshPass<Real>::give_links(Rows& rows, Pairs& pairs) const {
  constexpr std::size_t kEnds[kPairLinks][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  for (TrianglePair<Real>& pair : pairs) {
    for (std::size_t n = 0; n < kPairLinks; ++n) {
      const auto [earlier, later] = std::minmax({pair.x[kEnds[n][0]], pair.x[kEnds[n][1]]});
      std::vector<Link>& links = rows[static_cast<std::size_t>(earlier - view_.first)].far;
      const auto found = std::find_if(links.begin(), links.end(), [later = later](const Link& one) {
        return one.neighbour == later;
      });
      if (found == links.end()) continue;
      pair.link[n] = static_cast<Real>(-found->bending_weight);
      links.erase(found);
    }
  }
}

/// Lists of the pairs of triangles that begin in a block, in whole groups: the last one may have
/// some of the next block, and at the mesh's end lanes without a pair repeat the last.
template <class Real>
void MeshPass<Real>::add_pairs(const Pairs& pairs, std::size_t block, Rows& rows) {
  const auto count = pairs.size();
  const Index first = static_cast<Index>(view_.first) + static_cast<Index>(block);
  MeshPairs of_block;
  for (; listed_ < count && pairs[listed_].earliest() < first + kMeshBlock;
       listed_ = std::min(count, listed_ + kMeshGroup), ++of_block.groups) {
    const auto lane = [&](std::size_t k) -> const TrianglePair<Real>& {
      return pairs[std::min(listed_ + k, count - 1)];
    };
    for (std::size_t c = 0; c < kPairCorners; ++c, pull_count_ += kMeshGroup) {
      for (std::size_t k = 0; k < kMeshGroup; ++k) {
        const Index particle = lane(k).x[c];
        const std::ptrdiff_t ahead = 3 * static_cast<std::ptrdiff_t>(particle - first);
        in_reach_ = in_reach_ && ahead == static_cast<MeshOffset>(ahead);
        of_block.meets_last = of_block.meets_last || particle == view_.last;
        corners_.push_back(static_cast<MeshOffset>(ahead));
        if (listed_ + k < count && !(c == 3 && lane(k).is_single()))
          rows[static_cast<std::size_t>(particle - view_.first)].earlier.push_back(pull_count_ +
                                                                                   quad_of_lane(k));
      }
    }
    for (std::size_t n = 0; n < kPairNumbers; ++n) {
      for (std::size_t k = 0; k < kMeshGroup; ++k) shapes_.push_back(lane(k).shape[n]);
    }
    strains_.resize(strains_.size() + kPairStrains * kMeshGroup, Real(0));
    for (std::size_t n = 0; n < (bends_ ? kPairLinks : 0); ++n) {
      for (std::size_t k = 0; k < kMeshGroup; ++k) links_.push_back(lane(k).link[n]);
    }
  }
  pairs_.push_back(of_block);
}

/// Groups particles of a block that pull equally many others, so that few slots stay unused;
/// particles pulled by equally many are adjacent, so that the branch predictor learns where their
/// lists end.
template <class Real>
void MeshPass<Real>::sort_block(const Rows& rows, Members& block) {
  const auto lengths = [&](std::size_t i) {
    return std::tuple(rows[i].near.size(), rows[i].far.size(), rows[i].pulled_by);
  };
  std::stable_sort(block.begin(), block.end(),
                   [&](std::size_t a, std::size_t b) { return lengths(a) < lengths(b); });
}

/// Lists of all blocks. The earlier neighbours of a particle are in its own block or a previous
/// one.
/// @returns the members of each group
template <class Real>
std::vector<typename MeshPass<Real>::Members> MeshPass<Real>::lay_out(const Pairs& pairs,
                                                                      Rows& rows) {
  std::vector<Members> groups;
  std::size_t reach = 0;  // the farthest look-back in the ring
  for (std::size_t begin = 0; begin < rows.size(); begin += kMeshBlock) {
    Members block(std::min<std::size_t>(kMeshBlock, rows.size() - begin));
    std::iota(block.begin(), block.end(), begin);
    if (!pairs.empty()) add_pairs(pairs, begin, rows);
    sort_block(rows, block);
    for (auto first = block.begin(); first != block.end();) {
      const auto end = first + std::min<std::ptrdiff_t>(kMeshGroup, block.end() - first);
      add_group(rows, groups.emplace_back(first, end), begin);
      first = end;
    }
    for (const std::size_t i : block) {
      for (const std::size_t pull : rows[i].earlier) reach = std::max(reach, pull_count_ - pull);
    }
  }
  view_.ring_size = (reach + kMeshGroup - 1) / kMeshGroup * kMeshGroup;
  ring_.assign(4 * (view_.ring_size + 1), Real(0));
  return groups;
}

/// Offsets in the ring of the pulls that earlier neighbours store for each particle.
template <class Real>
void MeshPass<Real>::list_pulls(const Rows& rows, const std::vector<Members>& groups) {
  in_reach_ = in_reach_ && view_.ring_size < kLongestRing;
  if (!in_reach_) return;
  assert(groups.size() == groups_.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    std::size_t slots = 0;
    for (const std::size_t i : groups[g]) slots = std::max(slots, rows[i].earlier.size());
    groups_[g].earlier = stored_slots(slots);
    for (std::size_t s = 0; s < slots; ++s) {
      for (std::size_t k = 0; k < kMeshGroup; ++k) {
        const Row& row = rows[groups[g][std::min(k, groups[g].size() - 1)]];
        const std::size_t quad =
            s < row.earlier.size() ? row.earlier[s] % view_.ring_size : view_.ring_size;
        pulls_.push_back(static_cast<std::uint16_t>(4 / kPullUnit * quad));
      }
    }
  }
}

template <class Real>
void MeshPass<Real>::prepare(const ClothModel<Real>& model, const ClothPart<Real>& part) {
  *this = MeshPass();
  if (membrane_elements(part) == 0) return;
  view_.first = part.particles.first;
  Rows rows(static_cast<std::size_t>(part.particles.count));
  Pairs pairs = pair_triangles<Real>(
      {model.membrane.data() + part.membrane.first, static_cast<std::size_t>(part.membrane.count)});
  if (part.springs.count > 0) {
    const Spring<Real>& one = model.springs[static_cast<std::size_t>(part.springs.first)];
    view_.damping_per_stiffness = one.stiffness > 0 ? one.damping / one.stiffness : Real(0);
    if (!collect_springs(model, part, view_.damping_per_stiffness, rows)) return;
  }
  if (!count_pairs(pairs, part, rows)) return;
  collect_bending(part, rows);
  bends_ = quadratic_stencil_count(part) > 0;
  if (bends_) give_links(rows, pairs);
  for (const Row& row : rows) {
    for (const std::vector<Link>* links : {&row.near, &row.far}) {
      for (const Link& link : *links)
        ++rows[static_cast<std::size_t>(link.neighbour - part.particles.first)].pulled_by;
    }
  }
  view_.last = model.particle_count() - 1;
  view_.tensor = part.membrane_tensor;
  list_pulls(rows, lay_out(pairs, rows));
  if (!in_reach_) {
    *this = MeshPass();
    return;
  }
  offsets_.shrink_to_fit();
  numbers_.shrink_to_fit();
  groups_.shrink_to_fit();
  pulls_.shrink_to_fit();
  pairs_.shrink_to_fit();
  corners_.shrink_to_fit();
  shapes_.shrink_to_fit();
  strains_.shrink_to_fit();
  links_.shrink_to_fit();
  point_view();
  view_.count = part.particles.count;
}

template <class Real>
void MeshPass<Real>::point_view() {
  view_.group = groups_.data();
  view_.offset = offsets_.data();
  view_.number = numbers_.data();
  view_.pull = pulls_.data();
  view_.ring = ring_.data();
  view_.pairs = pairs_.empty() ? nullptr : pairs_.data();
  view_.corner = corners_.data();
  view_.shape = shapes_.data();
  view_.strain = strains_.data();
  view_.link = links_.empty() ? nullptr : links_.data();
}

template <class Real>
void MeshPass<Real>::compute_forces(const Vec3Array<Real>& x, const Vec3Array<Real>& v,
                                    Vec3Array<Real>& force) {
  assert(fits());
  assert(static_cast<std::ptrdiff_t>(x.size()) == view_.last + 1);
  assert(v.size() == x.size() && force.size() == x.size());
  mesh_forces(view_, x.data()->data(), v.data()->data(), force.data()->data());
}

template <class Real>
void MeshPass<Real>::kick(const KickLaw<Real>& law, const KickedParticles<Real>& particles,
                          const Vec3Array<Real>& x, Vec3Array<Real>& v, Real since_last) {
  assert(since_last >= 0);
  assert(fits());
  assert(static_cast<std::ptrdiff_t>(x.size()) == view_.last + 1);
  assert(v.size() == x.size() && particles.inverse_mass != nullptr);
  view_.substeps_per_second = since_last > 0 ? 1 / since_last : Real(0);
  mesh_kick(view_, law, particles, x.data()->data(), v.data()->data());
}

template <class Real>
std::size_t MeshPass<Real>::bytes() const {
  return groups_.capacity() * sizeof(MeshGroup) + offsets_.capacity() * sizeof(MeshOffset) +
         pairs_.capacity() * sizeof(MeshPairs) + corners_.capacity() * sizeof(MeshOffset) +
         (numbers_.capacity() + shapes_.capacity() + links_.capacity() + strains_.capacity() +
          ring_.capacity()) *
             sizeof(Real) +
         pulls_.capacity() * sizeof(std::uint16_t);
}

template class MeshPass<float>;
template class MeshPass<double>;

}  // namespace weft
