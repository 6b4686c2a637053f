#include "core/config/objects/reentry_config.h"

#include "core/config/yaml/bound_key.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {

const Section& reentry_section() {
  static const Section section{
      "reentry",
      "The light of an object that burns in the air, beside the Sun's.",
      {required("height_m", form::list(form::number(0.0, 500e3), 2),
                "Heights over the ellipsoid, ascending [m]. Above and below them there is no "
                "light."),
       required("magnitude", form::list(form::number(-30.0, 30.0), 2),
                "V magnitude at each height, seen from `range_m`; linear between them."),
       bound<&ReentryLight::range_m>("range_m", form::above(0.0, 1e9),
                                     "Distance from which the magnitudes are [m].")}};
  return section;
}

ReentryLight read_reentry(const YamlValue& value) {
  YamlMap map(value, reentry_section());
  ReentryLight light;
  read_bound(map, light);
  const YamlValue heights = map.require("height_m");
  for (const YamlValue& height : heights.list()) {
    if (!light.height_m.empty() && !(height.number() > light.height_m.back()))
      height.fail("must be above the one before");
    light.height_m.push_back(height.number());
  }
  if (light.height_m.size() < 2) heights.fail("must have two heights or more", false);
  const YamlValue magnitudes = map.require("magnitude");
  for (const YamlValue& magnitude : magnitudes.list()) light.v_mag.push_back(magnitude.number());
  if (light.v_mag.size() != light.height_m.size())
    magnitudes.fail("must have one for each height", false);
  map.done();
  return light;
}

}  // namespace dmise
