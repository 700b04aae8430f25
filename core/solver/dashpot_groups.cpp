// Groups the stencils of damped bending.

#include "core/solver/dashpot_groups.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "core/cloth/bending_stencil.h"
#include "core/error.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// One group before it is laid out: slots as they are told at DashpotFamily.
struct Group {
  std::vector<Index> particles;
  std::vector<std::vector<double>> weights;  ///< by curvature, of each slot
  std::vector<double> viscosity;             ///< by curvature
};

/// The family of groups of some size; it is added where there is none yet.
template <class Real>
DashpotFamily<Real>& family_of(std::size_t slots, std::size_t curvatures, bool of_triangles,
                               std::vector<DashpotFamily<Real>>& families) {
  assert(curvatures >= 1 && curvatures <= 3);
  const auto family = std::find_if(families.begin(), families.end(), [&](const auto& f) {
    return f.slots == slots && f.curvatures == curvatures && f.of_triangles == of_triangles;
  });
  if (family != families.end()) return *family;
  families.emplace_back();
  families.back().slots = slots;
  families.back().curvatures = curvatures;
  families.back().of_triangles = of_triangles;
  return families.back();
}

/// Adds a batch of groups without viscosity.
template <class Real>
void add_batch(DashpotFamily<Real>& family) {
  constexpr std::size_t kLanes = DashpotFamily<Real>::kLanes;
  const std::size_t batches = ++family.batches;
  family.places.resize(batches * family.slots * kLanes);
  family.viscosity.resize(batches * family.curvatures * kLanes, 0);
  if (family.of_triangles)
    family.weights.resize(batches * family.curvatures * family.slots * kLanes, 0);
  else
    family.in_rows.push_back(0);
}

/// Puts a group into a lane of the last batch, and its particles into those behind, which pad it.
template <class Real>
void put(const Group& group, std::size_t lane, DashpotFamily<Real>& family) {
  constexpr std::size_t kLanes = DashpotFamily<Real>::kLanes;
  assert(group.particles.size() == family.slots && lane < kLanes);
  const std::size_t batch = family.batches - 1;
  ++family.groups;
  for (std::size_t n = 0; n < family.slots; ++n) {
    const auto particle = static_cast<std::uint32_t>(group.particles[n]);
    std::uint32_t* const place = family.places.data() + (batch * family.slots + n) * kLanes;
    std::fill(
        place + lane, place + kLanes,
        family.of_triangles ? 4 * particle : particle - static_cast<std::uint32_t>(family.first));
  }
  for (std::size_t k = 0; k < family.curvatures; ++k) {
    const std::size_t first = batch * family.curvatures + k;
    family.viscosity[first * kLanes + lane] = static_cast<Real>(group.viscosity[k]);
    for (std::size_t n = 0; family.of_triangles && n < group.weights[k].size(); ++n)
      family.weights[(first * family.slots + n) * kLanes + lane] =
          static_cast<Real>(group.weights[k][n]);
  }
}

/// Adds a group to a family of groups of triangles as large. The particles that pad it are its
/// first, without weight.
template <class Real>
void append(Group group, std::vector<DashpotFamily<Real>>& families) {
  // Groups of an odd size join those of the next even one: fewer batches that are not full.
  const std::size_t slots = group.particles.size() + group.particles.size() % 2;
  if (slots > DashpotFamily<Real>::kMostSlots)
    throw DefinitionError(
        "bending_damping", "of a triangle with too many neighbours",
        "at most " + std::to_string(DashpotFamily<Real>::kMostSlots) + " particles",
        "no vertex with more than some 50 triangles, or no damping of bending");
  group.particles.resize(slots, group.particles.front());
  DashpotFamily<Real>& family = family_of(slots, group.viscosity.size(), true, families);
  const std::size_t lane = family.groups % DashpotFamily<Real>::kLanes;
  if (lane == 0) add_batch(family);
  put(group, lane, family);
}

/// How many groups from `from` on have particles that follow each other.
std::size_t run_length(const std::vector<Group>& groups, std::size_t from) {
  std::size_t count = 1;
  for (; from + count < groups.size(); ++count) {
    const std::vector<Index>&before = groups[from + count - 1].particles,
          &particles = groups[from + count].particles;
    for (std::size_t n = 0; n < particles.size(); ++n) {
      if (particles[n] != before[n] + 1) return count;
    }
  }
  return count;
}

/// Neighbours that are worth a batch of their own.
constexpr std::size_t kLeastInRow = 3;

/// Lays out groups of a grid, in the order of their particles, as a family: neighbours to a batch,
/// and what is left of rows together at the end.
template <class Real>
void lay_out(const std::vector<Group>& groups, const IndexRange& particles,
             std::vector<DashpotFamily<Real>>& families) {
  constexpr std::size_t kLanes = DashpotFamily<Real>::kLanes;
  if (groups.empty()) return;
  const Group& model = groups.front();
  assert(model.particles.size() <= DashpotFamily<Real>::kMostGridSlots);
  DashpotFamily<Real>& family =
      family_of(model.particles.size(), model.viscosity.size(), false, families);
  family.first = static_cast<std::size_t>(particles.first);
  family.plane = static_cast<std::size_t>(particles.count);
  for (const std::vector<double>& of_slots : model.weights)
    for (const double weight : of_slots) family.weights.push_back(static_cast<Real>(weight));
  std::vector<std::size_t> left;
  for (std::size_t from = 0; from < groups.size();) {
    const std::size_t length = run_length(groups, from), end = from + length;
    const auto has_room = [&](std::size_t g) {
      const std::vector<Index>& p = groups[g].particles;
      return *std::max_element(p.begin(), p.end()) + static_cast<Index>(kLanes) <= particles.end();
    };
    for (; from < end && end - from >= kLeastInRow && has_room(from);
         from += std::min(kLanes, end - from)) {
      add_batch(family);
      family.in_rows.back() = 1;
      for (std::size_t k = 0; k < std::min(kLanes, end - from); ++k)
        put(groups[from + k], k, family);
      std::uint32_t* const places =
          family.places.data() + (family.batches - 1) * family.slots * kLanes;
      for (std::size_t n = 0; n < family.slots; ++n)
        std::iota(places + n * kLanes, places + (n + 1) * kLanes, places[n * kLanes]);
    }
    for (; from < end; ++from) left.push_back(from);
  }
  for (std::size_t n = 0; n < left.size(); ++n) {
    if (n % kLanes == 0) add_batch(family);
    put(groups[left[n]], n % kLanes, family);
  }
}

/// Of each edge of a part the third particle of a triangle beside it.
template <class Real>
std::map<Edge, Index> opposite_particles(const ClothModel<Real>& model,
                                         const ClothPart<Real>& part) {
  std::map<Edge, Index> opposite;
  for (Index t = part.triangles.first; t < part.triangles.end(); ++t) {
    const Triangle& corners = model.triangles[static_cast<std::size_t>(t)];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(corners[k], corners[(k + 1) % 3]);
      opposite[{low, high}] = corners[(k + 2) % 3];
    }
  }
  return opposite;
}

/// The lines and twists of a grid. Lines through the same particle follow each other in its list of
/// stencils, and span the plane together; a line on the border spans it with a neighbour beside it.
template <class Real>
void group_grid(const ClothModel<Real>& model, const ClothPart<Real>& part,
                std::vector<DashpotFamily<Real>>& families) {
  std::vector<Group> crosses, twists;
  const std::map<Edge, Index> beside = opposite_particles(model, part);
  std::array<Index, 3> line{kNone, kNone, kNone};  // waits for one across it
  double viscosity_of_line = 0;
  const auto cross = [&](const std::array<Index, 3>& u, Index before, Index behind, double across) {
    crosses.push_back({{u[0], u[2], before, behind, u[1]},
                       {{1, 1, 0, 0, -2}, {0, 0, 1, 1, -2}},
                       {viscosity_of_line, across}});
  };
  const auto end_line = [&] {
    if (line[1] == kNone) return;
    cross(line, line[1], beside.at({std::min(line[0], line[1]), std::max(line[0], line[1])}), 0);
    line[1] = kNone;
  };
  visit_bending_stencils(part, [&](double k, const Index* p, const double*, int count) {
    const double viscosity = k * static_cast<double>(part.bending_time);
    if (count == 3 && p[1] == line[1]) {
      cross(line, p[0], p[2], viscosity);
      line[1] = kNone;
      return;
    }
    end_line();
    if (count == 3) {
      line = {p[0], p[1], p[2]};
      viscosity_of_line = viscosity;
    } else if (count == 4) {
      twists.push_back({{p[0], p[3], p[1], p[2]}, {{1, 1, -1, -1}}, {viscosity}});
    }
  });
  end_line();
  lay_out(crosses, part.particles, families);
  lay_out(twists, part.particles, families);
}

/// The three curvatures of each triangle.
template <class Real>
void group_triangles(const ClothModel<Real>& model, const ClothPart<Real>& part,
                     std::vector<DashpotFamily<Real>>& families) {
  const TriangleCurvatures<Real>& list = part.curvatures;
  for (std::size_t t = 0; t < list.triangles.size(); ++t) {
    const Index number = part.triangles.first + list.triangles[t];
    const Triangle& corners = model.triangles[static_cast<std::size_t>(number)];
    Group group{{corners.begin(), corners.end()}, {}, {}};
    group.weights.assign(3, std::vector<double>(3, 0));
    for (std::size_t n = list.begin[t]; n < list.begin[t + 1]; ++n) {
      const Index particle = part.particles.first + list.particles[n];
      auto& particles = group.particles;
      const auto corner = std::find(particles.begin(), particles.begin() + 3, particle);
      const auto slot = static_cast<std::size_t>(corner - particles.begin());
      if (slot == 3) particles.push_back(particle);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto weight = static_cast<double>(list.weights[n][static_cast<Eigen::Index>(k)]);
        if (slot < 3)
          group.weights[k][slot] = weight;
        else
          group.weights[k].push_back(weight);
      }
    }
    for (Eigen::Index k = 0; k < 3; ++k)
      group.viscosity.push_back(static_cast<double>(list.stiffness[t][k]) *
                                static_cast<double>(part.bending_time));
    append(std::move(group), families);
  }
}

}  // namespace

template <class Real>
std::vector<DashpotFamily<Real>> dashpot_families(const ClothModel<Real>& model,
                                                  const ClothPart<Real>& part) {
  std::vector<DashpotFamily<Real>> families;
  if (part.bending_time == 0) return families;
  if (part.bends_by_links)
    group_triangles(model, part, families);
  else
    group_grid(model, part, families);
  for (DashpotFamily<Real>& family : families)
    family.geometry.assign(family.batches * family.geometry_numbers() * family.kLanes, 0);
  return families;
}

WEFT_INSTANTIATE_FUNCTIONS(dashpot_families)

}  // namespace weft
