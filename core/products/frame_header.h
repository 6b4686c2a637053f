#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/sim_time.h"
#include "core/detector/detector.h"
#include "core/effects/accuracy.h"
#include "core/frames/quaternion.h"
#include "core/frames/vec.h"
#include "core/optics/camera.h"
#include "core/optics/exclusion.h"
#include "core/photometry/band.h"
#include "core/photometry/magnitude_system.h"
#include "core/products/detection.h"
#include "core/products/observation.h"
#include "core/products/unknown_facts.h"
#include "core/sky/air/refraction.h"
#include "core/wcs/wcs.h"

namespace dmise {

/// Position of a ground sensor.
struct SitePlace {
  double latitude_rad = 0.0, longitude_rad = 0.0;  // geodetic
  double height_m = 0.0;                           // above the scenario's ellipsoid
  Vec<Itrs> position_m;

  bool operator==(const SitePlace&) const = default;
};

/// All metadata of a frame: the content of its FITS header and the only input of detection besides
/// the counts. Independent of the wall clock and of how the run was started.
struct FrameHeader {
  std::string sensor;          // at most 64 printable ASCII characters, as all texts here
  std::uint32_t frame = 0;     // counts from 1
  SimTime start, middle, end;  // times of the exposure
  std::string start_utc, middle_utc, end_utc;  // ISO 8601; FITS drops the Z at the end
  double exposure_s = 0.0;
  std::string mount;     // "fixed", "sidereal", ...
  std::string software;  // name and version
  std::string scenario_digest;
  std::uint64_t seed = 0;

  std::string accuracy;  // what the frame was planned for; empty: all effects as asked for
  ErrorBound error;      // bound that the plan states

  double gain_e_per_dn = 1.0;
  double bias_dn = 0.0;
  double read_noise_e = 0.0;  // rms
  double dark_e_per_s = 0.0;
  double full_well_e = 0.0;
  ImageOptics image_optics;          // effects that are on
  std::optional<Detector> detector;  // effects that are on; empty in foreign files
  double saturation_dn = 0.0;        // lowest count that may be clipped: full well or ADC
  double psf_fwhm_px = 0.0;          // Gaussian, before pixel integration
  std::optional<double> defocus_um;  // where the focus drifts, at mid exposure
  MonotoneCubic illumination;        // relative, of a lens with a table of it
  FieldRadius illumination_radius = FieldRadius::angle_deg;
  Band band;
  double zero_point_mag = 0.0;              // a source of 1 e-/s has it, without atmosphere
  MagnitudeScale magnitudes;                // that products have; PHOTZP is in it
  double extinction_mag_per_airmass = 0.0;  // by the atmosphere in this band; 0 in space
  // Turbulence towards the zenith at 500 nm; all 0 if none is given.
  double r0_m = 0.0, isoplanatic_angle_rad = 0.0, tau0_s = 0.0;

  Observation observation;
  Wcs wcs;
  Projection projection;
  double focal_length_px = 0.0;
  // Start, middle and end of the exposure: how the star field moves over the detector.
  std::array<Quaternion, 3> camera_from_gcrs;
  bool mirrored = false;  // rows run against the camera's y axis

  Exclusion exclusion;  // limits set by the camera
  Excluded excluded;    // in this exposure
  bool dark = false;    // the camera's cover or shutter was closed

  UnknownFacts unknown;  // none in a run's frames

  Vec<Gcrs> sensor_position_m, sensor_velocity_m_per_s;  // geocentric, mid exposure
  // Velocity of the geocentre, barycentric, GCRS axes: displaces the stars by which the WCS is.
  // It is 0 if annual aberration is off.
  Vec<Gcrs> earth_velocity_m_per_s;
  std::optional<SitePlace> site;  // none in space
  // Air that refracts in a ground sensor's frame, pressure 0 if refraction is off. Empty in space
  // and in files without it.
  std::optional<Weather> air;

  /// The zero point for the V of sources of the Sun's colour, as catalogues and truth have it.
  double v_solar_zero_point_mag() const { return zero_point_mag - magnitudes.solar_colour_mag; }

  /// Whether no light came in.
  bool shutter_closed() const { return dark || closes_shutter(exclusion, excluded); }
  /// "the shutter was closed because of the Moon", "a cover or shutter was closed".
  std::string closed_text() const {
    return dark ? "a cover or shutter was closed"
                : "the shutter was closed because of " + excluding_text(excluded);
  }

  bool operator==(const FrameHeader&) const = default;
};

}  // namespace dmise
