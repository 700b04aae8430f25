// How far particles go, and what of the rows of Contact that makes matter.

#include <algorithm>
#include <limits>

#include "core/contact/objects/contact.h"
#include "core/contact/travel.h"

namespace weft {

/// Measures how far everybody is from where the rows were built, now or after the coming drift.
/// @return whether all stay within their reach
template <class Real>
bool Contact<Real>::measure_way(const ClothState<Real>& state, Real dt) {
  TravelPass<Real> pass;
  pass.particles = state.x.size();
  pass.x = state.x.data()->data();
  pass.v = state.v.data()->data();
  pass.dt = dt;
  pass.from = x_rows_.data()->data();
  pass.reach = row_reach_.data();
  pass.travel2 = travel2_.data();
  return measure_travel(pass, executor_);
}

/// The same for those alone whom the rows have moved or pushed since everybody was measured; lone
/// ones have been as they responded.
template <class Real>
bool Contact<Real>::measure_pushed_way(const ClothState<Real>& state, Real dt) {
  bool within = lone_response_.within;
  for (const std::size_t r : pushed_rows_) {
    const ContactRow<Real>& row = rows_[r];
    for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
      const auto i = static_cast<std::size_t>(row.particle[k]);
      const Vec3<Real> way = state.x[i] - x_rows_[i];
      const Real end2 = (way + state.v[i] * dt).squaredNorm();
      travel2_[i] = std::max(way.squaredNorm(), end2);
      within &= end2 <= row_reach_[i] * row_reach_[i];
    }
  }
  return within;
}

/// What of the rows tells whether they matter, close together.
template <class Real>
void Contact<Real>::measure_rooms() {
  // With some room for what the response of other rows changes.
  constexpr Real kRoom = Real(0.7);
  const auto square = [](Real room) { return room > 0 ? room * room : Real(-1); };
  rooms_.clear();
  for (const ContactRow<Real>& row : rows_) {
    RowRoom<Real> room;
    for (std::size_t k = 0; k < 3; ++k)
      room.particle[k] = row.particle[k < static_cast<std::size_t>(row.count) ? k : 0];
    room.touch2 = row.responds ? square((row.distance - row.thickness - Real(kTouchSlack)) * kRoom)
                               : std::numeric_limits<Real>::infinity();
    room.cross2 = square(row.least_height - row.keep);
    rooms_.push_back(room);
  }
}

/// Lone rows are worked on apart from the others.
template <class Real>
void Contact<Real>::find_lone_rows(std::size_t particles) {
  lone_rows_.find(rows_, rooms_, cloths_, particles);
  joint_rows_.clear();
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    if (!lone_rows_.has(r)) joint_rows_.push_back(r);
  }
}

template <class Real>
LonePass<Real> Contact<Real>::lone_pass(ClothState<Real>& state, Real dt) {
  LonePass<Real> pass;
  pass.x = state.x.data()->data();
  pass.v = state.v.data()->data();
  pass.dt = dt;
  pass.slack = Real(kTouchSlack);
  pass.push_part = Real(kPushOutPart);
  pass.push_most = Real(kPushOutSpeed) * dt;
  pass.from = x_rows_.data()->data();
  pass.reach = row_reach_.data();
  pass.travel2 = travel2_.data();
  return pass;
}

#define WEFT_INSTANTIATE(Real)                                                    \
  template bool Contact<Real>::measure_way(const ClothState<Real>&, Real);        \
  template bool Contact<Real>::measure_pushed_way(const ClothState<Real>&, Real); \
  template void Contact<Real>::measure_rooms();                                   \
  template void Contact<Real>::find_lone_rows(std::size_t);                       \
  template LonePass<Real> Contact<Real>::lone_pass(ClothState<Real>&, Real);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
