#include "core/orbit/sgp4/synthetic_catalogue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/base/numeric/rng.h"
#include "core/base/units.h"
#include "core/orbit/elements/record.h"
#include "core/orbit/sgp4/sgp4_terms.h"

namespace dmise {

namespace {

using sgp4::earth_radius_km;

enum class Shape { near_circular, debris, sun_synchronous, transfer, molniya, geostationary };

/// One kind of object. Perigee heights are uniform in their range, inclinations normal.
struct Family {
  const char* name;
  double share;
  Shape shape;
  double lowest_km, highest_km;
  double inclination_deg, inclination_sigma_deg;
};

constexpr std::array families = {
    Family{"SHELL A", 0.20, Shape::near_circular, 547, 553, 53.05, 0.01},
    Family{"SHELL B", 0.10, Shape::near_circular, 538, 542, 53.22, 0.01},
    Family{"SHELL C", 0.03, Shape::near_circular, 569, 572, 70.0, 0.01},
    Family{"SHELL D", 0.03, Shape::near_circular, 558, 562, 97.65, 0.01},
    Family{"SHELL E", 0.03, Shape::near_circular, 1195, 1205, 87.9, 0.01},
    Family{"SSO", 0.07, Shape::sun_synchronous, 450, 850, 0, 0.1},
    Family{"LEO 83", 0.05, Shape::near_circular, 750, 1000, 82.95, 0.2},
    Family{"LEO 74", 0.04, Shape::near_circular, 750, 1500, 74.05, 0.1},
    Family{"LEO 65", 0.02, Shape::near_circular, 600, 1000, 65.0, 0.3},
    Family{"DEBRIS SSO", 0.13, Shape::debris, 650, 870, 98.6, 0.8},
    Family{"DEBRIS 79", 0.13, Shape::debris, 600, 1000, 79.0, 4.0},
    Family{"DEBRIS 65", 0.04, Shape::debris, 500, 950, 65.3, 1.0},
    Family{"NAV 55", 0.015, Shape::near_circular, 20100, 20300, 55.2, 1.0},
    Family{"NAV 65", 0.01, Shape::near_circular, 19110, 19150, 64.9, 0.6},
    Family{"GEO", 0.035, Shape::geostationary, 0, 0, 0, 0},
    Family{"GRAVEYARD", 0.02, Shape::geostationary, 200, 500, 0, 0},
    Family{"MOLNIYA", 0.01, Shape::molniya, 0, 0, 63.4, 1.0},
    Family{"TRANSFER", 0.04, Shape::transfer, 200, 700, 0, 0},
};

/// Random numbers of one object, in the order of use.
class Draws {
 public:
  Draws(const RngKey& key, std::uint32_t object) : key_(key), object_(object) {}
  double uniform() { return uniform_of(rng_word(key_, object_, draw_++)); }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double normal(double mean, double sigma) {
    return mean + sigma * static_cast<double>(normal_of(rng_word(key_, object_, draw_++)));
  }
  double exponential(double mean) { return -mean * std::log(uniform()); }

 private:
  const RngKey& key_;
  std::uint32_t object_;
  std::uint32_t draw_ = 0;
};

double rounded_to(double value, double steps_per_unit) {
  return std::round(value * steps_per_unit) / steps_per_unit;
}

double mean_motion_rev_per_day(double semi_major_axis_km) {
  const double a = semi_major_axis_km;
  return day_s / (2 * pi) * std::sqrt(sgp4::mu_km3_per_s2 / (a * a * a));
}

void set_heights(double perigee_km, double apogee_km, PublishedOrbit& orbit) {
  const double a_km = earth_radius_km + (perigee_km + apogee_km) / 2;
  orbit.mean_motion_rev_per_day = mean_motion_rev_per_day(a_km);
  orbit.eccentricity = (apogee_km - perigee_km) / (2 * a_km);
}

PublishedOrbit orbit_of(const Family& family, Draws& draws) {
  PublishedOrbit orbit;
  const double perigee_km = draws.uniform(family.lowest_km, family.highest_km);
  orbit.inclination_deg = draws.normal(family.inclination_deg, family.inclination_sigma_deg);
  orbit.argument_of_perigee_deg = draws.uniform(0, 360);
  switch (family.shape) {
    case Shape::near_circular:
      set_heights(perigee_km, perigee_km + draws.exponential(perigee_km > 10000 ? 100 : 3), orbit);
      break;
    case Shape::debris:
      set_heights(perigee_km, perigee_km + std::min(draws.exponential(180), 4000.0), orbit);
      break;
    case Shape::sun_synchronous: {
      set_heights(perigee_km, perigee_km + draws.exponential(8), orbit);
      // The node is Sun-synchronous if cos i = -(a / 12352 km)^3.5.
      const double cosine = -std::pow((earth_radius_km + perigee_km) / 12352.0, 3.5);
      orbit.inclination_deg += std::acos(cosine) / deg;
      break;
    }
    case Shape::transfer:
      set_heights(perigee_km, std::clamp(draws.normal(35000, 2500), 15000.0, 42000.0), orbit);
      orbit.inclination_deg = draws.uniform(2, 30);
      break;
    case Shape::molniya:
      orbit.mean_motion_rev_per_day = draws.normal(2.006, 0.002);
      orbit.eccentricity = draws.uniform(0.68, 0.74);
      orbit.argument_of_perigee_deg = draws.normal(270, 8);
      break;
    case Shape::geostationary:
      orbit.mean_motion_rev_per_day = family.highest_km > 0
                                          ? mean_motion_rev_per_day(42164.2 + perigee_km)
                                          : draws.normal(1.00272, 1e-4);
      orbit.eccentricity = std::min(draws.exponential(3e-4), 0.02);
      orbit.inclination_deg = draws.uniform() < 0.4 ? draws.uniform(0, 0.1) : draws.uniform(0, 15);
      break;
  }
  orbit.raan_deg = draws.uniform(0, 360);
  orbit.mean_anomaly_deg = draws.uniform(0, 360);
  orbit.mean_motion_rev_per_day = rounded_to(orbit.mean_motion_rev_per_day, 1e8);
  orbit.eccentricity = rounded_to(orbit.eccentricity, 1e7);
  for (double* angle_deg : {&orbit.inclination_deg, &orbit.raan_deg, &orbit.argument_of_perigee_deg,
                            &orbit.mean_anomaly_deg})
    *angle_deg = rounded_to(*angle_deg, 1e4);
  return orbit;
}

/// Log-normal, falling with height; five digits, as a TLE has.
double drag_term(const PublishedOrbit& orbit, Draws& draws) {
  const double spread = draws.normal(0, 1.0);
  if (orbit.mean_motion_rev_per_day < 6.4) return 0.0;
  const double value = 2e-4 * std::exp(spread);
  const double power = std::floor(std::log10(value)) + 1;
  return std::round(value * std::pow(10.0, 5 - power)) / 1e5 * std::pow(10.0, power);
}

const Family& family_at(double share) {
  for (const Family& family : families) {
    if (share < family.share) return family;
    share -= family.share;
  }
  return families.front();
}

}  // namespace

std::vector<MeanElements> synthetic_catalogue(const SyntheticCatalogueOptions& options) {
  constexpr std::size_t most = 1'000'000;
  if (options.objects > most || options.first > most - options.objects)
    throw Error("synthetic catalogue: at most 1000000 objects, got " +
                std::to_string(options.objects) + " from number " + std::to_string(options.first));
  const RngKey key = rng_key(options.seed, "catalogue", 0, "synthetic");
  std::vector<MeanElements> catalogue(options.objects);
  for (std::size_t k = 0; k < options.objects; ++k) {
    const std::size_t i = options.first + k;
    Draws draws(key, static_cast<std::uint32_t>(i));
    const Family& family = family_at(draws.uniform());
    MeanElements& e = catalogue[k];
    e.catalogue_number = static_cast<std::uint32_t>(i + 1);
    e.name = family.name;
    const double age_days = draws.uniform(0, 3);
    const double days = options.newest_epoch.jd2 - age_days;
    e.epoch_jd1 = options.newest_epoch.jd1 + std::floor(days);
    e.epoch_jd2 = std::min(rounded_to(days - std::floor(days), 1e8), 0.99999999);
    const PublishedOrbit orbit = orbit_of(family, draws);
    set_orbit(orbit, e);
    e.bstar_per_earth_radius = drag_term(orbit, draws);
    e.element_number = 999;
    e.revolution = static_cast<int>(draws.uniform(0, 99999));
  }
  return catalogue;
}

}  // namespace dmise
