#include "core/sky/air/dispersion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/star_spectrum.h"
#include "core/sky/air/colour_airmass.h"
#include "core/sky/air/kept_tables.h"

namespace dmise {
namespace {

constexpr int edges = BandDispersion::max_cells + 1;
constexpr int dispersion_colours = 25, dispersion_airmasses = 17;  // every 0.1 of B-V
constexpr ColourAirmassNodes dispersion_nodes{dispersion_colours, dispersion_airmasses};

struct Lit {
  double blue_m, red_m;
};

/// The band without its ends that have no light.
Lit lit_part(const Band& band) {
  Lit lit{band.low_m(), band.high_m()};
  const Curve& r = band.response;
  for (std::size_t i = 0; i + 1 < r.value.size() && r.value[i] == 0.0 && r.value[i + 1] == 0.0; ++i)
    lit.blue_m = r.wavelength_m[i + 1];
  for (std::size_t i = r.value.size(); i > 1 && r.value[i - 1] == 0.0 && r.value[i - 2] == 0.0; --i)
    lit.red_m = r.wavelength_m[i - 2];
  return lit;
}

/// Refraction of this air at another wavelength, held within what eraRefco takes.
Refraction refraction_at(const Refraction& air, double wavelength_m) {
  return Refraction(air.weather(), std::clamp(wavelength_m / um, 0.1, 100.0));
}

}  // namespace

ErrorBound Dispersion::error(int level, const PlanFacts& f) {
  const double cell_rad = cell_px[std::size_t(level)] * f.pixel_rad;
  return f.shifted_by(level == 0 ? f.dispersion_rad : 0.5 * std::min(cell_rad, f.dispersion_rad));
}

double Dispersion::cost_s(int level, const PlanFacts& f) {
  if (level == 0) return 0.0;
  return (2e-6 + 0.4e-6 * cells(level, f.dispersion_rad / f.pixel_rad)) * f.stars;
}

BandDispersion::BandDispersion(const Band& band, const Curve& extinction) {
  const Lit lit = lit_part(band);
  blue_m_ = lit.blue_m;
  red_m_ = lit.red_m;
  // Wavelengths every 2 nm, and at least twice between samples of the band.
  double step_m = 2 * nm;
  const std::vector<double> samples = knots(band);
  for (std::size_t i = 1; i < samples.size(); ++i)
    step_m = std::min(step_m, 0.5 * (samples[i] - samples[i - 1]));
  step_m = std::max(step_m, 0.1 * nm);
  const double blue = dry_air_refractivity(blue_m_), red = dry_air_refractivity(red_m_);
  struct Step {
    double wavelength_m, at, weight;  // the response times the step
    int cell;
  };
  std::vector<Step> steps;
  for (int cell = 0; cell < max_cells; ++cell) {
    const auto edge_m = [&](int edge) {
      return edge == 0 ? blue_m_
             : edge == max_cells
                 ? red_m_
                 : wavelength_of_dry_air_m(std::lerp(blue, red, double(edge) / max_cells));
    };
    const double low = edge_m(cell), high = edge_m(cell + 1);
    const int pieces = std::max(4, int(std::ceil((high - low) / step_m)));
    for (int k = 0; k < pieces; ++k) {
      const double x = low + (high - low) * (k + 0.5) / pieces;
      steps.push_back({x, std::clamp((blue - dry_air_refractivity(x)) / (blue - red), 0.0, 1.0),
                       band.response.at_or_zero(x) * (high - low) / pieces, cell});
    }
  }
  std::vector<double> k_mag(steps.size()), photons(steps.size());
  for (std::size_t s = 0; s < steps.size(); ++s)
    k_mag[s] = extinction.at_or_end(steps[s].wavelength_m);
  // A loss common to all wavelengths changes nothing: it is left out, so that some light remains at
  // the horizon.
  const double min_k = *std::min_element(k_mag.begin(), k_mag.end());
  std::vector<double> transmission(steps.size() * dispersion_airmasses);
  for (int a = 0; a < dispersion_airmasses; ++a)
    for (std::size_t s = 0; s < steps.size(); ++s)
      transmission[a * steps.size() + s] =
          light_of_magnitude((k_mag[s] - min_k) * dispersion_nodes.airmass(a));
  sums_.reserve(std::size_t(dispersion_colours * dispersion_airmasses * edges * 2));
  for (int c = 0; c < dispersion_colours; ++c) {
    const StarSpectrum star = star_spectrum(dispersion_nodes.bv(c));
    for (std::size_t s = 0; s < steps.size(); ++s)
      photons[s] = steps[s].weight * star.photons_at(steps[s].wavelength_m);
    for (int a = 0; a < dispersion_airmasses; ++a) {
      std::array<double, edges> light{}, moment{};
      for (std::size_t s = 0; s < steps.size(); ++s) {
        const double through = photons[s] * transmission[a * steps.size() + s];
        light[steps[s].cell + 1] += through;
        moment[steps[s].cell + 1] += through * steps[s].at;
      }
      for (int e = 1; e < edges; ++e) {
        light[e] += light[e - 1];
        moment[e] += moment[e - 1];
      }
      const double whole = light[edges - 1];
      for (int e = 0; e < edges; ++e) {
        sums_.push_back(light[e] / whole);
        sums_.push_back(moment[e] / whole);
      }
    }
  }
}

void BandDispersion::add_cells(double airmass, double bv, int count,
                               std::vector<SpectrumCell>& cells) const {
  const auto place = dispersion_nodes.place(airmass, bv);
  const auto sum = [&](int edge, int which) {
    return dispersion_nodes.between(place, [&](int colour, int node) {
      return sums_[std::size_t(((colour * dispersion_airmasses + node) * edges + edge) * 2 +
                               which)];
    });
  };
  double light = 0.0, moment = 0.0;
  for (int k = 1; k <= count; ++k) {
    const int edge = k * (max_cells / count);
    const double light_to = sum(edge, 0), moment_to = sum(edge, 1);
    const double share = light_to - light;
    if (share > 0.0) cells.push_back({std::clamp((moment_to - moment) / share, 0.0, 1.0), share});
    light = light_to;
    moment = moment_to;
  }
}

int Dispersion::cells(int level, double length_px) {
  int count = 1;
  while (count < BandDispersion::max_cells && length_px > count * cell_px[std::size_t(level)])
    count *= 2;
  return count;
}

Dispersion::Dispersion(const Band& band, const Curve& extinction, const Refraction& air,
                       bool is_refracted)
    : middle_(air), is_refracted_(is_refracted) {
  static KeptTables<std::pair<Band, Curve>, BandDispersion> tables;
  band_ = tables.of({band, extinction}, [&] { return BandDispersion(band, extinction); });
  blue_ = refraction_at(air, band_->blue_m());
  red_ = refraction_at(air, band_->red_m());
}

Dispersion::Ends Dispersion::ends(double elevation_rad, double distance_m) const {
  const double truly =
      is_refracted_ ? middle_.true_from_apparent_rad(elevation_rad, distance_m) : elevation_rad;
  const double middle = middle_.apparent_from_true_rad(truly, distance_m);
  return {blue_.apparent_from_true_rad(truly, distance_m) - middle,
          red_.apparent_from_true_rad(truly, distance_m) - middle};
}

double dispersion_rad(const Band& band, const Refraction& air, double elevation_rad) {
  const auto [blue_m, red_m] = lit_part(band);
  return refraction_at(air, blue_m).at_apparent_rad(elevation_rad) -
         refraction_at(air, red_m).at_apparent_rad(elevation_rad);
}

}  // namespace dmise
