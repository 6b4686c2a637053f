#include "core/config/detector_config.h"

namespace dmise {

Detector read_detector(const YamlValue& value) {
  YamlMap map(value);
  Detector d;
  for (const DetectorParameter& p : detector_parameters()) {
    const auto given = p.required ? map.require(p.key) : map.find(p.key);
    if (p.key == "quantum_efficiency") continue;  // read with the band, because it may be a curve
    if (!given) {
      if (p.key == "temperature_c") d.temperature_c = d.dark_reference_c;  // default
    } else if (std::holds_alternative<bool Detector::*>(p.value)) {
      p.set(d, given->flag());
    } else if (std::holds_alternative<double Detector::*>(p.value)) {
      p.set(d, given->number({p.least, p.most, p.least_open}));
    } else {
      const auto most = std::int64_t(p.reason.empty() ? p.most : 4 * p.most);
      const auto number = given->integer(std::int64_t(p.least), most);
      if (double(number) > p.most)
        given->fail("must be " + std::to_string(std::int64_t(p.least)) + ".." +
                    std::to_string(std::int64_t(p.most)) + ": " + std::string(p.reason));
      p.set(d, double(number));
    }
  }
  map.done();
  if (const auto fault = fault_of(d)) {  // invalid combination of parameters
    if (const auto at = map.find(fault->key)) at->fail(fault->reason);
    value.fail(fault->key + " " + fault->reason, false);
  }
  return d;
}

void check_exposure(const Camera& camera, const YamlValue& exposure_s) {
  const double pixels = double(camera.optics.columns) * camera.optics.rows;
  const double hits = camera.detector.cosmic_rays_per_px_s * pixels * exposure_s.number();
  if (hits > most_cosmic_hits)
    exposure_s.fail("the camera's cosmic_rays_per_px_s gives more than 1e7 hits");
}

}  // namespace dmise
