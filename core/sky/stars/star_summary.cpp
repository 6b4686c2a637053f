#include "core/sky/stars/star_summary.h"

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

std::size_t bin_of(double v_mag) {
  const double bin = std::floor((v_mag - StarSummary::first_v_mag) / StarSummary::step_mag);
  return std::size_t(std::clamp(bin, 0.0, double(StarSummary::bins - 1)));
}

}  // namespace

std::uint64_t StarSummary::brighter_than(double v_mag) const {
  std::uint64_t stars = 0;
  for (std::size_t bin = 0; bin <= bin_of(v_mag); ++bin) stars += count[bin];
  return stars;
}

double StarSummary::magnitude_of_rank(double rank) const {
  std::uint64_t stars = 0;
  double v_mag = first_v_mag;
  for (std::size_t bin = 0; bin < bins && double(stars) <= rank; ++bin) {
    stars += count[bin];
    if (count[bin] > 0) v_mag = bright_edge(bin + 1);
  }
  return v_mag;
}

StarSummary summary_of(const StarTable& stars) {
  StarSummary summary{.faintest_filled_v_mag =
                          faintest_filled_v_mag({stars.v_mag.data(), stars.size()})};
  for (const float v_mag : stars.v_mag) ++summary.count[bin_of(v_mag)];
  for (const double parallax_rad : stars.parallax_rad)
    summary.largest_parallax_rad = std::max(summary.largest_parallax_rad, parallax_rad);
  return summary;
}

}  // namespace dmise
