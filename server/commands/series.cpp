#include "server/commands/series.h"

#include <cassert>
#include <cstring>
#include <limits>
#include <vector>

namespace weft::server {
namespace {

/// Appends numbers to a record.
class RecordBuilder {
 public:
  explicit RecordBuilder(std::string& record) : record_(record) { record_.clear(); }

  template <class Number>
  void add(Number value) {
    record_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class Scalar>
  void add(const Vec3<Scalar>& v) {
    for (int k = 0; k < 3; ++k) add(v[k]);
  }

 private:
  std::string& record_;
};

template <class Real>
std::size_t pins_with_forces(const World<Real>& world) {
  return solver_of(world.def()) == SolverKind::relaxation ? 0 : world.pins().list.size();
}

template <class Real>
NpyTable columns(const World<Real>& world, std::size_t records) {
  std::vector<NpyField> fields = {{"tick", 'u', 8, {}}};
  // Seconds; joules, the work since the record before; strain of the most stretched element.
  for (const char* name : {"time", "kinetic", "stretch", "bending", "gravity", "work", "strain"})
    fields.push_back({name, 'f', 8, {}});
  const auto add_vectors = [&](const char* name, std::size_t count, std::size_t bytes) {
    if (count > 0) fields.push_back({name, 'f', bytes, {count, 3}});
  };
  // Forces [N]: of each pin and scene hand on the cloth, of the cloth on each object.
  add_vectors("pins", pins_with_forces(world), sizeof(double));
  add_vectors("hands", world.def().hands.size(), sizeof(double));
  add_vectors("objects", world.def().colliders.size(), sizeof(double));
  add_vectors("x", world.model().mass.size(), sizeof(Real));
  add_vectors("v", world.model().mass.size(), sizeof(Real));
  return npy_table(std::move(fields), records);
}

const Vec3d kUnknown = Vec3d::Constant(std::numeric_limits<double>::quiet_NaN());

/// Force of a hand of the scene; zero while it does not hold [N].
template <class Real>
Vec3d hand_force(const World<Real>& world, std::size_t hand) {
  for (const Grab<Real>& grab : world.grabs().list) {
    if (world.scene_hand(grab.id) == hand) return grab.told;
  }
  return Vec3d::Zero();
}

template <class Real>
void add_forces(const World<Real>& world, RecordBuilder& record) {
  const Reactions* reactions = world.reactions();
  for (std::size_t k = 0; k < pins_with_forces(world); ++k)
    record.add(reactions ? reactions->pins.at(k).force : kUnknown);
  for (std::size_t k = 0; k < world.def().hands.size(); ++k)
    record.add(reactions ? hand_force(world, k) : kUnknown);
  for (std::size_t k = 0; k < world.def().colliders.size(); ++k)
    record.add(reactions && k < reactions->colliders.size() ? reactions->colliders[k] : kUnknown);
}

}  // namespace

template <class Real>
Series<Real>::Series(const std::string& path, World<Real>& world, int every, int ticks)
    : file_(path), table_(columns(world, 1 + static_cast<std::size_t>(ticks / every))),
      every_(every) {
  assert(every >= 1 && ticks >= 0);
  world.measure_forces(true);
  file_.write(npy_header(table_));
  write_record(world);
}

template <class Real>
void Series<Real>::note_tick(const World<Real>& world) {
  work_ += world.report().work;
  if (++passed_ < every_) return;
  write_record(world);
  passed_ = 0;
  work_ = 0;
}

template <class Real>
void Series<Real>::write_record(const World<Real>& world) {
  RecordBuilder record(record_);
  const TickReport& report = world.report();
  const Energies& energy = report.energies;
  record.add(std::uint64_t{world.tick()});
  for (const double value : {report.time, energy.kinetic, energy.stretch, energy.bending,
                             energy.gravity, work_, report.largest_strain})
    record.add(value);
  add_forces(world, record);
  for (const Vec3<Real>& x : world.state().x) record.add(x);
  for (const Vec3<Real>& v : world.state().v) record.add(v);
  assert(record_.size() == table_.record_bytes);
  file_.write(record_);
}

template class Series<float>;
template class Series<double>;

}  // namespace weft::server
