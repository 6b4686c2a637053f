#include "core/detection/source/line_kernels.h"

#include "core/base/numeric/lanes.h"

namespace dmise::DMISE_SIMD {
namespace {

constexpr double whole = 1 << SampleSum::bits;

DMISE_INLINE void add_one(const LineSamples& line, int k, SampleSum& out) {
  const double d = k - line.centre, r = d * line.to_r;
  const double place = line.middle + line.slope * d + line.bend * (1.0 / 3 - r * r);
  if (!(place >= 0 && place < line.across - 1)) return;
  const int m = int(place);
  const std::int8_t* at =
      line.pixels + std::size_t(k) * line.along_step + std::size_t(m) * line.across_step;
  const int a = at[0], b = at[line.across_step];
  const bool seen = (a != 0) & (b != 0);
  const int value = (a << SampleSum::bits) + int((place - m) * whole) * (b - a);
  out.sum += seen ? value : 0;
  out.samples += seen;
}

#if defined(__AVX2__)
constexpr int places = wide_lanes;
using Index = std::int32_t __attribute__((vector_size(places * 4)));

DMISE_INLINE Index gather(const std::int8_t* from, Index at) {
  const int* words = reinterpret_cast<const int*>(from);
#if defined(__AVX512F__)
  return (Index)_mm256_i32gather_epi32(words, (__m256i)at, 1);
#else
  return (Index)_mm_i32gather_epi32(words, (__m128i)at, 1);
#endif
}
DMISE_INLINE bool any_of(Index m) {
#if defined(__AVX512F__)
  return _mm256_movemask_epi8((__m256i)m) != 0;
#else
  return _mm_movemask_epi8((__m128i)m) != 0;
#endif
}

constexpr int read_at_once = 4;  // pixels

/// The first byte of each lane, with its sign.
DMISE_INLINE Index first_byte(Index v) { return (v << 24) >> 24; }

/// Adds the rows or columns from `k` on, as many as vectors hold; returns the first that is left.
template <bool adjacent>
DMISE_INLINE int add_along(const LineSamples& line, int k, SampleSum& out) {
  F64 ramp{};
  Index steps{};
  for (int i = 0; i < places; ++i) ramp[i] = i, steps[i] = i;
  const int along = int(line.along_step), across = int(line.across_step);
  const int last = int(line.count) - read_at_once - (adjacent ? 0 : across);
  Index sum{}, samples{};
  for (; k + places - 1 <= line.to; k += places) {
    const F64 d = ramp + double(k) - line.centre, r = d * line.to_r;
    const F64 place = line.middle + line.slope * d + line.bend * (1.0 / 3 - r * r);
    const I64 inside = (place >= 0) & (place < double(line.across - 1));
    const F64 held = bits<F64>(bits<I64>(place) & inside);
    const Index m = __builtin_convertvector(held, Index);
    const Index at = (steps + k) * along + m * across;
    if (any_of(at > last)) break;
    const Index words = gather(line.pixels, at);
    const Index a = first_byte(words);
    const Index b = first_byte(adjacent ? words >> 8 : gather(line.pixels + across, at));
    const Index seen = __builtin_convertvector(inside, Index) & (a != 0) & (b != 0);
    const Index weight =
        __builtin_convertvector((held - __builtin_convertvector(m, F64)) * whole, Index);
    sum += ((a << SampleSum::bits) + weight * (b - a)) & seen;
    samples -= seen;
  }
  for (int i = 0; i < places; ++i) {
    out.sum += sum[i];
    out.samples += samples[i];
  }
  return k;
}
#endif

using I16 = std::int16_t __attribute__((vector_size(DMISE_SIMD_BYTES)));
using I8 = std::int8_t __attribute__((vector_size(DMISE_SIMD_BYTES)));
constexpr int shorts = DMISE_SIMD_BYTES / 2;
constexpr int max_rows = 32;  // sums over as many fit into 16 bits
static_assert(31 * (1 << BandSums::bits) * max_rows < 32768);
static_assert(BandSums::block % (2 * shorts) == 0 && shorts < BandSums::spare);

/// Values between two pixels beside each other, which are the bytes of each lane; `weight` is that
/// of the second.
DMISE_INLINE I16 between(I16 pixels, std::int16_t weight) {
#if defined(__AVX2__)
  const I16 weights = I16{} + std::int16_t(weight << 8 | ((1 << BandSums::bits) - weight));
#if defined(__AVX512F__)
  return (I16)_mm512_maddubs_epi16((__m512i)weights, (__m512i)pixels);
#else
  return (I16)_mm256_maddubs_epi16((__m256i)weights, (__m256i)pixels);
#endif
#else
  const I16 a = (pixels << 8) >> 8, b = pixels >> 8;
  return (a << BandSums::bits) + (b - a) * weight;
#endif
}

/// Adds a row of pixels to every second line from the one that begins at the first pixel on.
DMISE_INLINE void add_row(const std::int8_t* at, std::int16_t weight, int lines, std::int16_t* part,
                          std::int16_t* count) {
  for (int i = 0; i < lines; i += shorts) {
    const I16 pixels = load<I16>(at + 2 * i);
    const I8 lit = bits<I8>(pixels) != 0;
    const I16 seen = bits<I16>(lit) == -1;
    store(part + i, load<I16>(part + i) + (between(pixels, weight) & seen));
    store(count + i, load<I16>(count + i) - seen);
  }
}

DMISE_INLINE void gather_parts(const BandSums& band) {
  for (int i = 0; i < band.width; ++i) {
    band.sum[i] += band.part[i];
    band.samples[i] += band.part_count[i];
    band.part[i] = band.part_count[i] = 0;
  }
}

}  // namespace

SampleSum sum_samples(const LineSamples& line) {
  SampleSum out;
  int k = line.from;
#if defined(__AVX2__)
  // Indices and the lanes' sums have 32 bits.
  if (line.count < (std::size_t(1) << 31) && line.to - line.from < 1 << 16)
    k = line.across_step == 1 ? add_along<true>(line, k, out) : add_along<false>(line, k, out);
#endif
  for (; k <= line.to; ++k) add_one(line, k, out);
  return out;
}

void sum_band(const LineSamples& line, const BandSums& band) {
  const int lines = 2 * band.reach + 1;
  int rows = 0;
  for (int k = line.from; k <= line.to; ++k) {
    const double d = k - line.centre, r = d * line.to_r;
    const double place = line.middle + line.slope * d + line.bend * (1.0 / 3 - r * r);
    if (!(place > -1e6 && place < 1e6)) continue;
    const int m = int(place + 1048576.0) - 1048576;  // rounds down
    const auto weight = std::int16_t((place - m) * (1 << BandSums::bits));
    const int first = m - band.reach;  // pixel of the first line
    const std::int8_t* pixels = line.pixels + std::size_t(k) * line.along_step;
    const std::int8_t* at = band.row;
    if (first >= 0 && first + band.width + BandSums::spare <= line.across) {
      at = pixels + first;
    } else {
      const int begin = first > 0 ? first : 0;
      const int end = first + lines + 1 < line.across ? first + lines + 1 : line.across;
      if (end <= begin) continue;
      __builtin_memset(band.row, 0, std::size_t(band.width + BandSums::spare));
      __builtin_memcpy(band.row + (begin - first), pixels + begin, std::size_t(end - begin));
    }
    const int half = band.width / 2;
    add_row(at, weight, half, band.part, band.part_count);
    if (band.has_odd) add_row(at + 1, weight, half, band.part + half, band.part_count + half);
    if (++rows % max_rows == 0) gather_parts(band);
  }
  gather_parts(band);
}

}  // namespace dmise::DMISE_SIMD
