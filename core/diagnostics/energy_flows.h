#pragma once

// Energy that came to the cloth and that left it, by cause.

namespace weft {

/// Energy over a time [J].
struct EnergyFlows {
  // Work of what acts on the cloth; negative where the cloth does work on it.
  double hands = 0;
  double slings = 0;
  double pins = 0;      ///< moving ones, and pins that stop what they take hold of
  double objects = 0;   ///< moving ones: force times the speed of their surface
  double grippers = 0;  ///< their jaws, likewise
  double wind = 0;      ///< force of the air times the speed of the air
  double push_out = 0;  ///< contact: positions corrected without a velocity

  // Energy taken from the cloth.
  double damping = 0;   ///< by the dashpots of membrane and hinges
  double drag = 0;      ///< by `drag`, and by `relaxation.damping`
  double air = 0;       ///< by the resistance of the air: its force times its speed over the cloth
  double friction = 0;  ///< of objects
  double impacts = 0;   ///< on objects, along their normals; of the seed's contact all it takes
  double self_contact = 0;  ///< of cloth with itself and other cloths, with friction
};

/// Calls visit(name, value) for what acts on the cloth.
template <class Flows, class Visit>
void visit_work(Flows& f, Visit&& visit) {
  visit("hands", f.hands);
  visit("slings", f.slings);
  visit("pins", f.pins);
  visit("objects", f.objects);
  visit("grippers", f.grippers);
  visit("wind", f.wind);
  visit("push_out", f.push_out);
}

/// Calls visit(name, value) for what takes energy from it.
template <class Flows, class Visit>
void visit_losses(Flows& f, Visit&& visit) {
  visit("damping", f.damping);
  visit("drag", f.drag);
  visit("air", f.air);
  visit("friction", f.friction);
  visit("impacts", f.impacts);
  visit("self_contact", f.self_contact);
}

/// Work less losses [J].
inline double net(const EnergyFlows& flows) {
  double sum = 0;
  visit_work(flows, [&sum](const char*, double work) { sum += work; });
  visit_losses(flows, [&sum](const char*, double loss) { sum -= loss; });
  return sum;
}

EnergyFlows& operator+=(EnergyFlows& sum, const EnergyFlows& more);

}  // namespace weft
