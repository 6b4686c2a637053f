#include "core/config/detector_config.h"

#include "core/detector/detector_figures.h"
#include "core/detector/expose.h"

namespace dmise {

Detector read_detector(const YamlValue& value) {
  YamlMap map(value);
  Detector d;
  for (const DetectorFigure& figure : detector_figures()) {
    if (figure.value == &Detector::quantum_efficiency) {
      map.find(figure.key);  // read with the band: it may be a curve
      continue;
    }
    double& v = d.*figure.value;
    if (figure.value == &Detector::temperature_c) v = d.dark_reference_c;  // unless it says more
    const Bounds bounds{figure.least, figure.most, figure.least_open};
    v = figure.required ? map.number(figure.key, bounds) : map.number_or(figure.key, v, bounds);
  }
  if (const auto bits = map.find("adc_bits")) {
    const auto asked = bits->integer(1, 64);
    if (asked > most_adc_bits)
      bits->fail("must be 1..16: counts are 16-bit numbers in frames and messages");
    d.adc_bits = static_cast<int>(asked);
  }
  d.reference_px = static_cast<int>(map.integer_or("reference_px", 0, 0, most_reference_px));
  d.blooming = map.flag_or("blooming", false);
  map.done();
  if (const auto fault = fault_of(d)) {  // what only two figures together make wrong
    if (const auto at = map.find(fault->key)) at->fail(fault->reason);
    value.fail(fault->key + " " + fault->reason, false);
  }
  return d;
}

void check_exposure(const Camera& camera, const YamlValue& exposure_s) {
  const double pixels = double(camera.optics.columns) * camera.optics.rows;
  const double hits = camera.detector.cosmic_rays_per_px_s * pixels * exposure_s.number();
  if (hits > most_cosmic_hits)
    exposure_s.fail("the camera's cosmic_rays_per_px_s makes more than 1e7 hits of it");
}

}  // namespace dmise
