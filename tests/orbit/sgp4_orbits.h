#pragma once
#include <cmath>
#include <random>
#include <vector>

#include "core/base/units.h"
#include "core/orbit/sgp4/sgp4_batch.h"

namespace dmise::test {

/// Elements of an orbit at `epoch`; the angles that are not given are those of the reference
/// scripts.
inline MeanElements elements_with(double e, double inclination_deg, double rev_per_day,
                                  double bstar) {
  MeanElements el;
  el.epoch_jd1 = 2433281.5 + 25000.0;
  el.epoch_jd2 = 0.75;
  el.eccentricity = e;
  el.inclination_rad = inclination_deg * deg;
  el.mean_motion_rad_per_min = rev_per_day * 2.0 * pi / 1440.0;
  el.bstar_per_earth_radius = bstar;
  el.argument_of_perigee_rad = 40.0 * deg;
  el.mean_anomaly_rad = 25.0 * deg;
  el.raan_rad = 310.0 * deg;
  return el;
}

struct Outputs {
  std::vector<double> position, velocity;
  std::vector<std::uint8_t> code;
  explicit Outputs(std::size_t n) : position(3 * n), velocity(3 * n), code(n) {}
  bool operator==(const Outputs&) const = default;
};

inline Outputs at(const Sgp4Batch& batch, double jd1, double jd2, Threads* threads = nullptr) {
  Outputs out(batch.size());
  batch.propagate(jd1, jd2, out.position, out.velocity, out.code, threads);
  return out;
}

/// Every class of orbit, eccentricity and inclination, some decaying; the same each time.
inline std::vector<MeanElements> mixture(std::size_t count) {
  std::mt19937_64 rng(1);
  const auto uniform = [&rng](double a, double b) {
    return a + (b - a) * double(rng() >> 11) * 0x1p-53;
  };
  std::vector<MeanElements> all;
  for (std::size_t k = 0; k < count; ++k) {
    const double n[] = {15.4, 14.2, 1.0027, 2.006, 1.6, 4.0};
    const double e[] = {0.0012, 0.021, 0.0003, 0.71, 0.1, 0.4};
    MeanElements el = elements_with(e[k % 6] * uniform(0.9, 1.1), uniform(0, 179),
                                    n[k % 6] * uniform(0.995, 1.005), k % 12 == 0 ? 0.01 : 1e-5);
    if (k % 4 == 2) el.inclination_rad = uniform(0, 14) * deg;
    el.epoch_jd2 = uniform(0, 1);
    el.epoch_jd1 -= std::floor(uniform(0, 30));
    el.raan_rad = uniform(0, 2 * pi);
    el.argument_of_perigee_rad = uniform(0, 2 * pi);
    el.mean_anomaly_rad = uniform(0, 2 * pi);
    all.push_back(el);
  }
  return all;
}

constexpr double epoch_jd1 = 2458281.5;

}  // namespace dmise::test
