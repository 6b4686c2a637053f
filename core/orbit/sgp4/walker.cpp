#include "core/orbit/sgp4/walker.h"

#include <cmath>

#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/orbit/sgp4/sgp4_terms.h"

namespace dmise {
namespace {

double turn_of(double angle_rad) {
  const double turn = std::fmod(angle_rad, 2 * pi);
  return turn < 0.0 ? turn + 2 * pi : turn;
}

int digits_of(int count) { return int(std::to_string(count).size()); }

/// How fast the mean argument of latitude grows in SGP4.
double latitude_rate_rad_per_s(const MeanElements& elements) {
  const auto model = sgp4::initialise(elements);
  const auto& secular = model.deep ? model.far.secular : model.near.secular;
  return (secular.m_dot + secular.argp_dot) / 60.0;
}

std::string name_of(const Walker& w, int plane, int place) {
  const std::string number = formatted("-%0*d", digits_of(w.per_plane), place + 1);
  if (w.spacing_s > 0) return w.name + number;
  return w.name + formatted("-%0*d", digits_of(w.planes), plane + 1) + number;
}

}  // namespace

double kozai_mean_motion_rad_per_min(double semi_major_axis_m, double inclination_rad) {
  const double brouwer = sgp4::xke / std::pow(semi_major_axis_m / sgp4::earth_radius_m, 1.5);
  const double cos_i = std::cos(inclination_rad);
  const double d1 = 0.75 * sgp4::j2 * (3.0 * cos_i * cos_i - 1.0);
  double kozai = brouwer;
  for (int k = 0; k < 8; ++k) {  // each step is exact to 1e-3 of the one before
    const double kozai_a = std::pow(sgp4::xke / kozai, 2.0 / 3.0), del = d1 / (kozai_a * kozai_a);
    const double a1 = kozai_a * (1.0 - del * del - del * (1.0 / 3.0 + 134.0 * del * del / 81.0));
    kozai = brouwer * (1.0 + d1 / (a1 * a1));
  }
  return kozai;
}

std::vector<MeanElements> elements_of(const Walker& w) {
  const double node_rad = w.raan_spread_rad / w.planes;
  const double phase_rad = 2 * pi * w.phasing / w.satellites();
  MeanElements common{.epoch_jd1 = w.epoch.jd1, .epoch_jd2 = w.epoch.jd2};
  common.mean_motion_rad_per_min =
      kozai_mean_motion_rad_per_min(w.semi_major_axis_m, w.inclination_rad);
  common.inclination_rad = w.inclination_rad;
  const double in_plane_rad =
      w.spacing_s > 0 ? -w.spacing_s * latitude_rate_rad_per_s(common) : 2 * pi / w.per_plane;
  std::vector<MeanElements> all(std::size_t(w.satellites()), common);
  for (int k = 0; k < w.satellites(); ++k) {
    const int plane = k / w.per_plane, place = k % w.per_plane;
    MeanElements& e = all[std::size_t(k)];
    e.catalogue_number = w.first_number + std::uint32_t(k);
    e.name = name_of(w, plane, place);
    e.raan_rad = turn_of(w.raan_rad + node_rad * plane);
    e.mean_anomaly_rad =
        turn_of(w.argument_of_latitude_rad + in_plane_rad * place + phase_rad * plane);
  }
  return all;
}

}  // namespace dmise
