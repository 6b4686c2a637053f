#pragma once

namespace dmise {

struct Scenario;

/// Gives each node of the user's its role and the topics that it hears, and each object that a node
/// moves or turns its place among those of the node. Throws `ConfigError` for a node without a role
/// or with two, and for what its role does not allow.
void assign_own_nodes(Scenario& scenario);

}  // namespace dmise
