#include <cmath>

#include "core/base/files/json.h"
#include "core/config/fusion_config.h"
#include "core/config/scenario.h"
#include "core/config/sensors/effect_list.h"
#include "core/config/sensors/exclusion_config.h"
#include "core/config/sensors/instrument_config.h"
#include "core/config/sensors/optics_config.h"
#include "core/config/sensors/pointing_config.h"
#include "core/config/surroundings_json.h"

namespace dmise {
namespace {

struct PlaceWriter {
  JsonWriter& json;
  void operator()(const SiteConfig& site) const {
    json.key("site").begin_object();
    json.field("latitude_deg", site.latitude_deg).field("longitude_deg", site.longitude_deg);
    json.field("height_m", site.height_m).end_object();
  }
  void operator()(const PlatformConfig& platform) const { json.field("platform", platform.object); }
};

void write_camera(JsonWriter& json, const Camera& camera) {
  const auto& o = camera.optics;
  const auto& d = camera.detector;
  json.key("camera").begin_object().field("name", camera.name);
  json.field("projection", o.projection.index());
  if (const auto coefficients = o.projection.coefficients(); !coefficients.empty())
    json.list("distortion", coefficients);
  json.field("focal_length_m", o.focal_length_m);
  json.field("aperture_m", o.aperture_m).field("obscuration", o.obscuration);
  json.field("pixel_pitch_m", o.pixel_pitch_m).field("columns", o.columns).field("rows", o.rows);
  json.field("transmission", o.transmission).field("psf_fwhm_px", o.psf_fwhm_px);
  write_optics_json(json, o);
  for (const auto& p : detector_parameters())
    if (p.key != "adc_bits" && (in_every_header(p) || p.number_of(d) != p.number_of({})))
      std::visit([&](auto member) { json.field(p.key, d.*member); }, p.value);
  json.field("adc_bits", d.adc_bits).field("band", camera.band.name);
  json.field("band_centre_m", camera.band.centre_m).field("band_width_m", camera.band.width_m);
  write_curve(json, "band_response", camera.band.response);
  if (!camera.filters.empty()) {
    json.key("filters").begin_array();
    for (const Filter& filter : camera.filters) {
      json.begin_object().field("name", filter.band.name).field("centre_m", filter.band.centre_m);
      json.field("width_m", filter.band.width_m);
      write_curve(json, "response", filter.band.response);
      json.end_object();
    }
    json.end_array();
  }
  if (camera.magnitudes.system != MagnitudeSystem::v_solar)
    json.field("magnitude_system", magnitude_system_name(camera.magnitudes.system))
        .field("solar_colour_mag", camera.magnitudes.solar_colour_mag);
  write_exclusion_json(json, camera.exclusion);
  json.end_object();
}

void write_own_sensor(JsonWriter& json, const SensorConfig& s) {
  json.field("node", s.observing->node).field("truth", s.observing->truth);
  json.field("half_angle_deg", s.observing->half_angle_deg);
  json.field("exposure_s", s.exposure_s).field("cadence_s", s.cadence_s);
  json.field("first_exposure_s", s.first_exposure_s).end_object();
}

void write_sensor(JsonWriter& json, const SensorConfig& s) {
  json.begin_object().field("name", s.name);
  std::visit(PlaceWriter{json}, s.place);
  if (!s.is_camera()) return write_own_sensor(json, s);
  write_camera(json, s.camera);
  json.key("pointing");
  write_pointing(json, s.pointing);
  json.field("tracking", static_cast<int>(s.tracking)).field("roll_deg", s.roll_deg);
  json.field("exposure_s", s.exposure_s).field("cadence_s", s.cadence_s);
  json.field("first_exposure_s", s.first_exposure_s);
  write_instrument_json(json, s.instrument);
  write_surroundings(json, s);
  if (s.seeing) write_seeing_json(json, *s.seeing);
  json.list("effects", effects_in_digest(s.effects));
  if (s.accuracy.is_planned()) {
    json.key("accuracy").begin_object();
    if (s.accuracy.name == "seconds")
      json.field("seconds_per_frame", s.accuracy.seconds_per_frame);
    else
      for (const auto& kind : error_kinds) json.field(kind.key, s.accuracy.budget.*kind.value);
    json.end_object();
  }
  if (s.effects.snapshots() > 0) json.field("snapshots", s.effects.snapshots());
  if (!s.detect) json.field("detection", false);
  if (s.light_curves) json.field("light_curves", true);
  if (s.detector) json.field("detector", s.detector->node);
  if (!s.recorded_plans.empty()) {
    json.key("recorded_plans").begin_object();
    for (const auto& [frame, levels] : s.recorded_plans) {
      json.key(std::to_string(frame)).begin_object();
      for (const auto& [effect, level] : levels) json.field(effect, level);
      json.end_object();
    }
    json.end_object();
  }
  if (s.effects.drawn_by_opengl()) json.field("evaluator", "opengl");
  json.end_object();
}

}  // namespace

std::string physics_json(const Scenario& scenario) {
  JsonWriter json;
  json.begin_object().key("simulation").begin_object();
  json.field("start", scenario.start_utc).field("duration_ns", scenario.duration.ns);
  json.field("tick_ns", scenario.tick.ns).field("seed", scenario.seed);
  json.field("interpolation", static_cast<int>(scenario.interpolation));
  write_earth(json, scenario.earth);
  json.end_object();
  write_objects(json, scenario.objects, scenario.own_objects);
  json.key("environment").begin_object();
  json.field("common_every_s", scenario.environment.common_every_s);
  json.field("site_every_s", scenario.environment.site_every_s).end_object();
  json.key("stars").begin_object().field("catalogue", scenario.star_catalogue_named);
  json.field("faintest_mag", scenario.faintest_star_mag);
  if (const auto& to_v_mag = scenario.synthetic_stars_to_v_mag; to_v_mag && std::isinf(*to_v_mag))
    json.field("synthetic_to", "limit");
  else if (to_v_mag)
    json.field("synthetic_to", *to_v_mag);
  if (!scenario.star_variables_path.empty()) json.field("variables", true);
  json.end_object();
  json.key("sensors").begin_array();
  for (const auto& sensor : scenario.sensors) write_sensor(json, sensor);
  json.end_array();
  if (scenario.fusion) write_fusion(json, *scenario.fusion);
  if (!scenario.own_nodes.empty()) write_own_nodes(json, scenario.own_nodes);
  return json.end_object().take();
}

}  // namespace dmise
