#include "core/config/sensors/field_tables_config.h"

#include <optional>
#include <string>
#include <vector>

#include "core/base/files/text_fields.h"
#include "core/base/formatted.h"
#include "core/config/yaml/bound_key.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/optics/waves/pupil.h"

namespace dmise {
namespace {

constexpr double widest_deg = 180.0, widest_px = 1e6, widest_fwhm_px = 200.0, max_nm = 1e5;
constexpr std::size_t max_radii = 1000;

Forms widths() { return form::list(form::number(0.3, widest_fwhm_px)); }

std::vector<Key> radius_keys() {
  return {optional("radius_deg", form::list(form::number(0.0, widest_deg)),
                   "Angles from the boresight [deg], rising."),
          optional("radius_px", form::list(form::number(0.0, widest_px)),
                   "Distances from the middle of the frame [px], in place of the angles.")};
}

const Section& field_zernike_section() {
  static const Section section{
      "field_zernike_nm",
      "Aberrations by the distance from the axis: the index of a Zernike term and its rms of "
      "optical "
      "path at each radius. Theta of a term is from the radius outwards.",
      {},
      required("^([2-9]|[1-5][0-9]|6[0-6])$", form::list(form::number(-max_nm, max_nm)),
               "Noll's index of the term, 2 to 66, and its rms at each radius [nm]. Terms 2 and 3 "
               "are the tilt by which light is beside the chief ray.")};
  return section;
}

std::vector<double> rising_numbers_in(const YamlValue& list) {
  std::vector<double> numbers = list.numbers();
  for (std::size_t i = 1; i < numbers.size(); ++i)
    if (!(numbers[i] > numbers[i - 1])) list.list()[i].fail("must rise");
  return numbers;
}

/// A column of a table, beside one of `rows` numbers that is named `beside`.
std::vector<double> column_in(const YamlValue& list, std::size_t rows, const char* beside) {
  std::vector<double> column = list.numbers();
  if (column.size() != rows)
    list.fail("must have a number for each of the " + std::to_string(rows) + " of " + beside +
                  ", has " + std::to_string(column.size()),
              false);
  return column;
}

/// The places of a table, which rise.
struct Radii {
  FieldRadius unit = FieldRadius::angle_deg;
  std::vector<double> at;
};
Radii read_radii(YamlMap& map) {
  const auto degrees = map.find("radius_deg"), pixels = map.find("radius_px");
  if (bool(degrees) == bool(pixels))
    map.value().fail("needs one of radius_deg and radius_px", false);
  const YamlValue& list = degrees ? *degrees : *pixels;
  const Radii radii{degrees ? FieldRadius::angle_deg : FieldRadius::distance_px,
                    rising_numbers_in(list)};
  if (radii.at.empty()) list.fail("needs a radius", false);
  if (radii.at.size() > max_radii) list.fail("must have at most 1000 radii", false);
  return radii;
}

MonotoneCubic read_column(const YamlValue& list, const Radii& radii) {
  return {radii.at, column_in(list, radii.at.size(), name(radii.unit))};
}

}  // namespace

int noll_index(const std::string& key, int least, const YamlValue& value) {
  constexpr int most = 66;
  const auto noll = parse_integer(key);
  if (!noll || key.starts_with('+') || *noll < least || *noll > most)
    value.fail("the key must be Noll's index of a Zernike term, " + std::to_string(least) + ".." +
                   std::to_string(most),
               false);
  return *noll;
}

const Section& vignetting_section() {
  static const Section section{
      "vignetting", "Light lost away from the axis.",
      with_keys(
          {bound<&Vignetting::natural>("natural", form::flag(),
                                       "Applies the cosine of the pupil's projection."),
           bound<&Vignetting::corner>("corner", form::above(0.0, 1.0),
                                      "Share of the light that reaches a corner."),
           bound<&Vignetting::power>(
               "power", form::number(1.0, 16.0),
               "Power of the distance from the axis with which light is lost.")},
          with_keys(radius_keys(),
                    {optional("relative_illumination", form::list(form::number(0.0, 1.0)),
                              "A measured lens, in place of `natural`, `corner` and `power`: light "
                              "at each radius, relative to that of the axis. It is smooth and "
                              "monotone between, and constant beyond the ends.")}))};
  return section;
}

Vignetting read_vignetting(const YamlValue& value) {
  YamlMap map(value, vignetting_section());
  Vignetting v;
  const auto illumination = map.find("relative_illumination");
  if (illumination) {
    for (const char* key : {"natural", "corner", "power"})
      if (const auto other = map.find(key))
        other->fail("can't stand beside relative_illumination, which includes it", false);
    const Radii radii = read_radii(map);
    if (radii.at.size() < 2) illumination->fail("needs two radii or more", false);
    v.table = read_column(*illumination, radii);
    v.table_radius = radii.unit;
  } else {
    for (const char* key : {"radius_deg", "radius_px"})
      if (const auto radius = map.find(key)) radius->fail("needs relative_illumination", false);
  }
  read_bound(map, v);
  map.done();
  return v;
}

const Section& psf_field_section() {
  static const Section section{
      "psf_field",
      "A point spread that changes with the distance from the axis: widths with `psf: gaussian`, "
      "aberrations with `psf: diffraction`. Smooth and monotone between the radii, constant beyond "
      "their ends.",
      with_keys(radius_keys(),
                {optional("fwhm_radial_px", widths(),
                          "Full width at half maximum along the radius [px], before diffraction; "
                          "in place of `psf_fwhm_px`."),
                 optional("fwhm_tangential_px", widths(),
                          "The same across the radius; as along it if not given."),
                 optional("zernike_nm", form::map(field_zernike_section),
                          "Aberrations, in addition to those of the whole field.")})};
  return section;
}

FieldBlur read_psf_field(const YamlValue& value, bool diffraction) {
  YamlMap map(value, psf_field_section());
  FieldBlur field;
  const Radii radii = read_radii(map);
  field.radius = radii.unit;
  const auto radial = map.find("fwhm_radial_px"), tangential = map.find("fwhm_tangential_px"),
             zernike = map.find("zernike_nm");
  if (zernike && !diffraction) zernike->fail("goes with psf: diffraction", false);
  for (const auto& width : {radial, tangential})
    if (width && diffraction) width->fail("goes with psf: gaussian", false);
  if (diffraction && !zernike) value.fail("needs zernike_nm", false);
  if (!diffraction && !radial) value.fail("needs fwhm_radial_px", false);
  const bool on_axis = radii.at.front() == 0.0;
  if (radial) {
    field.fwhm_radial_px = read_column(*radial, radii);
    field.fwhm_tangential_px = tangential ? read_column(*tangential, radii) : field.fwhm_radial_px;
    if (on_axis && field.fwhm_radial_px.value()[0] != field.fwhm_tangential_px.value()[0])
      tangential->list()[0].fail("must be that of fwhm_radial_px on the axis");
  }
  if (zernike) {
    YamlMap terms(*zernike, field_zernike_section());
    for (const std::string& key : terms.keys()) {
      const YamlValue rms = terms.require(key);
      const int noll = noll_index(key, 2, rms);
      const MonotoneCubic nm = read_column(rms, radii);
      if (on_axis && noll_orders(noll)[1] != 0 && nm.value()[0] != 0.0)
        rms.list()[0].fail("must be 0 on the axis, which has no direction");
      std::vector<double> rms_m = nm.value();
      for (double& number : rms_m) number *= 1e-9;
      field.wavefront.push_back({noll, {radii.at, std::move(rms_m)}});
    }
    terms.done();
    if (field.wavefront.empty()) zernike->fail("needs a term", false);
  }
  map.done();
  return field;
}

const Section& focus_drift_section() {
  static const Section section = [] {
    Section made{"focus_drift",
                 "The detector leaves the focus with time and with the daily swing of the "
                 "temperature. The blur is that of the defocus in the middle of each exposure.",
                 {}};
    for (const FocusParameter& p : focus_parameters())
      made.keys.push_back(optional(std::string(p.key), form::number(p.least, p.most),
                                   sentence_of(p.meaning), shortest_text(FocusDrift().*p.value)));
    return made;
  }();
  return section;
}

FocusDrift read_focus_drift(const YamlValue& value) {
  YamlMap map(value, focus_drift_section());
  FocusDrift drift;
  for (const FocusParameter& p : focus_parameters()) drift.*p.value = map.number(p.key);
  map.done();
  return drift;
}

const Section& stray_light_section() {
  static const Section section{
      "stray_light",
      "Point source transmittance of the optics, against the angle from the boresight.",
      {required("angle_deg", form::list(form::number(0.0, 180.0), 1),
                "Angles of a source from the boresight [deg], rising."),
       required("transmittance", form::list(form::number(0.0, 1.0), 1),
                "Irradiance of the focal plane over that of the aperture, at each angle.")}};
  return section;
}

StrayLight read_stray_light(const YamlValue& value) {
  YamlMap map(value, stray_light_section());
  StrayLight stray;
  const YamlValue angles = map.require("angle_deg");
  stray.angle_deg = rising_numbers_in(angles);
  if (!stray.any()) angles.fail("needs an angle", false);
  stray.transmittance =
      column_in(map.require("transmittance"), stray.angle_deg.size(), "angle_deg");
  map.done();
  return stray;
}

void write_field_tables_json(JsonWriter& json, const Optics& optics) {
  const auto write = [&](const MonotoneCubic& table) {
    for (const double x : table.at()) json.value(x);
    for (const double y : table.value()) json.value(y);
  };
  if (const FieldBlur& field = optics.spread.varying; field.any()) {
    json.key("psf_field").begin_object().field("radius", int(field.radius));
    json.key("fwhm_px").begin_array();
    write(field.fwhm_radial_px);
    write(field.fwhm_tangential_px);
    json.end_array().key("wavefront").begin_array();
    for (const FieldTerm& t : field.wavefront) {
      json.value(t.noll);
      write(t.rms_m);
    }
    json.end_array().end_object();
  }
  if (const FocusDrift& drift = optics.spread.drift; drift.any()) {
    json.key("focus_drift").begin_object();
    for (const FocusParameter& p : focus_parameters()) json.field(p.key, drift.*p.value);
    json.end_object();
  }
  if (const Vignetting& v = optics.vignetting; !v.table.empty()) {
    json.key("relative_illumination").begin_array().value(int(v.table_radius));
    write(v.table);
    json.end_array();
  }
  if (const StrayLight& stray = optics.stray_light; stray.any()) {
    json.key("stray_light").begin_object().list("angle_deg", stray.angle_deg);
    json.list("transmittance", stray.transmittance).end_object();
  }
}

}  // namespace dmise
