#include "core/detection/own_sightings.h"

#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/wcs/wcs.h"

namespace dmise {
namespace {

constexpr double max_sigma_rad = pi;
constexpr double max_range_m = 1e15, max_range_rate_m_per_s = speed_of_light_m_per_s;
constexpr double max_magnitude = 60.0;
constexpr double max_snr = 1e12;

void require_in(const std::string& key, double value, double least, double most) {
  if (!std::isfinite(value)) throw Error(key + formatted(": must be finite, got %.9g", value));
  if (!(value >= least && value <= most))
    throw Error(key + formatted(": must be from %.9g to %.9g, got %.9g", least, most, value));
}

void require_positive(const std::string& key, double value, double most) {
  require_in(key, value, 0.0, most);
  if (value == 0.0) throw Error(key + ": must be > 0, got 0");
}

void check_direction(const std::string& key, double ra_rad, double dec_rad) {
  require_in(key + "ra_rad", ra_rad, -2 * pi, 2 * pi);
  require_in(key + "dec_rad", dec_rad, -pi / 2, pi / 2);
}

void check_covariance(const std::string& key, const std::array<double, 3>& c) {
  for (const double variance : {c[0], c[2]})
    require_positive(key + "covariance_rad2", variance, max_sigma_rad * max_sigma_rad);
  if (!(c[1] * c[1] < c[0] * c[2]))
    throw Error(key +
                formatted("covariance_rad2: must be positive definite, got covariance %.9g", c[1]));
}

void check_sighting(const std::string& key, const OwnSighting& s, SimTime start, SimTime end) {
  if (s.time < start || s.time > end)
    throw Error(key + formatted("time_ns: must be within the exposure, %lld to %lld, got %lld",
                                static_cast<long long>(start.ns), static_cast<long long>(end.ns),
                                static_cast<long long>(s.time.ns)));
  check_direction(key, s.ra_rad, s.dec_rad);
  check_covariance(key, s.covariance_rad2);
  require_in(key + "snr", s.snr, 0.0, max_snr);
  if (s.magnitude) {
    require_in(key + "magnitude", s.magnitude->value, -max_magnitude, max_magnitude);
    require_in(key + "magnitude_sigma", s.magnitude->sigma, 0.0, max_magnitude);
  }
  if (s.range_m) {
    require_positive(key + "range_m", s.range_m->value, max_range_m);
    require_positive(key + "range_sigma_m", s.range_m->sigma, max_range_m);
  }
  if (s.range_rate_m_per_s) {
    require_in(key + "range_rate_m_per_s", s.range_rate_m_per_s->value, -max_range_rate_m_per_s,
               max_range_rate_m_per_s);
    require_positive(key + "range_rate_sigma_m_per_s", s.range_rate_m_per_s->sigma,
                     max_range_rate_m_per_s);
  }
}

ExposureEpoch epoch_of(SimTime time, const FrameReport& report) {
  if (time == report.middle) return ExposureEpoch::middle;
  if (time == report.start) return ExposureEpoch::start;
  return time == report.end ? ExposureEpoch::end : ExposureEpoch::middle;
}

}  // namespace

void check_observed(const Observed& observed, SimTime start, SimTime end) {
  check_direction("boresight_", observed.boresight_ra_rad, observed.boresight_dec_rad);
  if (observed.limiting_magnitude)
    require_in("limiting_magnitude", *observed.limiting_magnitude, -max_magnitude, max_magnitude);
  if (observed.sightings.size() > max_sightings)
    throw Error("sightings: must be at most " + std::to_string(max_sightings) + ", got " +
                std::to_string(observed.sightings.size()));
  for (std::size_t i = 0; i < observed.sightings.size(); ++i)
    check_sighting("sightings[" + std::to_string(i) + "].", observed.sightings[i], start, end);
}

double right_ascension_rad(double told_rad) {
  const double from_zero = told_rad < 0.0 ? told_rad + 2 * pi : told_rad;
  return from_zero < 2 * pi ? from_zero : 0.0;
}

Wcs wcs_without_image(double boresight_ra_rad, double boresight_dec_rad) {
  return {.projection = Projection::equidistant,
          .ra_rad = right_ascension_rad(boresight_ra_rad),
          .dec_rad = boresight_dec_rad,
          .cd_deg = {-1, 0, 0, 1}};
}

Detection detection_of(const OwnSighting& s, const FrameReport& report, const Vec<Gcrs>& sensor_m,
                       const Vec<Gcrs>& sensor_m_per_s) {
  const double ra_rad = right_ascension_rad(s.ra_rad);
  Detection d{.sensor = report.sensor,
              .frame = report.frame,
              .epoch = epoch_of(s.time, report),
              .time = s.time,
              .ra_rad = ra_rad,
              .dec_rad = s.dec_rad,
              .corrected_ra_rad = ra_rad,
              .corrected_dec_rad = s.dec_rad,
              .covariance_rad2 = s.covariance_rad2,
              .sensor_position_m = sensor_m,
              .sensor_velocity_m_per_s = sensor_m_per_s,
              .aberration_removed = true,
              .refraction_removed = true,
              .magnitude = s.magnitude ? s.magnitude->value : no_magnitude,
              .magnitude_sigma = s.magnitude ? s.magnitude->sigma : 0.0,
              .snr = s.snr,
              .end1_time = s.time,
              .end2_time = s.time};
  if (s.range_m) d.range_m = s.range_m->value, d.range_sigma_m = s.range_m->sigma;
  if (const auto& rate = s.range_rate_m_per_s)
    d.range_rate_m_per_s = rate->value, d.range_rate_sigma_m_per_s = rate->sigma;
  if (const auto pixel = wcs_pixel(report.wcs, from_spherical<Gcrs>(s.ra_rad, s.dec_rad)))
    d.x_px = pixel->x_px, d.y_px = pixel->y_px;
  // The ends of a point.
  d.end1_x_px = d.end2_x_px = d.x_px, d.end1_y_px = d.end2_y_px = d.y_px;
  d.end1_ra_rad = d.end2_ra_rad = d.ra_rad, d.end1_dec_rad = d.end2_dec_rad = d.dec_rad;
  return d;
}

}  // namespace dmise
