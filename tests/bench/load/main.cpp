// Many viewers in one process: how many frames reach them, and how old these are.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>
#include <nlohmann/json.hpp>

#include "tests/bench/load/viewer.h"

namespace {

using namespace weft::load;

struct Options {
  std::string address = "127.0.0.1";
  unsigned short port = 0;
  int viewers = 200;
  int rooms = 0;    // room-0, room-1 and so on, among which they are spread; 0: the default one
  int stalled = 0;  // of these stop to read before the measurement
  double seconds = 10;
  std::string codec = "packed";
};

constexpr double kJoining = 60;   // [s]
constexpr double kSettling = 2;   // before the measurement [s]
constexpr int kPings = 40;        // the least round trip of so many tells the server's clock
constexpr int kJoinsAtOnce = 32;  // connections that are not ready yet

double percentile(const std::vector<float>& sorted, double share) {
  if (sorted.empty()) return 0;
  const auto at = static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1));
  return static_cast<double>(sorted[at]);
}

class Load {
 public:
  explicit Load(const Options& options) : options_(options) {
    const auto address = boost::asio::ip::make_address(options.address);
    plan_.server = {address, options.port};
    plan_.host = options.address + ":" + std::to_string(options.port);
    plan_.codec = options.codec;
    for (int k = 0; k < options.viewers; ++k)
      viewers_.push_back(std::make_unique<Viewer>(
          io_, plan_, options.rooms > 0 ? "room-" + std::to_string(k % options.rooms) : ""));
  }

  /// @return whether all viewers joined
  bool join() {
    for (int k = 0; k < kJoinsAtOnce; ++k) join_next();
    run_until([this] { return ready_ == options_.viewers || !lost_.empty(); }, kJoining);
    return ready_ == options_.viewers;
  }

  void measure() {
    double least = 1e9;
    for (int k = 0; k < kPings; ++k) {
      bool answered = false;
      viewers_.back()->ping([&](double offset, double round_trip) {
        answered = true;
        if (round_trip >= least) return;
        least = round_trip;
        plan_.offset = offset;
      });
      run_until([&] { return answered; }, 2);
    }
    for (int k = 0; k < options_.stalled; ++k) viewers_[static_cast<std::size_t>(k)]->stall();
    run_until([] { return false; }, kSettling);
    plan_.counting = true;
    run_until([] { return false; }, options_.seconds);
    plan_.counting = false;
  }

  nlohmann::json results() const {
    std::uint32_t first = ~0u, last = 0;
    std::uint64_t frames = 0, bytes = 0, fewest = ~0ull;
    std::vector<float> ages;
    for (auto k = static_cast<std::size_t>(options_.stalled); k < viewers_.size(); ++k) {
      const Arrivals& a = viewers_[k]->arrivals();
      frames += a.frames;
      bytes += a.bytes;
      fewest = std::min(fewest, a.frames);
      ages.insert(ages.end(), a.ages.begin(), a.ages.end());
      if (a.frames == 0) continue;
      first = std::min(first, a.first);
      last = std::max(last, a.last);
    }
    std::sort(ages.begin(), ages.end());
    const double made = last >= first ? last - first + 1 : 0;
    const double reading = options_.viewers - options_.stalled;
    return {{"viewers", options_.viewers},
            {"stalled", options_.stalled},
            {"lost", lost_},
            {"frames_made", made},
            {"delivered", made > 0 ? static_cast<double>(frames) / (made * reading) : 0},
            {"delivered_to_worst", made > 0 ? static_cast<double>(fewest) / made : 0},
            {"age_p50_ms", 1000 * percentile(ages, 0.5)},
            {"age_p99_ms", 1000 * percentile(ages, 0.99)},
            {"age_largest_ms", 1000 * percentile(ages, 1)},
            {"frames", frames},
            {"bytes_a_frame",
             frames > 0 ? static_cast<double>(bytes) / static_cast<double>(frames) : 0}};
  }

 private:
  void join_next() {
    if (joining_ == options_.viewers) return;
    viewers_[static_cast<std::size_t>(joining_++)]->start(
        [this] {
          ++ready_;
          join_next();
        },
        [this](const std::string& reason) { lost_.push_back(reason); });
  }

  /// Sleeps while nothing arrives: what viewers take of the machine the server has not.
  template <class Done>
  void run_until(Done&& done, double seconds) {
    const double end = now() + seconds;
    while (!done() && now() < end) {
      io_.run_one_for(std::chrono::milliseconds(10));
      io_.poll();
      if (!io_.stopped()) continue;
      if (!lost_.empty()) return;  // nobody is left
      io_.restart();
    }
  }

  Options options_;
  boost::asio::io_context io_;
  Plan plan_;
  std::vector<std::unique_ptr<Viewer>> viewers_;
  int joining_ = 0, ready_ = 0;
  std::vector<std::string> lost_;
};

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Viewers of a server in another process; prints what reaches them as JSON.");
  app.add_option("--address", options.address, "of the server");
  app.add_option("--port", options.port, "of the server")->required();
  app.add_option("--viewers", options.viewers, "number of viewers")->check(CLI::Range(1, 10000));
  app.add_option("--rooms", options.rooms, "room-0, room-1, … among which they are spread")
      ->check(CLI::Range(0, 1000));
  app.add_option("--stalled", options.stalled, "of these stop to read")->check(CLI::Range(0, 9999));
  app.add_option("--seconds", options.seconds, "measured time")->check(CLI::Range(0.1, 600.0));
  app.add_option("--codec", options.codec, "f32 or packed");
  CLI11_PARSE(app, argc, argv);
  if (options.stalled >= options.viewers) {
    std::fprintf(stderr, "--stalled = %d: allowed is less than --viewers\n", options.stalled);
    return 2;
  }
  Load load(options);
  if (!load.join()) {
    std::fprintf(stderr, "not all viewers joined: %s\n", load.results().dump().c_str());
    return 1;
  }
  load.measure();
  std::printf("%s\n", load.results().dump().c_str());
  return 0;
}
