#pragma once
#include <algorithm>
#include <cstddef>

namespace dmise {

/// A place between two nodes of a table: `part` of the way from `node` to the next.
struct TablePlace {
  std::size_t node;
  double part;  // [0, 1]
};

/// Returns the place of `at`, counted in steps of the table and clamped to it; `nodes` >= 2.
inline TablePlace table_place(double at, std::size_t nodes) {
  const double held = std::clamp(at, 0.0, double(nodes) - 1.0);
  const auto node = std::min(std::size_t(held), nodes - 2);
  return {node, held - double(node)};
}

}  // namespace dmise
