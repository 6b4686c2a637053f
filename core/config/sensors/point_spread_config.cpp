#include "core/config/sensors/point_spread_config.h"

#include <algorithm>
#include <cmath>

#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/config/sensors/field_tables_config.h"
#include "core/config/sensors/psf_file_config.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/optics/range_defocus.h"

namespace dmise {
namespace {

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

/// Images of a point source are as they are: what else would blur them is refused.
void read_measured(YamlMap& map, Optics& optics, PointSpread& s) {
  const auto file = map.find("psf_file");
  if (s.model != PointSpread::Model::file) {
    if (file) file->fail("goes with psf: file", false);
    return;
  }
  if (!file) map.require("psf").fail("needs a psf_file");
  for (const char* key : {"psf_fwhm_px", "psf_field", "psf_grid", "support_px"})
    if (const auto other = map.find(key)) other->fail("can't stand beside psf: file", false);
  s.measured = read_psf_file(*file, optics);
  optics.psf_fwhm_px = s.measured->fwhm_px();
  constexpr int max_kernels = 9, max_wavelengths = 16;
  s.grid_columns = std::min(s.measured->grid_columns(), max_kernels);
  s.grid_rows = std::min(s.measured->grid_rows(), max_kernels);
  s.wavelengths = std::min(s.measured->wavelengths(), max_wavelengths);
  if (!s.measured->with_pixel()) return;
  if (const auto v = map.find("resampling"); v && v->choice() == "area")
    v->fail("images with the pixel in them are read at the pixels' middles: bilinear");
  s.resampling = PointSpread::Resampling::bilinear;
}

}  // namespace

std::vector<Key> point_spread_keys() {
  return {
      optional("psf", form::choice({"gaussian", "diffraction", "file"}),
               "`gaussian` is a round blur of given width. `diffraction` follows from the "
               "pupil, its aberrations and the air. `file` is that of `psf_file`.",
               "gaussian"),
      optional("psf_file", form::text() | form::map(psf_file_section),
               "Images of a point source, with `psf: file`: a FITS file, or a map of it."),
      optional("psf_fwhm_px", form::number(0.3, 50.0),
               "Full width at half maximum of the Gaussian [px], before diffraction.",
               shortest_text(Optics().psf_fwhm_px)),
      optional("spiders", form::map(spiders_section),
               "Vanes in the pupil, with `psf: diffraction`."),
      optional("defocus_m", form::number(-0.1, 0.1),
               "Distance of the detector from the focus [m], with `psf: diffraction`.", "0"),
      optional("focus_distance_m", form::above(0.0, 1e12),
               "Range that is in focus [m]. Stars are then out of focus, as are objects at other "
               "ranges.",
               "infinity"),
      optional("jitter_px", form::number(0.0, 100.0),
               "Rms jitter of the pointing along an axis [px], with `psf: diffraction` or `file`.",
               "0"),
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
               "Wavelengths of the band at which diffraction is computed.",
               std::to_string(PointSpread().wavelengths)),
      optional("most_screens", form::integer(1, 1000),
               "Most phase screens of a short exposure through turbulence.",
               std::to_string(PointSpread().max_screens)),
      optional("oversampling", form::integer(1, 16),
               "Cells per pixel and axis of the kernel. Chosen from the pupil if not given."),
      optional("support_px", form::integer(2, 256),
               "Radius of the kernel [px]. Chosen from the pupil if not given."),
      optional("method", form::choice({"auto", "deposit", "direct", "transform"}),
               "How light is blurred: source by source with a Gaussian or a kernel, or the "
               "frame at once.",
               "auto"),
      optional("resampling", form::choice({"area", "bilinear"}),
               "How cells of the kernel become pixels. `area` is exact.", "area")};
}

PointSpread read_point_spread(YamlMap& map, Optics& optics) {
  PointSpread s;
  const auto model = map.find("psf");
  using Model = PointSpread::Model;
  if (model) s.model = model->chosen({Model::gaussian, Model::diffraction, Model::file});
  const bool diffraction = s.model == Model::diffraction;
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
  if (const auto v = map.find("focus_distance_m")) {
    s.focus_distance_m = v->number();
    s.defocus_m += range_defocus_m(optics, s.focus_distance_m);
  }
  const auto jitter_px = map.find("jitter_px"), jitter_arcsec = map.find("jitter_arcsec");
  for (const auto& jitter : {jitter_px, jitter_arcsec})
    if (jitter && s.model == Model::gaussian)
      jitter->fail("goes with psf: diffraction or file", false);
  if (jitter_px && jitter_arcsec) jitter_px->fail("give one of jitter_px and jitter_arcsec", false);
  if (jitter_px) s.jitter_rad = jitter_px->number() * optics.pixel_angle_rad();
  if (jitter_arcsec) s.jitter_rad = jitter_arcsec->number() * arcsec;
  if (const auto v = of_pupil("zernike_nm")) s.wavefront = read_wavefront(*v);
  if (const auto v = of_pupil("field_nm")) {
    YamlMap field(*v, field_section());
    const auto rms_m = [&](const char* key) { return 1e-9 * field.number(key); };
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
  if (const auto v = of_pupil("most_screens")) s.max_screens = int(v->integer());
  if (const auto v = map.find("oversampling")) s.oversampling = int(v->integer());
  if (const auto v = map.find("support_px")) s.support_px = int(v->integer());
  using Method = PointSpread::Method;
  if (const auto v = map.find("method"))
    s.method = v->chosen({Method::automatic, Method::deposit, Method::direct, Method::transform});
  if (const auto v = map.find("resampling"))
    s.resampling = v->chosen({PointSpread::Resampling::area, PointSpread::Resampling::bilinear});
  read_measured(map, optics, s);
  return s;
}

void write_point_spread_json(JsonWriter& json, const PointSpread& s) {
  if (s == PointSpread{}) return;
  json.key("spread").begin_object();
  json.field("model", int(s.model)).field("method", int(s.method));
  json.field("resampling", int(s.resampling)).field("oversampling", s.oversampling);
  json.field("support_px", s.support_px).field("wavelengths", s.wavelengths);
  json.field("spiders", s.spiders).field("spider_width_m", s.spider_width_m);
  if (std::isfinite(s.focus_distance_m)) json.field("focus_distance_m", s.focus_distance_m);
  json.field("defocus_m", s.defocus_m).field("jitter_rad", s.jitter_rad);
  json.key("wavefront").begin_array();
  for (const WavefrontTerm& t : s.wavefront) json.value(t.noll).value(t.rms_m);
  json.end_array();
  json.field("coma_m", s.field.coma_m).field("astigmatism_m", s.field.astigmatism_m);
  json.field("curvature_m", s.field.curvature_m).field("grid_columns", s.grid_columns);
  json.field("grid_rows", s.grid_rows).field("most_screens", s.max_screens);
  if (s.measured) json.field("measured", s.measured->digest());
  json.end_object();
}

}  // namespace dmise
