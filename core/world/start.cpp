// Checks of a start other than flat.

#include "core/world/start.h"

#include <string>

#include "core/definition.h"
#include "core/error.h"
#include "core/solver/constants.h"

namespace weft {
namespace {

/// @param most  greatest length of an element
void check_all(const char* field, const std::vector<Vec3d>& values, std::size_t particles,
               double most, const char* unit) {
  if (values.size() != particles)
    throw DefinitionError(field, std::to_string(values.size()) + " particles",
                          std::to_string(particles) + ", as many as the scene has",
                          "take the scene and the settings that the file was written with");
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double length = values[i].norm();
    if (length <= most) continue;
    throw DefinitionError(std::string(field) + "[" + std::to_string(i) + "]",
                          number_text(length) + " " + unit,
                          "a length of at most " + number_text(most) + " " + unit);
  }
}

}  // namespace

void validate(const StartDef& start, std::size_t particles) {
  check_all("start.x", start.x, particles, kFarthestFromOrigin, "m");
  if (!start.v.empty()) check_all("start.v", start.v, particles, kFastestStart, "m/s");
}

}  // namespace weft
