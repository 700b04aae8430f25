#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "server/translate/translate_holds.h"

namespace weft::server {

/// A hand: its viewer, that viewer's number for it, and when it last sent a target.
struct Hand {
  GrabId grab = 0;
  proto::ViewerId viewer = 0;
  std::uint32_t drag = 0;
  double heard = 0;  ///< [s]
};

/// Which viewer holds the cloth where: hands, in the order in which they took hold, and the viewer
/// that set each pin.
class Holds {
 public:
  const std::vector<Hand>& hands() const { return hands_; }
  /// Null if there is none.
  Hand* find(proto::ViewerId viewer, std::uint32_t drag);
  /// The hand that holds by this grab; null if it is one of the scene's own.
  const Hand* holder(GrabId grab) const;
  void add(const Hand& hand) { hands_.push_back(hand); }
  void remove(GrabId grab);

  /// The hands of a viewer, the latest first.
  std::vector<Hand> of(proto::ViewerId viewer) const;
  /// Those that have not sent a target for so long, the latest first.
  /// @param now    [s]
  /// @param lease  [s]
  std::vector<Hand> expired(double now, double lease) const;
  /// Leases begin anew, as in a room that stands.
  void renew_leases(double now);

  void own(PinId pin, proto::ViewerId viewer) { pin_owners_[pin] = viewer; }
  void disown(PinId pin) { pin_owners_.erase(pin); }
  /// 0: the scene itself.
  proto::ViewerId owner(PinId pin) const;
  const std::map<PinId, proto::ViewerId>& pin_owners() const { return pin_owners_; }
  /// The pins of one viewer become another's: the same person that has come back.
  /// @return whether there are any
  bool pass_pins(proto::ViewerId from, proto::ViewerId to);

  /// No viewer holds anything.
  void clear();

 private:
  std::vector<Hand> hands_;
  std::map<PinId, proto::ViewerId> pin_owners_;
};

/// Why a viewer may not begin a drag of this number; nothing if it may.
std::optional<proto::Error> check_new_hand(const Holds& holds, proto::ViewerId viewer,
                                           std::uint32_t drag, const proto::ServerLimits& limits);
/// Particles in all pins of a viewer.
std::size_t pinned_particles(const ServedWorld& world, const Holds& holds, proto::ViewerId viewer);
/// Why a viewer that shares the cloth may not hold so much of it at once that others find nothing
/// to hold.
/// @param already  particles that it has pinned, if it pins
std::optional<proto::Error> check_width(const ServedWorld& world, Index particle, double radius,
                                        std::size_t already);
/// Why a viewer may not take hold of a particle: another viewer's hand has it.
std::optional<proto::Error> check_free(const Holds& holds, const ServedWorld& world,
                                       proto::ViewerId viewer, Index particle);

std::vector<proto::PinInfo> pins_of(const ServedWorld& world, const Holds& holds);
/// Grabs of the scene and of viewers.
/// @param with_force  otherwise without the force
std::vector<proto::GrabInfo> grabs_of(const ServedWorld& world, const Holds& holds,
                                      bool with_force);
/// The same for a frame; overwrites `samples`.
void grab_samples(const ServedWorld& world, const Holds& holds,
                  std::vector<proto::GrabSample>& samples);

}  // namespace weft::server
