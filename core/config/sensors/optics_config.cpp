#include "core/config/sensors/optics_config.h"

#include <algorithm>
#include <cmath>

#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/base/units.h"
#include "core/config/sensors/field_tables_config.h"
#include "core/config/sensors/point_spread_config.h"
#include "core/config/sensors/thermal_optics_config.h"
#include "core/config/yaml/bound_key.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/optics/projection.h"

namespace dmise {
namespace {

const Section& distortion_section() {
  static const Section section = [] {
    Section made{"distortion", "Calibrated coefficients of a lens, by its projection.", {}};
    for (const Projection::Row& row : Projection::rows())
      for (const ProjectionCoefficient& k : row.coefficients) {
        std::string what = sentence_of(k.comment);
        what.insert(what.size() - 1, ", " + shortest_text(-k.most) + " to " +
                                         shortest_text(k.most) + " with `" + row.name + "`");
        const auto known = std::find_if(made.keys.begin(), made.keys.end(),
                                        [&](const Key& key) { return key.name == k.key; });
        if (known == made.keys.end()) {
          made.keys.push_back(optional(k.key, form::number(-k.most, k.most), what, "0"));
          continue;
        }
        known->what += " " + what;
        Bounds& bounds = known->forms[0].bounds;
        bounds = Bounds::between(std::min(bounds.least, -k.most), std::max(bounds.most, k.most));
      }
    return made;
  }();
  return section;
}

/// Lengths that leave all that is computed from them finite.
Forms length() { return form::number(1e-12, 1e6); }

std::vector<std::string> projection_names() {
  std::vector<std::string> names;
  for (const Projection::Row& row : Projection::rows()) names.push_back(row.name);
  return names;
}

// projection: a row of the table; distortion: {COEFFICIENT: value, ...} of one that has some.
Projection read_projection(YamlMap& map) {
  const auto named = map.find("projection"), distortion = map.find("distortion");
  std::vector<std::string> distorted;
  for (const Projection::Row& row : Projection::rows())
    if (!row.coefficients.empty()) distorted.push_back(row.name);
  const std::size_t index = named ? *Projection::index_of_name(named->choice()) : 0;
  const auto wanted = Projection::rows()[index].coefficients;
  std::vector<double> values(wanted.size(), 0.0);
  if (distortion) {
    if (wanted.empty())
      distortion->fail("goes with projection: " + joined(distorted, " or "), false);
    YamlMap coefficients(*distortion, distortion_section());
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (const auto value = coefficients.find(wanted[i].key))
        values[i] = value->number(Bounds::between(-wanted[i].most, wanted[i].most));
    coefficients.done();
  }
  return Projection::make(index, values);
}

[[noreturn]] void fail_fold(const YamlValue& optics, double fold_rad) {
  optics.fail(formatted("distortion: the image folds back at %.4g deg from the boresight, within "
                        "the frame",
                        fold_rad / deg),
              false);
}

/// Changes the focal length, right for radial distortion alone, so that the field across the
/// columns is `field_rad`. Returns whether the lens images such a field.
bool fit_focal_length(Optics& optics, double field_rad) {
  const auto too_wide = [&] {
    return field_across_rad(optics, optics.columns / 2.0, 0.0) - field_rad;
  };
  if (std::abs(too_wide()) <= 1e-9 * field_rad) return true;
  double least = std::log(optics.focal_length_m / 64), most = std::log(optics.focal_length_m * 64);
  for (int halving = 0; halving < 60; ++halving) {
    optics.focal_length_m = std::exp((least + most) / 2);
    (too_wide() > 0.0 ? least : most) = (least + most) / 2;
  }
  return std::abs(too_wide()) <= 1e-6 * field_rad;
}

}  // namespace

const Section& optics_section() {
  static const Section section = [] {
    Section made{
        "optics",
        "The lens or telescope and the geometry of its detector. Either `focal_length_m` or "
        "`field_of_view_deg` is needed.",
        {optional("projection", form::choice(projection_names()), "How directions are imaged.",
                  projection_names().front()),
         optional("distortion", form::map(distortion_section),
                  "Coefficients of a projection that has some."),
         required("columns", form::integer(1, 32768), "Pixels along a row."),
         required("rows", form::integer(1, 32768), "Pixels along a column."),
         required("pixel_pitch_m", length(), "Distance between pixels [m]."),
         optional("focal_length_m", length(), "Focal length [m]."),
         optional("field_of_view_deg", form::above(0.0, 360.0),
                  "Field across the columns [deg], in place of the focal length. The projection "
                  "limits it further."),
         required("aperture_m", length(), "Diameter of the entrance pupil [m]."),
         bound<&Optics::obscuration>("obscuration", form::number(0.0, 0.99),
                                     "Diameter of the secondary in that of the primary."),
         bound<&Optics::transmission>(
             "transmission", form::above(0.0, 1.0),
             "Share of the light that passes the optics, without filter and obscuration.")}};
    const auto add = [&](std::vector<Key> keys) {
      made.keys.insert(made.keys.end(), keys.begin(), keys.end());
    };
    add(point_spread_keys());
    add({optional("vignetting", form::map(vignetting_section), "Light lost away from the axis."),
         optional("stray_light", form::map(stray_light_section),
                  "Light of Sun, Moon and Earth beside the field on the focal plane."),
         optional("emission", form::map(thermal_optics_section),
                  "Heat of the telescope and the window, in bands beyond 1.9 um."),
         bound<&Optics::equivalent_aperture>(
             "equivalent_aperture", form::flag(),
             "Takes the aperture as a collecting area, which allows focal ratios below 0.5.")});
    for (const ImageParameter& p : image_parameters())
      made.keys.push_back(optional(std::string(p.key), form::number(p.least, p.most),
                                   sentence_of(p.meaning), shortest_text(ImageOptics().*p.value)));
    return made;
  }();
  return section;
}

Optics read_optics(const YamlValue& value) {
  YamlMap map(value, optics_section());
  Optics optics;
  optics.projection = read_projection(map);
  optics.columns = static_cast<int>(map.require("columns").integer());
  optics.rows = static_cast<int>(map.require("rows").integer());
  optics.pixel_pitch_m = map.number("pixel_pitch_m");
  const double width_m = optics.columns * optics.pixel_pitch_m;
  const auto focal = map.find("focal_length_m");
  const auto field = map.find("field_of_view_deg");
  if (bool(focal) == bool(field))
    value.fail("needs either focal_length_m or field_of_view_deg (across the columns)", false);
  if (focal) {
    optics.focal_length_m = focal->number();
  } else {
    const double most = std::round(optics.projection.row().widest_field_rad / deg);
    const double field_deg = field->number(Bounds::above(0.0, most));
    const double half_rad = field_deg * deg / 2;
    const auto fold = optics.projection.fold_rad();
    if (fold && half_rad >= *fold) fail_fold(value, *fold);
    optics.focal_length_m = width_m / 2 / optics.projection.height(half_rad);
    if (!fit_focal_length(optics, field_deg * deg)) fail_fold(value, fold.value_or(half_rad));
  }
  if (const auto fold = fold_in_frame_rad(optics)) fail_fold(value, *fold);
  optics.aperture_m = map.number("aperture_m");
  read_bound(map, optics);
  optics.spread = read_point_spread(map, optics);
  if (const auto vignetting = map.find("vignetting"))
    optics.vignetting = read_vignetting(*vignetting);
  if (const auto stray = map.find("stray_light")) optics.stray_light = read_stray_light(*stray);
  if (const auto warm = map.find("emission")) optics.thermal = read_thermal_optics(*warm);
  for (const ImageParameter& p : image_parameters()) optics.image.*p.value = map.number(p.key);
  map.done();
  if (optics.focal_length_m < 0.5 * optics.aperture_m && !optics.equivalent_aperture)
    value.fail(
        "focal ratio is below 0.5, which no lens reaches; "
        "equivalent_aperture: true takes the aperture as a collecting area",
        false);
  return optics;
}

void write_optics_json(JsonWriter& json, const Optics& optics) {
  write_point_spread_json(json, optics.spread);
  if (const Vignetting& v = optics.vignetting; v.any()) {
    json.key("vignetting").begin_object();
    write_bound(json, vignetting_section(), v);
    json.end_object();
  }
  write_field_tables_json(json, optics);
  write_thermal_optics_json(json, optics.thermal);
  for (const ImageParameter& p : image_parameters())
    if (optics.image.*p.value != ImageOptics().*p.value) json.field(p.key, optics.image.*p.value);
}

void write_seeing_json(JsonWriter& json, const SensorSeeing& s) {
  json.key("seeing").begin_object().field("r0_m", s.r0_m).key("outer_scale_m");
  std::isfinite(s.outer_scale_m) ? json.value(s.outer_scale_m) : json.null();
  json.field("wind_m_per_s", s.wind_m_per_s).field("wind_direction_deg", s.wind_direction_deg);
  json.end_object();
}

}  // namespace dmise
