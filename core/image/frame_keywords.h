#pragma once
#include <string>
#include <variant>

#include "core/detector/detector.h"
#include "core/photometry/magnitude_system.h"
#include "core/products/frame_header.h"

// The keywords of a frame, listed once for writing (CardWriter) and reading (CardReader).
namespace dmise {

template <class Visitor>
void visit_observation(Visitor& v, Observation& o) {
  v.optional_text("OBJECT", o.object, "what is pointed at");
  v.optional_text("TELESCOP", o.telescope, "camera and telescope");
  v.optional_number("MJD-OBS", o.start_mjd, "[d] UTC, start of the exposure");
  v.optional_angle("RA", o.ra_rad, "[deg] of the centre, ICRS, mid exposure");
  v.optional_angle("DEC", o.dec_rad, "[deg] of the centre, ICRS, mid exposure");
  v.optional_number("AIRMASS", o.airmass, "of the centre, mid exposure");
  v.optional_angle("SUNALT", o.sun_altitude_rad, "[deg] altitude of the Sun, mid exposure");
  v.optional_angle("MOONALT", o.moon_altitude_rad, "[deg] altitude of the Moon, mid exposure");
}

template <class Visitor>
void visit_pixel_coordinate(Visitor& v, const char* key, double& zero_based, const char* comment) {
  double one_based = zero_based + 1.0;
  v.number(key, one_based, comment);
  zero_based = one_based - 1.0;
}

template <class Visitor, class Frame>
void visit_vector(Visitor& v, const std::string& key, Vec<Frame>& vector, const char* comment) {
  v.number(key + "X", vector.x, comment);
  v.number(key + "Y", vector.y, "");
  v.number(key + "Z", vector.z, "");
}

template <class Visitor>
void visit_refraction(Visitor& v, const Projection& lens, Wcs& wcs) {
  if (!v.present("CPDIS1", wcs.refraction.has_value())) return;
  if (!wcs.refraction) wcs.refraction.emplace();
  WcsRefraction& r = *wcs.refraction;
  if (!lens.row().fits_code) r.lens = lens;
  v.lookup(1);
  v.lookup(2);
  visit_vector(v, "WCSZEN", r.zenith, "zenith in the camera: right, down, boresight");
  v.number("WCSFOC", r.focal_length_px, "[px] focal length");
  v.number("WCSPRES", r.pressure_hpa, "[hPa] of the air that refracts");
  v.number("WCSTEMP", r.temperature_c, "[degC]");
  v.number("WCSHUM", r.humidity, "relative humidity");
  v.number("WCSWAVE", r.wavelength_um, "[um] wavelength");
  v.number("WCSOFFX", r.offset_x_px, "[px] left out of the lookup tables");
  v.number("WCSOFFY", r.offset_y_px, "");
  v.number("WCSCELL", r.cell_px, "[px] step of the lookup tables");
}

template <class Visitor>
void visit_wcs(Visitor& v, const Projection& lens, Wcs& wcs) {
  const bool sip = v.present("A_ORDER", wcs.order > 0);
  v.constant("WCSAXES", 2, "");
  v.wcs_projection(wcs, sip);
  v.constant("CUNIT1", "deg", "");
  v.constant("CUNIT2", "deg", "");
  visit_pixel_coordinate(v, "CRPIX1", wcs.crpix_x, "centre of the first pixel is 1");
  visit_pixel_coordinate(v, "CRPIX2", wcs.crpix_y, "");
  v.angle("CRVAL1", wcs.ra_rad, "[deg] right ascension of the reference pixel");
  v.angle("CRVAL2", wcs.dec_rad, "[deg] declination of the reference pixel");
  v.number("CD1_1", wcs.cd_deg[0], "[deg/px]");
  v.number("CD1_2", wcs.cd_deg[1], "[deg/px]");
  v.number("CD2_1", wcs.cd_deg[2], "[deg/px]");
  v.number("CD2_2", wcs.cd_deg[3], "[deg/px]");
  v.number_constant("LONPOLE", 180.0, "[deg] also at a celestial pole");
  v.constant("RADESYS", "ICRS", "places are astrometric: as in a star catalogue");
  v.sip(wcs);
  visit_refraction(v, lens, wcs);
  v.number("WCSRMS", wcs.rms_px, "[px] rms of the WCS where the sky is seen");
  v.number("WCSMAX", wcs.max_px, "[px] largest error of the WCS there");
}

// Parameters that every frame's header has anyway are copied from there, not written twice.
template <class Visitor>
void visit_detector(Visitor& v, FrameHeader& h) {
  if (!v.present("ADCBITS", h.detector.has_value())) return;
  if (!h.detector) h.detector.emplace();
  Detector& d = *h.detector;
  for (const DetectorParameter& p : detector_parameters()) {
    const std::string keyword(p.keyword), comment(p.meaning);
    const bool unusual = p.number_of(d) != p.number_of({});
    if (keyword.empty() || !(in_every_header(p) || v.present(keyword.c_str(), unusual))) continue;
    if (const auto number = std::get_if<double Detector::*>(&p.value))
      v.number(keyword, d.*(*number), comment.c_str());
    else if (const auto integer = std::get_if<int Detector::*>(&p.value))
      v.integer(keyword, d.*(*integer), comment.c_str());
    else
      v.flag(keyword, d.*std::get<bool Detector::*>(p.value), comment.c_str());
  }
  d.dark_e_per_s = h.dark_e_per_s;
  d.read_noise_e = h.read_noise_e;
  d.full_well_e = h.full_well_e;
  d.gain_e_per_dn = h.gain_e_per_dn;
  d.bias_dn = h.bias_dn;
}

/// Exclusion angles of a camera that has some, and whether a body was within them.
template <class Visitor>
void visit_exclusion(Visitor& v, FrameHeader& h) {
  if (!v.present("EXCLACT", h.exclusion.any())) return;
  const auto limit = [&](const char* key, std::optional<double>& limit_deg, const char* nearer_key,
                         bool& nearer, const char* comment) {
    v.optional_number(key, limit_deg, comment);
    if (limit_deg) v.flag(nearer_key, nearer, "it was, in the exposure");
  };
  limit("SUNEXCL", h.exclusion.sun_deg, "SUNNEAR", h.excluded.sun,
        "[deg] of the axis: the Sun must not be nearer");
  limit("MOONEXCL", h.exclusion.moon_deg, "MOONNEAR", h.excluded.moon,
        "[deg] of the axis: the Moon must not be nearer");
  limit("LIMBEXCL", h.exclusion.earth_limb_deg, "LIMBNEAR", h.excluded.earth_limb,
        "[deg] of the axis: the limb must not be nearer");
  v.choice("EXCLACT", h.exclusion.action, exclusion_action_names, "what happens if one is");
  v.constant("SHUTTER", h.shutter_closed() ? "closed" : "open", "in the exposure");
}

template <class Visitor>
void visit(Visitor& v, FrameHeader& h) {
  v.text("INSTRUME", h.sensor, "sensor");
  if (v.present("UNKNOWN", h.unknown.any())) v.facts("UNKNOWN", h.unknown, "facts");
  visit_observation(v, h.observation);
  v.integer("FRAMENUM", h.frame, "frame of this sensor, counts from 1");
  v.constant("TIMESYS", "UTC", "");
  // Unknown facts have no cards that others would read as facts; what stands in is read back.
  const bool timed = !h.unknown.has(FrameFact::time);
  const bool exposed = !h.unknown.has(FrameFact::exposure);
  if (timed) {
    v.utc("DATE-OBS", h.start_utc, "start of the exposure");
    v.utc("DATE-BEG", h.start_utc, "start of the exposure");
  }
  if (timed && exposed) {
    v.utc("DATE-AVG", h.middle_utc, "middle of the exposure");
    v.utc("DATE-END", h.end_utc, "end of the exposure");
  } else {
    h.middle_utc = h.end_utc = h.start_utc;
  }
  v.integer("SIMT-BEG", h.start.ns, "[ns] start, since the scenario's start");
  v.integer("SIMT-AVG", h.middle.ns, "[ns] middle");
  v.integer("SIMT-END", h.end.ns, "[ns] end");
  if (exposed)
    v.number("EXPTIME", h.exposure_s, "[s]");
  else
    h.exposure_s = h.end.seconds() - h.start.seconds();
  v.text("MOUNT", h.mount, "how the camera is carried");
  v.text("FILTER", h.band.name, "band");
  v.number("BANDCEN", h.band.centre_m, "[m] centre of the band");
  v.number("BANDWID", h.band.width_m, "[m] full width of the band");
  v.number("GAIN", h.gain_e_per_dn, "[e-/DN]");
  v.number("BIASLVL", h.bias_dn, "[DN] count of no electron");
  v.number("RDNOISE", h.read_noise_e, "[e-] rms");
  v.number("DARKCUR", h.dark_e_per_s, "[e-/s/px]");
  v.number("FULLWELL", h.full_well_e, "[e-]");
  visit_detector(v, h);
  v.number("SATURATE", h.saturation_dn, "[DN] counts from here on may be clipped");
  for (const ImageParameter& p : image_parameters()) {
    double& number = h.image_optics.*p.value;
    if (v.present(std::string(p.keyword).c_str(), number != ImageOptics().*p.value))
      v.number(std::string(p.keyword), number, std::string(p.meaning).c_str());
  }
  v.number("PSFFWHM", h.psf_fwhm_px, "[px] Gaussian, before pixel integration");
  v.optional_number("DEFOCUS", h.defocus_um, "[um] of the detector from the focus, mid exposure");
  if (v.present("VIGNROWS", !h.illumination.empty()))
    v.illumination(h.illumination, h.illumination_radius);
  const bool air_known = !h.unknown.has(FrameFact::extinction);
  if (!h.unknown.has(FrameFact::zero_point))
    v.zero_point(h.zero_point_mag, h.magnitudes,
                 air_known ? "[mag] of 1 e-/s, without atmosphere"
                           : "[mag] of 1 e-/s, dimmed by the air of the frame");
  if (air_known) v.number("EXTINCT", h.extinction_mag_per_airmass, "[mag/airmass]");
  if (v.present("R0", h.r0_m > 0)) {
    v.number("R0", h.r0_m, "[m] Fried parameter, zenith, 500 nm");
    v.number("ISOPLAN", h.isoplanatic_angle_rad, "[rad] isoplanatic angle, likewise");
    v.number("TAU0", h.tau0_s, "[s] coherence time r0 / wind, likewise");
  }
  v.projection("PROJNAME", h.projection, "of the lens");
  v.number("FOCALPX", h.focal_length_px, "[px] focal length");
  constexpr const char* attitudes[3] = {"QBEG", "QAVG", "QEND"};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string key = attitudes[i];
    Quaternion& q = h.camera_from_gcrs[i];
    v.number(key + "0", q.w, "quaternion camera from GCRS, scalar first");
    v.number(key + "1", q.x, "");
    v.number(key + "2", q.y, "");
    v.number(key + "3", q.z, "");
  }
  if (v.present("MIRRORED", h.mirrored))
    v.flag("MIRRORED", h.mirrored, "rows run against the camera's y axis");
  visit_exclusion(v, h);
  if (v.present("DARK", h.dark))
    v.flag("DARK", h.dark, "cover or shutter closed: no light came in");
  visit_vector(v, "SENPOS", h.sensor_position_m, "[m] sensor, GCRS, mid exposure");
  visit_vector(v, "SENVEL", h.sensor_velocity_m_per_s, "[m/s] sensor, GCRS, mid exposure");
  visit_vector(v, "EARVEL", h.earth_velocity_m_per_s, "[m/s] Earth, that aberrates the WCS, GCRS");
  if (v.present("OBSGEO-X", h.site.has_value())) {
    if (!h.site) h.site.emplace();
    visit_vector(v, "OBSGEO-", h.site->position_m, "[m] site, ITRS");
    v.angle("SITELAT", h.site->latitude_rad, "[deg] geodetic latitude");
    v.angle("SITELONG", h.site->longitude_rad, "[deg] longitude, east positive");
    v.number("SITEELEV", h.site->height_m, "[m] height above the ellipsoid");
  }
  if (v.present("PRESSURE", h.air.has_value())) {
    if (!h.air) h.air.emplace();
    v.number("PRESSURE", h.air->pressure_hpa, "[hPa] of the air; 0: refraction is off");
    v.number("AIRTEMP", h.air->temperature_c, "[deg C]");
    v.number("HUMIDITY", h.air->humidity, "relative, 0 to 1");
  }
  visit_wcs(v, h.projection, h.wcs);
  v.integer("SEED", h.seed, "of the random draws");
  if (v.present("ACCURACY", !h.accuracy.empty())) {
    v.text("ACCURACY", h.accuracy, "what the plan of effects was made for");
    v.number("ERRPHOT", h.error.photometry_mag, "[mag] bound of what the plan leaves out");
    v.number("ERRPOS", h.error.position_px, "[px] likewise");
    v.number("ERRBACK", h.error.background_sigma, "[noise of a pixel] of the background, likewise");
    v.number("ERRNOISE", h.error.noise, "of a pixel's noise, relative, likewise");
  }
  v.text("SCENARIO", h.scenario_digest, "digest of the scenario");
  v.text("CREATOR", h.software, "");
}

}  // namespace dmise
