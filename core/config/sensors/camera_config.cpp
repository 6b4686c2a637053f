#include "core/config/sensors/camera_config.h"

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/config/sensors/band_config.h"
#include "core/config/sensors/detector_config.h"
#include "core/config/sensors/exclusion_config.h"
#include "core/config/sensors/optics_config.h"
#include "core/config/sensors/unusual_cameras.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/optics/psf_table.h"
#include "core/photometry/magnitude.h"

namespace dmise {
namespace {

constexpr std::size_t max_filters = 31;

/// The bands as the detector sees them: filter times quantum efficiency, in one spectral integral.
void apply_quantum_efficiency(const YamlValue& value, Camera& camera) {
  const QuantumEfficiency efficiency = read_quantum_efficiency(value);
  camera.detector.quantum_efficiency = efficiency.peak;
  if (efficiency.relative.empty()) return;
  try {
    camera.band = through(camera.band, efficiency.relative);
    for (Filter& filter : camera.filters) filter.band = through(filter.band, efficiency.relative);
  } catch (const Error& e) {
    value.fail(e.what());
  }
}

void read_filters(const YamlValue& value, Camera& camera) {
  const auto list = value.list();
  if (list.size() > max_filters)
    value.fail("a wheel has at most 31 filters beside the band", false);
  for (const YamlValue& filter : list) camera.filters.push_back({read_band(filter), {}});
}

/// `camera` has its band as the detector sees it.
void check_blur(const YamlValue& optics, const Camera& camera) {
  const double sigma_px = psf_sigma_px(camera.optics, camera.band.centre_m);
  if (sigma_px > widest_sigma_px)
    YamlMap(optics)
        .require("aperture_m")
        .fail(formatted(
            "diffraction with this focal length and pixel pitch blurs to a sigma of %.3g px, "
            "more than %g",
            sigma_px, widest_sigma_px));
}

/// `camera` has its band as the detector sees it.
void read_magnitude_system(const YamlValue& value, Camera& camera) {
  const auto system = magnitude_system_of(value.choice());
  try {
    camera.magnitudes = magnitude_scale(*system, camera.band);
    for (Filter& filter : camera.filters) filter.magnitudes = magnitude_scale(*system, filter.band);
  } catch (const Error& e) {
    value.fail(e.what());
  }
}

}  // namespace

const Section& camera_section() {
  static const Section section{
      "camera",
      "A camera: its optics, its detector and its band.",
      {optional("name", form::text(), "Name of the camera in products.", "camera"),
       optional("source", form::text(), "Where the numbers come from. It is not used."),
       required("optics", form::map(optics_section), "The lens or telescope."),
       required("detector", form::map(detector_section), "The detector."),
       required("band", band_forms(),
                "The band: the name of a filter (`dmise list filters`), a CSV file of its "
                "transmission, or a box."),
       optional("filters", form::list(band_forms()),
                "Further filters of its wheel, after `band`: bands that an observatory's software "
                "may choose (`dmise observatory`)."),
       optional("magnitude_system",
                form::choice({magnitude_system_names.begin(), magnitude_system_names.end()}),
                "Of the magnitudes of detections and of the header's zero point: the V of a source "
                "of the Sun's colour that is as bright in the band, or the band's own.",
                magnitude_system_names[0]),
       optional("exclusion", form::map(exclusion_section),
                "How near Sun, Moon and the Earth's limb may be to the optical axis.")}};
  return section;
}

Camera read_camera(const YamlValue& value) {
  if (value.is_scalar()) return read_camera(load_preset("camera", value));
  YamlMap map(value, camera_section());
  Camera camera;
  camera.name = map.text("name");
  map.find("source");  // informative only
  camera.optics = read_optics(map.require("optics"));
  camera.detector = read_detector(map.require("detector"));
  camera.band = read_band(map.require("band"));
  if (const auto filters = map.find("filters")) read_filters(*filters, camera);
  if (const auto efficiency = YamlMap(map.require("detector")).find("quantum_efficiency"))
    apply_quantum_efficiency(*efficiency, camera);
  check_blur(map.require("optics"), camera);
  if (const auto system = map.find("magnitude_system")) read_magnitude_system(*system, camera);
  if (const auto exclusion = map.find("exclusion")) camera.exclusion = read_exclusion(*exclusion);
  camera.warnings = unusual_camera_values(value, camera);
  map.done();
  return camera;
}

}  // namespace dmise
