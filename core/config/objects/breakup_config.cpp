#include "core/config/objects/breakup_config.h"

#include <span>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/config/objects/named_motion.h"
#include "core/config/yaml/bound_key.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/orbit/sgp4/sgp4_batch.h"
#include "core/time/clock.h"

namespace dmise {
namespace {

MotionState<Teme> state_of(const MeanElements& elements, const Utc& time) {
  const Sgp4Batch batch(std::span(&elements, 1), nullptr, SimdLevel::sse2);
  const Sgp4State state = batch.propagate_one(0, batch.minutes_since_epoch(0, time.jd1, time.jd2));
  if (state.code != Sgp4Code::ok)
    throw Error("SGP4 has no state of it at the breakup: " + std::string(describe(state.code)));
  return {state.position_m, state.velocity_m_per_s};
}

MotionState<Teme> state_of(const MotionModel& motion, const Utc& time) {
  if (std::holds_alternative<NodeMotion>(motion)) throw Error("a node moves it during the run");
  const Clock clock(time);
  const EarthOrientation earth = earth_orientation(clock, {0}, Nutation::iau2000b);
  const auto state = in_gcrs(state_at(motion, clock.tai({0})), earth, {0});
  const auto teme_from_gcrs = earth.gcrs_from_teme({0}).inverse();
  return {teme_from_gcrs * state.position_m, teme_from_gcrs * state.velocity_m_per_s};
}

MotionState<Teme> state_of(const StatedModel& motion, const Utc& time) {
  return std::visit([&](const auto& model) { return state_of(model, time); }, motion);
}

/// Whether `time`, given as `at`, is after the start of the run.
bool later(const Utc& time, const Utc& start, const YamlValue& at) {
  try {
    return Clock(start).sim_time(time) > SimTime{0};
  } catch (const Error& e) {
    at.fail(e.what());
  }
}

BreakupEvent read_event(YamlMap& map, const YamlValue& value) {
  BreakupEvent event;
  const bool collides = map.require("kind").choice() == "collision";
  event.kind = collides ? BreakupKind::collision : BreakupKind::explosion;
  event.structure = collides ? BrokenStructure::spacecraft : BrokenStructure::upper_stage;
  if (const auto structure = map.find("structure"))
    event.structure = structure->choice() == "spacecraft" ? BrokenStructure::spacecraft
                                                          : BrokenStructure::upper_stage;
  event.mass_kg = map.number("mass_kg");
  const auto scale = map.find("scale"), projectile = map.find("projectile_mass_kg"),
             speed = map.find("relative_speed_m_per_s");
  if (collides) {
    if (scale) scale->fail("goes with kind: explosion", false);
    event.projectile_mass_kg = map.require("projectile_mass_kg").number();
    event.relative_speed_m_per_s = map.require("relative_speed_m_per_s").number();
  } else {
    for (const auto& other : {projectile, speed})
      if (other) other->fail("goes with kind: collision", false);
  }
  read_bound(map, event);
  const auto least = map.find("least_length_m");
  const double count = pieces_over(event, event.min_length_m);
  if (!(count < max_fragments + 1.0))
    (least ? *least : value)
        .fail("makes " + formatted("%.4g", count) + " fragments, at most " +
                  std::to_string(max_fragments) + " are possible",
              bool(least));
  if (!(count >= 1.0)) (least ? *least : value).fail("makes no fragment", bool(least));
  return event;
}

}  // namespace

const Section& breakup_section() {
  static const Section section{
      "breakup",
      "Pieces of an object that has exploded or collided, by NASA's standard breakup model "
      "(Johnson et al. 2001).",
      {required("parent", form::text() | form::map(motion_section),
                "The name or number of an object of the scenario, which stays in the scene, or a "
                "motion as of an object of one's own."),
       optional("at", form::time(), "UTC of the breakup, at or before the start of the run.",
                "start of the run"),
       required("kind", form::choice({"explosion", "collision"}), "What broke it."),
       optional("structure", form::choice({"upper_stage", "spacecraft"}),
                "Which area-to-mass ratios pieces over 8 cm have.",
                "`upper_stage` of an explosion, `spacecraft` of a collision"),
       required("mass_kg", form::above(0.0, 1e6), "Mass of the parent [kg]."),
       bound<&BreakupEvent::scale>("scale", form::above(0.0, 1000.0),
                                   "S of an explosion: 1 is an upper stage of 600 to 1000 kg."),
       optional("projectile_mass_kg", form::above(0.0, 1e6),
                "Mass of what hit it [kg]; needed of a collision."),
       optional("relative_speed_m_per_s", form::above(0.0, 1e5),
                "Speed at which that hit it [m/s]; needed of a collision."),
       bound<&BreakupEvent::min_length_m>("least_length_m", form::number(1e-3, 1.0),
                                          "Characteristic length of the smallest pieces [m]."),
       optional("seed", form::seed(), "Seed of the pieces.", "that of the scenario")}};
  return section;
}

Breakup read_breakup(const YamlValue& value, const Utc& start) {
  YamlMap map(value, breakup_section());
  Breakup breakup;
  breakup.event = read_event(map, value);
  const auto at = map.find("at");
  breakup.epoch = at ? at->time() : start;
  if (at && later(breakup.epoch, start, *at))
    at->fail("must be at or before the start of the run: no object begins within a run");
  if (const auto seed = map.find("seed")) breakup.seed = std::uint64_t(seed->integer());
  map.require("parent");
  map.done();
  return breakup;
}

void read_parent(const YamlValue& value, const Utc& start, const EarthConfig& earth,
                 const ObjectsConfig& objects, Breakup& breakup) {
  YamlMap map(value, breakup_section());
  const auto parent = map.require("parent");
  const bool named = !parent.is_map();
  const auto motion =
      named ? std::optional<MotionConfig>() : read_motion(parent, start, breakup.name, earth);
  if (motion && motion->proximity) parent.fail("must not be near another object", false);
  try {
    breakup.parent = state_of(
        motion ? motion->model : motion_named(parent.text(), objects.own, objects.catalogues),
        breakup.epoch);
  } catch (const Error& e) {
    parent.fail(e.what(), named);
  }
}

}  // namespace dmise
