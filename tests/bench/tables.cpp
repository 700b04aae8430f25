#include "tests/bench/tables.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <thread>

#include "core/forces/grid_pass.h"

namespace weft::bench {
namespace {

const char* outcome_name(Outcome outcome) {
  static constexpr const char* kNames[] = {"ran", "failed", "not run"};
  return kNames[static_cast<int>(outcome)];
}

std::string compiler_name() {
#ifdef __clang__
  return std::string("clang++ ") + __clang_version__;
#else
  return std::string("g++ ") + __VERSION__;
#endif
}

/// First value of a key of /proc/cpuinfo.
std::string cpu_info(const std::string& key) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind(key, 0) != 0) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

/// Those of the processor's features that decide how fast the kernels are.
std::string cpu_features() {
  const std::string all = cpu_info("flags").append(" ");
  std::string found;
  for (const char* name : {"sse2", "ssse3", "sse4_1", "avx", "avx2", "fma", "avx512f", "avx512bw"})
    if (all.find(std::string(name).append(" ")) != std::string::npos)
      found.append(found.empty() ? "" : " ").append(name);
  return found;
}

}  // namespace

std::string load_average() {
  std::ifstream file("/proc/loadavg");
  std::string minute, five, fifteen;
  if (!(file >> minute >> five >> fifteen)) return "unknown";
  return minute + ", " + five + ", " + fifteen + " in 1, 5, 15 minutes, on " +
         std::to_string(std::thread::hardware_concurrency()) + " processors";
}

Csv::Csv(const std::string& path, const std::vector<std::string>& columns)
    : file_(path), columns_(columns.size()) {
  if (!file_) throw std::runtime_error("cannot write " + path);
  for (std::size_t n = 0; n < columns.size(); ++n) write(columns[n], n);
  end_row(columns.size());
}

void Csv::write(const std::string& text, std::size_t n) {
  if (n > 0) file_ << ',';
  if (text.find_first_of(",\"") == std::string::npos) {
    file_ << text;
    return;
  }
  file_ << '"';
  for (const char c : text) {
    if (c == '"') file_ << c;
    file_ << c;
  }
  file_ << '"';
}

void Csv::write(double value, std::size_t n) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", value);
  write(std::string(buffer), n);
}

void Csv::end_row(std::size_t count) {
  if (count != columns_) throw std::logic_error("a row of the table has a column too many or few");
  file_ << '\n' << std::flush;
}

Tables::Tables(const std::string& directory, const std::string& commit)
    : directory_(directory), commit_(commit) {}

Tables::Accuracy::Accuracy(const std::string& directory)
    : cells(directory + "/accuracy.csv",
            {"scene",          "fabric",         "n",        "solver",  "setting", "factor",
             "damping_sweeps", "least_substeps", "sweeps",   "outcome", "reason",  "substeps",
             "cpu_per_second", "timed_runs",     "position", "strain",  "energy",  "momentum",
             "mean_shape",     "penetration_m",  "commit"}),
      references(
          directory + "/references.csv",
          {"scene", "fabric", "n", "how", "self_error", "compared_from_s", "positions_to_s",
           "strains_to_s", "energies_to_s", "horizon_s", "noise_of_position", "noise_of_strain",
           "noise_of_energy", "noise_of_mean_shape", "cpu_seconds", "missing", "commit"}),
      spatial(directory + "/spatial.csv",
              {"scene", "fabric", "n", "against", "position", "commit"}) {}

Tables::Accuracy& Tables::accuracy() {
  if (!accuracy_) accuracy_.emplace(directory_);
  return *accuracy_;
}

void Tables::write_machine(const std::string& load_at_start, double cpu_seconds) {
  Csv csv(directory_ + "/machine.csv", {"key", "value"});
  csv.row("commit", commit_);
  csv.row("compiler", compiler_name());
#ifdef NDEBUG
  csv.row("build", "optimised, without assertions");
#else
  csv.row("build", "with assertions");
#endif
  csv.row("processor", cpu_info("model name"));
  csv.row("features", cpu_features());
  csv.row("kernels", std::string(simd_level()));
  csv.row("clock", "CPU time of the thread");
  csv.row("load of the machine at the start", load_at_start);
  csv.row("load of the machine at the end", cpu_seconds > 0 ? load_average() : "the run was cut");
  csv.row("CPU seconds of all measurements", cpu_seconds);
}

void Tables::add_case(const CaseResult& result) {
  const Reference& r = result.reference;
  const auto at = [&](std::size_t sample) {
    return static_cast<double>(sample) * result.scene->sample_every / result.def.tick_rate;
  };
  accuracy().references.row(result.scene->name, result.fabric, result.n, r.how, r.self_error,
                            at(r.compared.first), at(r.compared.positions), at(r.compared.strains),
                            at(r.compared.energies), result.scene->ticks / result.def.tick_rate,
                            r.noise.position, r.noise.strain, r.noise.energy, r.noise.mean_shape,
                            r.cpu_seconds, r.missing, commit_);
  for (const Cell& c : result.cells) {
    const ErrorVector& e = c.error;
    const Setting& s = c.setting;
    accuracy().cells.row(c.scene, c.fabric, c.n, s.solver, s.name, s.factor, s.damping_sweeps,
                         s.substeps, s.sweeps, outcome_name(c.outcome), c.reason, c.substeps,
                         c.cpu_per_second, c.timed_runs, e.position, e.strain, e.energy, e.momentum,
                         e.mean_shape, e.penetration, commit_);
  }
}

void Tables::add_spatial(const CaseResult& coarse, const CaseResult& fine) {
  if (!coarse.reference.missing.empty() || !fine.reference.missing.empty()) return;
  const std::size_t first =
      std::max(coarse.reference.compared.first, fine.reference.compared.first);
  const std::size_t last =
      std::min(coarse.reference.compared.positions, fine.reference.compared.positions);
  if (last < first) return;
  accuracy().spatial.row(coarse.scene->name, coarse.fabric, coarse.n, fine.n,
                         spatial_error(coarse.def.cloths[0], coarse.reference.path,
                                       fine.def.cloths[0], fine.reference.path, first, last),
                         commit_);
}

void Tables::write_kernels(const std::vector<KernelFigure>& figures) {
  Csv csv(directory_ + "/kernels.csv",
          {"figure", "value", "unit", "bar", "runs", "vectors", "load", "commit"});
  for (const KernelFigure& f : figures)
    csv.row(f.name, f.value, f.unit, f.bar, f.runs, std::string(simd_level()), load_average(),
            commit_);
}

void Tables::write_parts(const std::vector<PartFigure>& figures) {
  Csv csv(directory_ + "/parts.csv", {"scene", "solver", "off", "ticks", "cpu_per_second",
                                      "moved_m", "same_bits", "runs", "vectors", "load", "commit"});
  for (const PartFigure& f : figures)
    csv.row(f.scene, f.solver, f.off, f.ticks, f.cpu_per_second, f.moved,
            f.same_bits ? "yes" : "no", f.runs, std::string(simd_level()), load_average(), commit_);
}

void Tables::write_real_time(const std::vector<RealTimeFigure>& figures) {
  Csv csv(directory_ + "/real_time.csv",
          {"case", "kind", "seconds_looked_at", "dearest_second", "springs", "air", "contact",
           "other", "substeps", "twice_the_substeps", "wall_two_threads", "implicit", "runs",
           "vectors", "load", "commit"});
  for (const RealTimeFigure& f : figures)
    csv.row(f.name, f.kind, f.seconds_looked_at, f.dearest, f.springs, f.air, f.contact, f.other,
            f.substeps, f.twice, f.wall_two, f.implicit, f.runs, std::string(simd_level()),
            load_average(), commit_);
}

void Tables::write_threads(const std::vector<ThreadFigure>& figures) {
  Csv csv(directory_ + "/threads.csv",
          {"scene", "ticks", "share_in_chunks", "wall_s_one_thread", "wall_ratio", "cpu_ratio",
           "same_bits", "runs", "vectors", "load", "commit"});
  for (const ThreadFigure& f : figures)
    csv.row(f.scene, f.ticks, f.offered, f.wall_one, f.wall_ratio, f.cpu_ratio,
            f.same_bits ? "yes" : "no", f.runs, std::string(simd_level()), load_average(), commit_);
}

void Tables::write_shaking(const std::vector<ShakingFigure>& figures) {
  Csv csv(
      directory_ + "/shaking.csv",
      {"solver", "substeps", "sweeps", "fabric", "rigidity_n_m", "n", "insult", "seeds",
       "from_rest", "back", "gained_energy", "bounded", "rescues", "vectors", "load", "commit"});
  for (const ShakingFigure& f : figures)
    csv.row(f.solver, f.substeps, f.sweeps, f.fabric, f.rigidity, f.n, f.disturbance, f.seeds,
            f.from_rest, f.back, f.gained_energy, f.bounded, f.rescues, std::string(simd_level()),
            load_average(), commit_);
}

void Tables::write_contact(const std::vector<ContactSpeed>& figures) {
  Csv csv(directory_ + "/contact.csv",
          {"state",      "n",       "how",          "substeps",       "pairs",
           "rows",       "tick_ms", "elastic_ms",   "broad_phase_ms", "pairs_ms",
           "regions_ms", "rows_ms", "repulsion_ms", "friction_ms",    "crossings",
           "ticks",      "runs",    "missing",      "vectors",        "load",
           "commit"});
  for (const ContactSpeed& f : figures)
    csv.row(f.state, f.n, f.how, f.substeps, f.pairs, f.rows, f.tick, f.elastic, f.broad_phase,
            f.pair_tests, f.regions, f.row_making, f.repulsion, f.friction, f.crossings, f.ticks,
            f.runs, f.missing, std::string(simd_level()), load_average(), commit_);
}

void Tables::write_contact_cases(const std::vector<CaseFigure>& figures) {
  static constexpr const char* kWanted[] = {"", "at most", "at least"};
  Csv csv(directory_ + "/contact_cases.csv", {"scene", "figure", "value", "unit", "wanted", "bar",
                                              "runs", "vectors", "load", "commit"});
  for (const CaseFigure& f : figures)
    csv.row(f.scene, f.name, f.value, f.unit, kWanted[static_cast<int>(f.kind)], f.bar, f.runs,
            std::string(simd_level()), load_average(), commit_);
}

}  // namespace weft::bench
