#pragma once
#include <cstddef>
#include <cstdint>

#include "core/base/numeric/simd_sets.h"

namespace dmise {

/// A sum that is large enough: its column, and in which of the joined rows it is.
struct BeamletHit {
  std::uint32_t column = 0;
  std::int16_t row = 0, sum = 0;
};

/// Sums of a strip and of its halves that are large enough, by rising column.
struct BeamletHits {
  BeamletHit* whole = nullptr;   // room for four of each column
  BeamletHit* halves = nullptr;  // room for as many
  std::size_t in_whole = 0, in_halves = 0;
};

/// Least sums that are hits, by row, of the whole strip and of its halves.
struct BeamletLeast {
  std::int16_t whole[4] = {32767, 32767, 32767, 32767};
  std::int16_t halves[2] = {32767, 32767};
  bool keeps_sums = true;  // for a longer strip; else the rows are left as they may be
};

/// Columns beside a row's end that kernels read, besides the shifts, and write.
inline constexpr std::size_t beamlet_spare = 64;

// Rows are followed by zeros, as far as kernels read: the shifts and `beamlet_spare`.
#define DMISE_BEAMLET_KERNELS(level)                                                             \
  namespace level {                                                                              \
  /* Steps of a frame, in the opposite order if `reversed`. */                                   \
  void widen_steps(const std::int8_t* from, std::size_t count, bool reversed, std::int16_t* to); \
  /* Replaces two rows of sums over n rows of pixels by those over 2 n: a[x] + b[x + shift + r], \
     r = 0, 1, for `begin` <= x < `end`. `hits` gets those of `least.whole`. */                  \
  void join_two(std::int16_t* const rows[2], std::size_t shift, std::size_t begin,               \
                std::size_t end, const BeamletLeast& least, BeamletHits& hits);                  \
  /* Replaces four rows of sums over n rows of pixels by those over 4 n, as three times          \
     `join_two` does: row r is a[x] + b[x + shift + r/2] + c[x + 2 shift + (r+1)/2]              \
     + d[x + 3 shift + r], and `hits` gets the sums over 2 n, too: of a and b in rows 0 and 1,   \
     of c and d in rows 2 and 3. */                                                              \
  void join_four(std::int16_t* const rows[4], std::size_t shift, std::size_t begin,              \
                 std::size_t end, const BeamletLeast& least, BeamletHits& hits);                 \
  }
DMISE_EACH_SIMD_SET(DMISE_BEAMLET_KERNELS)
#undef DMISE_BEAMLET_KERNELS

}  // namespace dmise
