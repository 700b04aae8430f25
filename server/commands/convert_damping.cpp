// Converts a fabric's damping from and to decay times and loss factors.

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

/// What a strip is made of.
enum class StripForm { grid, mesh };

FieldInfo strip_form_info() {
  return choice("form", "grid|mesh", "what the strip is made of");
}

struct DampedMode {
  FabricMode mode;
  double omega = 0;       ///< without damping [1/s]
  double setting = 0;     ///< relaxation time of the fabric's field [s]
  double relaxation = 0;  ///< of the mode [s]

  std::string name() const { return choice_word(fabric_mode_info(), static_cast<int>(mode)); }
  std::string field() const { return name() + "_damping"; }
  double loss_factor() const { return omega * relaxation; }
};

/// A strip of a fabric, whose grid damps its stretch by both dashpots.
class Strip {
 public:
  Strip(const ClothDef& cloth, double length, StripForm form)
      : fabric_(cloth.fabric), length_(length), cell_u_(cloth.width / (cloth.columns - 1)),
        cell_v_(cloth.height / (cloth.rows - 1)), form_(form) {
    if (form == StripForm::grid && fabric_.poisson != kPoissonOfGrid)
      throw OptionError("--form", "grid", "mesh for a fabric with a poisson");
  }

  bool resists(FabricMode mode) const { return omega_of(mode) > 0; }

  /// A mode as the fabric has it.
  DampedMode as_set(FabricMode mode) const {
    DampedMode found{mode, omega_of(mode), relaxation_time(fabric_, mode), 0};
    found.relaxation =
        is_shared(mode) ? stretch_relaxation_on_grid(fabric_, cell_u_, cell_v_) : found.setting;
    return found;
  }

  /// A mode with the setting that gives it a relaxation time.
  /// @param option, text  that asked for it, and for what
  DampedMode with_relaxation(FabricMode mode, double relaxation, const char* option,
                             const std::string& text) const {
    DampedMode found{mode, omega_of(mode), relaxation, relaxation};
    if (is_shared(mode)) {
      found.setting = stretch_damping_on_grid(fabric_, relaxation);
      refuse_less_than_diagonals(found, option, text);
    }
    check_setting(found);
    return found;
  }

 private:
  double omega_of(FabricMode mode) const { return angular_frequency(fabric_, mode, length_); }
  bool is_shared(FabricMode mode) const {
    return mode == FabricMode::stretch && form_ == StripForm::grid;
  }

  void refuse_less_than_diagonals(const DampedMode& found, const char* option,
                                  const std::string& text) const {
    FabricDef least = fabric_;
    least.stretch_damping = least_stretch_damping_on_grid(fabric_, cell_u_, cell_v_);
    constexpr double kRounding = 1e-9;
    if (found.setting >= least.stretch_damping * (1 - kRounding)) return;
    const double relaxation = stretch_relaxation_on_grid(least, cell_u_, cell_v_);
    const std::string by = " on a grid beside this fabric.shear_damping";
    if (option == std::string("--loss-factor"))
      throw OptionError(option, text, "at least " + rounded_text(found.omega * relaxation) + by);
    throw OptionError(option, text,
                      "at most " + rounded_text(decay_time(found.omega, relaxation)) + " s" + by);
  }

  /// The setting must be one that a fabric may have.
  static void check_setting(const DampedMode& mode) {
    FabricDef fabric;
    visit_fields_of_fabric(fabric, [&](const FieldInfo& info, double&) {
      if (mode.field() == info.name) check_field("fabric.", info, mode.setting);
    });
  }

  FabricDef fabric_;
  double length_, cell_u_, cell_v_;
  StripForm form_;
};

DampedMode mode_of(const Strip& strip, FabricMode mode, const FabricOptions& options) {
  const DampedMode damped = strip.as_set(mode);
  if (options.decay_time) {
    const std::string text = number_text(*options.decay_time);
    const double shortest = shortest_decay_time(damped.omega);
    if (*options.decay_time < shortest)
      throw OptionError("--decay-time", text,
                        "at least " + rounded_text(shortest) + " s, that of critical damping");
    const double relaxation = relaxation_of_decay(damped.omega, *options.decay_time);
    return strip.with_relaxation(mode, relaxation, "--decay-time", text);
  }
  if (options.loss_factor)
    return strip.with_relaxation(mode, relaxation_of_loss(damped.omega, *options.loss_factor),
                                 "--loss-factor", number_text(*options.loss_factor));
  return damped;
}

Json json_of(const DampedMode& mode) {
  Json out{{"mode", mode.name()},
           {"frequency_hz", mode.omega / (2 * kPi)},
           {"relaxation_time_s", mode.relaxation},
           {"loss_factor", mode.loss_factor()},
           {"decay_time_s", nullptr},
           {"creeps", creeps(mode.omega, mode.relaxation)},
           {"setting", {{"fabric." + mode.field(), mode.setting}}}};
  if (mode.relaxation > 0) out["decay_time_s"] = decay_time(mode.omega, mode.relaxation);
  return out;
}

void print(const DampedMode& mode) {
  std::printf("%-8s %.4g Hz, ", mode.name().c_str(), mode.omega / (2 * kPi));
  if (mode.relaxation > 0)
    std::printf("%s to 1/e in %.4g s, loss factor %.4g",
                creeps(mode.omega, mode.relaxation) ? "does not swing and creeps" : "decays",
                decay_time(mode.omega, mode.relaxation), mode.loss_factor());
  else
    std::printf("no damping of its own");
  std::printf(": fabric.%s=%.4g\n", mode.field().c_str(), mode.setting);
}

void check_options(const FabricOptions& o) {
  check_range("--length", o.length, kStripLengths);
  if (o.decay_time && o.loss_factor)
    throw OptionError("--loss-factor", number_text(*o.loss_factor), "none beside --decay-time");
  if ((o.decay_time || o.loss_factor) && o.mode.empty())
    throw OptionError("--mode", "",
                      "the mode that was measured: " + allowed_values(fabric_mode_info()));
}

StripForm form_of(const FabricOptions& options, const FabricDef& fabric) {
  StripForm form = fabric.poisson == kPoissonOfGrid ? StripForm::grid : StripForm::mesh;
  if (!options.form.empty()) parse_field("--", strip_form_info(), options.form, form);
  return form;
}

std::vector<DampedMode> modes_of(const Strip& strip, const FabricOptions& options) {
  std::vector<DampedMode> modes;
  if (!options.mode.empty()) {
    FabricMode mode{};
    parse_field("--", fabric_mode_info(), options.mode, mode);
    if (!strip.resists(mode))
      throw OptionError("--mode", options.mode, "a mode that the fabric resists");
    modes.push_back(mode_of(strip, mode, options));
    return modes;
  }
  for (const FabricMode mode : {FabricMode::stretch, FabricMode::shear, FabricMode::bending}) {
    if (strip.resists(mode)) modes.push_back(mode_of(strip, mode, options));
  }
  return modes;
}

}  // namespace

int convert_damping(const FabricOptions& options) {
  check_options(options);
  WorldDef def;
  for (const auto& [key, value] : options.settings) set_field(def, key, value);
  const ClothDef& cloth = def.cloths.front();
  const StripForm form = form_of(options, cloth.fabric);
  const std::vector<DampedMode> modes = modes_of({cloth, options.length, form}, options);
  Json list = Json::array();
  for (const DampedMode& mode : modes) list.push_back(json_of(mode));
  if (options.json)
    std::printf("%s\n", Json{{"length_m", options.length},
                             {"form", choice_word(strip_form_info(), static_cast<int>(form))},
                             {"modes", list}}
                            .dump(2)
                            .c_str());
  for (const DampedMode& mode : modes) {
    if (!options.json) print(mode);
  }
  return 0;
}

}  // namespace weft::server
