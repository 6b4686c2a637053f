#include "core/discrimination/discrimination_design.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/discrimination/aperture_fraction.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/spectrum.h"

namespace dmise {
namespace {

constexpr double shortest_s = 1e-5, longest_s = 1e5;

/// Rates of a band that no exposure changes.
struct BandRates {
  double sunlight_e_per_s = 0.0, background_e_per_s = 0.0, read_e2 = 0.0;
};

BandRates rates_of(const SpectralImager& imager, const ReflectingTarget& target, const Band& band) {
  const double e_per_photon_m2 =
      imager.optics.collecting_area_m2() * imager.optics.transmission * imager.quantum_efficiency;
  const double area_px = pi * imager.aperture_px * imager.aperture_px;
  const double arcsec2_per_px = std::pow(imager.optics.pixel_angle_rad() / arcsec, 2);
  const double sky_e_per_s = sunlight_photons_per_s_m2(imager.sky_v_mag_per_arcsec2, band) *
                             arcsec2_per_px * e_per_photon_m2;
  return {photon_rate_per_m2(solar_spectrum(), band) * e_per_photon_m2 * target.area_m2 /
              (target.range_m * target.range_m) *
              aperture_fraction(imager.optics, band.centre_m, imager.aperture_px),
          area_px * (sky_e_per_s + imager.dark_e_per_s),
          area_px * imager.read_noise_e * imager.read_noise_e};
}

ExpectedBand at(const BandRates& rates, double exposure_s) {
  return {rates.sunlight_e_per_s * exposure_s,
          rates.background_e_per_s * exposure_s + rates.read_e2};
}

using Pair = std::array<ExpectedBand, 2>;
using Signatures = std::array<MaterialSignature, 2>;

double wrong_of(const Pair& bands, const Signatures& signatures) {
  double worst = 0.0;
  for (std::size_t m = 0; m < 2; ++m) {
    std::array<double, 2> sigma{};
    MaterialSignature actual = signatures[m], other = signatures[1 - m];
    for (std::size_t i = 0; i < 2; ++i) {
      const double light_e = bands[i].sunlight_e * actual.reflectance[i];
      sigma[i] = std::sqrt(bands[i].background_e2 + light_e);
      actual.reflectance[i] *= bands[i].sunlight_e;
      other.reflectance[i] *= bands[i].sunlight_e;
    }
    worst = std::max(worst, mistaken_probability(actual, other, 1.0, sigma));
  }
  return worst;
}

Signatures signatures_of(const std::array<Material, 2>& materials, std::span<const Band> bands) {
  return {signature_of(materials[0], bands), signature_of(materials[1], bands)};
}

std::optional<double> exposure_of(const std::array<BandRates, 2>& rates,
                                  const Signatures& signatures, double wrong) {
  const auto wrong_at = [&](double s) {
    return wrong_of({at(rates[0], s), at(rates[1], s)}, signatures);
  };
  if (wrong_at(longest_s) > wrong) return std::nullopt;
  double low = std::log(shortest_s), high = std::log(longest_s);
  while (high - low > 1e-6) {
    const double middle = 0.5 * (low + high);
    (wrong_at(std::exp(middle)) > wrong ? low : high) = middle;
  }
  return std::exp(high);
}

std::vector<double> logarithmic(double least, double most, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i)
    values.push_back(least * std::pow(most / least, double(i) / (count - 1)));
  return values;
}

}  // namespace

ExpectedBand expected_band(const SpectralImager& imager, const ReflectingTarget& target,
                           const Band& band, double exposure_s) {
  return at(rates_of(imager, target, band), exposure_s);
}

double wrong_probability(const SpectralImager& imager, const ReflectingTarget& target,
                         const std::array<Band, 2>& bands, const std::array<Material, 2>& materials,
                         double exposure_s) {
  return wrong_of({expected_band(imager, target, bands[0], exposure_s),
                   expected_band(imager, target, bands[1], exposure_s)},
                  signatures_of(materials, bands));
}

std::optional<double> exposure_for(const SpectralImager& imager, const ReflectingTarget& target,
                                   const std::array<Band, 2>& bands,
                                   const std::array<Material, 2>& materials, double wrong) {
  return exposure_of({rates_of(imager, target, bands[0]), rates_of(imager, target, bands[1])},
                     signatures_of(materials, bands), wrong);
}

std::vector<BandPair> compare_band_pairs(const SpectralImager& imager,
                                         const ReflectingTarget& target,
                                         const std::array<Material, 2>& materials, double low_m,
                                         double high_m, double width_m, double wrong) {
  std::vector<Band> bands;
  std::vector<BandRates> rates;
  for (int i = 0; low_m + (i + 1) * width_m <= high_m + 1e-12; ++i) {
    bands.push_back({.name = "", .centre_m = low_m + (i + 0.5) * width_m, .width_m = width_m});
    rates.push_back(rates_of(imager, target, bands.back()));
  }
  const Signatures all = signatures_of(materials, bands);
  std::vector<BandPair> pairs;
  for (std::size_t i = 0; i < bands.size(); ++i)
    for (std::size_t j = i + 1; j < bands.size(); ++j) {
      Signatures two;
      for (std::size_t m = 0; m < 2; ++m)
        two[m] = {all[m].name, {all[m].reflectance[i], all[m].reflectance[j]}};
      pairs.push_back({bands[i], bands[j], exposure_of({rates[i], rates[j]}, two, wrong)});
    }
  std::stable_sort(pairs.begin(), pairs.end(), [](const BandPair& a, const BandPair& b) {
    return a.exposure_s.value_or(2 * longest_s) < b.exposure_s.value_or(2 * longest_s);
  });
  return pairs;
}

DiscriminationDesign design(const SpectralImager& imager, const ReflectingTarget& target,
                            const std::array<Band, 2>& bands,
                            const std::array<Material, 2>& materials, double right) {
  if (!(right > 0.5 && right < 1.0)) throw Error("design: probability: must be in (0.5, 1)");
  const double wrong = 1.0 - right;
  DiscriminationDesign d{.bands = bands, .materials = materials, .right = right};
  for (const double s : logarithmic(1e-3, 10.0, 81))
    d.right_by_exposure.push_back(
        {s, 1.0 - wrong_probability(imager, target, bands, materials, s)});
  const auto needs = [&](const SpectralImager& i, const ReflectingTarget& t) {
    return exposure_for(i, t, bands, materials, wrong);
  };
  for (const double range_m : logarithmic(1e5, 1e7, 41)) {
    ReflectingTarget t = target;
    t.range_m = range_m;
    d.by_range_m.push_back({range_m, needs(imager, t)});
  }
  for (const double aperture_m : logarithmic(0.05, 1.0, 27)) {
    SpectralImager i = imager;
    i.optics.aperture_m = aperture_m;
    if (i.optics.f_number() < 0.5) continue;
    d.by_aperture_m.push_back({aperture_m, needs(i, target)});
  }
  for (double radius = 1.0; radius <= 12.0; radius += 0.5) {
    SpectralImager i = imager;
    i.aperture_px = radius;
    d.by_photometric_radius_px.push_back({radius, needs(i, target)});
  }
  d.pairs = compare_band_pairs(imager, target, materials, 0.40e-6, 1.80e-6, 0.05e-6, wrong);
  return d;
}

}  // namespace dmise
