#pragma once

namespace dmise {

struct OwnNode;
struct OwnObject;
struct Scenario;

/// Whether a node of the user's says where an object is, and how it is turned.
bool is_moved_by(const OwnNode& node, const OwnObject& object);
bool is_turned_by(const OwnNode& node, const OwnObject& object);

/// Gives each node of the user's its role and the topics that it hears, and each object that a node
/// moves or turns its place among those of the node. Throws `ConfigError` for a node without a role
/// or with two, and for what its role does not allow.
void assign_own_nodes(Scenario& scenario);

}  // namespace dmise
