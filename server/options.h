#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace weft::server {

/// An option that cannot be accepted; what() names field, value and allowed values.
struct OptionError : std::runtime_error {
  OptionError(const std::string& field, const std::string& value, const std::string& allowed)
      : std::runtime_error(field + " = " + (value.empty() ? "(nothing)" : value) + ": allowed is " +
                           allowed) {}
};

/// Range of a number, ends included.
struct OptionRange {
  double minimum, maximum;
  std::string text() const;  ///< e.g. "0 to 65535"
};

inline constexpr OptionRange kPorts{0, 65535};
inline constexpr OptionRange kRates{1, 1000};  // [1/s]
inline constexpr OptionRange kThreadCounts{1, 64};
inline constexpr OptionRange kTickCounts{1, 10'000'000};
inline constexpr OptionRange kCountPauses{0, 1'000'000};  // [ticks]
inline constexpr OptionRange kRunSeconds{0, 1e7};         // [s]
inline constexpr OptionRange kTickLimits{0, 3600};        // [s of CPU]
inline constexpr OptionRange kViewerCounts{1, 10'000};
inline constexpr OptionRange kSocketCounts{1, 100'000};
inline constexpr OptionRange kMessageRates{1, 1e6};    // [1/s]
inline constexpr OptionRange kPongSeconds{0.1, 3600};  // [s]
inline constexpr OptionRange kRoomCounts{1, 1000};
inline constexpr OptionRange kRoomIdles{0, 1e7};  // [s]

/// Throws OptionError if the value is NaN or out of range.
void check_range(const char* field, double value, const OptionRange& range);

/// Parses a decimal number; no other characters may precede or follow it. Throws OptionError if the
/// text is not a number or out of range.
/// @param field  as the error names it, e.g. "--port"
int parse_whole_number(const char* field, const std::string& text, const OptionRange& range);
double parse_number(const char* field, const std::string& text, const OptionRange& range);

/// Limits that protect the server from its viewers.
struct ConnectionLimits {
  int viewers = 1000;                   ///< WebSocket connections
  int connections = 2000;               ///< sockets of any kind
  int connections_per_address = 128;    ///< sockets of any kind from one address
  double messages_per_second = 1000;    ///< text messages of one viewer; also the longest burst
  double handshake_seconds = 5;         ///< for a request to be complete
  double idle_seconds = 30;             ///< HTTP connection without a request
  double pong_seconds = 20;             ///< WebSocket without a sign of life
  std::size_t queued_messages = 4096;   ///< messages waiting for one viewer
  std::size_t queued_bytes = 8 << 20;   ///< the same in bytes, except the largest and the mesh
  std::size_t waiting_commands = 1024;  ///< commands of one viewer that wait for the room
};

/// CPU time after which a tick is given up [s]: a hundred times that of a large scene's tick.
inline constexpr double kUsualTickLimit = 2;

/// Default number of threads for the physics: two where there are two cores, because contact keeps
/// two busy in many ticks, and no more. The number never changes a bit of the motion.
int usual_threads();

/// Holds tokens, as a file of them does; `weft serve` takes it from the environment.
inline constexpr const char* kTokensVariable = "WEFT_TOKENS";

/// All options of `weft serve`.
struct ServerOptions {
  std::string bind = "127.0.0.1";       ///< address; others than loopback need `open`
  int port = 8080;                      ///< 0 to 65535; 0 lets the system choose
  bool open = false;                    ///< serve other machines, without authentication
  bool has_tokens = false;              ///< viewers are let in by token
  std::string scene = "default";        ///< a name, or a file that ends in .json
  std::string scenes;                   ///< directory with further scenes and meshes; empty: none
  double rate = 0;                      ///< ticks a second, 1 to 1000; 0: the scene's own
  int threads = usual_threads();        ///< for the physics, 1 to 64
  bool paused = false;                  ///< start paused
  int count_crossings = 60;             ///< ticks between two counts, 0 to 1,000,000; 0: none
  double tick_limit = kUsualTickLimit;  ///< of CPU for a tick, 0 to 3600 [s]; 0: no bound
  int rooms = 64;                       ///< at a time, 1 to 1000
  double room_idle = 600;               ///< an empty room closes after this [s]; 0: never
  std::string tokens;                   ///< file of tokens; empty: those of the environment
  std::string web;                      ///< directory of the page; empty: beside the executable
  std::vector<std::string> allowed_origins;  ///< besides the server's own; origin.h
  std::vector<std::string> trusted_proxies;  ///< whose word on the client's address counts
  std::vector<std::pair<std::string, std::string>> settings;  ///< `--set`, in order
  double max_seconds = 0;          ///< stop by itself after this; 0: never
  std::string log_level = "info";  ///< trace, debug, info, warning, error or off
  ConnectionLimits limits;
};

/// Throws OptionError if a value is out of range or options contradict each other.
void validate(const ServerOptions& options);

/// Whether only this machine can reach the address.
bool is_loopback(const std::string& address);

}  // namespace weft::server
