#pragma once
#include <algorithm>
#include <cstddef>

namespace dmise {

/// Where a number lies between the nodes of a table: part of the way from a node to the next.
struct TablePlace {
  std::size_t node;
  double part;  // [0, 1]
};

/// `at` in steps of the table, held within it; `nodes` >= 2.
inline TablePlace table_place(double at, std::size_t nodes) {
  const double held = std::clamp(at, 0.0, double(nodes) - 1.0);
  const auto node = std::min(std::size_t(held), nodes - 2);
  return {node, held - double(node)};
}

}  // namespace dmise
