#include "tests/fuzz/table.h"

#include <algorithm>
#include <cctype>
#include <cstdio>

namespace weft::fuzz {
namespace {

constexpr std::size_t kMostListed = 40;
constexpr double kMostHalted = 0.02;  // of all scenes may meet the tick limit

/// A text without its numbers, so that what differs in them alone is one kind.
std::string kind_of(const std::string& text) {
  std::string kind;
  for (const char letter : text) {
    const bool digit = std::isdigit(static_cast<unsigned char>(letter)) != 0;
    if (!digit)
      kind += letter;
    else if (kind.empty() || kind.back() != '#')
      kind += '#';
  }
  return kind;
}

/// Of a report the lines that tell what it is: the first, and those of the project's own functions.
std::string essence(const std::string& words) {
  std::string out;
  int lines = 0;
  for (std::size_t at = 0; at < words.size() && lines < 14;) {
    const std::size_t end = std::min(words.find('\n', at), words.size());
    const std::string line = words.substr(at, end - at);
    at = end + 1;
    const bool telling = line.find("ERROR") != line.npos ||
                         line.find("runtime error") != line.npos ||
                         line.find("weft") != line.npos || line.find("ssert") != line.npos ||
                         line.find("what()") != line.npos || line.find("longer than") != line.npos;
    if (!telling) continue;
    out += "    " + line.substr(0, 220) + "\n";
    ++lines;
  }
  return out;
}

std::string count_line(const char* what, std::uint64_t count) {
  char line[120];
  std::snprintf(line, sizeof line, "%-44s %llu\n", what, static_cast<unsigned long long>(count));
  return line;
}

std::string kinds_text(const std::map<std::string, int>& kinds) {
  std::vector<std::pair<int, std::string>> sorted;
  for (const auto& [kind, count] : kinds) sorted.emplace_back(count, kind);
  std::sort(sorted.rbegin(), sorted.rend());
  if (sorted.size() > kMostListed) sorted.resize(kMostListed);
  std::string text;
  for (const auto& [count, kind] : sorted)
    text += "  " + std::to_string(count) + " x " + kind + "\n";
  return text;
}

}  // namespace

void Table::add(const std::string& name, const Outcome& outcome, const Ending& ending) {
  ++runs_;
  const bool refused = outcome.refused[0] != '\0';
  refused_ += refused;
  bare_refusals_ += outcome.bare_refusal;
  if (refused) {
    std::string reason = kind_of(outcome.refused);
    const std::size_t limit = reason.find(": allowed is");
    const std::size_t value = reason.find(" = ");
    if (limit != reason.npos && value < limit) reason.erase(value, limit - value);
    ++refusals_[reason];
  }
  commands_ += outcome.commands;
  errors_ += outcome.errors;
  ticks_ += outcome.ticks;
  cpu_ += outcome.cpu;
  tick_.take(outcome.longest_tick, name);
  wait_.take(outcome.longest_wait, std::string(outcome.longest_wait_in) + ", " + name);
  build_.take(outcome.longest_build, name);
  ticks_over_ += outcome.ticks_over;
  waits_over_ += outcome.waits_over;
  recoveries_ += outcome.recoveries;
  halts_ += outcome.halts;
  if (outcome.halts > 0) {
    ++halted_runs_;
    ++halt_causes_[kind_of(outcome.halt)];
    halted_.push_back(name);
  }
  not_finite_ += outcome.not_finite_energy + outcome.not_finite_frames;
  false_promises_ += outcome.false_promises;
  internal_ += outcome.internal_errors;
  problems_ += outcome.problems;

  const std::string repeat = "\n    ./dev fuzz " + name + "\n";
  if (ending.kind != Ending::Kind::well) {
    ++(ending.kind == Ending::Kind::crashed ? crashes_ : hangs_);
    failures_.push_back(ending.how + " in " + outcome.doing + repeat + essence(ending.words));
  } else if (!refused && !outcome.ended) {
    failures_.push_back("ended early in " + std::string(outcome.doing) + repeat);
  }
  if (outcome.problems > 0) failures_.push_back(outcome.problem + repeat);
  if (outcome.bare_refusal)
    failures_.push_back("a refusal without field or limit: " + std::string(outcome.refused) +
                        repeat);
  if (outcome.ticks_over + outcome.waits_over == 0) return;
  char line[160];
  std::snprintf(line, sizeof line, "tick %.2f s, wait %.2f s (%s)", outcome.longest_tick,
                outcome.longest_wait, outcome.longest_wait_in);
  slow_.push_back(line + repeat);
}

bool Table::good() const {
  return failures_.empty() && slow_.empty() &&
         static_cast<double>(halted_runs_) <= kMostHalted * static_cast<double>(runs_) + 1;
}

std::string Table::text() const {
  std::string out;
  for (const std::string& failure : failures_) out += "FAILED  " + failure;
  for (std::size_t k = 0; k < std::min(slow_.size(), kMostListed); ++k)
    out += "SLOW    " + slow_[k];
  if (refused_ > 0) out += "refused, by kind:\n" + kinds_text(refusals_);
  if (halts_ > 0) out += "halts, by cause:\n" + kinds_text(halt_causes_);
  for (const std::string& name : halted_) out += "halted  ./dev fuzz " + name + "\n";
  out += count_line("scenes", runs_) + count_line("  refused", refused_) +
         count_line("  refused without field or limit", bare_refusals_) +
         count_line("commands", commands_) + count_line("  answered by an error", errors_) +
         count_line("ticks", ticks_) + count_line("crashes", crashes_) +
         count_line("hangs", hangs_) + count_line("ticks beyond the limit", ticks_over_) +
         count_line("waits between ticks beyond the limit", waits_over_) +
         count_line("blow-ups recovered from and told", recoveries_) + count_line("halts", halts_) +
         count_line("  scenes with a halt", halted_runs_) +
         count_line("energies or frames that are not finite", not_finite_) +
         count_line("guarantee held while something crosses", false_promises_) +
         count_line("internal errors", internal_) + count_line("problems in all", problems_);
  char line[300];
  std::snprintf(line, sizeof line,
                "longest tick  %.3f s of CPU time (%s)\nlongest wait  %.3f s (%s)\n", tick_.seconds,
                tick_.name.c_str(), wait_.seconds, wait_.name.c_str());
  out += line;
  std::snprintf(line, sizeof line, "longest build %.3f s (%s)\nCPU time      %.1f s\n",
                build_.seconds, build_.name.c_str(), cpu_);
  return out + line;
}

}  // namespace weft::fuzz
