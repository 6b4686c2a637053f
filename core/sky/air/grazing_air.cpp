#include "core/sky/air/grazing_air.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/units.h"
#include "core/photometry/spectrum.h"
#include "core/sky/air/standard_air.h"

namespace dmise {
namespace {

constexpr double earth_radius_m = 6371e3;

// Heights of the table: every 250 m to 40 km, every 1 km to 110 km.
constexpr int fine_heights = 160, coarse_heights = 70, heights = fine_heights + coarse_heights + 1;
constexpr double height_of_node(int i) {
  return i <= fine_heights ? 250.0 * i : 40e3 + 1e3 * (i - fine_heights);
}
int node_of_height(double height_m) {
  const double at = height_m < 40e3 ? height_m / 250.0 : fine_heights + (height_m - 40e3) / 1e3;
  return std::clamp(int(std::lround(at)), 0, heights - 1);
}

double density_slope(double height_m) {
  constexpr double step_m = 50.0;
  return (relative_density(height_m + step_m) - relative_density(height_m - step_m)) / (2 * step_m);
}

// 2/3 b^3 - ... = b - sin b cos b, without cancellation.
double segment(double b) {
  if (b > 0.05) return b - std::sin(b) * std::cos(b);
  const double bb = b * b;
  return b * bb * (2.0 / 3 - bb * (2.0 / 15 - bb * (4.0 / 315)));
}

}  // namespace

double visible_fraction(const LowSun& sun) {
  const auto [s, above, k] = sun;
  if (above >= s) return 1.0;
  const double centres = 1.0 + above * k;  // distance of the two centres, times k
  if (s * k <= 1.0 && above <= -s) return 0.0;
  if (s * k > 1.0 && centres <= s * k - 1.0) return 1.0 - 1.0 / (s * s * k * k);

  // Half angles of the chord where the circles cross, seen from the disc's and the limb's centre.
  const double cos_a = (2 * above + (above * above + s * s) * k) / (2 * s * centres);
  const double a = std::acos(std::clamp(cos_a, -1.0, 1.0));
  const double sin_b = s * k * std::sin(a);
  const double cos_b = (centres * centres + 1.0 - s * s * k * k) / (2 * centres);
  const double b = std::atan2(sin_b, cos_b);
  const double of_disc = a - std::sin(a) * std::cos(a);
  const double of_limb = b > 0.0 ? segment(b) / (s * s * k * k) : 0.0;
  return std::clamp(1.0 - (of_disc + of_limb) / pi, 0.0, 1.0);
}

GrazingAir::GrazingAir(const Band& band) {
  constexpr int wavelengths = 64;
  std::array<double, wavelengths> x_m, light;
  double whole = 0.0, refractivity = 0.0, alpha = 0.0;
  for (int i = 0; i < wavelengths; ++i) {
    x_m[i] = std::lerp(band.low_m(), band.high_m(), (i + 0.5) / wavelengths);
    light[i] = band.response.at_or_zero(x_m[i]) * sunlight_spectrum().irradiance.at_or_end(x_m[i]) *
               x_m[i];
    whole += light[i];
    refractivity += light[i] * refractivity_at_sea(x_m[i]);
    alpha += light[i] * std::max(0.0, -0.023 + 0.292 * um / x_m[i]);
  }
  refractivity /= whole;
  alpha /= whole;
  divide_disc(alpha);

  // Air over the sea, and along rays.
  constexpr double sea_step_m = 100.0;
  double column_m = 0.0;
  for (double z = 0.5 * sea_step_m; z < 120e3; z += sea_step_m)
    column_m += sea_step_m * relative_density(z);
  for (int node = 0; node < heights; ++node) {
    const double height_m = height_of_node(node);
    const double slope = refractivity * density_slope(height_m);
    // The ray bends downwards: it rises like a straight one over a larger Earth.
    const double rises = std::max(0.2, 1.0 + slope * earth_radius_m) / (2 * earth_radius_m);
    constexpr double step_m = 5e3, farthest_m = 1.3e6;
    double turns = 0.0, air_m = 0.0, ozone = 0.0;
    for (double s = 0.5 * step_m; s < farthest_m; s += step_m) {
      const double z = height_m + s * s * rises;
      turns -= 2 * step_m * refractivity * density_slope(z);
      air_m += 2 * step_m * relative_density(z);
      ozone += 2 * step_m * ozone_density(z);
    }
    bending_rad_.push_back(turns);
    double left = 0.0;
    for (int i = 0; i < wavelengths; ++i)
      left += light[i] * std::exp(-rayleigh_depth(x_m[i]) * air_m / column_m -
                                  ozone_absorption(x_m[i]) * ozone);
    transmission_.push_back(left / whole);
  }
}

void GrazingAir::divide_disc(double alpha) {
  // Gauss-Chebyshev quadrature: chords of the disc along the limb and places on them, at the
  // cosines of equidistant angles.
  constexpr int chords = 96, places = 4;
  double whole = 0.0;
  for (int i = 0; i < chords; ++i) {
    const double chord = pi * (i + 0.5) / chords, half = std::sin(chord);
    for (int j = 0; j < places; ++j) {
      const double at = 0.5 * pi * (j + 0.5) / places;
      const double share = half * half * std::sin(at) * std::pow(half * std::sin(at), alpha);
      disc_.push_back({std::cos(chord), half * std::cos(at), share});
      whole += share;
    }
  }
  for (Place& place : disc_) place.share /= whole;
  // The brightness is that of uniform discs: the part above I has the radius sqrt(1 - I^(2 /
  // alpha)).
  constexpr int levels = 32;
  whole = 0.0;
  for (int i = 0; i < levels; ++i) {
    const double area = alpha > 1e-6 ? 1.0 - std::pow((i + 0.5) / levels, 2.0 / alpha) : 1.0;
    uniform_discs_.push_back({std::sqrt(area), area});
    whole += area;
  }
  for (auto& disc : uniform_discs_) disc[1] /= whole;
}

double GrazingAir::bending_rad(double height_m) const {
  return bending_rad_[std::size_t(node_of_height(height_m))];
}

double GrazingAir::transmission(double height_m) const {
  return transmission_[std::size_t(node_of_height(height_m))];
}

double GrazingAir::light_past_sharp_limb(const LowSun& sun) const {
  if (sun.above_rad >= sun.radius_rad) return 1.0;
  double light = 0.0;
  for (const auto& [radius, share] : uniform_discs_) {
    LowSun disc = sun;
    disc.radius_rad *= radius;
    light += share * visible_fraction(disc);
  }
  return std::clamp(light, 0.0, 1.0);
}

double GrazingAir::light(const LowSun& sun, double distance_m, double radius_m) const {
  // Where a ray of each height is seen over the limb: it leaves the air so that r sin(angle from
  // the nadir + bending) is the distance of its line from the centre, and light is dimmed as rays
  // are farther apart behind the air than before it.
  std::array<double, heights> seen_rad, gain;
  const double limb_rad = std::asin(std::min(1.0, radius_m / distance_m));
  int nodes = 0;
  for (; nodes < heights && radius_m + height_of_node(nodes) < distance_m; ++nodes)
    seen_rad[nodes] = std::asin((radius_m + height_of_node(nodes)) / distance_m) -
                      bending_rad_[std::size_t(nodes)] - limb_rad;
  if (nodes < 3) return light_past_sharp_limb(sun);
  for (int i = 0; i < nodes; ++i) {
    const int below = std::max(0, i - 1), next = std::min(nodes - 1, i + 1);
    const double apart_m = height_of_node(next) - height_of_node(below);
    const auto line_m = [&](int node) { return distance_m * std::sin(limb_rad + seen_rad[node]); };
    gain[i] = transmission_[std::size_t(i)] *
              std::min(1.0, (radius_m + height_of_node(i)) * apart_m /
                                (line_m(i) * std::max(line_m(next) - line_m(below), 1e-9)));
  }
  if (!(gain[nodes - 1] > 0.0)) return 0.0;
  const auto light_at = [&](double angle_rad) {
    if (angle_rad >= seen_rad[nodes - 1]) return 1.0;
    if (angle_rad < seen_rad[0]) return 0.0;
    const auto* above = std::upper_bound(seen_rad.data(), seen_rad.data() + nodes, angle_rad);
    const auto i = std::size_t(above - seen_rad.data());
    const double t = (angle_rad - seen_rad[i - 1]) / (seen_rad[i] - seen_rad[i - 1]);
    return std::lerp(gain[i - 1], gain[i], t);
  };
  const auto [s, above, k] = sun;
  if (above - s >= seen_rad[nodes - 1]) return 1.0;
  double light = 0.0;
  for (const auto& [up, aside, share] : disc_) {
    const double over = above + s * up, across = s * aside;
    const double angle = (2 * over + k * (across * across + over * over)) /
                         (1 + std::hypot(k * across, 1 + k * over));
    light += share * light_at(angle);
  }
  return std::clamp(light, 0.0, 1.0);
}

}  // namespace dmise
