#include "server/commands/serve.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <malloc.h>
#include <memory>
#include <optional>
#include <random>
#include <sys/resource.h>
#include <thread>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "proto/room_name.h"
#include "server/commands/qr_code.h"
#include "server/commands/version.h"
#include "server/net/addresses.h"
#include "server/net/close_codes.h"
#include "server/net/listener.h"
#include "server/net/network_output.h"
#include "server/output.h"
#include "server/rooms/rooms.h"
#include "server/scene/scene_library.h"
#include "server/thread_priority.h"

namespace weft::server {
namespace {

namespace asio = boost::asio;

constexpr auto kPollPause = std::chrono::milliseconds(10);  // of the hub
constexpr auto kGoodbye = std::chrono::seconds(1);          // time for viewers to close
constexpr auto kLastWork = std::chrono::milliseconds(500);  // time for running work to end
constexpr double kBuildSeconds = 30;  // limit of building a scene for a viewer [s of CPU]
constexpr double kEmptyPause = 0.5;   // between two looks for empty rooms [s]

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

/// Reads the tokens of the file or, without one, of the environment, from which they are taken, so
/// that no child process has them. A variable that is there without a token is refused, as a server
/// that should have had tokens would be open.
void read_tokens(const ServerOptions& options, Tokens& tokens) {
  const char* const given = std::getenv(kTokensVariable);
  const std::optional<std::string> text = given ? std::optional<std::string>(given) : std::nullopt;
  ::unsetenv(kTokensVariable);
  if (!options.tokens.empty()) return tokens.read_file(options.tokens);
  if (text) tokens.read(kTokensVariable, *text);
}

/// Lets the process have a descriptor for each socket, as far as the system allows.
void allow_sockets(int connections) {
  constexpr ::rlim_t kOthers = 64;  // files, timers and what the libraries open
  const ::rlim_t wanted = static_cast<::rlim_t>(connections) + kOthers;
  ::rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= wanted) return;
  limit.rlim_cur = std::min(limit.rlim_max, wanted);
  if (::setrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur < wanted)
    spdlog::warn("the system allows {} open files, fewer than --max-connections", limit.rlim_cur);
}

/// Lets arrays of large scenes go back to the system as these end. Left to itself the allocator
/// keeps them: the size from which it maps each apart grows with what is freed, up to 32 MiB.
void map_large_arrays() {
  constexpr int kMapped = 256 << 10;  // [bytes] more than most frames, which come and go
  ::mallopt(M_MMAP_THRESHOLD, kMapped);
}

RoomOptions room_options(const ServerOptions& options, const SceneLibrary& library) {
  RoomOptions room;
  room.scene = options.scene;
  room.scene_def = std::make_shared<const WorldDef>(library.opened(options.scene));
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
  room.build_limit = kBuildSeconds;
  return room;
}

RoomOptions with_rights(RoomOptions room, const ServerOptions& options, Tokens& tokens) {
  room.linked = tokens.required() || !is_loopback(options.bind) || !options.trusted_proxies.empty();
  room.has_tokens = tokens.required();
  room.make_token = [&tokens](const Grant& grant) { return tokens.make(grant); };
  return room;
}

RoomsOptions rooms_options(const ServerOptions& options, Tokens& tokens) {
  return {options.threads,
          static_cast<std::size_t>(options.rooms),
          options.room_idle,
          options.tick_limit,
          options.limits.waiting_commands,
          [&tokens](const std::string& room) { tokens.forget(room); }};
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
  // Phones in the same place read it.
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
    be_prompt();
    io_.run();
  }

 private:
  void poll() {
    for (const auto& room : context_.rooms.all()) hub_of(*room).poll();
    if (context_.stopping && (context_.viewers == 0 || std::chrono::steady_clock::now() > last_))
      return io_.stop();
    if (context_.clock() > next_look_) {
      next_look_ = context_.clock() + kEmptyPause;
      context_.rooms.close_empty();
    }
    poll_.expires_after(kPollPause);
    poll_.async_wait([this](boost::system::error_code error) {
      if (!error) poll();
    });
  }

  void stop(const char* why) {
    spdlog::info("stopping: {}", why);
    context_.stopping = true;
    context_.rooms.stop();  // also ends the ticks under way
    last_ = std::chrono::steady_clock::now() + kGoodbye;
    listener_.stop();
    signals_.cancel();
    end_.cancel();
    const proto::Bye bye{kCloseGoingAway, "the server stops"};
    const Message last = text_message(proto::encode_bye(bye));
    for (const auto& room : context_.rooms.all())
      hub_of(*room).close_all(bye.code, bye.reason, last);
  }

  asio::io_context& io_;
  ServiceContext& context_;
  Listener listener_;
  asio::signal_set signals_;
  asio::steady_timer poll_, end_;
  std::chrono::steady_clock::time_point last_{};
  double next_look_ = 0;  // for empty rooms [s]
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
  allow_sockets(options.limits.connections);
  map_large_arrays();
  Metrics metrics;
  Tokens tokens;
  read_tokens(options, tokens);
  const StaticFiles files(page_directory(options));
  if (!options.web.empty() && !files.find("/"))
    throw OptionError("--web", options.web, "a directory with the page's index.html");
  // Forks to parse the folder's meshes, so it precedes all threads.
  const SceneLibrary library(beside_program("meshes"), options.scenes);
  for (const std::string& problem : library.problems()) spdlog::warn("scene folder: {}", problem);

  auto io = std::make_unique<asio::io_context>(1);
  const ChannelLimits limits{options.limits.queued_messages, options.limits.queued_bytes};
  Rooms rooms(
      rooms_options(options, tokens), with_rights(room_options(options, library), options, tokens),
      [&library](const std::string& name) { return library.named(name); },
      [&io, &limits](Metrics& counts) {
        return std::make_shared<NetworkOutput>(
            *io, std::make_shared<Hub>(process_seconds, 60, limits, counts));
      },
      process_seconds, metrics);
  rooms.open_default();
  ServiceContext context{options, rooms, tokens, files, process_seconds, version_info()};
  for (const std::string& proxy : options.trusted_proxies)
    context.trusted_proxies.push_back(*AddressRange::parse(proxy));
  for (const SceneInfo& scene : library.list())
    context.scenes.push_back({scene.name, scene.description});

  std::optional<Network> network;
  listen(network, *io, context);
  if (!is_loopback(options.bind) && !tokens.required())
    spdlog::warn("everyone who reaches {} port {} may command the cloth", options.bind,
                 context.port);
  if (!files.find("/"))
    spdlog::warn("no page in {}; scripts can connect nevertheless", page_directory(options));

  const proto::RoomInfo first = rooms.find(proto::kDefaultRoom)->info();
  spdlog::info("scene {} with {} particles", first.scene, first.particles);
  rooms.start();
  print_addresses(options, context.port);
  network->run();
  rooms.stop();
  end_or_exit([&rooms] { return rooms.stands(); });
  rooms.cancel_builds();
  end_or_exit([&rooms] { return !rooms.builds(); });
  network.reset();
  io.reset();  // pending handlers own sessions, and these use the rooms
  return 0;
}

}  // namespace weft::server
