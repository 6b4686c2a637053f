#pragma once
#include <optional>
#include <span>

namespace dmise {

/// Returns the least x in (0, upto] at which the polynomial c[0] + c[1] x + ... is not positive;
/// empty if there is none. c[0] must be > 0.
std::optional<double> first_root(std::span<const double> c, double upto);

}  // namespace dmise
