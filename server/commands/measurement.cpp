// Steps and measures a world, and judges what crossed.

#include "server/commands/measurement.h"

#include <algorithm>
#include <cassert>
#include <ctime>

#include "core/instantiate.h"
#include "server/clock.h"

namespace weft::server {
namespace {

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

/// Crossings that break the scene's promise: contact of the seed promises nothing, and without
/// self-contact cloths may pass through each other.
template <class Real>
std::size_t broken_promises(const World<Real>& world, const WorldCrossings& found) {
  if (contact_of(world.def()) != ContactModel::certified) return 0;
  return found.objects.all() + (has_guard(world.def()) ? found.cloths.all() : 0);
}

}  // namespace

template <class Real>
bool measure_tick(World<Real>& world, WorkLimit& limit, Measurement<Real>& m) {
  const double cpu = cpu_seconds(), wall = process_seconds();
  const TickReport& report = [&]() -> const TickReport& {
    const WorkLimit::Scope scope(limit);
    return world.step();
  }();
  if (report.halted) return false;
  const double seconds = process_seconds() - wall;
  m.cpu += cpu_seconds() - cpu;
  m.wall += seconds;
  m.ticks.push_back(seconds);
  for (std::size_t i = 0; i < kStageCount; ++i) {
    m.stages.stages[i].seconds += report.profile.stages[i].seconds;
    m.stages.stages[i].work += report.profile.stages[i].work;
  }
  m.divergences += report.divergence ? 1 : 0;
  m.stopped += was_stopped(report) ? 1 : 0;
  m.damped_substeps += report.damped_substeps;
  m.least_substeps =
      m.least_substeps == 0 ? report.substeps : std::min(m.least_substeps, report.substeps);
  m.most_substeps = std::max(m.most_substeps, report.substeps);
  m.largest_strain = std::max(m.largest_strain, report.largest_strain);
  return true;
}

template <class Real>
void look(World<Real>& world, bool judged, bool led_out, CrossingCounter<Real>& counter,
          Measurement<Real>& m) {
  ++m.checks;
  m.deepest = std::max(m.deepest, world.deepest_penetration());
  const WorldCrossings found = judged ? m.verdict.crossing_now : counter.count(world);
  if (found.total() == 0) return;
  m.cloth_crossings += found.cloths.proper + found.cloths.touching;
  m.object_crossings += found.objects.proper + found.objects.touching;
  ++m.crossed_ticks;
  if (m.first_crossed == 0) m.first_crossed = static_cast<int>(world.tick());
  if (world.report().time <= world.def().verdict.clear_after) return;
  m.late_crossings += found.total();
  (led_out ? m.while_led_out : m.broken_promises) += broken_promises(world, found);
}

WEFT_INSTANTIATE_FUNCTIONS(measure_tick, look)

}  // namespace weft::server
