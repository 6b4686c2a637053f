#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "core/image/charts/chart.h"

namespace dmise {

/// A measured light curve and what a smooth model gives, at 1000 km.
struct PassLightCurve {
  std::vector<double> time_s, measured_mag, smooth_mag;
  /// Magnitude that the model's small parts add at each time, for objects of a seed.
  std::function<std::vector<double>(std::uint64_t seed)> glints_mag;
};

/// Power of light curves in a range of periods [mag2]: the variance that it has.
struct CurveBand {
  double shortest_s = 0.0, longest_s = 0.0;
  std::size_t tracks = 0;  // that are long enough
  double measured_mean = 0.0, measured_median = 0.0, model_mean = 0.0, model_median = 0.0;
};

struct CurvePower {
  std::vector<CurveBand> bands;  // octaves of periods; the last is of all, to a track's length
  double white_mag = 0.0;        // standard deviation of the noise of a point, the median
  struct Density {
    double period_s, measured, model, smooth;  // mag2 / Hz, means over tracks
  };
  std::vector<Density> densities;
};

inline constexpr int glint_seeds = 16;
inline constexpr double power_target = 2.0;  // a factor either way

/// Compares the power of light curves of 10 Hz about their straight line over the longest run
/// without a gap of a second. The white level above 1 Hz, of photons and of scintillation, is
/// subtracted from the measured power; the model gets noise of this level, and it is subtracted
/// again. Tracks shorter than 16 s are left out. The model's power is of `glint_seeds` seeds.
CurvePower curve_power(std::span<const PassLightCurve> curves);

Chart power_chart(const CurvePower& power, const std::string& title);

}  // namespace dmise
