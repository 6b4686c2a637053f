#pragma once

namespace dmise {

/// Environment variable in which a program of the user's finds the address of its node.
inline constexpr const char* own_node_variable = "DMISE_OWN_NODE";

}  // namespace dmise
