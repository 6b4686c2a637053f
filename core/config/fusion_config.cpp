#include "core/config/fusion_config.h"

#include <algorithm>
#include <array>

#include "core/base/files/json.h"
#include "core/config/yaml/bound_key.h"
#include "core/config/yaml/section.h"
#include "core/orbit/elements/catalogue.h"

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
  constexpr std::array taken{"node",     "detection_probability", "cue_delay_ticks", "catalogue",
                             "age_days", "not_in_catalogue"};
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
                "filters. Of the other keys it takes `detection_probability`, `cue_delay_ticks`, "
                "`catalogue`, `age_days` and `not_in_catalogue`."),
       optional("catalogue", form::text(),
                "File of element sets beside the scenario (TLE, 3LE, OMM) that the node knows "
                "instead of those with which the objects move."),
       bound<&FusionConfig::age_days>(
           "age_days", form::number(0.0, 10000.0),
           "Least age at the start of the run of the element sets of `catalogue` [days]: of each "
           "object the newest that is so old is known."),
       optional("catalogue_sigma_m", form::numbers(3, 1.0, 1e8),
                "Errors of the catalogue at its epoch [m]: radial, along the track, across it."),
       optional("catalogue_sigma_m_per_day", form::numbers(3, 0.0, 1e8),
                "Growth of these errors [m per day]."),
       bound<&FusionSettings::gate_d2>(
           "gate_d2", form::number(1.0, 1000.0),
           "Greatest squared distance of a detection from a track, as chi-square of 2 "
           "degrees of freedom. 18.4 misses 1 in 10,000."),
       bound<&FusionSettings::detection_probability>(
           "detection_probability", form::number(0.01, 0.999),
           "Probability that an object well above the limit is detected."),
       bound<&FusionSettings::false_alarms_per_frame>(
           "false_alarms_per_frame", form::number(1e-6, 1e5), "Expected false alarms in a frame."),
       bound<&FusionSettings::lost_after_s>(
           "lost_after_s", form::number(1.0, 1e6),
           "Time without a detection after which a confirmed track is lost [s]."),
       bound<&FusionSettings::tentative_s>("tentative_s", form::number(1.0, 1e6),
                                           "The same for a tentative track [s]."),
       bound<&FusionSettings::start_window_s>(
           "start_window_s", form::number(1.0, 600.0),
           "Greatest time between the detections that start a track [s]."),
       bound<&FusionSettings::simultaneous_s>(
           "simultaneous_s", form::number(1e-3, 10.0),
           "Greatest time between detections of two sites that give a position [s]."),
       later(bound<&FusionSettings::arc_window_s>(
           "arc_window_s", form::number(10.0, 3600.0),
           "Greatest time between the exposures of one site that begin a track [s].")),
       later(bound<&FusionSettings::arc_exposures>(
           "arc_exposures", form::integer(0, 1000),
           "Least exposures of one site that begin a track. 0: one site begins none; else 4 "
           "or more.")),
       bound<&FusionSettings::acceleration_noise_m2_per_s3>(
           "acceleration_noise_m2_per_s3", form::number(0.0, 1.0),
           "Process noise of the filter [m^2/s^3]."),
       later(bound<&FusionSettings::pointing_sigma_arcsec>(
           "pointing_sigma_arcsec", form::number(0.0, 3600.0),
           "Error of a frame's directions that its detections do not know [arcsec]: jitter, "
           "bias, drift.")),
       later(bound<&FusionSettings::confirm_catalogued>(
           "confirm_catalogued", form::integer(1, 1000),
           "Detections that confirm a track of a catalogued object.")),
       later(bound<&FusionSettings::confirm_unknown>(
           "confirm_unknown", form::integer(1, 1000),
           "Detections that confirm a track of an unknown object, which begins with four.")),
       later(bound<&FusionSettings::confirm_arc>(
           "confirm_arc", form::integer(0, 1000),
           "Further detections that confirm a track that one site began.")),
       later(bound<&FusionSettings::keep_orbits>(
           "keep_orbits", form::flag(),
           "Keep the orbits of objects from arc to arc of their detections by numerical forces, "
           "find manoeuvres and breakups, and write `orbits.jsonl` and `breakups.jsonl`. Runs of "
           "at most 18 days.")),
       bound<&FusionConfig::cue_delay_ticks>(
           "cue_delay_ticks", form::integer(1, 100000),
           "Ticks between the decision for a task and its beginning."),
       optional("not_in_catalogue", form::list(form::text()),
                "Names or numbers of objects that the fusion node does not know beforehand.")}};
  return section;
}

std::vector<MeanElements> believed_elements(const FusionConfig& config, const Utc& start) {
  CatalogueOptions options;
  if (config.age_days) options.until = Utc{start.jd1, start.jd2 - *config.age_days};
  auto elements = read_catalogue(config.catalogue_path, options).elements;
  if (elements.empty())
    throw ConfigError(config.catalogue_where + ": " + config.catalogue_path +
                      " has no element set that is old enough");
  return elements;
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
  read_bound(map, s);
  read_bound(map, config);
  if (const auto file = map.find("catalogue")) {
    config.catalogue_path = file->existing_file();
    config.catalogue_where = file->place();
  } else if (const auto age = map.find("age_days")) {
    age->fail("goes with catalogue", false);
  }
  if (s.arc_exposures > 0 && s.arc_exposures < 4)
    map.require("arc_exposures").fail("must be 0 (one site begins no track) or >= 4");
  if (const auto names = map.find("not_in_catalogue"))
    for (const auto& name : names->list()) {
      config.not_in_catalogue.push_back(name.text());
      config.not_in_catalogue_where.push_back(name.place());
    }
  map.done();
  return config;
}

void write_fusion(JsonWriter& json, const FusionConfig& fusion) {
  const FusionSettings& s = fusion.settings;
  json.key("fusion").begin_object();
  json.list("catalogue_sigma_m", s.catalogue_sigma_m);
  json.list("catalogue_sigma_m_per_day", s.catalogue_sigma_m_per_day);
  write_bound(json, fusion_section(), s);
  json.field("cue_delay_ticks", std::int64_t(fusion.cue_delay_ticks));
  if (!fusion.node.empty()) json.field("node", fusion.node);
  if (!fusion.catalogue_path.empty()) json.field("catalogue", true);
  if (fusion.age_days) json.field("age_days", *fusion.age_days);
  json.list("not_in_catalogue", fusion.not_in_catalogue).end_object();
}

}  // namespace dmise
