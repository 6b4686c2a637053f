#include "core/config/fusion_config.h"

#include <algorithm>
#include <array>

#include "core/base/formatted.h"
#include "core/config/section.h"
#include "core/config/yaml_reader.h"

namespace dmise {
namespace {

void read_sigmas(YamlMap& map, const char* key, std::array<double, 3>& sigmas) {
  const auto value = map.find(key);
  if (!value) return;
  const auto numbers = value->numbers();
  std::copy(numbers.begin(), numbers.end(), sigmas.begin());
}

/// A tracker of the user's takes few of the keys.
void read_node(YamlMap& map, FusionConfig& config) {
  const auto node = map.find("node");
  if (!node) return;
  config.node = node->text();
  config.node_where = node->place();
  constexpr std::array taken{"node", "detection_probability", "cue_delay_ticks",
                             "not_in_catalogue"};
  for (const Key& key : fusion_section().keys) {
    if (std::ranges::find(taken, key.name) != taken.end()) continue;
    if (const auto value = map.find(key.name))
      value->fail("is of the fusion node's own filters, and node " + config.node +
                  " makes the tracks");
  }
}

}  // namespace

const Section& fusion_section() {
  static const Section section{
      "fusion",
      "A node that makes tracks of the detections of all sensors.",
      {optional("node", form::text(),
                "Node of `nodes` whose program makes the tracks, instead of the fusion node's own "
                "filters. Of the other keys it takes `detection_probability`, `cue_delay_ticks` "
                "and `not_in_catalogue`."),
       optional("catalogue_sigma_m", form::numbers(3, 1.0, 1e8),
                "Errors of the catalogue at its epoch [m]: radial, along the track, across it."),
       optional("catalogue_sigma_m_per_day", form::numbers(3, 0.0, 1e8),
                "Growth of these errors [m per day]."),
       optional("gate_d2", form::number(1.0, 1000.0),
                "Greatest squared distance of a detection from a track, as chi-square of 2 "
                "degrees of freedom. 18.4 misses 1 in 10,000.",
                "18.4"),
       optional("detection_probability", form::number(0.01, 0.999),
                "Probability that an object well above the limit is detected.", "0.9"),
       optional("false_alarms_per_frame", form::number(1e-6, 1e5),
                "Expected false alarms in a frame.", "1"),
       optional("lost_after_s", form::number(1.0, 1e6),
                "Time without a detection after which a confirmed track is lost [s].", "900"),
       optional("tentative_s", form::number(1.0, 1e6), "The same for a tentative track [s].",
                "120"),
       optional("start_window_s", form::number(1.0, 600.0),
                "Greatest time between the detections that start a track [s].", "60"),
       optional("simultaneous_s", form::number(1e-3, 10.0),
                "Greatest time between detections of two sites that give a position [s].", "0.5"),
       optional("arc_window_s", form::number(10.0, 3600.0),
                "Greatest time between the exposures of one site that begin a track [s].",
                shortest_text(FusionSettings().arc_window_s)),
       optional("arc_exposures", form::integer(0, 1000),
                "Least exposures of one site that begin a track. 0: one site begins none; else 4 "
                "or more.",
                std::to_string(FusionSettings().arc_exposures)),
       optional("acceleration_noise_m2_per_s3", form::number(0.0, 1.0),
                "Process noise of the filter [m^2/s^3].", "1e-06"),
       optional("pointing_sigma_arcsec", form::number(0.0, 3600.0),
                "Error of a frame's directions that its detections do not know [arcsec]: jitter, "
                "bias, drift.",
                "0"),
       optional("cue_delay_ticks", form::integer(1, 100000),
                "Ticks between the decision for a task and its beginning.", "2"),
       optional("not_in_catalogue", form::list(form::text()),
                "Names or numbers of objects that the fusion node does not know beforehand.")}};
  return section;
}

FusionConfig read_fusion(const YamlValue& value) {
  FusionConfig config;
  config.where = value.place();
  if (value.is_scalar() && value.flag()) return config;
  YamlMap map(value, fusion_section());
  read_node(map, config);
  FusionSettings& s = config.settings;
  read_sigmas(map, "catalogue_sigma_m", s.catalogue_sigma_m);
  read_sigmas(map, "catalogue_sigma_m_per_day", s.catalogue_sigma_m_per_day);
  s.gate_d2 = map.number_or("gate_d2", s.gate_d2);
  s.detection_probability = map.number_or("detection_probability", s.detection_probability);
  s.false_alarms_per_frame = map.number_or("false_alarms_per_frame", s.false_alarms_per_frame);
  s.lost_after_s = map.number_or("lost_after_s", s.lost_after_s);
  s.tentative_s = map.number_or("tentative_s", s.tentative_s);
  s.start_window_s = map.number_or("start_window_s", s.start_window_s);
  s.simultaneous_s = map.number_or("simultaneous_s", s.simultaneous_s);
  s.arc_window_s = map.number_or("arc_window_s", s.arc_window_s);
  if (const auto least = map.find("arc_exposures")) {
    s.arc_exposures = int(least->integer());
    if (s.arc_exposures > 0 && s.arc_exposures < 4)
      least->fail("must be 0 (one site begins no track) or >= 4");
  }
  s.acceleration_noise_m2_per_s3 =
      map.number_or("acceleration_noise_m2_per_s3", s.acceleration_noise_m2_per_s3);
  s.pointing_sigma_arcsec = map.number_or("pointing_sigma_arcsec", s.pointing_sigma_arcsec);
  config.cue_delay_ticks = map.integer_or("cue_delay_ticks", config.cue_delay_ticks);
  if (const auto names = map.find("not_in_catalogue"))
    for (const auto& name : names->list()) {
      config.not_in_catalogue.push_back(name.text());
      config.not_in_catalogue_where.push_back(name.place());
    }
  map.done();
  return config;
}

}  // namespace dmise
