#include "core/photometry/star_light.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/numeric/vector_math.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/spectrum.h"

namespace dmise {
namespace {

constexpr double step = 0.01;
constexpr int steps = 240;  // min_bv + steps x step = greatest_bv
constexpr double min_dwarf_bv = 0.95;

/// Spectra of stars with their photon rates in V.
struct StarOfColour {
  StarSpectrum spectrum;
  double in_v = 0.0;
};

StarOfColour star_of(const StarColour& colour) {
  StarSpectrum star = star_spectrum(colour);
  const double in_v = photon_rate(star, johnson_v());
  return {std::move(star), in_v};
}

/// Every `step` of B-V from a least one.
std::vector<StarOfColour> stars_by_bv(double least, StarKind kind) {
  std::vector<StarOfColour> stars;
  for (int i = 0; least + i * step < greatest_bv + 0.5 * step; ++i)
    stars.push_back(star_of({least + i * step, kind}));
  return stars;
}

struct StarsOfKinds {
  std::vector<StarOfColour> most = stars_by_bv(min_bv, StarKind::most);
  std::vector<StarOfColour> red_dwarfs = stars_by_bv(min_dwarf_bv, StarKind::red_dwarf);
  std::vector<StarOfColour> m_stars;
};

const StarsOfKinds& stars_of_kinds() {
  static const StarsOfKinds stars = [] {
    StarsOfKinds out;
    for (int kind = int(StarKind::m0_giant); kind <= int(StarKind::m5_dwarf); ++kind)
      out.m_stars.push_back(star_of({0.0, StarKind(kind)}));
    return out;
  }();
  return stars;
}

}  // namespace

StarLight::StarLight(const Band& band) {
  check_band(band);
  const double zero_point = zero_point_photons_per_s_m2(johnson_v());
  const auto light_of = [&](const std::vector<StarOfColour>& stars) {
    std::vector<double> light;
    for (const StarOfColour& star : stars)
      light.push_back(zero_point * photon_rate(star.spectrum, band) / star.in_v);
    return light;
  };
  at_v_0_ = light_of(stars_of_kinds().most);
  red_dwarf_at_v_0_ = light_of(stars_of_kinds().red_dwarfs);
  m_at_v_0_ = light_of(stars_of_kinds().m_stars);
}

double StarLight::at_v_0(double bv) const {
  const double used = bv >= min_bv ? std::min(bv, greatest_bv) : min_bv;
  const double at = (used - min_bv) / step;
  const int low = std::min(int(at), steps - 1);
  return at_v_0_[low] + (at - low) * (at_v_0_[low + 1] - at_v_0_[low]);
}

double StarLight::at_v_0(const StarColour& colour) const {
  if (colour.kind == StarKind::most) return at_v_0(colour.bv);
  if (colour.kind != StarKind::red_dwarf)
    return m_at_v_0_[std::size_t(colour.kind) - std::size_t(StarKind::m0_giant)];
  const double used = colour.bv >= min_dwarf_bv ? std::min(colour.bv, greatest_bv) : min_dwarf_bv;
  const double at = (used - min_dwarf_bv) / step;
  const std::size_t low = std::min(std::size_t(at), red_dwarf_at_v_0_.size() - 2);
  return std::lerp(red_dwarf_at_v_0_[low], red_dwarf_at_v_0_[low + 1], at - double(low));
}

double StarLight::photons_per_s_m2(double v_mag, const StarColour& colour) const {
  return light_of_magnitude(v_mag) * at_v_0(colour);
}

double StarLight::max_photons_per_s_m2(double v_mag) const {
  return light_of_magnitude(v_mag) *
         std::max({std::ranges::max(at_v_0_), std::ranges::max(red_dwarf_at_v_0_),
                   std::ranges::max(m_at_v_0_)});
}

void StarLight::photons_per_s_m2(std::span<const double> v_mag, std::span<const double> bv,
                                 std::span<double> rate) const {
  if (v_mag.size() != rate.size() || bv.size() != rate.size())
    throw Error("star light: magnitudes, colours and rates differ in number");
  constexpr double log_per_mag = -0.4 * 2.302585092994045684;
  for (std::size_t i = 0; i < rate.size(); ++i) rate[i] = log_per_mag * v_mag[i];
  exp_of(rate, rate);
  for (std::size_t i = 0; i < rate.size(); ++i) rate[i] *= at_v_0(bv[i]);
}

}  // namespace dmise
