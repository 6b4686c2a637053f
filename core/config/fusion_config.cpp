#include "core/config/fusion_config.h"

#include <algorithm>

namespace dmise {
namespace {

void read_sigmas(YamlMap& map, const char* key, double least, std::array<double, 3>& sigmas) {
  const auto value = map.find(key);
  if (!value) return;
  const auto numbers = value->numbers(3, Bounds::between(least, 1e8));
  std::copy(numbers.begin(), numbers.end(), sigmas.begin());
}

}  // namespace

FusionConfig read_fusion(const YamlValue& value) {
  FusionConfig config;
  config.where = value.place();
  if (value.is_scalar() && value.flag()) return config;
  YamlMap map(value);
  FusionSettings& s = config.settings;
  read_sigmas(map, "catalogue_sigma_m", 1.0, s.catalogue_sigma_m);
  read_sigmas(map, "catalogue_sigma_m_per_day", 0.0, s.catalogue_sigma_m_per_day);
  s.gate_d2 = map.number_or("gate_d2", s.gate_d2, Bounds::between(1.0, 1000.0));
  s.detection_probability =
      map.number_or("detection_probability", s.detection_probability, Bounds::between(0.01, 0.999));
  s.false_alarms_per_frame =
      map.number_or("false_alarms_per_frame", s.false_alarms_per_frame, Bounds::between(1e-6, 1e5));
  s.lost_after_s = map.number_or("lost_after_s", s.lost_after_s, Bounds::between(1.0, 1e6));
  s.tentative_s = map.number_or("tentative_s", s.tentative_s, Bounds::between(1.0, 1e6));
  s.start_window_s = map.number_or("start_window_s", s.start_window_s, Bounds::between(1.0, 600.0));
  s.simultaneous_s = map.number_or("simultaneous_s", s.simultaneous_s, Bounds::between(1e-3, 10.0));
  s.arc_window_s = map.number_or("arc_window_s", s.arc_window_s, Bounds::between(10.0, 3600.0));
  if (const auto least = map.find("arc_exposures")) {
    s.arc_exposures = int(least->integer(0, 1000));
    if (s.arc_exposures > 0 && s.arc_exposures < 4)
      least->fail("must be 0 (one site begins no track) or >= 4");
  }
  s.acceleration_noise_m2_per_s3 = map.number_or(
      "acceleration_noise_m2_per_s3", s.acceleration_noise_m2_per_s3, Bounds::between(0.0, 1.0));
  if (const auto delay = map.find("cue_delay_ticks"))
    config.cue_delay_ticks = delay->integer(1, 100000);
  if (const auto names = map.find("not_in_catalogue"))
    for (const auto& name : names->list()) {
      config.not_in_catalogue.push_back(name.text());
      config.not_in_catalogue_where.push_back(name.place());
    }
  map.done();
  return config;
}

}  // namespace dmise
