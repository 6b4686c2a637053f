#include "core/config/optics_config.h"

#include <algorithm>
#include <cmath>

#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/base/units.h"
#include "core/config/field_tables_config.h"
#include "core/config/yaml_reader.h"
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

const Section& zernike_section() {
  static const Section section{
      "zernike_nm",
      "Aberrations of the whole field: the index of a Zernike term and its rms of optical path.",
      {},
      required("^([4-9]|[1-5][0-9]|6[0-6])$", form::number(-1e5, 1e5),
               "Noll's index of the term, 4 to 66, and its rms [nm].")};
  return section;
}

const Section& spiders_section() {
  static const Section section{
      "spiders",
      "Vanes that hold the secondary mirror.",
      {required("count", form::integer(0, 12), "Number of vanes, evenly spread."),
       required("width_m", form::number(0.0, 1e3), "Width of a vane [m], at most the aperture.")}};
  return section;
}

const Section& field_section() {
  static const Section section{
      "field_nm",
      "Aberrations that grow with the distance from the axis, as rms of optical path in a corner.",
      {optional("coma", form::number(-1e5, 1e5), "Coma [nm].", "0"),
       optional("astigmatism", form::number(-1e5, 1e5), "Astigmatism [nm].", "0"),
       optional("curvature", form::number(-1e5, 1e5), "Curvature of field [nm].", "0")}};
  return section;
}

const Section& grid_section() {
  static const Section section{
      "psf_grid",
      "Kernels over the field, between which the point spread is interpolated.",
      {required("columns", form::integer(1, 9), "Kernels along a row."),
       required("rows", form::integer(1, 9), "Kernels along a column.")}};
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
      values[i] = coefficients.number_or(wanted[i].key, 0.0,
                                         Bounds::between(-wanted[i].most, wanted[i].most));
    coefficients.done();
  }
  return Projection::make(index, values);
}

// {NOLL INDEX: rms in nanometres of path, ...}
std::vector<WavefrontTerm> read_wavefront(const YamlValue& value) {
  YamlMap map(value, zernike_section());
  std::vector<WavefrontTerm> terms;
  for (const std::string& key : map.keys()) {
    const YamlValue rms = map.require(key);
    terms.push_back({noll_index(key, 4, rms), 1e-9 * rms.number()});
  }
  map.done();
  return terms;
}

// psf: gaussian has its width, psf: diffraction the parameters of a pupil; keys of the other are
// refused.
PointSpread read_point_spread(YamlMap& map, Optics& optics) {
  PointSpread s;
  const auto model = map.find("psf");
  const bool diffraction = model && model->choice() == "diffraction";
  s.model = diffraction ? PointSpread::Model::diffraction : PointSpread::Model::gaussian;
  const auto width = map.find("psf_fwhm_px");
  if (width && diffraction) width->fail("goes with psf: gaussian");
  if (width) optics.psf_fwhm_px = width->number();
  const auto of_pupil = [&](const char* key) {
    auto value = map.find(key);
    if (value && !diffraction) value->fail("goes with psf: diffraction", false);
    return value;
  };
  if (const auto v = of_pupil("spiders")) {
    YamlMap vanes(*v, spiders_section());
    s.spiders = int(vanes.require("count").integer());
    s.spider_width_m = vanes.number("width_m", Bounds::between(0.0, optics.aperture_m));
    vanes.done();
  }
  if (const auto v = of_pupil("defocus_m")) s.defocus_m = v->number();
  const auto jitter_px = of_pupil("jitter_px"), jitter_arcsec = of_pupil("jitter_arcsec");
  if (jitter_px && jitter_arcsec) jitter_px->fail("give one of jitter_px and jitter_arcsec", false);
  if (jitter_px) s.jitter_rad = jitter_px->number() * optics.pixel_angle_rad();
  if (jitter_arcsec) s.jitter_rad = jitter_arcsec->number() * arcsec;
  if (const auto v = of_pupil("zernike_nm")) s.wavefront = read_wavefront(*v);
  if (const auto v = of_pupil("field_nm")) {
    YamlMap field(*v, field_section());
    const auto rms_m = [&](const char* key) { return 1e-9 * field.number_or(key, 0.0); };
    s.field = {.coma_m = rms_m("coma"),
               .astigmatism_m = rms_m("astigmatism"),
               .curvature_m = rms_m("curvature")};
    field.done();
  }
  if (const auto v = of_pupil("psf_grid")) {
    YamlMap grid(*v, grid_section());
    s.grid_columns = int(grid.require("columns").integer());
    s.grid_rows = int(grid.require("rows").integer());
    grid.done();
  }
  if (const auto v = map.find("psf_field")) {
    s.varying = read_psf_field(*v, diffraction);
    if (const auto grid = map.find("psf_grid"))
      grid->fail("can't stand beside psf_field, whose level is the number of kernels", false);
    if (width) width->fail("can't stand beside psf_field, which has the widths", false);
    if (!diffraction) optics.psf_fwhm_px = 0.0;
  }
  if (const auto v = map.find("focus_drift")) s.drift = read_focus_drift(*v);
  if (s.field.any() && s.varying.any())
    map.require("field_nm").fail("can't stand beside psf_field", false);
  if (s.field.any() && s.grid_columns * s.grid_rows == 1)
    map.value().fail("field_nm needs a psf_grid of more than one kernel", false);
  if (const auto v = of_pupil("wavelengths")) s.wavelengths = int(v->integer());
  if (const auto v = of_pupil("most_screens")) s.most_screens = int(v->integer());
  if (const auto v = map.find("oversampling")) s.oversampling = int(v->integer());
  if (const auto v = map.find("support_px")) s.support_px = int(v->integer());
  using Method = PointSpread::Method;
  if (const auto v = map.find("method"))
    s.method = v->chosen({Method::automatic, Method::deposit, Method::direct, Method::transform});
  if (const auto v = map.find("resampling"))
    s.resampling = v->chosen({PointSpread::Resampling::area, PointSpread::Resampling::bilinear});
  return s;
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
         optional("obscuration", form::number(0.0, 0.99),
                  "Diameter of the secondary in that of the primary.", "0"),
         optional("transmission", form::above(0.0, 1.0),
                  "Share of the light that passes the optics, without filter and obscuration.",
                  "1"),
         optional("psf", form::choice({"gaussian", "diffraction"}),
                  "`gaussian` is a round blur of given width. `diffraction` follows from the "
                  "pupil, its aberrations and the air.",
                  "gaussian"),
         optional("psf_fwhm_px", form::number(0.3, 50.0),
                  "Full width at half maximum of the Gaussian [px], before diffraction.", "1.5"),
         optional("spiders", form::map(spiders_section),
                  "Vanes in the pupil, with `psf: diffraction`."),
         optional("defocus_m", form::number(-0.1, 0.1),
                  "Distance of the detector from the focus [m], with `psf: diffraction`.", "0"),
         optional("jitter_px", form::number(0.0, 100.0),
                  "Rms jitter of the pointing along an axis [px], with `psf: diffraction`.", "0"),
         optional("jitter_arcsec", form::number(0.0, 3600.0),
                  "The same [arcsec]; one of both may be given.", "0"),
         optional("zernike_nm", form::map(zernike_section),
                  "Aberrations of the whole field, with `psf: diffraction`."),
         optional("field_nm", form::map(field_section),
                  "Aberrations that grow with the field; they need a `psf_grid`."),
         optional("psf_grid", form::map(grid_section), "Kernels over the field.", "1 x 1"),
         optional("psf_field", form::map(psf_field_section),
                  "A point spread that changes with the distance from the axis."),
         optional("focus_drift", form::map(focus_drift_section),
                  "The focus drifts with time and temperature."),
         optional("wavelengths", form::integer(1, 16),
                  "Wavelengths of the band at which diffraction is computed.", "1"),
         optional("most_screens", form::integer(1, 1000),
                  "Most phase screens of a short exposure through turbulence.",
                  std::to_string(PointSpread().most_screens)),
         optional("oversampling", form::integer(1, 16),
                  "Cells per pixel and axis of the kernel. Chosen from the pupil if not given."),
         optional("support_px", form::integer(2, 256),
                  "Radius of the kernel [px]. Chosen from the pupil if not given."),
         optional("method", form::choice({"auto", "deposit", "direct", "transform"}),
                  "How light is blurred: source by source with a Gaussian or a kernel, or the "
                  "frame at once.",
                  "auto"),
         optional("resampling", form::choice({"area", "bilinear"}),
                  "How cells of the kernel become pixels. `area` is exact.", "area"),
         optional("vignetting", form::map(vignetting_section), "Light lost away from the axis."),
         optional("stray_light", form::map(stray_light_section),
                  "Light of Sun, Moon and Earth beside the field on the focal plane."),
         optional("equivalent_aperture", form::flag(),
                  "Takes the aperture as a collecting area, which allows focal ratios below 0.5.",
                  "off")}};
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
  optics.obscuration = map.number_or("obscuration", 0.0);
  optics.transmission = map.number_or("transmission", 1.0);
  optics.spread = read_point_spread(map, optics);
  if (const auto vignetting = map.find("vignetting"))
    optics.vignetting = read_vignetting(*vignetting);
  if (const auto stray = map.find("stray_light")) optics.stray_light = read_stray_light(*stray);
  for (const ImageParameter& p : image_parameters())
    optics.image.*p.value = map.number_or(p.key, optics.image.*p.value);
  optics.equivalent_aperture = map.flag_or("equivalent_aperture", false);
  map.done();
  if (optics.focal_length_m < 0.5 * optics.aperture_m && !optics.equivalent_aperture)
    value.fail(
        "focal ratio is below 0.5, which no lens reaches; "
        "equivalent_aperture: true takes the aperture as a collecting area",
        false);
  return optics;
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
  write_field_tables_json(json, optics);
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
