#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace dmise {

/// What it costs to give a row a column; any finite number.
struct Pairing {
  std::size_t row = 0, column = 0;
  double cost = 0.0;
};

inline constexpr std::size_t unassigned = std::size_t(-1);

/// The column of each row, or `unassigned`, so that no column is taken twice and the sum of costs
/// is least; a row without a column costs 0. Only the listed pairs are possible; of a pair that is
/// listed twice the cheaper counts. Shortest augmenting paths (Jonker & Volgenant 1987) on the
/// sparse graph. Depends on the pairs alone, not on their order, unless solutions cost the same.
/// Throws `Error` for a row or column out of range or a cost that is not finite.
std::vector<std::size_t> assign(std::size_t rows, std::size_t columns,
                                std::span<const Pairing> pairs);

}  // namespace dmise
