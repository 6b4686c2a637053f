#include "core/detection/detection_json.h"

#include <array>
#include <initializer_list>
#include <string_view>

#include "core/base/json.h"
#include "core/base/units.h"
#include "core/detection/unknown_fields.h"
#include "core/photometry/magnitude_system.h"
#include "core/products/detection_fields.h"
#include "core/products/field_value.h"
#include "core/products/frame_report.h"
#include "core/wcs/wcs.h"

namespace dmise {
namespace {

const char* name_of(DetectionKind kind) { return detection_kind_name(kind); }
const char* name_of(ExposureEpoch epoch) { return exposure_epoch_name(epoch); }
const char* name_of(MagnitudeSystem system) { return magnitude_system_name(system); }

/// Writes keys of common forms.
class Line {
 public:
  explicit Line(const UtcText& utc, const UnknownFacts& unknown = {})
      : utc_(utc), unknown_(unknown) {
    json_.begin_object();
  }

  template <class T>
  Line& field(std::string_view name, const T& value) {
    return is_unknown(name, unknown_) ? null(name) : known_field(name, value);
  }
  /// null if it was not measured.
  template <class T>
  Line& measured(std::string_view name, const T& value, bool was) {
    return was ? field(name, value) : null(name);
  }
  Line& angle(std::string_view name, double value_rad) { return field(name, value_rad / deg); }
  /// "NAME_ns" and "NAME_utc".
  Line& time(const std::string& name, SimTime value) {
    field(name + "_ns", value.ns);
    return is_unknown(name + "_utc", unknown_) ? null(name + "_utc")
                                               : known_field(name + "_utc", utc_(value));
  }
  template <class Values = std::initializer_list<double>>
  Line& array(std::string_view name, const Values& values, double unit = 1.0) {
    if (is_unknown(name, unknown_)) return null(name);
    json_.key(name).begin_array();
    for (const double v : values) json_.value(v / unit);
    json_.end_array();
    return *this;
  }
  Line& vector(std::string_view name, const Vec<Gcrs>& v) { return array(name, {v.x, v.y, v.z}); }
  Line& notes(const FrameNotes& n) {
    if (!n.missing.empty()) json_.list("missing", n.missing);
    if (!n.assumed.empty()) json_.list("assumed", n.assumed);
    return *this;
  }
  Line& wcs(const Wcs& w) {
    if (is_unknown("wcs", unknown_)) return null("wcs");
    json_.key("wcs").begin_object();
    json_.field("projection",
                w.projection.row().fits_code + std::string(w.order > 0 ? "-SIP" : ""));
    coefficients(w.projection);
    array("crpix_px", {w.crpix_x, w.crpix_y});
    array("crval_deg", {w.ra_rad / deg, w.dec_rad / deg});
    array("cd_deg_per_px", w.cd_deg);
    json_.field("order", w.order);
    if (w.order > 0) {
      array("a", w.a);
      array("b", w.b);
      array("ap", w.ap);
      array("bp", w.bp);
    }
    if (w.refraction) {
      const WcsRefraction& air = *w.refraction;
      json_.key("refraction").begin_object();
      array("zenith", {air.zenith.x, air.zenith.y, air.zenith.z});
      json_.field("focal_length_px", air.focal_length_px);
      if (air.lens) {
        json_.field("lens", air.lens->name());
        coefficients(*air.lens);
      }
      json_.field("pressure_hpa", air.pressure_hpa);
      json_.field("temperature_c", air.temperature_c);
      json_.field("humidity", air.humidity);
      json_.field("wavelength_um", air.wavelength_um);
      array("offset_px", {air.offset_x_px, air.offset_y_px});
      json_.field("cell_px", air.cell_px);
      json_.end_object();
    }
    json_.field("rms_px", w.rms_px);
    json_.field("max_px", w.max_px);
    json_.end_object();
    return *this;
  }
  std::string end() { return json_.end_object().take(); }

 private:
  template <class T>
  Line& known_field(std::string_view name, const T& value) {
    json_.field(name, value);
    return *this;
  }
  Line& null(std::string_view name) {
    json_.key(name).null();
    return *this;
  }
  void coefficients(const Projection& projection) {
    const auto names = projection.row().coefficients;
    for (std::size_t i = 0; i < names.size(); ++i)
      json_.field(names[i].key, projection.coefficients()[i]);
  }

  JsonWriter json_;
  const UtcText& utc_;
  const UnknownFacts unknown_;
};

}  // namespace

const char* detection_kind_name(DetectionKind kind) {
  return kind == DetectionKind::streak ? "streak" : "point";
}

const char* exposure_epoch_name(ExposureEpoch epoch) {
  constexpr const char* names[] = {"start", "middle", "end"};
  return names[std::size_t(epoch)];
}

std::string to_json(const Detection& d, const UtcText& utc, const UnknownFacts& unknown) {
  Line line(utc, unknown);
#define DMISE_VALUE(field_, key, unit) line.field(key, in_unit(d.field_, unit));
#define DMISE_TIME(field_, key) line.time(key, d.field_);
#define DMISE_NAME(field_, key, Enum) line.field(key, name_of(d.field_));
#define DMISE_LIST(field_, key, unit) line.array(key, d.field_, unit);
#define DMISE_VECTOR(field_, key) line.vector(key, d.field_);
#define DMISE_PAIR(x, y, key) line.array(key, {d.x, d.y});
#define DMISE_TEXT(key, value) line.field(key, value);
#define DMISE_WHERE(field_, key) \
  if (d.field_) line.field(key, true);
#define DMISE_MEASURED(field_, key) \
  if (d.field_) line.field(key, *d.field_);
  DMISE_DETECTION_FIELDS(DMISE_VALUE, DMISE_TIME, DMISE_NAME, DMISE_LIST, DMISE_VECTOR, DMISE_PAIR,
                         DMISE_TEXT, DMISE_WHERE, DMISE_MEASURED)
#undef DMISE_VALUE
#undef DMISE_TIME
#undef DMISE_NAME
#undef DMISE_LIST
#undef DMISE_VECTOR
#undef DMISE_PAIR
#undef DMISE_TEXT
#undef DMISE_WHERE
#undef DMISE_MEASURED
  return line.end();
}

std::string to_json(const FrameReport& r, const UtcText& utc, const UnknownFacts& unknown) {
  Line line(utc, unknown);
  line.field("sensor", r.sensor).field("frame", r.frame);
  line.time("start", r.start).time("middle", r.middle).time("end", r.end);
  line.angle("boresight_ra_deg", r.boresight_ra_rad)
      .angle("boresight_dec_deg", r.boresight_dec_rad);
  line.wcs(r.wcs);
  line.vector("sensor_position_gcrs_m", r.sensor_position_m);
  line.vector("sensor_velocity_gcrs_m_per_s", r.sensor_velocity_m_per_s);
  const bool measured = !r.detection_off;
  if (!measured) line.field("detection_off", true);
  const std::pair<const char*, bool> rare[] = {{"shutter_closed", r.shutter_closed},
                                               {"sun_excludes", r.excluded.sun},
                                               {"moon_excludes", r.excluded.moon},
                                               {"earth_limb_excludes", r.excluded.earth_limb}};
  for (const auto& [name, is] : rare)
    if (is) line.field(name, true);
  line.measured("limiting_magnitude", r.limiting_magnitude,
                measured && r.limiting_magnitude != 0.0);
  line.measured("background_e", r.background_e, measured);
  line.measured("noise_e", r.noise_e, measured).field("zero_point_mag", r.zero_point_mag);
  line.field("magnitude_system", name_of(r.magnitudes.system));
  if (r.magnitudes.system != MagnitudeSystem::v_solar)
    line.field("solar_colour_mag", r.magnitudes.solar_colour_mag);
  line.measured("psf_fwhm_px", r.psf_fwhm_px, measured);
  line.measured("psf_stars", r.psf_stars, measured);
  line.measured("stars_expected", r.stars_expected, measured);
  line.measured("stars_found", r.stars_found, measured);
  line.field("detections", r.detections).measured("star_like", r.star_like, measured);
  line.measured("saturated_px", r.saturated_px, measured);
  line.field("stars_rendered", r.stars_rendered).field("objects_rendered", r.objects_rendered);
  line.field("plan", r.plan).notes(r.notes);
  return line.end();
}

std::string to_json(const Truth& t, const UtcText& utc) {
  Line line(utc);
  line.field("sensor", t.sensor).field("frame", t.frame);
  line.field("catalogue_number", t.catalogue_number).field("name", t.name);
  line.time("start", t.start).time("middle", t.middle).time("end", t.end);
  line.vector("true_position_gcrs_m", t.true_position_m);
  line.vector("true_velocity_gcrs_m_per_s", t.true_velocity_m_per_s);
  line.field("true_range_m", t.true_range_m);
  line.angle("true_ra_deg", t.true_ra_rad).angle("true_dec_deg", t.true_dec_rad);
  line.angle("apparent_ra_deg", t.apparent_ra_rad).angle("apparent_dec_deg", t.apparent_dec_rad);
  line.angle("true_elevation_deg", t.true_elevation_rad)
      .angle("phase_angle_deg", t.phase_angle_rad);
  line.field("sunlit", t.sunlit).field("true_magnitude", t.true_magnitude);
  line.field("magnitude_system", name_of(MagnitudeSystem::v_solar));
  line.field("rendered_signal_e", t.rendered_signal_e);
  const std::array<double, 2> rendered_px{t.rendered_x_px, t.rendered_y_px};
  t.rendered_signal_e > 0.0 ? line.array("rendered_px", rendered_px)
                            : line.measured("rendered_px", 0.0, false);
  line.array("start_px", {t.start_x_px, t.start_y_px});
  line.array("middle_px", {t.middle_x_px, t.middle_y_px});
  line.array("end_px", {t.end_x_px, t.end_y_px});
  line.field("in_frame", t.in_frame).field("whole", t.whole).field("resolved", t.resolved);
  if (const auto& q = t.camera_from_gcrs) line.array("camera_from_gcrs", {q->w, q->x, q->y, q->z});
  return line.end();
}

}  // namespace dmise
