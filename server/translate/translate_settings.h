#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "core/error.h"
#include "proto/messages/settings.h"
#include "server/translate/translate.h"

// What `set` sets, and what `state` tells of it.

namespace weft::server {

/// The environment with the command's settings.
EnvironmentDef with_settings(EnvironmentDef environment, const proto::Set& set);

/// The budget with the command's settings.
BudgetDef with_settings(BudgetDef budget, const proto::Set& set);
proto::OverBudget to_wire(OverBudget remedy);

/// A cloth and the fabric that it shall have.
struct FabricWanted {
  std::size_t cloth = 0;
  FabricDef fabric;
};

/// What `set` asks of a cloth's fabric; empty if nothing. An error if there is no such cloth or
/// preset.
proto::Result<std::optional<FabricWanted>> fabric_wanted(const ServedWorld& world,
                                                         const proto::Set& set);

/// The refusal of a `set` whose fabric is one that the physics refuses: of a field that was sent,
/// by its path in the command.
/// @param set  has a fabric
proto::Error refused_fabric(const DefinitionError& error, const proto::Set& set);

/// The same of the softness that it leads to.
proto::Error refused_softness(const DefinitionError& error, const proto::Set& set);

/// The same of its environment.
proto::Error refused_environment(const DefinitionError& error, const proto::Set& set);

/// Writes the environment and the fabrics into a state.
void tell_settings(const ServedWorld& world, proto::State& state);

}  // namespace weft::server
