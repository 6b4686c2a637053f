#include "core/astrometry/solve_frame.h"

#include <algorithm>
#include <cmath>

#include "core/astrometry/star_photometry.h"
#include "core/astrometry/star_sources.h"
#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/detection/known/atmosphere.h"
#include "core/frames/quaternion.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"
#include "core/wcs/wcs_fit.h"

namespace dmise {
namespace {

/// Without a time: of J2000. Its aberration moves a field, and bends it by less than 0.1 arcsec a
/// degree.
Observer observer_of(const FrameHeader& header, FrameNotes& notes) {
  if (header.unknown.has(FrameFact::time)) {
    const Tt j2000 = Clock(parse_utc("2000-01-01T11:58:55.816Z")).tt({});
    notes.assumed.push_back("time: stars are taken where they were in 2000: without proper motion");
    return space_observer({}, {}, j2000, solar_system(j2000));
  }
  const Tt tt = Clock(parse_utc(header.middle_utc)).tt({});
  Observer o = space_observer(header.sensor_position_m, header.sensor_velocity_m_per_s, tt,
                              solar_system(tt));
  if (header.site) {
    o.air = Air{unit(zenith_of(header)), Refraction()};
    if (const auto refraction = refraction_of(header)) o.air->refraction = *refraction;
  }
  return o;
}

PlateHint belief_of(const Frame& frame, bool blind) {
  const FrameHeader& h = frame.header;
  PlateHint b{.columns = frame.counts.columns,
              .rows = frame.counts.rows,
              .projection = h.projection,
              .focal_length_px = 0.0,
              .camera_from_gcrs = std::nullopt,
              .axis = std::nullopt};
  if (blind) return b;
  if (!h.unknown.has(FrameFact::focal_length)) b.focal_length_px = h.focal_length_px;
  if (h.unknown.has(FrameFact::pointing)) {
    const Observation& o = h.observation;
    if (o.ra_rad && o.dec_rad) b.axis = from_spherical<Gcrs>(*o.ra_rad, *o.dec_rad);
    return b;
  }
  const auto camera = rotation_of<CameraFrame, Gcrs>(h.camera_from_gcrs[1]);
  b.camera_from_gcrs = h.mirrored ? flipped(camera) : camera;
  return b;
}

/// The WCS of a plate: its sky is where the catalogue has the stars that it sees.
Wcs wcs_of(const PlateSolution& plate, const PlateSky& sky, int columns, int rows) {
  const PlateModel& model = plate.fit.model;
  constexpr double pitch_m = 1e-5;  // any
  const Optics optics{.projection = model.projection,
                      .focal_length_m = model.focal_length_px * pitch_m,
                      .pixel_pitch_m = pitch_m,
                      .columns = columns,
                      .rows = rows};
  const SkyOfPixel seen = [&](PixelPosition pixel) -> std::optional<Vec<Gcrs>> {
    const auto direction = model.direction(pixel);
    if (!direction) return std::nullopt;
    return sky.places().star_seen_at(*direction);
  };
  std::optional<CameraAir> air;
  if (sky.air()) air = CameraAir{model.camera_from_gcrs * sky.air()->zenith, sky.air()->refraction};
  Wcs wcs = best_wcs(optics, seen, air);
  // The plate's own error comes on top.
  double sum = 0.0, most = 0.0;
  int count = 0;
  for (int j = 0; j <= 8; ++j)
    for (int i = 0; i <= 8; ++i) {
      const PixelPosition at{i * (columns - 1) / 8.0, j * (rows - 1) / 8.0};
      const auto direction = model.direction(at);
      if (!direction || (sky.air() && dot(*direction, sky.air()->zenith) < 0)) continue;
      const double sigma = plate.sigma_px(*direction, at);
      sum += 2 * sigma * sigma;
      most = std::max(most, sigma);
      ++count;
    }
  if (count) wcs.rms_px = std::hypot(wcs.rms_px, std::sqrt(sum / count));
  wcs.max_px = std::hypot(wcs.max_px, 3 * most);
  return wcs;
}

/// Why no stars are where the header points, if its site and time put that below the horizon.
std::string below_horizon(const PlateHint& belief, const PlateSky& sky) {
  auto axis = belief.axis;
  if (belief.camera_from_gcrs)
    axis = belief.camera_from_gcrs->inverse() * Vec<CameraFrame>{0, 0, 1};
  if (!axis || !sky.air()) return {};
  const double elevation_deg =
      std::asin(std::clamp(dot(unit(*axis), sky.air()->zenith), -1.0, 1.0)) / deg;
  if (elevation_deg > 0) return {};
  return formatted(
      "; the header's site and time put the middle of its field %.1f deg below the horizon",
      -elevation_deg);
}

/// The plate near the believed axis; elsewhere, if there is none: headers may name a target that
/// is beside the frame.
PlateSolution solved_plate(std::span<const PlateSource> sources, PlateHint belief,
                           const PlateSky& sky, const SolveSettings& settings) {
  if (belief.axis && settings.elsewhere) {
    try {
      return solve_plate(sources, belief, sky, settings.search);
    } catch (const Error&) {
      belief.axis.reset();
    }
  }
  return solve_plate(sources, belief, sky, settings.search);
}

}  // namespace

FrameSolution solve_frame(const Frame& frame, const StarMap& stars, const SolveSettings& settings,
                          Threads& threads) {
  const FrameHeader& h = frame.header;
  FrameSolution out;
  const PlateSky sky(stars, observer_of(h, out.notes));
  // Attitudes of an unknown mount are by the trails that the frame shows.
  const bool unknown_mount = h.mount == "unknown";
  const bool moves = unknown_mount || (!settings.blind && !h.unknown.has(FrameFact::pointing));
  const StarMotion motion(h, frame.counts.columns, frame.counts.rows);
  const StarSourceSettings search{
      .gain_e_per_dn = h.gain_e_per_dn,
      .saturation_dn = h.saturation_dn - 5 * h.read_noise_e / h.gain_e_per_dn,
      .psf_fwhm_px = h.psf_fwhm_px,
      .motion = moves ? &motion : nullptr,
      .unknown_mount = unknown_mount};
  const auto sources = find_star_sources(frame.counts, search, threads);
  out.sources = sources.size();
  const PlateHint belief = belief_of(frame, settings.blind);
  try {
    out.plate = solved_plate(sources, belief, sky, settings);
  } catch (const Error& error) {
    const bool by_focallen = h.unknown.has(FrameFact::pointing) && belief.focal_length_px > 0;
    std::string why = error.what();
    if (by_focallen && sources.size() >= 3) {
      why += formatted(
          " within 5 %% of the focal length of %.6g px, which is that of "
          "FOCALLEN / XPIXSZ: --blind tries all",
          belief.focal_length_px);
    }
    throw Error(why + below_horizon(belief, sky));
  }
  out.wcs = wcs_of(out.plate, sky, frame.counts.columns, frame.counts.rows);
  if (h.unknown.has(FrameFact::exposure)) return out;
  out.zero_point = zero_point_of(
      frame, out.plate, light_by_psf(frame, solved_header(h, out), sources, search, threads), sky);
  return out;
}

FrameHeader solved_header(const FrameHeader& header, const FrameSolution& solution) {
  FrameHeader h = header;
  const PlateModel& model = solution.plate.fit.model;
  h.wcs = solution.wcs;
  h.focal_length_px = model.focal_length_px;
  const auto [ra, dec] = to_spherical(wcs_direction(h.wcs, {h.wcs.crpix_x, h.wcs.crpix_y}));
  h.observation.ra_rad = ra;
  h.observation.dec_rad = dec;
  h.mirrored = model.mirrored();
  const auto upright = h.mirrored ? flipped(model.camera_from_gcrs) : model.camera_from_gcrs;
  const auto middle = rotation_of<CameraFrame, Gcrs>(header.camera_from_gcrs[1]);
  for (std::size_t i = 0; i < 3; ++i)  // turns during the exposure as believed
    h.camera_from_gcrs[i] = quaternion_of(
        upright * middle.inverse() * rotation_of<CameraFrame, Gcrs>(header.camera_from_gcrs[i]));
  h.unknown.remove(FrameFact::pointing);
  h.unknown.remove(FrameFact::focal_length);
  if (const auto& z = solution.zero_point) {
    h.zero_point_mag = z->zero_point_mag + h.magnitudes.solar_colour_mag;
    h.extinction_mag_per_airmass = z->extinction_mag_per_airmass;
    h.unknown.remove(FrameFact::zero_point);
    if (z->extinction_fitted) h.unknown.remove(FrameFact::extinction);
  }
  return h;
}

std::string to_json(const FrameSolution& solution, const FrameHeader& header,
                    const FrameNotes& notes) {
  const PlateFit& fit = solution.plate.fit;
  const PlateModel& model = fit.model;
  JsonWriter json;
  json.begin_object();
  json.field("sensor", header.sensor).field("frame", header.frame);
  json.field("sources", std::uint64_t(solution.sources)).field("matched", fit.count);
  json.field("rms_px", fit.rms_px).field("error_scale", fit.error_scale);
  json.field("log_odds", solution.plate.log_odds);
  const auto [ra, dec] =
      to_spherical(wcs_direction(solution.wcs, {solution.wcs.crpix_x, solution.wcs.crpix_y}));
  json.field("ra_deg", ra / deg).field("dec_deg", dec / deg);
  json.field("scale_arcsec_per_px", wcs_scale_rad_per_px(solution.wcs) / arcsec);
  json.field("mirrored", model.mirrored());
  json.field("projection", model.projection.name());
  json.field("focal_length_px", model.focal_length_px);
  json.field("centre_x_px", model.centre.x_px).field("centre_y_px", model.centre.y_px);
  json.field("distortion_order", model.order).list("distortion_px", model.distortion);
  json.key("free").begin_array().value("attitude");
  if (fit.free.focal_length) json.value("focal_length");
  if (fit.free.centre) json.value("centre");
  if (fit.free.order > 0) json.value("distortion");
  if (fit.free.radial) json.value("radial_distortion");
  json.end_array().list("covariance", fit.covariance);
  json.field("wcs_rms_px", solution.wcs.rms_px).field("wcs_max_px", solution.wcs.max_px);
  json.key("zero_point");
  if (const auto& z = solution.zero_point) {
    json.begin_object();
    json.field("zero_point_mag", z->zero_point_mag).field("zero_point_sigma", z->sigma(0));
    json.field("colour_term", z->colour_term).field("colour_term_sigma", z->sigma(1));
    json.field("colour_fitted", z->colour_fitted);
    json.field("extinction_mag_per_airmass", z->extinction_mag_per_airmass);
    json.field("extinction_sigma", z->sigma(2)).field("extinction_fitted", z->extinction_fitted);
    json.field("stars", z->stars).field("rms_mag", z->rms_mag);
    json.end_object();
  } else {
    json.null();
  }
  FrameNotes all = notes;
  all.assumed.insert(all.assumed.end(), solution.notes.assumed.begin(),
                     solution.notes.assumed.end());
  if (!all.missing.empty()) json.list("missing", all.missing);
  if (!all.assumed.empty()) json.list("assumed", all.assumed);
  json.end_object();
  return json.take();
}

}  // namespace dmise
