#include "core/sky/air_shells.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/sky/air/haze.h"
#include "core/sky/air/standard_air.h"
#include "core/sky/air/sunlit_air.h"

namespace dmise {

AirShells::AirShells(double ground_m) {
  constexpr int shells = 40;
  const auto density = [&](double over_ground_m) {
    return AirAmounts{relative_density(ground_m + over_ground_m),
                      std::exp(-over_ground_m / haze_scale_height_m) / haze_scale_height_m,
                      ozone_density(ground_m + over_ground_m)};
  };
  double column_m = 0.0;  // height of all molecules, at the density at the sea
  for (int i = 0; i <= shells; ++i) {
    const auto height_m = [](double level) { return top_m * level * level / (shells * shells); };
    radius_m_.push_back(AirColumns::earth_radius_m + ground_m + height_m(i));
    at_level_.push_back(density(height_m(i)));
    if (i == shells) break;
    const double low_m = height_m(i), high_m = height_m(i + 1);
    AirAmounts mean;  // by Simpson's rule
    mean.add(1.0 / 6.0, at_level_.back());
    mean.add(4.0 / 6.0, density(0.5 * (low_m + high_m)));
    mean.add(1.0 / 6.0, density(high_m));
    column_m += (high_m - low_m) * mean.molecules;
    in_shell_.push_back(mean);
  }
  for (auto* densities : {&at_level_, &in_shell_})
    for (AirAmounts& d : *densities) d.molecules /= column_m;
}

AirAmounts AirShells::towards(double radius_m, double sin_altitude) const {
  const double passes_m2 = radius_m * radius_m * (1.0 - sin_altitude * sin_altitude);
  const auto from_lowest_m = [&](double r) { return std::sqrt(std::max(0.0, r * r - passes_m2)); };
  const double here_m = std::abs(radius_m * sin_altitude);
  const double below = sin_altitude < 0.0 ? 2.0 : 0.0;  // times the line passes air under the place
  AirAmounts sum;
  double low_m = from_lowest_m(radius_m_[0]);
  for (std::size_t i = 0; i + 1 < radius_m_.size(); ++i) {
    const double high_m = from_lowest_m(radius_m_[i + 1]);
    const bool is_below = radius_m_[i + 1] <= radius_m, is_above = radius_m_[i] >= radius_m;
    if (is_above)
      sum.add(high_m - low_m, in_shell_[i]);
    else if (is_below)
      sum.add(below * (high_m - low_m), in_shell_[i]);
    else
      sum.add(high_m - here_m + below * (here_m - low_m), in_shell_[i]);
    low_m = high_m;
  }
  return sum;
}

double AirShells::sunlit_share(double radius_m, double sin_sun_altitude) const {
  constexpr double sun_radius_rad = 0.004652;
  const double dip_rad = std::acos(std::min(1.0, radius_m_[0] / radius_m));
  const double over_horizon_rad = std::asin(std::clamp(sin_sun_altitude, -1.0, 1.0)) + dip_rad;
  return std::clamp(0.5 + 0.5 * over_horizon_rad / sun_radius_rad, 0.0, 1.0);
}

LineThroughShells::LineThroughShells(const AirShells& shells, double sine) : sin_altitude(sine) {
  const double ground_m = shells.radius_m(0), start_m = ground_m * sine;
  const double passes_m2 = ground_m * ground_m * (1.0 - sine * sine);
  AirAmounts before;
  double low_m = 0.0;
  for (std::size_t i = 0; i + 1 < shells.levels(); ++i) {
    const double r = shells.radius_m(i + 1);
    const double high_m = std::sqrt(r * r - passes_m2) - start_m;
    const double middle_m = 0.5 * (low_m + high_m), from_lowest_m = start_m + middle_m;
    AirAmounts to_middle = before;
    to_middle.add(middle_m - low_m, shells.in_shell(i));
    pieces.push_back({high_m - low_m, middle_m,
                      std::sqrt(passes_m2 + from_lowest_m * from_lowest_m), to_middle});
    before.add(high_m - low_m, shells.in_shell(i));
    low_m = high_m;
  }
}

}  // namespace dmise
