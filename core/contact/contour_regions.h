#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/types.h"

namespace weft {

/// A place where a line cuts an edge of a sheet.
struct EdgeCut {
  Index edge = kNone;
  double along = 0;    ///< from the edge's first end, 0 to 1
  bool above = false;  ///< on which side of the line the first end is
};

/// The parts into which a line cuts a sheet of cloth.
class ContourRegions {
 public:
  ContourRegions() = default;
  template <class Real>
  explicit ContourRegions(const ClothModel<Real>& model);

  /// The smaller of the two parts, and if it holds what cannot be moved the other one.
  struct Part {
    int side = 0;     ///< 1 above the line, -1 below; 0: the line does not cut the sheet in two
    double area = 0;  ///< at rest [m^2]; a metre squared more for each particle that is held
  };
  /// @param cuts     all of the line, in any order; sorted
  /// @param is_held  of each particle 1 if it cannot be moved
  Part smaller_part(std::vector<EdgeCut>& cuts, const std::vector<char>& is_held);

  /// Calls visit(neighbour) for all that an edge joins to a particle.
  template <class Visit>
  void for_neighbours(Index particle, Visit&& visit) const {
    const auto i = static_cast<std::size_t>(particle);
    for (Index k = first_joined_[i]; k < first_joined_[i + 1]; ++k)
      visit(joined_[static_cast<std::size_t>(k)].particle);
  }

 private:
  struct Joined {
    Index edge, particle;
  };
  struct Flood {
    std::vector<Index> particles;
    std::size_t next = 0;
    double area = 0;
    bool held = false;
  };

  void seed(Index particle, std::size_t side, const std::vector<char>& is_held);
  bool spread(std::size_t side, const std::vector<char>& is_held);
  bool fill(std::size_t side, const std::vector<char>& is_held);

  std::vector<Edge> edges_;
  std::vector<Index> first_joined_;  ///< of each particle
  std::vector<Joined> joined_;
  std::vector<double> area_;            ///< of each particle [m^2]
  std::vector<std::uint32_t> is_cut_;   ///< of each edge, the search that cut it
  std::vector<std::uint32_t> reached_;  ///< of each particle, search x 2 + side
  std::uint32_t search_ = 0;
  std::array<Flood, 2> floods_;  ///< below and above
  bool meet_ = false;            ///< both sides are one
};

}  // namespace weft
