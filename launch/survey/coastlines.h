#pragma once
#include <cstdint>
#include <vector>

namespace dmise {

/// A place on a coast [0.1 deg].
struct CoastPoint {
  std::int16_t longitude = 0, latitude = 0;
};

/// Coasts of the land for maps of the whole Earth, to 0.35 deg; without islands of less than
/// 1.5 deg. Source: Natural Earth at 1:110 million, public domain.
const std::vector<std::vector<CoastPoint>>& coastlines();

}  // namespace dmise
