#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/files/whole_file.h"
#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/config/objects/object_names.h"
#include "core/conjunction/cdm.h"
#include "core/conjunction/close_approaches.h"
#include "core/orbit/elements/catalogue.h"
#include "core/time/iso8601.h"
#include "launch/command/command.h"
#include "launch/command/common_options.h"
#include "launch/command/notes.h"

namespace dmise {
namespace {

struct ConjunctionOptions {
  std::string path, start, cdm;
  std::vector<std::string> objects;
  double hours = 24, within_km = 5, radius_m = 10;
  bool json = false;
};

std::vector<std::size_t> indices_of(const CatalogueFile& catalogue,
                                    const std::vector<std::string>& names) {
  std::vector<std::size_t> out;
  for (const std::string& name : names) {
    const std::size_t before = out.size();
    for (std::size_t i = 0; i < catalogue.elements.size(); ++i)
      if (is_called(catalogue.elements[i], name)) out.push_back(i);
    if (out.size() == before)
      throw ConfigError("--object: no object of " + catalogue.source +
                        " has this name or number, got " + name);
  }
  return out;
}

CdmObject told(const MeanElements& e) {
  return {std::to_string(e.catalogue_number), e.name, e.designator};
}

/// Without the Z, which a CDM does not need, and to a millisecond.
std::string cdm_utc(const Utc& utc) {
  std::string text = format_utc(utc, 3);
  if (!text.empty() && text.back() == 'Z') text.pop_back();
  return text;
}

void print_line(const CdmFacts& facts, const Encounter& encounter, bool json) {
  const RelativeMotion motion = relative_motion(encounter);
  const double miss_m = norm(motion.position_m), speed = norm(motion.velocity_m_per_s);
  if (!json) {
    std::printf("%sZ  %s %s  %s %s  miss %.3f km, %.3f km/s, probability %.2e\n",
                facts.closest_utc.c_str(), facts.first.number.c_str(), facts.first.name.c_str(),
                facts.second.number.c_str(), facts.second.name.c_str(), miss_m / km, speed / km,
                facts.probability);
    return;
  }
  JsonWriter line;
  line.begin_object().field("utc", facts.closest_utc + "Z");
  line.field("first", facts.first.number).field("second", facts.second.number);
  line.field("miss_m", miss_m).field("speed_m_per_s", speed);
  line.field("probability", facts.probability).end_object();
  std::puts(line.take().c_str());
}

Clock clock_from(const std::string& start) {
  try {
    return Clock(parse_utc(start));
  } catch (const Error& e) {
    throw ConfigError("--start: " + std::string(e.what()));
  }
}

void find_conjunctions(const ConjunctionOptions& options) {
  const CatalogueFile catalogue = read_catalogue(options.path);
  for (const auto& problem : catalogue.refused)
    print_note(catalogue.describe(problem) + " (left out)");
  const Clock clock = clock_from(options.start);
  const auto found = close_approaches(catalogue.elements, clock,
                                      {.of = indices_of(catalogue, options.objects),
                                       .duration = sim_seconds(options.hours * 3600),
                                       .within_m = options.within_km * km,
                                       .radius_m = options.radius_m});
  if (!options.cdm.empty()) std::filesystem::create_directories(options.cdm);
  std::size_t number = 0;
  for (const CloseApproach& approach : found) {
    const std::string name = formatted("%06zu", ++number);
    const CdmFacts facts{.created_utc = cdm_utc(clock.utc({0})),
                         .message_id = name,
                         .closest_utc = cdm_utc(clock.utc(approach.encounter.first.state.time)),
                         .first = told(catalogue.elements[approach.first]),
                         .second = told(catalogue.elements[approach.second]),
                         .covariance_method = "DEFAULT",
                         .probability = collision_probability(approach.encounter)};
    print_line(facts, approach.encounter, options.json);
    if (!options.cdm.empty())
      write_file_whole(options.cdm + "/" + name + ".cdm", cdm_text(approach.encounter, facts));
  }
  if (found.empty()) print_note("no approach below this distance");
}

void add_conjunctions_options(CLI::App& command) {
  auto options = std::make_shared<ConjunctionOptions>();
  command.add_option("file", options->path, "TLE, 3LE, gpredict or OMM (JSON, CSV, XML, KVN)")
      ->required();
  command
      .add_option("--object", options->objects,
                  "name or number of an object whose approaches are wanted; several")
      ->required();
  command.add_option("--start", options->start, "UTC such as 2018-01-21T00:00:00Z")->required();
  command.add_option("--hours", options->hours, "duration [h]")
      ->capture_default_str()
      ->check(number_between(0.01, 720.0));
  command.add_option("--within-km", options->within_km, "largest distance that is told [km]")
      ->capture_default_str()
      ->check(number_between(0.001, 1000.0));
  command.add_option("--radius-m", options->radius_m, "sum of the radii of both objects [m]")
      ->capture_default_str()
      ->check(number_between(0.001, 1000.0));
  command.add_option("--cdm", options->cdm,
                     "directory for Conjunction Data Messages (CCSDS 508.0, KVN)");
  command.add_flag("--json", options->json, "a JSON object a line");
  command.callback([options] { find_conjunctions(*options); });
}

}  // namespace

Command conjunctions_command() {
  return {
      .group = CommandGroup::predictions,
      .summary = "Finds close approaches of objects of a catalogue, and probabilities of collision",
      .add_options = add_conjunctions_options};
}

}  // namespace dmise
