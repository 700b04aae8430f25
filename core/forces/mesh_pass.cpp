#include "core/forces/mesh_pass.h"

#include <algorithm>
#include <cmath>

#include "core/forces/bending_stencil.h"
#include "core/forces/mesh_kernels.h"

namespace weft {

template <class Real>
bool MeshPass<Real>::collect_springs(const ClothModel<Real>& model, const ClothPart<Real>& part,
                                     Real damping_per_stiffness, Links& links) {
  for (Index n = part.springs.first; n < part.springs.end(); ++n) {
    const Spring<Real>& s = model.springs[static_cast<std::size_t>(n)];
    const Real expected = damping_per_stiffness * s.stiffness;
    if (!(std::abs(s.damping - expected) <= Real(1e-5) * expected)) return false;
    const auto add = [&](Index own, Index other) {
      links[static_cast<std::size_t>(own - part.particles.first)].push_back(
          {other, s.rest_length, s.stiffness, 0, true});
    };
    add(s.i, s.j);
    add(s.j, s.i);
  }
  return true;
}

/// Entries k w_i w_j of the bending matrix. Those of a row add up to zero, so its own is not
/// needed: the force is minus the sum of entries times ways to the neighbours.
template <class Real>
void MeshPass<Real>::collect_bending(const ClothPart<Real>& part, Links& links) {
  visit_bending_stencils(part, [&](Real k, const Index* corners, const double* weights, int count) {
    for (int a = 0; a < count; ++a) {
      std::vector<Link>& row = links[static_cast<std::size_t>(corners[a] - part.particles.first)];
      for (int b = 0; b < count; ++b) {
        if (a == b) continue;
        auto link = std::find_if(row.begin(), row.end(),
                                 [&](const Link& l) { return l.neighbour == corners[b]; });
        if (link == row.end()) {
          row.push_back({corners[b], 0, 0, 0, false});
          link = row.end() - 1;
        }
        link->bending_weight += static_cast<double>(k) * weights[a] * weights[b];
      }
    }
  });
}

template <class Real>
void MeshPass<Real>::lay_out(const Links& links, Index first) {
  const auto is_spring = [](const Link& link) { return link.is_spring; };
  const std::size_t blocks = (links.size() + kMeshBlock - 1) / kMeshBlock;
  std::vector<std::size_t> slot_starts, near_starts;
  int most_numbers = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t begin = b * kMeshBlock, end = std::min(begin + kMeshBlock, links.size());
    MeshBlock<Real> block;
    for (std::size_t i = begin; i < end; ++i) {
      const auto springs =
          static_cast<int>(std::count_if(links[i].begin(), links[i].end(), is_spring));
      block.near = std::max(block.near, springs);
      block.far = std::max(block.far, static_cast<int>(links[i].size()) - springs);
    }
    const std::size_t slot_start = neighbour_.size(), near_start = stiffness_.size();
    const auto slots = static_cast<std::size_t>(block.near + block.far);
    // Lanes behind the last particle lead to it, as free slots lead to their own particle.
    for (std::size_t k = 0; k < slots * kMeshBlock; ++k)
      neighbour_.push_back(first + static_cast<Index>(std::min(begin + k % kMeshBlock, end - 1)));
    bending_weight_.resize(neighbour_.size(), Real(0));
    rest_length_.resize(near_start + static_cast<std::size_t>(block.near) * kMeshBlock, Real(0));
    stiffness_.resize(rest_length_.size(), Real(0));
    for (std::size_t i = begin; i < end; ++i) {
      std::size_t near_slot = 0, far_slot = static_cast<std::size_t>(block.near);
      for (const Link& link : links[i]) {
        const std::size_t slot = link.is_spring ? near_slot++ : far_slot++;
        const std::size_t place = slot * kMeshBlock + (i - begin);
        neighbour_[slot_start + place] = link.neighbour;
        bending_weight_[slot_start + place] = static_cast<Real>(link.bending_weight);
        if (!link.is_spring) continue;
        rest_length_[near_start + place] = link.rest_length;
        stiffness_[near_start + place] = link.stiffness;
      }
    }
    most_numbers = std::max(most_numbers, 2 * block.near + block.far);
    slot_starts.push_back(slot_start);
    near_starts.push_back(near_start);
    blocks_.push_back(block);
  }
  for (std::size_t b = 0; b < blocks; ++b) {
    blocks_[b].neighbour = neighbour_.data() + slot_starts[b];
    blocks_[b].bending_weight = bending_weight_.data() + slot_starts[b];
    blocks_[b].rest_length = rest_length_.data() + near_starts[b];
    blocks_[b].stiffness = stiffness_.data() + near_starts[b];
  }
  // Positions of all slots, velocities of the near ones; own positions, velocities and forces.
  gathered_.assign(static_cast<std::size_t>(most_numbers + 3) * 3 * kMeshBlock, Real(0));
}

template <class Real>
void MeshPass<Real>::prepare(const ClothModel<Real>& model, const ClothPart<Real>& part) {
  *this = MeshPass();
  if (part.springs.count == 0) return;
  const Spring<Real>& one = model.springs[static_cast<std::size_t>(part.springs.first)];
  const Real damping = one.stiffness > 0 ? one.damping / one.stiffness : Real(0);
  Links links(static_cast<std::size_t>(part.particles.count));
  if (!collect_springs(model, part, damping, links)) return;
  collect_bending(part, links);
  lay_out(links, part.particles.first);
  view_.block = blocks_.data();
  view_.blocks = static_cast<int>(blocks_.size());
  view_.first = part.particles.first;
  view_.count = part.particles.count;
  view_.damping_per_stiffness = damping;
  view_.gathered = gathered_.data();
}

template <class Real>
void MeshPass<Real>::compute_forces(const Vec3Array<Real>& x, const Vec3Array<Real>& v,
                                    Vec3Array<Real>& force) {
  mesh_forces(view_, x.data()->data(), v.data()->data(), force.data()->data());
}

template <class Real>
std::size_t MeshPass<Real>::bytes() const {
  return neighbour_.capacity() * sizeof(Index) +
         (rest_length_.capacity() + stiffness_.capacity() + bending_weight_.capacity() +
          gathered_.capacity()) *
             sizeof(Real) +
         blocks_.capacity() * sizeof(MeshBlock<Real>);
}

template class MeshPass<float>;
template class MeshPass<double>;

}  // namespace weft
