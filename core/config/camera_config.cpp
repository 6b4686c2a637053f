#include "core/config/camera_config.h"

#include <cmath>

#include "core/base/units.h"
#include "core/config/search_path.h"

namespace dmise {
namespace {

Projection projection_named(const std::string& name) {
  if (name == "equidistant") return Projection::equidistant;
  if (name == "equisolid") return Projection::equisolid;
  if (name == "stereographic") return Projection::stereographic;
  return Projection::gnomonic;
}

/// Focal length that spreads a full field of `field_rad` over `width_m`.
double focal_length_for(Projection projection, double width_m, double field_rad) {
  const double half = field_rad / 2;
  switch (projection) {
    case Projection::gnomonic: return width_m / 2 / std::tan(half);
    case Projection::equidistant: return width_m / 2 / half;
    case Projection::equisolid: return width_m / 2 / (2 * std::sin(half / 2));
    case Projection::stereographic: return width_m / 2 / (2 * std::tan(half / 2));
  }
  return 0.0;
}

Optics read_optics(const YamlValue& value) {
  YamlMap map(value);
  Optics optics;
  if (const auto projection = map.find("projection"))
    optics.projection = projection_named(
        projection->choice({"gnomonic", "equidistant", "equisolid", "stereographic"}));
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
    const double most = optics.projection == Projection::gnomonic ? 170.0 : 220.0;
    const double field_deg = field->number({.least = 0.0, .most = most, .least_open = true});
    optics.focal_length_m = focal_length_for(optics.projection, width_m, field_deg * deg);
  }
  optics.aperture_m = map.number("aperture_m", Bounds::positive());
  optics.obscuration = map.number_or("obscuration", 0.0, Bounds::between(0.0, 0.99));
  optics.transmission =
      map.number_or("transmission", 1.0, {.least = 0.0, .most = 1.0, .least_open = true});
  optics.psf_fwhm_px = map.number_or("psf_fwhm_px", 1.5, Bounds::between(0.3, 50.0));
  optics.equivalent_aperture = map.flag_or("equivalent_aperture", false);
  map.done();
  if (optics.focal_length_m < 0.5 * optics.aperture_m && !optics.equivalent_aperture)
    value.fail("focal ratio is below 0.5, which no lens reaches; "
               "equivalent_aperture: true takes the aperture as a collecting area", false);
  return optics;
}

Detector read_detector(const YamlValue& value) {
  YamlMap map(value);
  Detector d;
  d.quantum_efficiency =
      map.number_or("quantum_efficiency", 1.0, {.least = 0.0, .most = 1.0, .least_open = true});
  d.dark_e_per_s = map.number_or("dark_e_per_s", 0.0, Bounds::between(0.0, 1e9));
  d.read_noise_e = map.number_or("read_noise_e", 0.0, Bounds::between(0.0, 1e6));
  d.full_well_e = map.number("full_well_e", {.least = 0.0, .most = 1e9, .least_open = true});
  d.gain_e_per_dn = map.number("gain_e_per_dn", {.least = 0.0, .most = 1e6, .least_open = true});
  d.bias_dn = map.number_or("bias_dn", 0.0, Bounds::between(0.0, 65535.0));
  if (const auto bits = map.find("adc_bits"))
    d.adc_bits = static_cast<int>(bits->integer(1, 16));
  map.done();
  return d;
}

Band read_band(const YamlValue& value) {
  YamlMap map(value);
  Band band;
  band.name = map.text_or("name", "V");
  band.centre_m = map.number("centre_m", Bounds::between(0.1e-6, 30e-6));
  band.width_m =
      map.number("width_m", {.least = 0.0, .most = 2 * band.centre_m, .least_open = true});
  map.done();
  return band;
}

}  // namespace

Camera read_camera(const YamlValue& value) {
  if (value.is_scalar()) {
    const std::string path = find_preset("cameras", value.text(), value.file());
    if (path.empty()) {
      const auto names = preset_names("cameras");
      const std::string hint = nearest_name(value.text(), names);
      std::string all;
      for (const auto& name : names) all += (all.empty() ? "" : ", ") + name;
      value.fail("no such camera" + (hint.empty() ? "" : ", did you mean " + hint + "?") +
                 " (a path to a YAML file, or one of " + all + ")");
    }
    return read_camera(YamlValue::load(path));
  }
  YamlMap map(value);
  Camera camera;
  camera.name = map.text_or("name", "camera");
  map.find("source");  // for people
  camera.optics = read_optics(map.require("optics"));
  camera.detector = read_detector(map.require("detector"));
  camera.band = read_band(map.require("band"));
  map.done();
  return camera;
}

}  // namespace dmise
