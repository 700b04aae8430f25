#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/cloth/neighbours.h"
#include "core/types.h"

// Parts of a sheet on the two sides of a line.

namespace weft {

/// A point where a line cuts an edge of a sheet.
struct EdgeCut {
  Index edge = kNone;
  double along = 0;    ///< from the edge's first end, 0 to 1
  bool above = false;  ///< side of the line where the first end lies
};

/// The parts into which a line cuts a sheet of cloth.
class ContourRegions {
 public:
  ContourRegions() = default;
  template <class Real>
  explicit ContourRegions(const ClothModel<Real>& model);

  /// The smaller of the two parts; if only that one holds particles that cannot move, the other.
  struct Part {
    int side = 0;     ///< 1 above the line, -1 below; 0: the line does not divide the sheet
    double area = 0;  ///< at rest [m^2]; larger if a particle is held
  };
  /// @param cuts     of the whole line, in any order; sorted
  /// @param through  particles that the line passes through; kNone: none
  /// @param is_held  of each particle 1 if it cannot move
  Part smaller_part(std::vector<EdgeCut>& cuts, const std::array<Index, 2>& through,
                    const std::vector<char>& is_held);

  /// Whether a particle next to the latest line is on this side of it.
  bool is_on(Index particle, int side) const {
    assert(side == 1 || side == -1);
    return reached_[static_cast<std::size_t>(particle)] == 2 * search_ + (side > 0 ? 1 : 0);
  }

 private:
  struct Flood {
    std::vector<Index> particles;
    std::size_t next = 0;
    double area = 0;
    bool held = false;
  };

  void seed(Index particle, std::size_t side, const std::vector<char>& is_held);
  bool spread(std::size_t side, const std::vector<char>& is_held);
  void begin();
  bool fill(std::size_t side, const std::vector<char>& is_held);

  std::vector<Edge> edges_;
  Neighbours neighbours_;
  std::vector<double> area_;            ///< of each particle [m^2]
  std::vector<std::uint32_t> is_cut_;   ///< of each edge, the search that cut it
  std::vector<std::uint32_t> reached_;  ///< of each particle, search x 2 + side
  std::array<Index, 2> through_ = {kNone, kNone};
  std::uint32_t search_ = 0;
  std::array<Flood, 2> floods_;  ///< below and above
  bool meet_ = false;            ///< both sides are connected
};

}  // namespace weft
