#include "orbit-node/load_objects.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "core/base/units.h"
#include "core/config/fusion_config.h"
#include "core/config/objects/object_names.h"
#include "core/orbit/elements/catalogue.h"
#include "core/orbit/elements/object_facts.h"
#include "core/orbit/sgp4/catalogue_report.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

bool wanted(const ObjectSource& source, const MeanElements& elements) {
  return source.only.empty() || std::ranges::any_of(source.only, [&](const std::string& name) {
           return is_called(elements, name);
         });
}

/// Throws `ConfigError` at `where` if none of `objects` has this name or number; `whose`: " of
/// FILE", or empty.
template <class Object>
void require_found(const std::vector<Object>& objects, const std::string& name,
                   const std::string& where, const std::string& whose) {
  if (std::ranges::any_of(objects, [&](const auto& o) { return is_called(o, name); })) return;
  std::vector<std::string> names;
  for (const auto& o : objects) names.push_back(o.name);
  const std::string hint = nearest_object(name, names);
  throw ConfigError(where + ": no object" + whose + " has this name or number" +
                    (hint.empty() ? "" : ", did you mean " + printable(hint) + "?") + ", got " +
                    printable(name));
}

std::string prefix(const std::string& where) { return where.empty() ? "" : where + ": "; }

/// Returns `read()`; its errors get the scenario's key as a prefix.
auto at_key(const std::string& where, const auto& read) {
  try {
    return read();
  } catch (const Error& e) {
    throw ConfigError(prefix(where) + e.what());
  }
}

/// Adds objects one by one.
class Loader {
 public:
  Loader(const Scenario& scenario, const Clock& clock)
      : scenario_(scenario),
        models_(models_of(scenario.objects)),
        clock_(clock),
        start_(clock.utc({0})) {
    population_.ellipsoid = scenario.earth.ellipsoid;
    for (const auto& object : scenario.own_objects) taken_.insert(object.catalogue_number);
  }

  ObjectPopulation load() {
    for (const auto& source : scenario_.objects) add(source);
    note_models();
    for (const auto& object : scenario_.own_objects) require_name_of_its_own(object);
    for (const auto& object : scenario_.own_objects)
      if (const auto* elements = std::get_if<MeanElements>(&object.motion.model)) {
        population_.elements.push_back(*elements);
        add(object, element_age_days(*elements, start_));
      }
    for (const auto& object : scenario_.own_objects)
      if (const auto* model = std::get_if<MotionModel>(&object.motion.model)) {
        if (const auto* path = std::get_if<Trajectory>(model)) check_span(object, *path);
        population_.models.push_back(*model);
        add(object, 0.0);
      }
    if (scenario_.fusion && !scenario_.fusion->catalogue_path.empty())
      believed_elements(*scenario_.fusion, start_);
    if (const auto& fusion = scenario_.fusion)
      for (std::size_t k = 0; k < fusion->not_in_catalogue.size(); ++k) {
        const auto& where = fusion->not_in_catalogue_where;  // empty if no file has them
        require_found(population_.roster.objects, fusion->not_in_catalogue[k],
                      k < where.size() ? where[k] : "fusion.not_in_catalogue", "");
      }
    if (stale_ > 0)
      note(std::to_string(stale_) + " of " + std::to_string(population_.elements.size()) +
           " objects have elements more than 30 days from the start of the run");
    return std::move(population_);
  }

 private:
  void note(const std::string& text) { population_.notes.push_back(text); }

  void add(const ObjectSource& source) {
    ObjectFactsFile facts;
    auto catalogue =
        source.walker
            ? CatalogueFile{.source = source.named, .elements = elements_of(*source.walker)}
        : source.breakup    ? fragments(source, facts)
        : source.population ? debris(source, facts)
                            : at_key(source.where, [&] { return read_catalogue(source.path); });
    for (auto& e : catalogue.elements) e.name = printable(e.name);  // as displayed and published
    if (catalogue.elements.empty() && !source.population)
      throw ConfigError(prefix(source.where) + source.path + ": no element set could be read" +
                        (catalogue.refused.empty()
                             ? std::string()
                             : ": " + catalogue.describe(catalogue.refused[0])));
    for (std::size_t k = 0; k < source.only.size(); ++k)
      require_found(catalogue.elements, source.only[k],
                    k < source.only_where.size() ? source.only_where[k] : source.path,
                    " of " + source.path);
    if (!source.facts_path.empty())
      facts = at_key(source.where, [&] { return read_object_facts(source.facts_path); });
    for (const auto& problem : facts.refused)
      note(source.facts_path + ":" + std::to_string(problem.line) + ": " + problem.reason +
           " (left out)");
    for (const auto& problem : catalogue.refused) note(catalogue.describe(problem) + " (left out)");
    for (const auto& problem : catalogue.warnings) note(catalogue.describe(problem));
    int of_earlier = 0;
    std::string first;
    for (const auto& e : catalogue.elements) {
      if (!wanted(source, e)) continue;
      // Number 0 (not catalogued) does not identify an object.
      if (e.catalogue_number != 0 && !taken_.insert(e.catalogue_number).second) {
        if (is_own(e.catalogue_number)) continue;
        if (of_earlier++ == 0) first = std::to_string(e.catalogue_number) + " " + e.name;
        continue;
      }
      const auto known = facts.facts.find(e.catalogue_number);
      const DiffuseSphere sphere = known == facts.facts.end()
                                       ? source.sphere
                                       : sphere_of(known->second, source.sphere).sphere;
      const ObjectModel* model = models_.of(e.name, e.catalogue_number);
      if (model)
        population_.attitudes.push_back({population_.roster.objects.size(), model->attitude.model});
      population_.roster.objects.push_back({.catalogue_number = e.catalogue_number,
                                            .name = e.name,
                                            .designator = e.designator,
                                            .sphere = sphere,
                                            .element_age_s = aged(element_age_days(e, start_)),
                                            .panel = axes_of(model ? model->panel : std::nullopt)});
      population_.elements.push_back(e);
    }
    if (of_earlier > 0)
      note(catalogue.source + ": " + std::to_string(of_earlier) +
           (of_earlier == 1 ? " element set" : " element sets") +
           " left out: catalogues listed before have the numbers; first " + first);
  }

  /// Pieces of a breakup, and the spheres that they are.
  CatalogueFile fragments(const ObjectSource& source, ObjectFactsFile& facts) {
    Fragments made = fragments_of(*source.breakup, scenario_.seed, start_);
    note(describe(*source.breakup, made));
    if (made.elements.empty())
      throw ConfigError(prefix(source.where) + "no fragment is in orbit at the start of the run");
    for (std::size_t k = 0; k < made.elements.size(); ++k)
      facts.facts[made.elements[k].catalogue_number] = {
          .dimensions_m = {2.0 * std::sqrt(made.pieces[k].area_m2 / pi)},
          .albedo = source.sphere.albedo};
    return {.source = source.named, .elements = std::move(made.elements)};
  }

  /// Objects of a population, of which chance may make none, and the spheres that they are.
  CatalogueFile debris(const ObjectSource& source, ObjectFactsFile& facts) {
    DrawnDebris drawn = draw_debris(*source.population, scenario_.seed);
    note(describe(*source.population, drawn));
    for (std::size_t k = 0; k < drawn.elements.size(); ++k)
      facts.facts[drawn.elements[k].catalogue_number] = {.dimensions_m = {drawn.diameters_m[k]},
                                                         .albedo = source.sphere.albedo};
    return {.source = source.named, .elements = std::move(drawn.elements)};
  }

  /// Notes what the shapes of models lack, and patterns of the user's that fit no object. Those
  /// that a model has itself may, unless all do.
  void note_models() {
    std::set<const ObjectModel*> noted;
    std::vector<std::string> stated, all;
    for (const auto& rule : models_.rules()) {
      if (noted.insert(rule.model.get()).second)
        for (const auto& text : rule.model->geometry.notes) note(text);
      const ObjectModels alone({rule});
      if (std::ranges::any_of(population_.roster.objects, [&](const ObjectInfo& object) {
            return alone.of(object.name, object.catalogue_number);
          }))
        continue;
      all.push_back(rule.pattern);
      if (std::ranges::find(rule.model->names, rule.pattern) == rule.model->names.end())
        stated.push_back(rule.pattern);
    }
    for (const auto& pattern : all.size() == models_.rules().size() ? all : stated)
      note("models: no object of the catalogues has a name or number like " + pattern);
  }

  bool is_own(std::uint32_t number) const {
    return std::ranges::any_of(scenario_.own_objects,
                               [&](const auto& o) { return o.catalogue_number == number; });
  }

  void add(const OwnObject& object, double age_days) {
    if (object.geometry)
      for (const auto& note : object.geometry->notes) population_.notes.push_back(note);
    if (object.attitude) {
      check_span(object, object.attitude->model);
      population_.attitudes.push_back({population_.roster.objects.size(), object.attitude->model});
    }
    population_.roster.objects.push_back({.catalogue_number = object.catalogue_number,
                                          .name = object.name,
                                          .sphere = object.sphere,
                                          .element_age_s = aged(age_days),
                                          .panel = axes_of(object.panel)});
  }

  static std::optional<SunTrackingPanel> axes_of(const std::optional<HingedPanel>& panel) {
    return panel ? std::optional(panel->axes) : std::nullopt;
  }

  double aged(double age_days) {
    stale_ += std::abs(age_days) > stale_after_days;
    return age_days * day_s;
  }

  void require_name_of_its_own(const OwnObject& object) const {
    for (const auto& other : population_.roster.objects)
      if (other.name == object.name)
        throw ConfigError(object.where + ": a catalogue's object has this name, got " +
                          object.name + " (give it the number " +
                          std::to_string(other.catalogue_number) + " to take its place)");
  }

  /// Checks that a trajectory overlaps the run, and covers it if a sensor depends on it.
  void check_span(const OwnObject& object, const Trajectory& path) {
    const TrajectorySpan span = span_of(path);
    const SimTime end = scenario_.time_of(scenario_.last_tick());
    const auto after = [](const Tai& a, const Tai& b) { return seconds_between(b, a) > 1e-9; };
    const auto& flight = object.motion.flight;
    const std::string text =
        (flight ? "the path of " : object.motion.trajectory_path + ": the trajectory of ") +
        object.name + (flight && !flight->end.empty() ? " (" + flight->end + ")" : "") + " spans " +
        span_text(path) + ", the run " + format_utc(start_) + " to " + format_utc(clock_.utc(end));
    if (after(clock_.tai({0}), span.stop) || after(span.start, clock_.tai(end)))
      throw ConfigError(object.where + ": " + text);
    if (!after(span.start, clock_.tai({0})) && !after(clock_.tai(end), span.stop)) return;
    for (const auto& sensor : scenario_.sensors)
      if (depends_on(sensor, object))
        throw ConfigError(object.where + ": sensor " + sensor.name + " depends on it, but " + text);
    note(text + ": it is in the scene only within that span");
  }

  void check_span(const OwnObject& object, const Attitude& attitude) const {
    const auto* table = std::get_if<TableAttitude>(&attitude);
    const double end_s = scenario_.time_of(scenario_.last_tick()).seconds();
    if (!table || (table->time_s.front() <= 0.0 && table->time_s.back() >= end_s)) return;
    throw ConfigError(object.where + ": " + object.attitude->table_path + ": the attitudes of " +
                      object.name + " span " + std::to_string(table->time_s.front()) + " to " +
                      std::to_string(table->time_s.back()) + " s of the run, its ticks 0 to " +
                      std::to_string(end_s) + " s");
  }

  static bool depends_on(const SensorConfig& sensor, const OwnObject& object) {
    const auto* platform = std::get_if<PlatformConfig>(&sensor.place);
    const auto* target = std::get_if<PointTarget>(&sensor.pointing);
    return (platform && is_called(object, platform->object)) ||
           (target && is_called(object, target->object));
  }

  const Scenario& scenario_;
  const ObjectModels& models_;
  const Clock& clock_;
  const Utc start_;
  ObjectPopulation population_;
  std::set<std::uint32_t> taken_;
  int stale_ = 0;
};

}  // namespace

ObjectPopulation load_objects(const Scenario& scenario, const Clock& clock) {
  return Loader(scenario, clock).load();
}

}  // namespace dmise
