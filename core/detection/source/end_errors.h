#pragma once
#include <array>
#include <cstddef>

namespace dmise {

/// Parameters of a streak that depend on its ends: the place of its middle along the line, its
/// light, its length, its slope of brightness, and the distance of its middle from the line, where
/// the ends are on a turned one.
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
