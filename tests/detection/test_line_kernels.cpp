#include "core/detection/source/line_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/base/numeric/simd_level.h"
#include "core/detection/source/line_search.h"

namespace dmise {
namespace {

struct Kernels {
  decltype(&sse2::sum_samples) sum_samples;
  decltype(&sse2::sum_band) sum_band;
};

std::vector<Kernels> levels() {
  std::vector<Kernels> out{{sse2::sum_samples, sse2::sum_band}};
  if (best_simd_level() >= SimdLevel::avx2) out.push_back({avx2::sum_samples, avx2::sum_band});
  if (best_simd_level() >= SimdLevel::avx512)
    out.push_back({avx512::sum_samples, avx512::sum_band});
  return out;
}

/// A frame of noise, a fifth of which is hidden.
FilteredFrame noise(int columns, int rows) {
  FilteredFrame frame(columns, rows, 0.9);
  std::mt19937_64 random(7);
  for (auto& step : frame.snr) {
    const int value = int(random() % 63) - 31;
    step = std::int8_t(random() % 5 == 0 ? 0 : value == 0 ? 1 : value);
  }
  return frame;
}

/// By the definition: between the two pixels beside the line in each row or column.
struct Expected {
  double sum = 0.0;
  int samples = 0;
};

Expected expected(const LineSamples& line, double shift) {
  Expected out;
  for (int k = line.from; k <= line.to; ++k) {
    const double d = k - line.centre, r = d * line.to_r;
    const double place = line.middle + shift + line.slope * d + line.bend * (1.0 / 3 - r * r);
    const double m = std::floor(place);
    if (m < 0 || m > line.across - 2) continue;
    const std::int8_t* at =
        line.pixels + std::size_t(k) * line.along_step + std::size_t(m) * line.across_step;
    const double a = at[0], b = at[line.across_step];
    if (a == 0 || b == 0) continue;
    out.sum += a + (place - m) * (b - a);
    ++out.samples;
  }
  return out;
}

/// Lines that lie within, cross each edge, and have one sample or none; bent and straight.
std::vector<LineSamples> lines_in(const FilteredFrame& frame, bool by_rows) {
  const int along = by_rows ? frame.rows : frame.columns;
  const int across = by_rows ? frame.columns : frame.rows;
  std::vector<LineSamples> out;
  for (const double middle : {-3.0, 0.2, 0.5 * across, across - 1.4, across + 5.0})
    for (const double slope : {-0.99, 0.0, 0.37})
      for (const double bend : {0.0, 5.0})
        for (const auto& [from, to] :
             {std::pair{0, along - 1}, {3, 12}, {along - 1, along - 1}, {5, 4}}) {
          LineSamples line;
          line.pixels = frame.snr.data();
          line.count = frame.snr.size();
          line.along_step = by_rows ? std::size_t(frame.columns) : 1;
          line.across_step = by_rows ? 1 : std::size_t(frame.columns);
          line.from = from;
          line.to = to;
          line.across = across;
          line.centre = 0.5 * along + 0.3;
          line.middle = middle;
          line.slope = slope;
          line.bend = bend;
          line.to_r = 2.0 / along;
          out.push_back(line);
        }
  return out;
}

TEST(LineKernels, SumsAreThoseOfTheDefinitionOnEveryInstructionSet) {
  const FilteredFrame frame = noise(61, 97);
  for (const bool by_rows : {false, true})
    for (const LineSamples& line : lines_in(frame, by_rows)) {
      const Expected right = expected(line, 0.0);
      const SampleSum first = sse2::sum_samples(line);
      EXPECT_EQ(first.samples, right.samples);
      // Fractions are cut to 1/4096, of differences of up to 62.
      EXPECT_NEAR(double(first.sum) / (1 << SampleSum::bits), right.sum,
                  62.0 / (1 << SampleSum::bits) * right.samples + 1e-9);
      for (const Kernels& kernels : levels()) {
        const SampleSum sum = kernels.sum_samples(line);
        EXPECT_EQ(sum.sum, first.sum);
        EXPECT_EQ(sum.samples, first.samples);
      }
    }
}

TEST(LineKernels, ABandHasTheSumsOfItsLinesOnEveryInstructionSet) {
  for (const int columns : {61, 300}) {
    const FilteredFrame frame = noise(columns, 97);
    for (const LineSamples& line : lines_in(frame, true))
      for (const int reach : {0, 9, 150}) {
        LineBand of_first, band;
        const BandSums sums = of_first.of(reach);
        sse2::sum_band(line, sums);
        for (int offset = -reach; offset <= reach; ++offset) {
          const Expected right = expected(line, offset);
          const std::size_t at = sums.place_of(reach + offset);
          ASSERT_EQ(of_first.samples[at], right.samples);
          ASSERT_NEAR(double(of_first.sum[at]) / (1 << BandSums::bits), right.sum,
                      62.0 / (1 << BandSums::bits) * right.samples + 1e-9);
        }
        for (const Kernels& kernels : levels()) {
          kernels.sum_band(line, band.of(reach));
          EXPECT_EQ(band.sum, of_first.sum);
          EXPECT_EQ(band.samples, of_first.samples);
          kernels.sum_band(line, band.of(reach, false));
          for (int k = 0; k <= 2 * reach; k += 2) {
            EXPECT_EQ(band.sum[sums.place_of(k)], of_first.sum[sums.place_of(k)]);
            EXPECT_EQ(band.samples[sums.place_of(k)], of_first.samples[sums.place_of(k)]);
          }
        }
      }
  }
}

}  // namespace
}  // namespace dmise
