#pragma once
#include <array>
#include <cstddef>

namespace dmise {

/// What of a streak depends on where it ends: the place of its middle along the line, its light,
/// length and slope of brightness, and how far its middle is beside the line, if the ends are on
/// one that is turned.
enum EndParameter : std::size_t {
  end_middle,
  end_flux,
  end_length,
  end_slope,
  end_beside,
  end_parameters
};

/// Means of products of the differences between what a streak may be and its fit, in the order of
/// `EndParameter` [px, e-, px, 1, px].
using EndErrors = std::array<std::array<double, end_parameters>, end_parameters>;

}  // namespace dmise
