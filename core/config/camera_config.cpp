#include "core/config/camera_config.h"

#include "core/config/detector_config.h"
#include "core/config/optics_config.h"
#include "core/config/search_path.h"

namespace dmise {
namespace {

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
