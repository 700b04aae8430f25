#include "server/commands/error_of_run.h"

#include <algorithm>
#include <cstdio>
#include <vector>

namespace weft::server {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kNotMeasured = "not measured";

std::string text_of(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

Json figure_of(const QuantityError& quantity) {
  const ErrorFigure& figure = quantity.figure;
  Json json = Json::object();
  json["error"] = figure.measured ? Json(figure.estimate.error) : Json(kNotMeasured);
  json["unit"] = quantity.unit;
  if (figure.measured) {
    if (figure.estimate.order > 0) json["order"] = figure.estimate.order;
    json["noise"] = figure.noise;
    json["until"] = figure.until;
  }
  if (figure.chaotic) json["noise_rules_from"] = figure.chaotic_at;
  return json;
}

Json figures_of(const std::vector<QuantityError>& all) {
  Json json = Json::object();
  for (const QuantityError& quantity : all) json[quantity.name] = figure_of(quantity);
  return json;
}

/// "positions 0.00012 m until 1.5 s (noise rules from 1.52 s)"
std::string words_of(const QuantityError& quantity) {
  const ErrorFigure& figure = quantity.figure;
  std::string words = quantity.name;
  words += figure.measured ? text_of(" %.2g ", figure.estimate.error) + quantity.unit +
                                 text_of(" until %.4g s", figure.until)
                           : std::string(" ") + kNotMeasured;
  if (figure.chaotic) words += text_of(" (noise rules from %.4g s)", figure.chaotic_at);
  return words;
}

std::string words_of(const std::vector<QuantityError>& all) {
  std::string words;
  for (const QuantityError& quantity : all)
    words += (words.empty() ? "" : ", ") + words_of(quantity);
  return words;
}

bool any_measured(const std::vector<QuantityError>& all) {
  return std::any_of(all.begin(), all.end(),
                     [](const QuantityError& quantity) { return quantity.figure.measured; });
}

}  // namespace

std::string ErrorOfRun::cost_told_before(const TickCost& run) const {
  const double once = once_.cost_in(once_.environment()).updates();
  const double part = once / run.updates();
  return "--error repeats the run: about " +
         text_of("%.3g", part * (1 + error_.relative_cost(once_))) +
         " times its cost besides, in double precision";
}

Json ErrorOfRun::summary() const {
  const std::vector<QuantityError> time = error_.in_time(), space = error_.in_space(once_);
  if (!any_measured(time) && !any_measured(space)) return kNotMeasured;
  const std::string no_space = std::string(kNotMeasured) + ": " + error_.space_forbidden();
  return {{"summary", "time: " + words_of(time) +
                          "; twice the rows: " + (space.empty() ? no_space : words_of(space))},
          {"time", figures_of(time)},
          {"space", space.empty() ? Json(no_space) : figures_of(space)},
          {"broke_off", error_.broke_off()}};
}

}  // namespace weft::server
