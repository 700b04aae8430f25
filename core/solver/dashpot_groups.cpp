// Groups the stencils of damped bending.

#include "core/solver/dashpot_groups.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
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

/// Adds a group to a family of groups as large. The particles that pad it are its first, without
/// weight.
template <class Real>
void append(Group group, std::size_t slots, bool of_triangles,
            std::vector<DashpotFamily<Real>>& families) {
  constexpr std::size_t kLanes = DashpotFamily<Real>::kLanes;
  const std::size_t curvatures = group.viscosity.size();
  assert(slots >= group.particles.size() && curvatures >= 1 && curvatures <= 3);
  if (slots > DashpotFamily<Real>::kMostSlots)
    throw DefinitionError(
        "bending_damping", "of a triangle with too many neighbours",
        "at most " + std::to_string(DashpotFamily<Real>::kMostSlots) + " particles",
        "no vertex with more than some 50 triangles, or no damping of bending");
  group.particles.resize(slots, group.particles.front());
  auto family = std::find_if(families.begin(), families.end(), [&](const auto& f) {
    return f.slots == slots && f.curvatures == curvatures && f.of_triangles == of_triangles;
  });
  if (family == families.end()) {
    families.emplace_back();
    family = families.end() - 1;
    family->slots = slots;
    family->curvatures = curvatures;
    family->of_triangles = of_triangles;
    for (const std::vector<double>& of_slots : group.weights) {
      for (std::size_t n = 0; !of_triangles && n < slots; ++n)
        family->weights.push_back(static_cast<Real>(of_slots[n]));
    }
  }
  const std::size_t lane = family->groups % kLanes;
  if (lane == 0) {
    const std::size_t batch = family->batches++;
    family->places.resize((batch + 1) * slots * kLanes);
    if (of_triangles) family->weights.resize((batch + 1) * curvatures * slots * kLanes, 0);
    family->viscosity.resize((batch + 1) * curvatures * kLanes, 0);
  }
  const std::size_t batch = family->groups++ / kLanes;
  for (std::size_t n = 0; n < slots; ++n) {
    // Groups that pad the batch have the particles of the last one.
    std::uint32_t* const place = family->places.data() + (batch * slots + n) * kLanes;
    std::fill(place + lane, place + kLanes, 4 * static_cast<std::uint32_t>(group.particles[n]));
  }
  for (std::size_t k = 0; k < curvatures; ++k) {
    const std::size_t first = batch * curvatures + k;
    family->viscosity[first * kLanes + lane] = static_cast<Real>(group.viscosity[k]);
    for (std::size_t n = 0; of_triangles && n < group.weights[k].size(); ++n)
      family->weights[(first * slots + n) * kLanes + lane] = static_cast<Real>(group.weights[k][n]);
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
  static constexpr std::size_t kCross = 5, kTwist = 4;
  const std::map<Edge, Index> beside = opposite_particles(model, part);
  std::array<Index, 3> line{kNone, kNone, kNone};  // waits for one across it
  double viscosity_of_line = 0;
  const auto cross = [&](const std::array<Index, 3>& u, Index before, Index behind, double across) {
    append<Real>({{u[0], u[2], before, behind, u[1]},
                  {{1, 1, 0, 0, -2}, {0, 0, 1, 1, -2}},
                  {viscosity_of_line, across}},
                 kCross, false, families);
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
      append<Real>({{p[0], p[3], p[1], p[2]}, {{1, 1, -1, -1}}, {viscosity}}, kTwist, false,
                   families);
    }
  });
  end_line();
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
    // Groups of an odd size join those of the next even one: fewer batches that are not full.
    const std::size_t slots = group.particles.size() + group.particles.size() % 2;
    append(std::move(group), slots, true, families);
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
