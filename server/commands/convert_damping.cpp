#include "server/commands/convert_damping.h"

#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "core/cloth/fabric_modes.h"
#include "core/definition.h"
#include "core/world/world_def.h"

namespace weft::server {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kPi = 3.14159265358979323846;

struct DampedMode {
  FabricMode mode;
  double omega = 0;       ///< [1/s]
  double relaxation = 0;  ///< [s]

  std::string name() const { return choice_word(fabric_mode_info(), static_cast<int>(mode)); }
  double loss_factor() const { return omega * relaxation; }
  double decay_time() const { return 2 / (omega * omega * relaxation); }
};

DampedMode mode_of(const FabricDef& fabric, FabricMode mode, const FabricOptions& options) {
  DampedMode damped{mode, angular_frequency(fabric, mode, options.length),
                    relaxation_time(fabric, mode)};
  if (!(damped.omega > 0))
    throw OptionError("--mode", damped.name(), "a mode that the fabric resists");
  if (options.decay_time > 0)
    damped.relaxation = relaxation_of_decay(damped.omega, options.decay_time);
  if (options.loss_factor > 0)
    damped.relaxation = relaxation_of_loss(damped.omega, options.loss_factor);
  return damped;
}

Json json_of(const DampedMode& mode) {
  Json out{{"mode", mode.name()},
           {"frequency_hz", mode.omega / (2 * kPi)},
           {"relaxation_time_s", mode.relaxation},
           {"loss_factor", mode.loss_factor()},
           {"decay_time_s", nullptr}};
  if (mode.relaxation > 0) out["decay_time_s"] = mode.decay_time();
  return out;
}

void print(const DampedMode& mode) {
  const std::string name = mode.name();
  std::printf("%-8s %.4g Hz, ", name.c_str(), mode.omega / (2 * kPi));
  if (mode.relaxation > 0)
    std::printf("decays to 1/e in %.4g s, loss factor %.4g: fabric.%s_damping=%.4g\n",
                mode.decay_time(), mode.loss_factor(), name.c_str(), mode.relaxation);
  else
    std::printf("no damping of its own: fabric.%s_damping=0\n", name.c_str());
}

void check_options(const FabricOptions& o) {
  check_range("--length", o.length, kStripLengths);
  const bool measured = o.decay_time > 0 || o.loss_factor > 0;
  if (o.decay_time > 0 && o.loss_factor > 0)
    throw OptionError("--loss-factor", number_text(o.loss_factor), "none beside --decay-time");
  if (measured && o.mode.empty())
    throw OptionError("--mode", "",
                      "the mode that was measured: " + allowed_values(fabric_mode_info()));
}

}  // namespace

int convert_damping(const FabricOptions& options) {
  check_options(options);
  WorldDef def;
  for (const auto& [key, value] : options.settings) set_field(def, key, value);
  const FabricDef& fabric = def.cloths.front().fabric;
  std::vector<DampedMode> modes;
  if (!options.mode.empty()) {
    FabricMode mode{};
    parse_field("--", fabric_mode_info(), options.mode, mode);
    modes.push_back(mode_of(fabric, mode, options));
  } else {
    for (const FabricMode mode : {FabricMode::stretch, FabricMode::shear, FabricMode::bending}) {
      if (angular_frequency(fabric, mode, options.length) > 0)
        modes.push_back(mode_of(fabric, mode, options));
    }
  }
  Json list = Json::array();
  for (const DampedMode& mode : modes) list.push_back(json_of(mode));
  if (options.json)
    std::printf("%s\n", Json{{"length_m", options.length}, {"modes", list}}.dump(2).c_str());
  for (const DampedMode& mode : modes) {
    if (!options.json) print(mode);
  }
  return 0;
}

}  // namespace weft::server
