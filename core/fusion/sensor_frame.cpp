#include "core/fusion/sensor_frame.h"

#include <algorithm>
#include <cmath>

#include "core/base/algebra/symmetric2.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double limit_width_mag = 0.5;  // standard deviation of the fall at the limit
/// Least standard deviation of a direction: bright sources in images are known better than star
/// catalogues, clocks and refraction, and than a filter is linear that knew a kilometre before.
constexpr double min_sigma_rad = 0.2 * arcsec;

/// Raises both axes of an ellipse to the least; leaves what is wider as it is, to the bit.
void widen(Symmetric2& covariance) {
  auto& [e, c, n] = covariance;
  const double least = min_sigma_rad * min_sigma_rad;
  const double mean = mean_of_axes(covariance), half = half_of_axes(covariance);
  if (mean - half >= least) return;
  const double large = std::max(mean + half, least);
  // least I + (large - least) times the projection on the longer axis.
  const double share = half > 0 ? (large - least) / (2 * half) : 0.0;
  const double along = (e - n) / 2;
  e = least + share * (half + along);
  n = least + share * (half - along);
  c *= share;
}

}  // namespace

bool SensorFrame::shows(const Vec<Gcrs>& direction, double margin_px) const {
  if (dot(direction, axis) < std::cos(half_angle_rad)) return false;
  if (!wcs) return true;
  const auto pixel = wcs_pixel(*wcs, direction);
  return pixel && pixel->x_px > margin_px - 0.5 && pixel->y_px > margin_px - 0.5 &&
         pixel->x_px < columns - 0.5 - margin_px && pixel->y_px < rows - 0.5 - margin_px &&
         wcs_sees_sky(*wcs, *pixel);
}

double SensorFrame::detection_probability(double magnitude, double best) const {
  if (!searched) return 0.0;
  return best * 0.5 *
         std::erfc((magnitude - limiting_magnitude) / (limit_width_mag * std::sqrt(2.0)));
}

double SensorFrame::solid_angle_sr() const { return 2 * pi * (1 - std::cos(half_angle_rad)); }

SensorFrame sensor_frame(const FrameReport& report, const std::vector<Detection>& detections,
                         int columns, int rows, double half_angle_rad, double pointing_sigma_rad) {
  SensorFrame out{
      .sensor = report.sensor,
      .frame = report.frame,
      .time = report.middle,
      .sensor_m = report.sensor_position_m,
      .axis = from_spherical<Gcrs>(report.boresight_ra_rad, report.boresight_dec_rad),
      .half_angle_rad = half_angle_rad,
      .wcs = report.wcs,
      .columns = columns,
      .rows = rows,
      .limiting_magnitude = report.limiting_magnitude - report.magnitudes.solar_colour_mag,
      .searched = !report.detection_off};
  if (columns == 0) {
    out.wcs.reset();
    out.searched = report.limiting_magnitude != 0.0;
    out.needs_sunlight = false;
  } else if (report.psf_fwhm_px > 0.0) {
    out.resolution_rad = report.psf_fwhm_px * wcs_scale_rad_per_px(report.wcs);
  }
  for (const Detection& d : detections)
    if (auto observation = angle_observation(d)) {
      observation->covariance_rad2[0] += pointing_sigma_rad * pointing_sigma_rad;
      observation->covariance_rad2[2] += pointing_sigma_rad * pointing_sigma_rad;
      widen(observation->covariance_rad2);
      out.sources.push_back({.observation = std::move(*observation),
                             .magnitude = d.magnitude - report.magnitudes.solar_colour_mag,
                             .star_like = d.star_like,
                             .is_point = d.kind == DetectionKind::point});
    }
  return out;
}

}  // namespace dmise
