#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>
#include <unistd.h>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

#include "core/error.h"
#include "server/commands/convert_damping.h"
#include "server/commands/drape.h"
#include "server/commands/list_scenes.h"
#include "server/commands/log_sink.h"
#include "server/commands/serve.h"
#include "server/commands/simulate.h"
#include "server/commands/version.h"
#include "server/options.h"
#include "server/output.h"
#include "server/scene/mesh_child.h"

namespace {

using namespace weft::server;

constexpr const char* kExamples = R"(
Examples:
  weft serve                                      the page on http://127.0.0.1:8080/
  weft serve --port 0 --scene flag                another scene, on a port that is free
  weft serve --set fabric.stretch_warp=800        a stiffer cloth
  weft simulate --scene default --ticks 600       ten seconds of cloth, as fast as possible
  weft simulate --scene flag --ticks 300 --set environment.wind=8,0,0 --out flag.obj
  weft simulate --scene drape-sphere --ticks 600 --json
  weft serve --scene my.json                      a scene of your own; weft scenes --schema
  weft scenes                                     what there is
  weft scenes --json flag                         one as a file to start from
  weft fabric --set fabric=wool --mode bending --length 0.05 --decay-time 0.5
                                                  the damping of a strip that was seen to swing
  weft drape --fabric silk --threads 2            what the drape test says of a fabric

Exit codes: 0 done, 1 failed, 2 what was asked for is refused; simulate: 3 something crossed, 4 a
tick took too long; 5 output could not be written
)";

/// Splits "key=value"; the key must not be empty.
std::pair<std::string, std::string> split_setting(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw OptionError("--set", text, "key=value, e.g. fabric.shear=20");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

std::string version_text() {
  const auto version = version_info();
  return "weft " + version.version + " (commit " + version.commit + ", " + version.compiler + ", " +
         version.simd + ")";
}

/// Adds an option whose value this program parses, because the library takes "" for 0 and does not
/// name the allowed range.
template <class Number>
void add_number(CLI::App& command, const char* name, Number& value, const OptionRange& range,
                const std::string& description) {
  const auto read = [name, &value, range](const std::string& text) {
    if constexpr (std::is_integral_v<Number>)
      value = parse_whole_number(name, text, range);
    else
      value = parse_number(name, text, range);
  };
  command.add_option_function<std::string>(name, read, description + ", " + range.text())
      ->type_name(std::is_integral_v<Number> ? "INT" : "NUMBER");
}

/// Adds an option that takes a path, of which the empty one would mean that none is given.
void add_path(CLI::App& command, const char* name, std::string& value, const char* allowed,
              const std::string& description) {
  const auto read = [name, &value, allowed](const std::string& text) {
    if (text.empty()) throw OptionError(name, text, allowed);
    value = text;
  };
  command.add_option_function<std::string>(name, read, description);
}

void add_switch(CLI::App& command, const char* name, bool& value, const char* description) {
  command.add_flag(name, value, description)->disable_flag_override();
}

void add_serve(CLI::App& app, ServerOptions& o, std::vector<std::string>& settings) {
  CLI::App& serve = *app.add_subcommand("serve", "Simulate a scene and serve it to viewers");
  ConnectionLimits& l = o.limits;
  serve.add_option("--bind", o.bind, "Address to listen on")->capture_default_str();
  add_number(serve, "--port", o.port, kPorts, "Port (8080); 0 picks a free one");
  add_switch(
      serve, "--open", o.open,
      "Let other machines in without tokens (any address but loopback needs this or --tokens)");
  serve.add_option("--scene", o.scene, "Built-in scene, or a file that ends in .json")
      ->capture_default_str();
  serve.add_option("--scenes", o.scenes, "Directory of scenes and meshes that clients may name");
  serve.add_option("--set", settings, "Setting of the scene as key=value; may be repeated");
  add_number(serve, "--rate", o.rate, kRates, "Ticks a second (the scene's)");
  add_number(serve, "--threads", o.threads, kThreadCounts,
             "Threads for the physics (2, or 1 where there is one core)");
  add_switch(serve, "--paused", o.paused, "Start paused");
  add_number(serve, "--count-crossings", o.count_crossings, kCountPauses,
             "Ticks between two counts of crossings (60; 0: none)");
  add_number(serve, "--tick-limit", o.tick_limit, kTickLimits,
             "Seconds of CPU after which a tick is given up and the room pauses (2; 0: never)");
  add_path(serve, "--tokens", o.tokens,
           "a file with one line for each token: role token [name]; leave it out to serve without",
           "File of tokens, one a line: role token [name] (without it, the lines of the "
           "environment variable WEFT_TOKENS)");
  serve.add_option("--web", o.web, "Directory of the page (default: web beside the program)");
  serve.add_option(
      "--allow-origin", o.allowed_origins,
      "Origin whose pages may connect and whose host is accepted, e.g. "
      "https://weft.example behind a proxy, or http://localhost:3000; may be repeated");
  add_number(serve, "--rooms", o.rooms, kRoomCounts, "Most rooms at a time (64)");
  add_number(serve, "--room-idle", o.room_idle, kRoomIdles,
             "Seconds after which an empty room closes; 0: never (600)");
  serve.add_option("--trusted-proxy", o.trusted_proxies,
                   "Address or network of a proxy that tells each client's address truly, e.g. "
                   "127.0.0.1 or 10.0.0.0/8; may be repeated");
  add_number(serve, "--max-viewers", l.viewers, kViewerCounts, "Most viewers (1000)");
  add_number(serve, "--max-connections", l.connections, kSocketCounts, "Most sockets (2000)");
  add_number(serve, "--max-connections-per-address", l.connections_per_address, kSocketCounts,
             "Most sockets from one address (128)");
  add_number(serve, "--max-messages-per-second", l.messages_per_second, kMessageRates,
             "Most messages a second of one viewer (1000)");
  add_number(serve, "--pong-seconds", l.pong_seconds, kPongSeconds,
             "Seconds without a sign of life after which a viewer is closed (20)");
  add_number(serve, "--max-seconds", o.max_seconds, kRunSeconds,
             "Seconds after which the server stops by itself (0: never)");
  serve.add_option("--log-level", o.log_level, "trace, debug, info, warning, error or off")
      ->capture_default_str();
}

void add_simulate(CLI::App& app, SimulateOptions& o, std::vector<std::string>& settings) {
  CLI::App& simulate =
      *app.add_subcommand("simulate", "Run a scene as fast as possible and print a summary");
  simulate.add_option("--scene", o.scene, "Built-in scene, or a file that ends in .json")
      ->capture_default_str();
  simulate.add_option("--scenes", o.scenes, "Directory of further scenes and their meshes");
  add_number(simulate, "--ticks", o.ticks, kTickCounts, "Ticks (600)");
  simulate.add_option("--set", settings, "Setting of the scene as key=value; may be repeated");
  add_path(simulate, "--out", o.out, "a file that ends in .obj or .ply",
           "Write the cloth at the end, FILE.obj or FILE.ply");
  add_path(simulate, "--start", o.start, "a .npy file",
           "Begin where FILE.npy says: a series, or an array of particles x 3 or 6");
  add_path(simulate, "--series", o.series, "a file that ends in .npy",
           "Write time, energies, forces, positions and velocities into FILE.npy");
  add_number(simulate, "--series-every", o.series_every, kTickCounts,
             "Ticks between two records of it (1)");
  add_switch(simulate, "--balance", o.balance,
             "Measure what each cause did to the cloth's energy; takes longer");
  add_switch(simulate, "--error", o.error,
             "Repeat the run with finer steps, with noise and on a finer mesh, and tell its error");
  add_switch(simulate, "--double", o.in_double,
             "Compute in double precision, in place of the float that a server takes");
  add_switch(simulate, "--json", o.json, "Print JSON");
  add_number(simulate, "--threads", o.threads, kThreadCounts, "Threads for the physics (1)");
  add_number(simulate, "--tick-limit", o.tick_limit, kTickLimits,
             "Seconds of CPU after which a tick is given up, with exit code 4 (2; 0: never)");
  add_switch(simulate, "--any-cost", o.any_cost,
             "Take scenes whatever a tick is estimated to cost");
  add_number(simulate, "--check-every", o.check_every, kTickCounts,
             "Ticks between two counts of crossings (1); exit code 3 if there are any");
}

/// Describes the misuse of a known option: no value, two, or one for a switch.
std::string describe_mismatch(const CLI::App& command, const std::string& wrong) {
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    const bool is_switch = option->get_items_expected_max() == 0;
    if (is_switch && wrong.starts_with(option->get_lnames().front() + " ")) {
      return name + " takes no value";
    }
    if (!wrong.starts_with(name + ":") && !wrong.starts_with(name + " ")) continue;
    if (option->count() > 1) return name + " is given twice; allowed: once";
    return name + " has no value; allowed: " + option->get_description();
  }
  return wrong;
}

void add_scenes(CLI::App& app, ScenesOptions& o) {
  CLI::App& scenes = *app.add_subcommand("scenes", "List the built-in scenes");
  scenes.add_option("NAME", o.name, "With --json: this scene or file, with all defaults filled in");
  add_switch(scenes, "--json", o.json, "Print JSON");
  add_switch(scenes, "--schema", o.schema, "Print the JSON Schema of scene files");
}

void add_fabric(CLI::App& app, FabricOptions& o, std::vector<std::string>& settings) {
  CLI::App& fabric =
      *app.add_subcommand("fabric", "Convert a fabric's damping from and to what can be measured");
  fabric.add_option("--set", settings, "Setting of the fabric as key=value; may be repeated");
  fabric.add_option("--mode", o.mode,
                    "First mode of a strip along the warp: stretch, shear (both held at both ends) "
                    "or bending (held level at one end)");
  fabric.add_option("--form", o.form,
                    "grid or mesh (grid; mesh for a fabric with a poisson): a grid damps its "
                    "stretch by shear_damping too, because its diagonals resist stretch as well");
  add_number(fabric, "--length", o.length, kStripLengths, "Length of the strip in metres (0.2)");
  add_number(fabric, "--decay-time", o.decay_time, kDecayTimes,
             "Seconds in which its amplitude fell to 1/e, at least those of critical damping");
  add_number(fabric, "--loss-factor", o.loss_factor, kLossFactors,
             "Energy lost in a cycle over 2 pi times that of the mode");
  add_switch(fabric, "--json", o.json, "Print JSON");
}

void add_drape(CLI::App& app, DrapeOptions& o, std::vector<std::string>& settings) {
  CLI::App& drape = *app.add_subcommand(
      "drape", "Run the drape test of a fabric from several starts, on grids and on a mesh");
  drape.add_option("--fabric", o.fabric, "Name of a preset")->capture_default_str();
  drape.add_option("--set", settings, "Value of the fabric as key=value; may be repeated");
  add_number(drape, "--starts", o.starts, kDrapeStarts, "Runs of each specimen (5)");
  add_number(drape, "--seconds", o.seconds, kDrapeSeconds, "Simulated seconds of a run (4)");
  add_number(drape, "--threads", o.threads, kThreadCounts,
             "Threads, each with runs of its own (1)");
  add_switch(drape, "--json", o.json, "Print JSON");
}

/// One line that names the error and the allowed values.
std::string describe(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  std::string allowed;
  const auto chosen = app.get_subcommands();
  if (chosen.empty()) {
    for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
      allowed += sub->get_name() + ", ";
    std::string wrong = "no command";
    if (argc > 1)
      wrong = (*argv[1] == '-' ? "unknown option " : "unknown command ") + std::string(argv[1]);
    return wrong + "; allowed: " + allowed + "--help, --version";
  }
  const CLI::App& command = *chosen.front();
  const std::vector<std::string> rest = command.remaining();
  if (rest.empty()) return describe_mismatch(command, error.what());
  for (const CLI::Option* option : command.get_options())
    allowed += (allowed.empty() ? "" : ", ") + option->get_name();
  // The library lists unknown arguments from the last to the first; the first one is the cause.
  const auto unknown = [&rest](const char* argument) {
    return std::find(rest.begin(), rest.end(), argument) != rest.end();
  };
  const auto* const first = std::find_if(argv + 1, argv + argc, unknown);
  return std::string("unknown option ") + (first == argv + argc ? rest.back() : *first) +
         "; allowed: " + allowed;
}

/// Prints an error as one line, whatever bytes the arguments contain.
void complain(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  std::fprintf(stderr, "weft: %s\n", text.c_str());
}

int run(int argc, char** argv) {
  CLI::App app("Weft: cloth that many can hold, simulated on a server", "weft");
  app.footer(kExamples);
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  ServerOptions serve_options;
  SimulateOptions simulate_options;
  FabricOptions fabric_options;
  DrapeOptions drape_options;
  std::vector<std::string> serve_settings, simulate_settings, fabric_settings, drape_settings;
  ScenesOptions scenes_options;
  add_serve(app, serve_options, serve_settings);
  add_simulate(app, simulate_options, simulate_settings);
  add_scenes(app, scenes_options);
  add_fabric(app, fabric_options, fabric_settings);
  add_drape(app, drape_options, drape_settings);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // help or version
      std::ostringstream text;
      const int code = app.exit(error, text);
      std::fputs(text.str().c_str(), stdout);
      return code;
    }
    complain(describe(app, error, argc, argv));
    return 2;
  }
  for (const std::string& text : serve_settings)
    serve_options.settings.push_back(split_setting(text));
  for (const std::string& text : simulate_settings)
    simulate_options.settings.push_back(split_setting(text));
  for (const std::string& text : fabric_settings)
    fabric_options.settings.push_back(split_setting(text));
  for (const std::string& text : drape_settings)
    drape_options.settings.push_back(split_setting(text));
  if (app.got_subcommand("drape")) return predict_drape(drape_options);
  if (app.got_subcommand("fabric")) return convert_damping(fabric_options);
  if (app.got_subcommand("scenes")) return list_scenes(scenes_options);
  if (app.got_subcommand("simulate")) return simulate(simulate_options);
  serve_options.has_tokens = !serve_options.tokens.empty() || std::getenv(kTokensVariable);
  validate(serve_options);
  spdlog::set_level(spdlog::level::from_str(serve_options.log_level));
  return serve(serve_options);
}

}  // namespace

int main(int argc, char** argv) {
  prepare_standard_streams();
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>("weft", std::make_shared<LogSink>(STDERR_FILENO)));
  try {
    if (argc == 3 && std::string_view(argv[1]) == kMeshChildCommand) return run_mesh_child(argv[2]);
    const int code = run(argc, argv);
    flush_standard_output();
    return code;
  } catch (const OutputError& error) {
    complain(error.what());
    return kOutputFailed;
  } catch (const OptionError& error) {
    complain(error.what());
  } catch (const weft::DefinitionError& error) {
    complain(error.what());
  } catch (const std::exception& error) {
    complain(error.what());
    return 1;
  }
  return 2;
}
