#include "core/contact/objects/lone_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/objects/lone_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once for each instruction set; the second inclusion guard belongs to that.
#include "core/contact/objects/lone_rows-inl.h"

#if HWY_ONCE
namespace weft {

namespace {

#define WEFT_DISPATCH(Real, Kind)                                                                \
  HWY_EXPORT(push_and_aim_##Kind);                                                               \
  HWY_EXPORT(aim_##Kind);                                                                        \
  HWY_EXPORT(sweep_##Kind);                                                                      \
  HWY_EXPORT(measure_pushed_##Kind);                                                             \
  HWY_EXPORT(next_crossing_##Kind);                                                              \
  void run_push_and_aim(const LoneView<Real>& rows, const LonePass<Real>& pass) {                \
    HWY_DYNAMIC_DISPATCH(push_and_aim_##Kind)(rows, pass);                                       \
  }                                                                                              \
  void run_aim(const LoneView<Real>& rows, const LonePass<Real>& pass) {                         \
    HWY_DYNAMIC_DISPATCH(aim_##Kind)(rows, pass);                                                \
  }                                                                                              \
  Real run_sweep(const LoneView<Real>& rows, const LonePass<Real>& pass, std::uint64_t& count) { \
    return HWY_DYNAMIC_DISPATCH(sweep_##Kind)(rows, pass, count);                                \
  }                                                                                              \
  bool run_measure_pushed(const LoneView<Real>& rows, const LonePass<Real>& pass) {              \
    return HWY_DYNAMIC_DISPATCH(measure_pushed_##Kind)(rows, pass);                              \
  }                                                                                              \
  std::size_t run_next_crossing(const LoneView<Real>& rows, const Real* travel2,                 \
                                std::size_t from) {                                              \
    return HWY_DYNAMIC_DISPATCH(next_crossing_##Kind)(rows, travel2, from);                      \
  }
WEFT_DISPATCH(float, f32)
WEFT_DISPATCH(double, f64)
#undef WEFT_DISPATCH

}  // namespace

template <class Real>
LoneView<Real> LoneRows<Real>::view() {
  LoneView<Real> view;
  view.count = row_.size();
  view.particle = particle_.data();
  for (std::size_t c = 0; c < 3; ++c) view.normal[c] = normal_[c].data();
  view.offset = offset_.data();
  view.thickness = thickness_.data();
  view.friction = friction_.data();
  view.touch2 = touch2_.data();
  view.cross2 = cross2_.data();
  view.least_speed = least_speed_.data();
  view.pushed = pushed_.data();
  return view;
}

template <class Real>
void LoneRows<Real>::clear() {
  row_.clear();
  particle_.clear();
  for (AlignedVector<Real>* array : {&normal_[0], &normal_[1], &normal_[2], &offset_, &thickness_,
                                     &friction_, &touch2_, &cross2_})
    array->clear();
}

template <class Real>
void LoneRows<Real>::find(const std::vector<ContactRow<Real>>& rows,
                          const std::vector<RowRoom<Real>>& rooms,
                          const std::vector<ContactDef>& cloths, std::size_t particles) {
  constexpr Index kNoRow = -1, kSeveral = -2;
  const auto cloth = [&](const ContactRow<Real>& row) -> const ContactDef& {
    return cloths[static_cast<std::size_t>(row.cloth)];
  };
  clear();
  is_lone_.assign(rows.size(), 0);
  row_of_.assign(particles, kNoRow);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const ContactRow<Real>& row = rows[r];
    const bool alone =
        row.count == 1 && row.responds && row.mover == kNone && cloth(row).restitution == 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
      Index& known = row_of_[static_cast<std::size_t>(row.particle[k])];
      known = known == kNoRow && alone ? static_cast<Index>(r) : kSeveral;
    }
  }
  for (std::size_t i = 0; i < particles; ++i) {
    if (row_of_[i] < 0) continue;
    const auto r = static_cast<std::size_t>(row_of_[i]);
    is_lone_[r] = 1;
    row_.push_back(r);
    particle_.push_back(static_cast<Index>(i));
    for (std::size_t c = 0; c < 3; ++c) normal_[c].push_back(rows[r].normal[static_cast<Index>(c)]);
    offset_.push_back(rows[r].offset);
    thickness_.push_back(rows[r].thickness);
    friction_.push_back(static_cast<Real>(cloth(rows[r]).friction));
    touch2_.push_back(rooms[r].touch2);
    cross2_.push_back(rooms[r].cross2);
  }
  least_speed_.resize(row_.size());
  begin_step();
}

template <class Real>
void LoneRows<Real>::push_and_aim(const LonePass<Real>& pass) {
  run_push_and_aim(view(), pass);
}

template <class Real>
void LoneRows<Real>::aim(const LonePass<Real>& pass) {
  run_aim(view(), pass);
}

template <class Real>
Real LoneRows<Real>::sweep(const LonePass<Real>& pass, std::uint64_t& evaluations) {
  return run_sweep(view(), pass, evaluations);
}

template <class Real>
bool LoneRows<Real>::measure_pushed(const LonePass<Real>& pass) {
  return run_measure_pushed(view(), pass);
}

template <class Real>
std::size_t LoneRows<Real>::next_crossing(const Real* travel2, std::size_t k) {
  return run_next_crossing(view(), travel2, k);
}

template class LoneRows<float>;
template class LoneRows<double>;

}  // namespace weft
#endif
