#include "core/config/optics_config.h"

#include <charconv>
#include <cmath>
#include <cstdio>

#include "core/base/units.h"
#include "core/optics/projection.h"

namespace dmise {
namespace {

// projection: a row of the table; distortion: {COEFFICIENT: value, ...} of one that has some.
Projection read_projection(YamlMap& map) {
  const auto named = map.find("projection"), distortion = map.find("distortion");
  std::vector<std::string_view> names;
  std::string distorted;
  for (const Projection::Row& row : Projection::rows()) {
    names.push_back(row.name);
    if (!row.coefficients.empty())
      distorted += (distorted.empty() ? "" : " or ") + std::string(row.name);
  }
  const std::size_t index = named ? *Projection::index_of_name(named->choice(names)) : 0;
  const auto wanted = Projection::rows()[index].coefficients;
  std::vector<double> values(wanted.size(), 0.0);
  if (distortion) {
    if (wanted.empty()) distortion->fail("goes with projection: " + distorted, false);
    YamlMap coefficients(*distortion);
    for (std::size_t i = 0; i < wanted.size(); ++i)
      values[i] = coefficients.number_or(wanted[i].key, 0.0,
                                         Bounds::between(-wanted[i].most, wanted[i].most));
    coefficients.done();
  }
  return Projection::make(index, values);
}

// {NOLL INDEX: rms in nanometres of path, ...}
std::vector<WavefrontTerm> read_wavefront(const YamlValue& value) {
  YamlMap map(value);
  std::vector<WavefrontTerm> terms;
  for (const std::string& key : map.keys()) {
    const YamlValue rms = map.require(key);
    int noll = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), noll);
    if (error != std::errc() || end != key.data() + key.size() || noll < 4 || noll > 66)
      rms.fail("the key must be Noll's index of a Zernike term, 4..66", false);
    terms.push_back({noll, 1e-9 * rms.number(Bounds::between(-1e5, 1e5))});
  }
  map.done();
  return terms;
}

// psf: gaussian has its width, psf: diffraction the parameters of a pupil; keys of the other are
// refused.
PointSpread read_point_spread(YamlMap& map, Optics& optics) {
  PointSpread s;
  const auto model = map.find("psf");
  const bool diffraction = model && model->choice({"gaussian", "diffraction"}) == "diffraction";
  s.model = diffraction ? PointSpread::Model::diffraction : PointSpread::Model::gaussian;
  const auto width = map.find("psf_fwhm_px");
  if (width && diffraction) width->fail("goes with psf: gaussian");
  if (width) optics.psf_fwhm_px = width->number(Bounds::between(0.3, 50.0));
  const auto of_pupil = [&](const char* key) {
    auto value = map.find(key);
    if (value && !diffraction) value->fail("goes with psf: diffraction", false);
    return value;
  };
  if (const auto v = of_pupil("spiders")) {
    YamlMap vanes(*v);
    s.spiders = int(vanes.require("count").integer(0, 12));
    s.spider_width_m = vanes.number("width_m", Bounds::between(0.0, optics.aperture_m));
    vanes.done();
  }
  if (const auto v = of_pupil("defocus_m")) s.defocus_m = v->number(Bounds::between(-0.1, 0.1));
  const auto jitter_px = of_pupil("jitter_px"), jitter_arcsec = of_pupil("jitter_arcsec");
  if (jitter_px && jitter_arcsec) jitter_px->fail("give one of jitter_px and jitter_arcsec", false);
  if (jitter_px)
    s.jitter_rad = jitter_px->number(Bounds::between(0.0, 100.0)) * optics.pixel_angle_rad();
  if (jitter_arcsec) s.jitter_rad = jitter_arcsec->number(Bounds::between(0.0, 3600.0)) * arcsec;
  if (const auto v = of_pupil("zernike_nm")) s.wavefront = read_wavefront(*v);
  if (const auto v = of_pupil("field_nm")) {
    YamlMap field(*v);
    const auto rms_m = [&](const char* key) {
      return 1e-9 * field.number_or(key, 0.0, Bounds::between(-1e5, 1e5));
    };
    s.field = {.coma_m = rms_m("coma"),
               .astigmatism_m = rms_m("astigmatism"),
               .curvature_m = rms_m("curvature")};
    field.done();
  }
  if (const auto v = of_pupil("psf_grid")) {
    YamlMap grid(*v);
    s.grid_columns = int(grid.require("columns").integer(1, 9));
    s.grid_rows = int(grid.require("rows").integer(1, 9));
    grid.done();
  }
  if (s.field.any() && s.grid_columns * s.grid_rows == 1)
    map.value().fail("field_nm needs a psf_grid of more than one kernel", false);
  if (const auto v = of_pupil("wavelengths")) s.wavelengths = int(v->integer(1, 16));
  if (const auto v = of_pupil("most_screens")) s.most_screens = int(v->integer(1, 1000));
  if (const auto v = map.find("oversampling")) s.oversampling = int(v->integer(1, 16));
  if (const auto v = map.find("support_px")) s.support_px = int(v->integer(2, 256));
  if (const auto v = map.find("method")) {
    const std::string name = v->choice({"auto", "deposit", "direct", "transform"});
    s.method = name == "auto"      ? PointSpread::Method::automatic
               : name == "deposit" ? PointSpread::Method::deposit
               : name == "direct"  ? PointSpread::Method::direct
                                   : PointSpread::Method::transform;
  }
  if (const auto v = map.find("resampling"))
    s.resampling = v->choice({"area", "bilinear"}) == "area" ? PointSpread::Resampling::area
                                                             : PointSpread::Resampling::bilinear;
  return s;
}

Vignetting read_vignetting(const YamlValue& value) {
  YamlMap map(value);
  Vignetting v;
  v.natural = map.flag_or("natural", false);
  v.corner = map.number_or("corner", 1.0, {.least = 0.0, .most = 1.0, .least_open = true});
  v.power = map.number_or("power", 2.0, Bounds::between(1.0, 16.0));
  map.done();
  return v;
}

[[noreturn]] void fail_fold(const YamlValue& optics, double fold_rad) {
  char at[32];
  std::snprintf(at, sizeof at, "%.4g", fold_rad / deg);
  optics.fail("distortion: the image folds back at " + std::string(at) +
                  " deg from the boresight, within the frame",
              false);
}

}  // namespace

Optics read_optics(const YamlValue& value) {
  YamlMap map(value);
  Optics optics;
  optics.projection = read_projection(map);
  optics.columns = static_cast<int>(map.require("columns").integer(1, 32768));
  optics.rows = static_cast<int>(map.require("rows").integer(1, 32768));
  optics.pixel_pitch_m = map.number("pixel_pitch_m", Bounds::positive());
  const double width_m = optics.columns * optics.pixel_pitch_m;
  const auto focal = map.find("focal_length_m");
  const auto field = map.find("field_of_view_deg");
  if (bool(focal) == bool(field))
    value.fail("needs either focal_length_m or field_of_view_deg (across the columns)", false);
  if (focal) {
    optics.focal_length_m = focal->number(Bounds::positive());
  } else {
    const double most = std::round(optics.projection.row().widest_field_rad / deg);
    const double field_deg = field->number({.least = 0.0, .most = most, .least_open = true});
    const double half_rad = field_deg * deg / 2;
    if (const auto fold = optics.projection.fold_rad(); fold && half_rad >= *fold)
      fail_fold(value, *fold);
    optics.focal_length_m = width_m / 2 / optics.projection.height(half_rad);
  }
  if (const auto fold = fold_in_frame_rad(optics)) fail_fold(value, *fold);
  optics.aperture_m = map.number("aperture_m", Bounds::positive());
  optics.obscuration = map.number_or("obscuration", 0.0, Bounds::between(0.0, 0.99));
  optics.transmission =
      map.number_or("transmission", 1.0, {.least = 0.0, .most = 1.0, .least_open = true});
  optics.spread = read_point_spread(map, optics);
  if (const auto vignetting = map.find("vignetting"))
    optics.vignetting = read_vignetting(*vignetting);
  for (const ImageParameter& p : image_parameters())
    optics.image.*p.value =
        map.number_or(p.key, optics.image.*p.value, Bounds::between(p.least, p.most));
  optics.equivalent_aperture = map.flag_or("equivalent_aperture", false);
  map.done();
  if (optics.focal_length_m < 0.5 * optics.aperture_m && !optics.equivalent_aperture)
    value.fail(
        "focal ratio is below 0.5, which no lens reaches; "
        "equivalent_aperture: true takes the aperture as a collecting area",
        false);
  return optics;
}

SensorSeeing read_seeing(const YamlValue& value) {
  YamlMap map(value);
  SensorSeeing s;
  s.r0_m = map.number("r0_m", Bounds::between(1e-3, 1e6));
  if (const auto v = map.find("outer_scale_m"))
    s.outer_scale_m = v->number(Bounds::between(0.1, 1e6));
  s.wind_m_per_s = map.number_or("wind_m_per_s", 10.0, Bounds::between(0.0, 1e4));
  s.wind_direction_deg = map.number_or("wind_direction_deg", 0.0, Bounds::between(-360.0, 360.0));
  map.done();
  return s;
}

void write_optics_json(JsonWriter& json, const Optics& optics) {
  const PointSpread& s = optics.spread;
  if (!(s == PointSpread{})) {
    json.key("spread").begin_object();
    json.field("model", int(s.model)).field("method", int(s.method));
    json.field("resampling", int(s.resampling)).field("oversampling", s.oversampling);
    json.field("support_px", s.support_px).field("wavelengths", s.wavelengths);
    json.field("spiders", s.spiders).field("spider_width_m", s.spider_width_m);
    json.field("defocus_m", s.defocus_m).field("jitter_rad", s.jitter_rad);
    json.key("wavefront").begin_array();
    for (const WavefrontTerm& t : s.wavefront) json.value(t.noll).value(t.rms_m);
    json.end_array();
    json.field("coma_m", s.field.coma_m).field("astigmatism_m", s.field.astigmatism_m);
    json.field("curvature_m", s.field.curvature_m).field("grid_columns", s.grid_columns);
    json.field("grid_rows", s.grid_rows).field("most_screens", s.most_screens).end_object();
  }
  if (const Vignetting& v = optics.vignetting; v.any()) {
    json.key("vignetting").begin_object().field("natural", v.natural);
    json.field("corner", v.corner).field("power", v.power).end_object();
  }
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
