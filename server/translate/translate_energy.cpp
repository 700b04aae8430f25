#include "server/translate/translate_energy.h"

#include "proto/messages/command_writer.h"

namespace weft::server {

template <class Real>
std::optional<proto::EnergyBalance> balance_of(const World<Real>& world) {
  const EnergyBalance* balance = world.energy_balance();
  if (!balance) return std::nullopt;
  const EnergyFlows& f = balance->flows;
  proto::EnergyBalance out;
  out.since = balance->since;
  out.start = balance->start;
  out.work = {.hands = f.hands,
              .slings = f.slings,
              .pins = f.pins,
              .objects = f.objects,
              .grippers = f.grippers,
              .wind = f.wind,
              .push_out = f.push_out,
              .disturbances = balance->disturbances,
              .commands = balance->commands};
  out.losses = {.damping = f.damping,
                .drag = f.drag,
                .air = f.air,
                .friction = f.friction,
                .impacts = f.impacts,
                .self_contact = f.self_contact,
                .sleep = balance->sleep,
                .recovery = balance->recovery,
                .solver = balance->lost()};
  out.now = balance->now.total();
  return out;
}

template std::optional<proto::EnergyBalance> balance_of(const World<float>&);
template std::optional<proto::EnergyBalance> balance_of(const World<double>&);

nlohmann::ordered_json json_of(const proto::EnergyBalance& balance) {
  return proto::CommandWriter::json_of(balance);
}

}  // namespace weft::server
