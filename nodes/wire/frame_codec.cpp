#include "core/base/error.h"
#include "core/products/frame_report.h"
#include "dmise/v1/frame.pb.h"
#include "nodes/wire/codecs.h"

// Fields with the same name and type on both sides, in the order of the message.
// clang-format off
#define DMISE_REPORT_FIELDS(X) \
  X(sensor) X(frame) X(boresight_ra_rad) X(boresight_dec_rad) X(limiting_magnitude) \
  X(background_e) X(noise_e) X(zero_point_mag) X(detections) X(star_like) X(saturated_px) \
  X(stars_rendered) X(objects_rendered) X(plan) X(detection_off) X(shutter_closed) \
  X(psf_fwhm_px) X(psf_stars) X(stars_expected) X(stars_found)
// clang-format on

namespace dmise {
namespace {

// clang-format off
#define DMISE_WCS_REFRACTION_FIELDS(X) \
  X(focal_length_px) X(pressure_hpa) X(temperature_c) X(humidity) X(wavelength_um) X(offset_x_px) \
  X(offset_y_px) X(cell_px)
// clang-format on

void put_wcs(v1::Wcs* message, const Wcs& wcs) {
  message->set_crpix_x_px(wcs.crpix_x);
  message->set_crpix_y_px(wcs.crpix_y);
  message->set_ra_rad(wcs.ra_rad);
  message->set_dec_rad(wcs.dec_rad);
  put(message->mutable_cd_deg(), wcs.cd_deg);
  message->set_order(std::uint32_t(wcs.order));
  message->mutable_a()->Add(wcs.a.begin(), wcs.a.end());
  message->mutable_b()->Add(wcs.b.begin(), wcs.b.end());
  message->mutable_ap()->Add(wcs.ap.begin(), wcs.ap.end());
  message->mutable_bp()->Add(wcs.bp.begin(), wcs.bp.end());
  message->set_rms_px(wcs.rms_px);
  message->set_max_px(wcs.max_px);
  message->set_projection(std::uint32_t(wcs.projection.index()));
  const auto coefficients = wcs.projection.coefficients();
  message->mutable_coefficients()->Add(coefficients.begin(), coefficients.end());
  if (!wcs.refraction) return;
  const WcsRefraction& from = *wcs.refraction;
  auto* to = message->mutable_refraction();
  put(to->mutable_zenith(), from.zenith);
#define X(field) to->set_##field(from.field);
  DMISE_WCS_REFRACTION_FIELDS(X)
#undef X
  if (!from.lens) return;
  to->set_lens(std::uint32_t(from.lens->index()));
  const auto of_lens = from.lens->coefficients();
  to->mutable_lens_coefficients()->Add(of_lens.begin(), of_lens.end());
}

template <class Repeated>
Projection take_projection(std::uint32_t index, const Repeated& coefficients, const char* field) {
  try {
    return Projection::make(index, {coefficients.data(), std::size_t(coefficients.size())});
  } catch (const Error& error) {
    throw Refused(Refusal::value, std::string(field) + ": " + error.what());
  }
}

Wcs take_wcs(const v1::Wcs& message) {
  Wcs wcs;
  wcs.crpix_x = message.crpix_x_px();
  wcs.crpix_y = message.crpix_y_px();
  wcs.ra_rad = message.ra_rad();
  wcs.dec_rad = message.dec_rad();
  wcs.cd_deg = take<4>(message.cd_deg(), "wcs.cd_deg");
  if (message.order() > 9) throw Refused(Refusal::value, "wcs.order: must be 0 to 9");
  wcs.order = int(message.order());
  wcs.a.assign(message.a().begin(), message.a().end());
  wcs.b.assign(message.b().begin(), message.b().end());
  wcs.ap.assign(message.ap().begin(), message.ap().end());
  wcs.bp.assign(message.bp().begin(), message.bp().end());
  wcs.rms_px = message.rms_px();
  wcs.max_px = message.max_px();
  wcs.projection = take_projection(message.projection(), message.coefficients(), "wcs.projection");
  if (!wcs.projection.row().fits_code)
    throw Refused(Refusal::value, "wcs.projection: must be one that FITS has");
  if (!message.has_refraction()) return wcs;
  const v1::WcsRefraction& from = message.refraction();
  WcsRefraction& to = wcs.refraction.emplace();
  to.zenith = take_vec<CameraFrame>(from.zenith(), "wcs.refraction.zenith");
#define X(field) to.field = from.field();
  DMISE_WCS_REFRACTION_FIELDS(X)
#undef X
  if (from.has_lens())
    to.lens = take_projection(from.lens(), from.lens_coefficients(), "wcs.refraction.lens");
  return wcs;
}

}  // namespace

Encoded encode_body(const FrameReport& report) {
  v1::FrameReport message;
#define X(field) message.set_##field(report.field);
  DMISE_REPORT_FIELDS(X)
#undef X
  message.set_sun_excludes(report.excluded.sun);
  message.set_moon_excludes(report.excluded.moon);
  message.set_earth_limb_excludes(report.excluded.earth_limb);
  message.set_start_ns(report.start.ns);
  message.set_middle_ns(report.middle.ns);
  message.set_end_ns(report.end.ns);
  message.set_magnitude_system(static_cast<v1::MagnitudeSystem>(report.magnitudes.system));
  message.set_solar_colour_mag(report.magnitudes.solar_colour_mag);
  put_wcs(message.mutable_wcs(), report.wcs);
  put(message.mutable_sensor_position_m(), report.sensor_position_m);
  put(message.mutable_sensor_velocity_m_per_s(), report.sensor_velocity_m_per_s);
  return {MessageKind::frame_report, message.SerializeAsString(), {}};
}

FrameReport decode_report(std::string_view payload) {
  const auto message = parse<v1::FrameReport>(payload);
  FrameReport report;
#define X(field) report.field = message.field();
  DMISE_REPORT_FIELDS(X)
#undef X
  report.excluded = {message.sun_excludes(), message.moon_excludes(),
                     message.earth_limb_excludes()};
  report.start = {message.start_ns()};
  report.middle = {message.middle_ns()};
  report.end = {message.end_ns()};
  if (!v1::MagnitudeSystem_IsValid(message.magnitude_system()))
    throw Refused(Refusal::value, "magnitude_system: unknown");
  report.magnitudes = {static_cast<MagnitudeSystem>(message.magnitude_system()),
                       message.solar_colour_mag()};
  report.wcs = take_wcs(message.wcs());
  report.sensor_position_m = take_vec<Gcrs>(message.sensor_position_m(), "sensor_position_m");
  report.sensor_velocity_m_per_s =
      take_vec<Gcrs>(message.sensor_velocity_m_per_s(), "sensor_velocity_m_per_s");
  return report;
}

}  // namespace dmise
