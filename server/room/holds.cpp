#include "server/room/holds.h"

#include <algorithm>
#include <iterator>
#include <string>

#include "server/constants.h"
#include "server/room/refusals.h"

namespace weft::server {

using proto::ErrorCode;
using proto::ViewerId;

Hand* Holds::find(ViewerId viewer, std::uint32_t drag) {
  const auto found = std::find_if(hands_.begin(), hands_.end(), [&](const Hand& hand) {
    return hand.viewer == viewer && hand.drag == drag;
  });
  return found == hands_.end() ? nullptr : &*found;
}

const Hand* Holds::holder(GrabId grab) const {
  const auto found = std::find_if(hands_.begin(), hands_.end(),
                                  [&](const Hand& hand) { return hand.grab == grab; });
  return found == hands_.end() ? nullptr : &*found;
}

void Holds::remove(GrabId grab) {
  std::erase_if(hands_, [&](const Hand& hand) { return hand.grab == grab; });
}

std::vector<Hand> Holds::of(ViewerId viewer) const {
  std::vector<Hand> list;
  std::copy_if(hands_.rbegin(), hands_.rend(), std::back_inserter(list),
               [&](const Hand& hand) { return hand.viewer == viewer; });
  return list;
}

std::vector<Hand> Holds::expired(double now, double lease) const {
  std::vector<Hand> list;
  std::copy_if(hands_.rbegin(), hands_.rend(), std::back_inserter(list),
               [&](const Hand& hand) { return now - hand.heard >= lease; });
  return list;
}

void Holds::renew_leases(double now) {
  for (Hand& hand : hands_) hand.heard = now;
}

ViewerId Holds::owner(PinId pin) const {
  const auto found = pin_owners_.find(pin);
  return found == pin_owners_.end() ? 0 : found->second;
}

bool Holds::pass_pins(ViewerId from, ViewerId to) {
  bool any = false;
  for (auto& [pin, owner] : pin_owners_) {
    if (owner != from) continue;
    owner = to;
    any = true;
  }
  return any;
}

void Holds::clear() {
  hands_.clear();
  pin_owners_.clear();
}

std::optional<proto::Error> check_new_hand(const Holds& holds, ViewerId viewer, std::uint32_t drag,
                                           const proto::ServerLimits& limits) {
  std::size_t own = 0;
  for (const Hand& hand : holds.hands()) {
    if (hand.viewer != viewer) continue;
    ++own;
    if (hand.drag == drag)
      return field_error(ErrorCode::drag_exists, "this viewer already has a drag with this number",
                         "drag", drag, "end it or use another number");
  }
  if (own >= limits.drags_per_viewer)
    return too_many("drags of one viewer", limits.drags_per_viewer,
                    "end one first; with the policy one_hand a viewer has one");
  if (holds.hands().size() >= limits.drags) return too_many("drags", limits.drags);
  return std::nullopt;
}

std::optional<proto::Error> check_free(const Holds& holds, const ServedWorld& world,
                                       ViewerId viewer, Index particle) {
  for (const Grab<float>& grab : world.grabs().list) {
    const Hand* const hand = holds.holder(grab.id);
    if (!hand || hand->viewer == viewer) continue;
    if (std::find(grab.particles.begin(), grab.particles.end(), particle) != grab.particles.end())
      return field_error(ErrorCode::held, "another hand holds this particle", "particle",
                         static_cast<std::uint32_t>(particle), "take another or wait");
  }
  return std::nullopt;
}

std::size_t pinned_particles(const ServedWorld& world, const Holds& holds, ViewerId viewer) {
  std::size_t count = 0;
  for (const Pin& pin : world.pins().list) {
    if (holds.owner(pin.id) == viewer) count += pin.particles.size();
  }
  return count;
}

std::optional<proto::Error> check_width(const ServedWorld& world, Index particle, double radius,
                                        std::size_t already) {
  const std::size_t count = world.model().mass.size();
  const std::size_t most = std::max(kNarrowHold, count / kHoldsBeside);
  if (count <= most || already + particles_in_disc(world.model(), particle, radius).size() <= most)
    return std::nullopt;
  proto::Error error = proto::make_error(
      ErrorCode::held,
      already > 0 ? "with so many pins a viewer leaves others nothing to hold"
                  : "a hold so wide leaves others nothing to hold",
      "take less: of " + std::to_string(count) + " particles at most " + std::to_string(most));
  error.field = "radius";
  error.value = proto::number_text(radius);
  return error;
}

std::vector<proto::PinInfo> pins_of(const ServedWorld& world, const Holds& holds) {
  std::vector<proto::PinInfo> list;
  for (const Pin& pin : world.pins().list)
    list.push_back(pin_info(world, pin, holds.owner(pin.id)));
  return list;
}

std::vector<proto::GrabInfo> grabs_of(const ServedWorld& world, const Holds& holds,
                                      bool with_force) {
  std::vector<proto::GrabInfo> list;
  for (const Grab<float>& grab : world.grabs().list) {
    if (const auto own = world.scene_hand(grab.id))
      list.push_back(grab_info(world, grab, 0, static_cast<std::uint32_t>(*own)));
    else if (const Hand* const hand = holds.holder(grab.id))
      list.push_back(grab_info(world, grab, hand->viewer, hand->drag));
  }
  if (!with_force) {
    for (proto::GrabInfo& grab : list) grab.force.reset();
  }
  return list;
}

void grab_samples(const ServedWorld& world, const Holds& holds,
                  std::vector<proto::GrabSample>& samples) {
  samples.clear();
  for (const Grab<float>& grab : world.grabs().list) {
    const Hand* const hand = holds.holder(grab.id);
    samples.push_back(grab_sample(world, grab, hand ? hand->viewer : 0));
  }
}

}  // namespace weft::server
