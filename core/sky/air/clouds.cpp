#include "core/sky/air/clouds.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/numeric/quantile.h"
#include "core/base/units.h"
#include "core/sky/air/airmass.h"

namespace dmise {
namespace {

/// Well mixed 64 bits of a lattice point (the finaliser of SplitMix64: Steele, Lea & Flood 2014).
std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// Uniform in [0, 1) at a lattice point.
double lattice(std::uint64_t seed, std::int64_t i, std::int64_t j) {
  const std::uint64_t key = mix(seed + 0x9e3779b97f4a7c15ULL * std::uint64_t(i));
  return double(mix(key + 0x9e3779b97f4a7c15ULL * std::uint64_t(j)) >> 11) * 0x1p-53;
}

double smooth(double t) { return t * t * t * (t * (6 * t - 15) + 10); }

/// Values at lattice points joined smoothly (second derivatives are continuous).
double noise(std::uint64_t seed, double x, double y) {
  const double fx = std::floor(x), fy = std::floor(y);
  const auto i = std::int64_t(fx), j = std::int64_t(fy);
  const double u = smooth(x - fx), v = smooth(y - fy);
  const double low = lattice(seed, i, j) + u * (lattice(seed, i + 1, j) - lattice(seed, i, j));
  const double high =
      lattice(seed, i, j + 1) + u * (lattice(seed, i + 1, j + 1) - lattice(seed, i, j + 1));
  return low + v * (high - low);
}

/// Five octaves of noise, each half as large and half as strong.
double pattern(std::uint64_t seed, double x, double y) {
  double sum = 0.0, strength = 0.5;
  for (std::uint64_t octave = 0; octave < 5; ++octave) {
    sum += strength * noise(seed + octave * 0x632be59bd9b4e019ULL, x, y);
    x *= 2, y *= 2, strength *= 0.5;
  }
  return sum;
}

/// Half the width over which a cloud thickens, in units of the pattern.
constexpr double edge = 0.06;

void check_share(double value, const char* what) {
  if (!(value >= 0 && value <= 1))
    throw Error(std::string("clouds: ") + what + " must be in [0, 1], got " +
                std::to_string(value));
}

}  // namespace

CloudMap::CloudMap(const Clouds& clouds) : clouds_(clouds) {
  if (const auto* veil = std::get_if<UniformCloud>(&clouds)) {
    check_share(veil->transmission, "transmission");
    return;
  }
  const auto& patches = std::get<PatchyClouds>(clouds);
  check_share(patches.cover, "cover");
  check_share(patches.transmission, "transmission");
  if (!(patches.patch_m > 0)) throw Error("clouds: patch size must be > 0");
  if (!(patches.height_m > 0)) throw Error("clouds: height must be > 0");
  // The level that the share `cover` of the pattern exceeds, from a piece of 40 x 40 patches.
  constexpr int side = 120;
  std::vector<double> levels;
  levels.reserve(side * side);
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      levels.push_back(pattern(patches.seed, i / 3.0 - 20 + 0.17, j / 3.0 - 20 + 0.17));
  threshold_ = quantile_of(std::move(levels), 1.0 - patches.cover);
  // Wholly clear or covered, edges included.
  if (patches.cover == 0) threshold_ = 1.0 + edge;
  if (patches.cover == 1) threshold_ = -edge;
}

double CloudMap::transmission(const Vec<Enu>& direction, double time_s) const {
  const double sin_altitude = std::clamp(direction.z, std::sin(1 * deg), 1.0);
  const double path = scattering_airmass(sin_altitude);
  if (const auto* veil = std::get_if<UniformCloud>(&clouds_))
    return std::pow(veil->transmission, path);
  const auto& patches = std::get<PatchyClouds>(clouds_);
  const double reach_m = patches.height_m / sin_altitude;
  const double x = (direction.x * reach_m - patches.wind_east_m_per_s * time_s) / patches.patch_m;
  const double y = (direction.y * reach_m - patches.wind_north_m_per_s * time_s) / patches.patch_m;
  const double t = (pattern(patches.seed, x, y) - threshold_ + edge) / (2 * edge);
  const double thickness = smooth(std::clamp(t, 0.0, 1.0));
  const double cloud = std::pow(patches.transmission, path);
  return 1.0 - thickness * (1.0 - cloud);
}

}  // namespace dmise
