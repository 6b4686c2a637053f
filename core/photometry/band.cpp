#include "core/photometry/band.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

struct Sample {
  double wavelength_nm, value;
};
#include "core/photometry/filter_tables.inc"

struct Filter {
  std::string_view name;
  std::span<const Sample> samples;
};
constexpr Filter filters[] = {
    {"bessell-U", bessell_u}, {"bessell-B", bessell_b}, {"bessell-V", bessell_v},
    {"bessell-R", bessell_r}, {"bessell-I", bessell_i}, {"sdss-u", sdss_u},
    {"sdss-g", sdss_g},       {"sdss-r", sdss_r},       {"sdss-i", sdss_i},
    {"sdss-z", sdss_z},
};

}  // namespace

std::optional<Band> filter_named(std::string_view name) {
  for (const Filter& filter : filters) {
    if (filter.name != name) continue;
    Curve curve;
    for (const Sample& sample : filter.samples) {
      curve.add(sample.wavelength_nm * nm, sample.value);
    }
    return band_of(std::string(name), std::move(curve));
  }
  return std::nullopt;
}

std::vector<std::string> filter_names() {
  std::vector<std::string> names;
  for (const Filter& filter : filters) names.emplace_back(filter.name);
  return names;
}

Band band_of(std::string name, Curve response) {
  check_curve(response, ("band " + name).c_str());
  double area = 0.0, moment = 0.0;
  for (std::size_t i = 1; i < response.value.size(); ++i) {
    const double a = response.wavelength_m[i - 1], b = response.wavelength_m[i];
    const double ya = response.value[i - 1], yb = response.value[i];
    area += (b - a) * (ya + yb) / 2;
    moment += (b - a) * (ya * (2 * a + b) + yb * (a + 2 * b)) / 6;
  }
  if (!(area > 0)) throw Error("band " + name + ": transmits no light");
  Band band{std::move(name), moment / area, 0.0, std::move(response)};
  band.width_m = area / *std::max_element(band.response.value.begin(), band.response.value.end());
  check_band(band);
  return band;
}

std::vector<double> knots(const Band& band) {
  if (band.response.empty()) return {band.low_m(), band.high_m()};
  return band.response.wavelength_m;
}

std::vector<double> knots(const Band& band, const Curve& curve) {
  std::vector<double> at = knots(band);
  for (const double x : curve.wavelength_m)
    if (x > band.low_m() && x < band.high_m()) at.push_back(x);
  std::sort(at.begin(), at.end());
  at.erase(std::unique(at.begin(), at.end()), at.end());
  return at;
}

Band through(const Band& band, const Curve& transmission) {
  if (transmission.empty()) return band;
  const std::vector<double> at = knots(band, transmission);
  constexpr double step_m = 2 * nm;
  Curve product;
  const auto add = [&](double x) {
    product.add(x, band.response.at_or_zero(x) * transmission.at_or_end(x));
  };
  add(at[0]);
  for (std::size_t i = 1; i < at.size(); ++i) {
    const int pieces = std::max(1, int(std::ceil((at[i] - at[i - 1]) / step_m - 1e-9)));
    for (int k = 1; k < pieces; ++k) add(at[i - 1] + (at[i] - at[i - 1]) * k / pieces);
    add(at[i]);
  }
  return band_of(band.name, std::move(product));
}

void check_band(const Band& band) {
  const auto fail = [&](const char* why) { throw Error("band " + band.name + ": " + why); };
  if (!(band.width_m > 0) || !std::isfinite(band.width_m)) fail("width must be > 0");
  if (!(band.low_m() > 0) || !std::isfinite(band.high_m())) fail("must lie at wavelengths > 0");
  for (const double y : band.response.value)
    if (!(y <= 1)) fail("response must be <= 1");
}

}  // namespace dmise
