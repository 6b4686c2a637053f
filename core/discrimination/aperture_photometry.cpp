#include "core/discrimination/aperture_photometry.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace dmise {
namespace {

/// Area within the circle of the rectangle from the origin to (x, y), both >= 0.
double corner_in_circle(double x, double y, double radius) {
  const double r2 = radius * radius;
  if (x * x + y * y <= r2) return x * y;
  // Below y up to where the circle falls to y, below the circle from there on.
  const double end = std::min(x, radius);
  const double flat = y >= radius ? 0.0 : std::sqrt(r2 - y * y);
  const auto under_circle = [&](double u) {
    return 0.5 * (u * std::sqrt(std::max(0.0, r2 - u * u)) +
                  r2 * std::asin(std::clamp(u / radius, -1.0, 1.0)));
  };
  return flat * y + under_circle(end) - under_circle(std::min(flat, end));
}

/// Area of a corner with signs: odd in x and in y.
double signed_corner(double x, double y, double radius) {
  const double area = corner_in_circle(std::abs(x), std::abs(y), radius);
  return (x < 0) == (y < 0) ? area : -area;
}

struct Ring {
  double mean = 0.0, sigma = 0.0;
  std::size_t pixels = 0;
};

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

Ring clipped(std::vector<double> values) {
  constexpr int max_rounds = 5;
  constexpr double clip_sigmas = 3.0;
  Ring ring;
  for (int round = 0;; ++round) {
    const std::size_t count = values.size();
    double sum = 0.0, square = 0.0;
    for (const double v : values) sum += v;
    ring.mean = sum / double(count);
    for (const double v : values) square += (v - ring.mean) * (v - ring.mean);
    ring.sigma = std::sqrt(square / double(count));
    ring.pixels = count;
    if (round == max_rounds) return ring;
    const double middle = median_of(values), reach = clip_sigmas * ring.sigma;
    std::erase_if(values, [&](double v) { return std::abs(v - middle) > reach; });
    if (values.size() == count || values.empty()) return ring;
  }
}

}  // namespace

void check(const Aperture& a) {
  const auto refuse = [](const char* key, const char* reason, double got) {
    throw Error(std::string("aperture: ") + key + ": " + reason + ", got " + std::to_string(got));
  };
  if (!(a.radius_px >= 0.5)) refuse("radius_px", "must be at least 0.5", a.radius_px);
  if (!(a.inner_px >= a.radius_px))
    refuse("inner_px", "must be at least the radius of the aperture", a.inner_px);
  if (!(a.outer_px >= a.inner_px + 1.0))
    refuse("outer_px", "must be at least 1 px more than inner_px", a.outer_px);
  if (!(a.outer_px <= 500.0)) refuse("outer_px", "must be at most 500", a.outer_px);
}

double pixel_in_circle(double x, double y, double radius) {
  const double nearest =
      std::hypot(std::max(0.0, std::abs(x) - 0.5), std::max(0.0, std::abs(y) - 0.5));
  if (nearest >= radius) return 0.0;
  if (std::hypot(std::abs(x) + 0.5, std::abs(y) + 0.5) <= radius) return 1.0;
  const double area =
      signed_corner(x + 0.5, y + 0.5, radius) - signed_corner(x - 0.5, y + 0.5, radius) -
      signed_corner(x + 0.5, y - 0.5, radius) + signed_corner(x - 0.5, y - 0.5, radius);
  return std::clamp(area, 0.0, 1.0);
}

ApertureFlux aperture_flux(const CountImage& counts, const CountScale& scale, PixelPosition centre,
                           const Aperture& aperture) {
  check(aperture);
  const double reach = aperture.outer_px;
  if (!(centre.x_px - reach >= 0.0 && centre.y_px - reach >= 0.0 &&
        centre.x_px + reach <= counts.columns - 1.0 && centre.y_px + reach <= counts.rows - 1.0))
    throw Error("aperture: the ring about (" + std::to_string(centre.x_px) + ", " +
                std::to_string(centre.y_px) + ") is not wholly in the frame");
  ApertureFlux result;
  double sum_e = 0.0, squares = 0.0;  // weighted light; squares of the weights
  std::vector<double> ring;
  for (int y = int(std::floor(centre.y_px - reach)); y <= int(std::ceil(centre.y_px + reach)); ++y)
    for (int x = int(std::floor(centre.x_px - reach)); x <= int(std::ceil(centre.x_px + reach));
         ++x) {
      if (x < 0 || y < 0 || x >= counts.columns || y >= counts.rows) continue;
      const double dx = x - centre.x_px, dy = y - centre.y_px, away = std::hypot(dx, dy);
      const double electrons = (counts.at(x, y) - scale.bias_dn) * scale.gain_e_per_dn;
      if (away >= aperture.inner_px && away <= aperture.outer_px) ring.push_back(electrons);
      const double weight = pixel_in_circle(dx, dy, aperture.radius_px);
      if (weight <= 0.0) continue;
      sum_e += weight * electrons;
      squares += weight * weight;
      result.area_px += weight;
      result.saturated = result.saturated || counts.at(x, y) >= scale.saturation_dn;
    }
  const Ring background = clipped(std::move(ring));
  result.background_e = background.mean;
  result.background_sigma_e = background.sigma;
  result.ring_pixels = background.pixels;
  result.flux_e = sum_e - result.area_px * background.mean;
  const double variance = background.sigma * background.sigma;
  result.sigma_e =
      std::sqrt(variance * (squares + result.area_px * result.area_px / double(background.pixels)) +
                std::max(0.0, result.flux_e));
  return result;
}

}  // namespace dmise
