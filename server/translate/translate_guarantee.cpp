#include "server/translate/translate_guarantee.h"

#include <cmath>

#include "core/world/object_name.h"

namespace weft::server {

template <class Real>
proto::Crossings crossings_of(const World<Real>& world, CrossingCounter<Real>& counter,
                              std::vector<Meeting>& meetings) {
  proto::Crossings found;
  found.count = counter.count(world, &meetings).total();
  found.tick = world.tick();
  const double gap = smallest_gap(world);
  if (std::isfinite(gap)) found.smallest_gap = gap;
  return found;
}

template <class Real>
std::vector<std::string> voiding_colliders(const World<Real>& world) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < world.colliders().size(); ++k)
    if (world.colliders()[k].voided) names.push_back(object_name(world.def(), k));
  return names;
}

template <class Real>
proto::Guarantee guarantee_of(const World<Real>& world, const BadStarts& bad_starts) {
  proto::Guarantee guarantee;
  if (contact_of(world.def()) != ContactModel::certified) {
    guarantee.state = proto::GuaranteeState::none;
    return guarantee;
  }
  guarantee.covers.emplace_back("objects");
  if (has_guard(world.def())) guarantee.covers.emplace_back("cloth");
  const std::vector<std::string> forced = voiding_colliders(world);
  if (!forced.empty())
    guarantee.state = proto::GuaranteeState::broken;
  else if (!bad_starts.what.empty())
    guarantee.state = proto::GuaranteeState::bad_start;
  for (const std::string& name : forced)
    guarantee.reasons.push_back(name + " was forced through the cloth");
  guarantee.reasons.insert(guarantee.reasons.end(), bad_starts.what.begin(), bad_starts.what.end());
  guarantee.pairs = bad_starts.pairs;
  return guarantee;
}

#define WEFT_INSTANTIATE(Real)                                                       \
  template proto::Crossings crossings_of(const World<Real>&, CrossingCounter<Real>&, \
                                         std::vector<Meeting>&);                     \
  template std::vector<std::string> voiding_colliders(const World<Real>&);           \
  template proto::Guarantee guarantee_of(const World<Real>&, const BadStarts&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft::server
