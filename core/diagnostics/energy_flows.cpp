// Sums of energy flows.

#include "core/diagnostics/energy_flows.h"

namespace weft {

EnergyFlows& operator+=(EnergyFlows& sum, const EnergyFlows& more) {
  sum.hands += more.hands;
  sum.slings += more.slings;
  sum.pins += more.pins;
  sum.objects += more.objects;
  sum.grippers += more.grippers;
  sum.wind += more.wind;
  sum.push_out += more.push_out;
  sum.damping += more.damping;
  sum.drag += more.drag;
  sum.air += more.air;
  sum.friction += more.friction;
  sum.impacts += more.impacts;
  sum.self_contact += more.self_contact;
  return sum;
}

}  // namespace weft
