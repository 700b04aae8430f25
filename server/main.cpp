#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "core/error.h"
#include "server/options.h"
#include "server/serve.h"
#include "server/simulate.h"
#include "server/version.h"

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
  weft scenes                                     what there is
)";

/// Splits "key=value"; the key may not be empty.
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

void add_serve(CLI::App& app, ServerOptions& o, std::vector<std::string>& settings) {
  CLI::App* serve = app.add_subcommand("serve", "Simulate a scene and serve it to viewers");
  serve->add_option("--bind", o.bind, "Address to listen on")->capture_default_str();
  serve->add_option("--port", o.port, "Port, 0 to 65535; 0 picks a free one")
      ->capture_default_str();
  serve->add_flag("--open", o.open,
                  "Let other machines in (needed for other addresses than loopback)");
  serve->add_option("--scene", o.scene, "Built-in scene")->capture_default_str();
  serve->add_option("--set", settings, "Setting of the scene as key=value; may be repeated");
  serve->add_option("--rate", o.rate, "Ticks a second, 1 to 1000 (default: the scene's)");
  serve->add_option("--threads", o.threads, "Threads for the physics, 1 to 64")
      ->capture_default_str();
  serve->add_flag("--paused", o.paused, "Start paused");
  serve->add_option("--web", o.web, "Directory of the page (default: web beside the program)");
  serve->add_option("--allow-origin", o.allowed_origins,
                    "Origin whose pages may connect, e.g. http://localhost:3000; may be repeated");
  serve->add_option("--max-viewers", o.limits.viewers, "Most viewers")->capture_default_str();
  serve->add_option("--max-connections", o.limits.connections, "Most sockets")
      ->capture_default_str();
  serve
      ->add_option("--max-connections-per-address", o.limits.connections_per_address,
                   "Most sockets from one address")
      ->capture_default_str();
  serve
      ->add_option("--max-messages-per-second", o.limits.messages_per_second,
                   "Most messages a second of one viewer")
      ->capture_default_str();
  serve->add_option("--max-seconds", o.max_seconds, "Stop by itself after this; 0: never")
      ->capture_default_str();
  serve->add_option("--log-level", o.log_level, "trace, debug, info, warning, error or off")
      ->capture_default_str();
}

void add_simulate(CLI::App& app, SimulateOptions& o, std::vector<std::string>& settings) {
  CLI::App* simulate = app.add_subcommand("simulate", "Run a scene as fast as possible and sum up");
  simulate->add_option("--scene", o.scene, "Built-in scene")->capture_default_str();
  simulate->add_option("--ticks", o.ticks, "Ticks, 1 to 10000000")->capture_default_str();
  simulate->add_option("--set", settings, "Setting of the scene as key=value; may be repeated");
  simulate->add_option("--out", o.out, "Write the cloth at the end, FILE.obj or FILE.ply");
  simulate->add_flag("--json", o.json, "Print JSON");
  simulate->add_option("--threads", o.threads, "Threads for the physics, 1 to 64")
      ->capture_default_str();
}

/// One line that names what was wrong and what is allowed there.
std::string describe(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  std::string allowed, wrong = error.what();
  const auto chosen = app.get_subcommands();
  if (chosen.empty()) {
    for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
      allowed += sub->get_name() + ", ";
    if (argc > 1) wrong = std::string("unknown command ") + argv[1];
    return wrong + "; allowed: " + allowed + "--help, --version";
  }
  for (const CLI::Option* option : chosen.front()->get_options())
    allowed += (allowed.empty() ? "" : ", ") + option->get_name();
  // The library lists what it did not understand from behind; the first one is the cause.
  const std::vector<std::string> rest = chosen.front()->remaining();
  for (int i = 1; i < argc; ++i) {
    if (std::find(rest.begin(), rest.end(), argv[i]) == rest.end()) continue;
    wrong = std::string("unknown option ") + argv[i];
    break;
  }
  return wrong + "; allowed: " + allowed;
}

int run(int argc, char** argv) {
  CLI::App app("Weft: cloth that many can hold, simulated on a server", "weft");
  app.footer(kExamples);
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  ServerOptions serve_options;
  SimulateOptions simulate_options;
  std::vector<std::string> serve_settings, simulate_settings;
  bool scenes_json = false;
  add_serve(app, serve_options, serve_settings);
  add_simulate(app, simulate_options, simulate_settings);
  app.add_subcommand("scenes", "List the built-in scenes")
      ->add_flag("--json", scenes_json, "Print JSON");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // help or version
    std::fprintf(stderr, "weft: %s\n", describe(app, error, argc, argv).c_str());
    return 2;
  }
  for (const std::string& text : serve_settings)
    serve_options.settings.push_back(split_setting(text));
  for (const std::string& text : simulate_settings)
    simulate_options.settings.push_back(split_setting(text));
  if (app.got_subcommand("scenes")) return list_scenes(scenes_json);
  if (app.got_subcommand("simulate")) return simulate(simulate_options);
  validate(serve_options);
  spdlog::set_level(spdlog::level::from_str(serve_options.log_level));
  return serve(serve_options);
}

}  // namespace

int main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_logger_mt("weft"));
  try {
    return run(argc, argv);
  } catch (const OptionError& error) {
    std::fprintf(stderr, "weft: %s\n", error.what());
  } catch (const weft::DefinitionError& error) {
    std::fprintf(stderr, "weft: %s\n", error.what());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "weft: %s\n", error.what());
    return 1;
  }
  return 2;
}
