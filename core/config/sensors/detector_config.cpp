#include "core/config/sensors/detector_config.h"

#include "core/base/formatted.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

Forms forms_of(const DetectorParameter& p) {
  if (p.key == "quantum_efficiency") return form::above(0.0, 1.0) | form::text();  // text: a curve
  if (std::holds_alternative<bool Detector::*>(p.value)) return form::flag();
  if (std::holds_alternative<int Detector::*>(p.value))
    return form::integer(std::int64_t(p.least), std::int64_t(p.most));
  return p.least_open ? form::above(p.least, p.most) : form::number(p.least, p.most);
}

/// The default of a parameter, as text.
std::string default_of(const DetectorParameter& p) {
  if (p.required) return "";
  if (p.key == "temperature_c") return "dark_reference_c";
  const double number = p.number_of(Detector());
  if (std::holds_alternative<bool Detector::*>(p.value)) return number != 0.0 ? "on" : "off";
  return shortest_text(number);
}

}  // namespace

const Section& detector_section() {
  static const Section section = [] {
    Section made{"detector", "The detector, from electrons to counts.", {}};
    for (const DetectorParameter& p : detector_parameters())
      made.keys.push_back(
          {std::string(p.key), forms_of(p), sentence_of(p.meaning), default_of(p), p.required});
    return made;
  }();
  return section;
}

Detector read_detector(const YamlValue& value) {
  YamlMap map(value, detector_section());
  Detector d;
  for (const DetectorParameter& p : detector_parameters()) {
    const auto given = p.required ? map.require(p.key) : map.find(p.key);
    if (p.key == "quantum_efficiency") continue;  // read with the band, because it may be a curve
    if (!given) {
      if (p.key == "temperature_c") d.temperature_c = d.dark_reference_c;  // default
    } else if (std::holds_alternative<bool Detector::*>(p.value)) {
      p.set(d, given->flag());
    } else if (std::holds_alternative<double Detector::*>(p.value)) {
      p.set(d, given->number());
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
  if (hits > max_cosmic_hits)
    exposure_s.fail("the camera's cosmic_rays_per_px_s gives more than 1e7 hits");
}

}  // namespace dmise
