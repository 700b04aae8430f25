#include "server/commands/serve.h"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <optional>
#include <random>
#include <thread>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "server/commands/qr_code.h"
#include "server/commands/version.h"
#include "server/net/addresses.h"
#include "server/net/close_codes.h"
#include "server/net/listener.h"
#include "server/net/network_output.h"
#include "server/output.h"
#include "server/room/room.h"
#include "server/room/simulation_loop.h"
#include "server/scene/scene_library.h"
#include "server/thread_pool.h"

namespace weft::server {
namespace {

namespace asio = boost::asio;

constexpr auto kPollPause = std::chrono::milliseconds(10);  // of the hub
constexpr auto kGoodbye = std::chrono::seconds(1);          // time for viewers to close
constexpr auto kLastWork = std::chrono::milliseconds(500);  // time for running work to end
constexpr double kReadinessPause = 0.1;                     // [s]
constexpr double kStallSeconds = 1;   // time without a turn of the room that is worth a warning [s]
constexpr double kBuildSeconds = 30;  // limit of building a loaded scene [s of CPU]

/// A recent copy of the room's status for the network thread.
class Bulletin {
 public:
  void post(const Room& room) {
    const std::lock_guard lock(mutex_);
    readiness_.scene = room.world().def().name;
    readiness_.tick = room.world().tick();
    readiness_.real_time_factor = room.real_time_factor();
    readiness_.ready = !room.ticking() || readiness_.real_time_factor >= 0.9 * room.speed();
  }
  /// Marks that the room has made a turn.
  void beat() { last_turn_.store(process_seconds(), std::memory_order_relaxed); }
  /// Also tells when the room is stuck and posts nothing.
  proto::Readiness read() const {
    const std::lock_guard lock(mutex_);
    proto::Readiness readiness = readiness_;
    const double stalled = process_seconds() - last_turn_.load(std::memory_order_relaxed);
    if (stalled > kStallSeconds) {
      readiness.stalled = stalled;
      readiness.ready = false;
    }
    return readiness;
  }

 private:
  std::atomic<double> last_turn_ = process_seconds();
  mutable std::mutex mutex_;
  proto::Readiness readiness_;
};

/// The room as the loop runs it, which keeps its bulletin up to date.
class PostedRoom {
 public:
  PostedRoom(Room& room, Bulletin& bulletin) : room_(room), bulletin_(bulletin) {
    bulletin_.post(room_);
  }
  void take(Inbound item) { room_.take(std::move(item)); }
  void take_meanwhile(Inbound item) { room_.take_meanwhile(std::move(item)); }
  bool gives_up() { return room_.gives_up(); }
  StopSignal* stop_signal() { return room_.stop_signal(); }
  bool advancing() const { return room_.advancing(); }
  void advance_until(double deadline) { room_.advance_until(deadline); }
  bool advance_waits() const { return room_.advance_waits(); }
  bool ticking() const { return room_.ticking(); }
  double tick_interval() const { return room_.tick_interval(); }
  void tick() { room_.tick(); }
  double next_wake() const { return room_.next_wake(); }
  void finish_turn() {
    room_.finish_turn();
    bulletin_.beat();
    const double now = process_seconds();
    if (now < next_post_) return;
    next_post_ = now + kReadinessPause;
    bulletin_.post(room_);
  }

 private:
  Room& room_;
  Bulletin& bulletin_;
  double next_post_ = 0;
};

/// A helper thread for the room, one job at a time.
class Beside {
 public:
  explicit Beside(Mailbox& mailbox) : mailbox_(mailbox) {}

  void start(std::function<void()> job) {
    if (thread_.joinable()) thread_.join();  // finished: the room starts no second job before
    running_ = true;
    thread_ = std::jthread([this, job = std::move(job)] {
      job();
      running_ = false;
      mailbox_.wake();
    });
  }
  bool running() const { return running_; }

 private:
  Mailbox& mailbox_;
  std::atomic<bool> running_ = false;
  std::jthread thread_;
};

/// Waits for work that was told to end. If it does not respond, the process exits without it: there
/// is no state that could be lost.
template <class Done>
void end_or_exit(Done&& done) {
  const auto last = std::chrono::steady_clock::now() + kLastWork;
  while (!done()) {
    if (std::chrono::steady_clock::now() > last) {
      spdlog::warn("stopped in the middle of work");
      spdlog::shutdown();
      std::_Exit(0);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

std::string random_session() {
  std::random_device source;
  return proto::hash_text((static_cast<std::uint64_t>(source()) << 32) | source());
}

std::string page_directory(const ServerOptions& options) {
  return options.web.empty() ? beside_program("web") : options.web;
}

RoomOptions room_options(const ServerOptions& options, const SceneLibrary& library) {
  RoomOptions room;
  room.scene = options.scene;
  room.scene_def = library.opened(options.scene);
  room.read_scene = [&library](const std::string& json) { return library.from_client(json); };
  room.tick_rate = options.rate;
  room.settings = options.settings;
  room.paused = options.paused;
  room.count_pause = static_cast<std::uint32_t>(options.count_crossings);
  room.version = version_info().version;
  room.session = random_session();
  for (const SceneInfo& scene : library.list()) room.scene_names.push_back(scene.name);
  room.limits.messages_per_second = options.limits.messages_per_second;
  room.limits.viewers = static_cast<std::uint32_t>(options.limits.viewers);
  return room;
}

void print_addresses(const ServerOptions& options, int port) {
  std::vector<std::string> urls;
  for (const std::string& host : hosts_to_open(options.bind, interface_addresses()))
    urls.push_back("http://" + host + ":" + std::to_string(port) + "/");
  const nlohmann::ordered_json line = {
      {"url", urls.front()}, {"websocket", std::string(urls.front()).replace(0, 4, "ws") + "ws"},
      {"urls", urls},        {"host", options.bind},
      {"port", port},        {"scene", options.scene}};
  std::printf("%s\n", line.dump().c_str());
  try {
    flush_standard_output();
  } catch (const OutputError& error) {
    spdlog::warn("the addresses could not be printed: {}; port {}", error.what(), port);
  }
  // Beside somebody who lets others in, for their phones.
  if (!options.open || ::isatty(STDERR_FILENO) == 0) return;
  if (const auto code = qr_code(urls.front()))
    std::fprintf(stderr, "%s%s\n", terminal_text(*code).c_str(), urls.front().c_str());
}

/// The network thread with its timers and its shutdown.
class Network {
 public:
  Network(asio::io_context& io, ServiceContext& context)
      : io_(io), context_(context), listener_(io, context), signals_(io, SIGINT, SIGTERM),
        poll_(io), end_(io) {
    context_.port = listener_.port();
  }

  void run() {
    listener_.start();
    signals_.async_wait([this](boost::system::error_code error, int) {
      if (!error) stop("asked to stop");
    });
    if (context_.options.max_seconds > 0) {
      end_.expires_after(
          std::chrono::milliseconds(static_cast<long long>(context_.options.max_seconds * 1000)));
      end_.async_wait([this](boost::system::error_code error) {
        if (!error) stop("--max-seconds is over");
      });
    }
    poll();
    io_.run();
  }

 private:
  void poll() {
    context_.hub.poll();
    if (context_.stopping &&
        (context_.hub.viewers() == 0 || std::chrono::steady_clock::now() > last_))
      return io_.stop();
    poll_.expires_after(kPollPause);
    poll_.async_wait([this](boost::system::error_code error) {
      if (!error) poll();
    });
  }

  void stop(const char* why) {
    spdlog::info("stopping: {}", why);
    context_.stopping = true;
    context_.mailbox.stop();  // also ends the running tick
    last_ = std::chrono::steady_clock::now() + kGoodbye;
    listener_.stop();
    signals_.cancel();
    end_.cancel();
    const proto::Bye bye{kCloseGoingAway, "the server stops"};
    context_.hub.close_all(bye.code, bye.reason, text_message(proto::encode_bye(bye)));
  }

  asio::io_context& io_;
  ServiceContext& context_;
  Listener listener_;
  asio::signal_set signals_;
  asio::steady_timer poll_, end_;
  std::chrono::steady_clock::time_point last_{};
};

/// Starts to listen. Throws OptionError if it cannot.
void listen(std::optional<Network>& network, asio::io_context& io, ServiceContext& context) {
  const ServerOptions& options = context.options;
  try {
    network.emplace(io, context);
  } catch (const boost::system::system_error& error) {
    const std::string why = " (" + error.code().message() + ")";
    if (error.code() == asio::error::address_in_use || error.code() == asio::error::access_denied)
      throw OptionError("--port", std::to_string(options.port),
                        "a port that is free, or 0 to let the system choose one" + why);
    throw OptionError("--bind", options.bind, "an address of this machine" + why);
  }
}

}  // namespace

int serve(const ServerOptions& options) {
  validate(options);
  Metrics metrics;
  Mailbox mailbox(options.limits.waiting_commands);
  const StaticFiles files(page_directory(options));
  if (!options.web.empty() && !files.find("/"))
    throw OptionError("--web", options.web, "a directory with the page's index.html");
  Bulletin bulletin;
  // Forks to parse the folder's meshes, so it precedes all threads.
  const SceneLibrary library(beside_program("meshes"), options.scenes);
  for (const std::string& problem : library.problems()) spdlog::warn("scene folder: {}", problem);

  Hub hub(process_seconds, 60, {options.limits.queued_messages, options.limits.queued_bytes},
          metrics);
  ServiceContext context{options,
                         hub,
                         mailbox,
                         metrics,
                         files,
                         process_seconds,
                         version_info(),
                         {},
                         [&bulletin] { return bulletin.read(); },
                         {},
                         1,
                         0,
                         false};
  for (const SceneInfo& scene : library.list())
    context.scenes.push_back({scene.name, scene.description});
  // Destroyed before the objects that sessions use, because pending handlers own sessions.
  asio::io_context io(1);
  NetworkOutput output(io, hub);
  ThreadPool pool(options.threads);
  WorkLimit limit(options.tick_limit);
  RoomOptions settings = room_options(options, library);
  settings.limit = &limit;
  settings.build_limit = kBuildSeconds;
  settings.cpu_clock = &thread_cpu_seconds;
  Beside beside(mailbox);
  settings.beside = [&beside](std::function<void()> job) { beside.start(std::move(job)); };
  Room room(
      std::move(settings), [&library](const std::string& name) { return library.named(name); },
      output, process_seconds, metrics, options.threads > 1 ? &pool : nullptr);
  mailbox.on_arrival = [&limit] { limit.signal().raise(); };
  const LimitWatch watch(limit);
  room.on_finished = [&mailbox](proto::ViewerId viewer) { mailbox.finished(viewer); };

  std::optional<Network> network;
  listen(network, io, context);
  if (!is_loopback(options.bind))
    spdlog::warn("everyone who reaches {} port {} may command the cloth", options.bind,
                 context.port);
  if (!files.find("/"))
    spdlog::warn("no page in {}; scripts can connect nevertheless", page_directory(options));

  PostedRoom posted(room, bulletin);
  SimulationLoop<PostedRoom, Mailbox> loop(posted, mailbox, process_seconds);
  std::atomic<bool> simulating = true;
  std::jthread simulation([&] {
    loop.run();
    simulating = false;
  });
  spdlog::info("scene {} with {} particles, {} ticks a second", options.scene,
               room.world().model().mass.size(), room.world().def().tick_rate);
  print_addresses(options, context.port);
  network->run();
  mailbox.stop();
  end_or_exit([&simulating] { return !simulating; });
  simulation.join();
  room.cancel_build();
  end_or_exit([&beside] { return !beside.running(); });
  return 0;
}

}  // namespace weft::server
