#include "core/detection/make_report.h"

#include <algorithm>
#include <cmath>

#include "core/detection/known/atmosphere.h"
#include "core/detection/pixels/components.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/wcs/wcs.h"

namespace dmise {
namespace {

std::uint32_t count_saturated(const CountImage& counts, double saturation_dn) {
  if (!(saturation_dn <= 65535.0)) return 0;
  const auto least = std::uint16_t(std::max(std::ceil(saturation_dn), 0.0));
  return std::uint32_t(std::count_if(counts.pixels.begin(), counts.pixels.end(),
                                     [&](std::uint16_t v) { return v >= least; }));
}

PixelPosition centre_of(const CountImage& counts) {
  return {(counts.columns - 1) / 2.0, (counts.rows - 1) / 2.0};
}

}  // namespace

double lowest_clipped_dn(const FrameHeader& header) {
  const double column_e = header.detector ? header.detector->column_noise_e : 0.0;
  return header.saturation_dn -
         5 * std::hypot(header.read_noise_e, column_e) / header.gain_e_per_dn;
}

FrameReport unmeasured_report(const CountImage& counts, const FrameHeader& header) {
  FrameReport r;
  r.sensor = header.sensor;
  r.frame = header.frame;
  r.start = header.start;
  r.middle = header.middle;
  r.end = header.end;
  const auto place = to_spherical(wcs_direction(header.wcs, centre_of(counts)));
  r.boresight_ra_rad = place[0];
  r.boresight_dec_rad = place[1];
  r.wcs = header.wcs;
  r.sensor_position_m = header.sensor_position_m;
  r.sensor_velocity_m_per_s = header.sensor_velocity_m_per_s;
  r.magnitudes = header.magnitudes;
  r.zero_point_mag = header.zero_point_mag;
  r.excluded = header.excluded;
  r.shutter_closed = header.shutter_closed();
  return r;
}

FrameReport make_report(const CountImage& counts, const FrameHeader& header,
                        const Background& background, const PsfField& psf) {
  const double sigma_px = psf.at(centre_of(counts)).equivalent_sigma_px();
  FrameReport r = unmeasured_report(counts, header);
  r.background_e = (background.median_level_dn() - header.bias_dn) * header.gain_e_per_dn;
  r.noise_e = background.median_sigma_dn() * header.gain_e_per_dn;
  const double min_e = limiting_point_e(r.noise_e, sigma_px);
  r.limiting_magnitude = r.zero_point_mag - 2.5 * std::log10(min_e / header.exposure_s) -
                         extinction_mag(header, centre_of(counts));
  r.psf_fwhm_px = fwhm_before_pixel(sigma_px);
  r.psf_stars = std::uint32_t(psf.stars);
  r.saturated_px = count_saturated(counts, lowest_clipped_dn(header));
  return r;
}

}  // namespace dmise
