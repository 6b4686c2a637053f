#pragma once
#include <cstdint>
#include <string>

#include "core/base/sim_time.h"
#include "core/base/units.h"
#include "core/frames/vec.h"
#include "core/optics/exclusion.h"
#include "core/photometry/magnitude_system.h"
#include "core/products/frame_notes.h"
#include "core/products/wcs_fields.h"

namespace dmise {

/// Report of an exposure, also of one without detections.
struct FrameReport {
  std::string sensor;
  std::uint32_t frame = 0;                                 // counts from 1
  SimTime start, middle, end;                              // times of the exposure
  double boresight_ra_rad = 0.0, boresight_dec_rad = 0.0;  // ICRS, at mid exposure
  Wcs wcs;
  Vec<Gcrs> sensor_position_m, sensor_velocity_m_per_s;  // at mid exposure
  double limiting_magnitude = 0.0;  // point source at SNR = detection threshold; 0: unknown
  double background_e = 0.0;        // median [e-/px]
  double noise_e = 0.0;             // median of the per-pixel noise [e-]
  double zero_point_mag = 0.0;      // magnitude of a source of 1 e-/s
  MagnitudeScale magnitudes;        // this report and its detections are in it
  // The Gaussian has the PSF's sum of squares in the frame's middle, before pixel integration.
  double psf_fwhm_px = 0.0;
  std::uint32_t psf_stars = 0;  // from which the PSF was measured; 0: it is the header's
  // Stars of a catalogue that stand well out of the noise where the header points, and how many of
  // them the frame shows there.
  std::uint32_t stars_expected = 0, stars_found = 0;
  std::uint32_t detections = 0;  // published
  std::uint32_t star_like = 0;   // sources that move like stars
  std::uint32_t saturated_px = 0;
  std::uint32_t stars_rendered = 0, objects_rendered = 0;
  std::string plan;  // "effect effect ..." that ran, in order
  // Detection was off: limiting magnitude, background, noise, saturated_px and the numbers of
  // detections are 0.
  bool detection_off = false;
  Excluded excluded;            // bodies nearer to the axis than the camera allows
  bool shutter_closed = false;  // because of them: the frame is dark, and detection was off
  FrameNotes notes;             // on another camera's frame; not sent

  bool operator==(const FrameReport&) const = default;
};

template <class V, MaybeConst<FrameReport> R>
void visit_fields(V& v, R& r) {
  const bool measured = !r.detection_off;
  v("sensor", r.sensor);
  v("frame", r.frame);
  v("start", r.start);
  v("middle", r.middle);
  v("end", r.end);
  v("boresight_ra_rad", r.boresight_ra_rad, "boresight_ra_deg", deg);
  v("boresight_dec_rad", r.boresight_dec_rad, "boresight_dec_deg", deg);
  v("wcs", r.wcs);
  v("sensor_position_m", r.sensor_position_m, "sensor_position_gcrs_m");
  v("sensor_velocity_m_per_s", r.sensor_velocity_m_per_s, "sensor_velocity_gcrs_m_per_s");
  v.absent_unless(r.detection_off, "detection_off", r.detection_off);
  v.absent_unless(r.shutter_closed, "shutter_closed", r.shutter_closed);
  v.absent_unless(r.excluded.sun, "sun_excludes", r.excluded.sun);
  v.absent_unless(r.excluded.moon, "moon_excludes", r.excluded.moon);
  v.absent_unless(r.excluded.earth_limb, "earth_limb_excludes", r.excluded.earth_limb);
  v.null_unless(measured && r.limiting_magnitude != 0.0, "limiting_magnitude",
                r.limiting_magnitude);
  v.null_unless(measured, "background_e", r.background_e);
  v.null_unless(measured, "noise_e", r.noise_e);
  v("zero_point_mag", r.zero_point_mag);
  v("magnitude_system", r.magnitudes.system);
  v.absent_unless(r.magnitudes.system != MagnitudeSystem::v_solar, "solar_colour_mag",
                  r.magnitudes.solar_colour_mag);
  v.null_unless(measured, "psf_fwhm_px", r.psf_fwhm_px);
  v.null_unless(measured, "psf_stars", r.psf_stars);
  v.null_unless(measured, "stars_expected", r.stars_expected);
  v.null_unless(measured, "stars_found", r.stars_found);
  v("detections", r.detections);
  v.null_unless(measured, "star_like", r.star_like);
  v.null_unless(measured, "saturated_px", r.saturated_px);
  v("stars_rendered", r.stars_rendered);
  v("objects_rendered", r.objects_rendered);
  v("plan", r.plan);
  v.notes("missing", r.notes.missing);
  v.notes("assumed", r.notes.assumed);
}

}  // namespace dmise
