#pragma once
#include <cstddef>
#include <cstdint>

namespace dmise {

struct PreparedCone {
  double apex[3];
  double axis[3];  // divided by the cosine of the half angle
  bool wide;       // more than 90 degrees: axis and angle are those of the opposite cone
};

/// Words of one cone over 64 objects each; `present` masks out objects without a state.
using ConeWords = void (*)(const double* x, const double* y, const double* z, std::size_t words,
                           const PreparedCone& cone, const std::uint64_t* present,
                           std::uint64_t* inside);

extern const ConeWords cone_words_sse2, cone_words_avx2, cone_words_avx512;

}  // namespace dmise
