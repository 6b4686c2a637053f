#include "core/config/objects/flight_config.h"

#include "core/base/files/json.h"
#include "core/config/yaml/bound_key.h"
#include "core/config/yaml/vector_values.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/time/clock.h"

namespace dmise {
namespace {

constexpr double longest_before_s = 100 * 86400.0;  // a manoeuvre before the run

FlightForceSettings read_forces(const YamlValue& value) {
  YamlMap map(value, forces_section());
  FlightForceSettings forces;
  const auto degree = map.find("gravity_degree");
  read_bound(map, forces);
  if (forces.gravity_degree == 1) degree->fail("must be 0 or 2 to 70");
  const auto area = map.find("area_to_mass_m2_per_kg");
  for (const char* key : {"drag", "radiation", "drag_coefficient", "radiation_coefficient"})
    if (const auto given = map.find(key); given && !area)
      given->fail("goes with area_to_mass_m2_per_kg", false);
  const double area_to_mass = area ? area->number() : 0.0;
  if (map.flag("drag")) forces.drag_m2_per_kg = map.number("drag_coefficient") * area_to_mass;
  if (map.flag("radiation"))
    forces.radiation_m2_per_kg = map.number("radiation_coefficient") * area_to_mass;
  map.done();
  return forces;
}

void read_burn(YamlMap& map, const YamlValue& thrust, Manoeuvre& burn) {
  burn.thrust_n = thrust.number();
  burn.mass_kg = map.number("mass_kg");
  const auto duration = map.require("duration_s");
  burn.duration_s = duration.number();
  burn.direction = direction_of<Rtn>(map.require("direction_rtn"));
  if (const auto impulse = map.find("specific_impulse_s"))
    burn.specific_impulse_s = impulse->number();
  if (!(mass_left_kg(burn, burn.end_s()) > 0))
    duration.fail("the burn takes more mass than there is");
}

Manoeuvre read_manoeuvre(const YamlValue& value, const Utc& start) {
  YamlMap map(value, manoeuvre_section());
  Manoeuvre manoeuvre;
  const auto at = map.find("at"), at_s = map.find("at_s");
  if (bool(at) == bool(at_s)) value.fail("give either at or at_s", false);
  manoeuvre.at_s = at ? Clock(start).sim_time(at->time()).seconds() : at_s->number();
  if (manoeuvre.at_s < -longest_before_s)
    (at ? *at : *at_s).fail("is more than 100 days before the run");
  const auto delta_v = map.find("delta_v_rtn_m_per_s"), thrust = map.find("thrust_n");
  if (bool(delta_v) == bool(thrust))
    value.fail("give either delta_v_rtn_m_per_s or thrust_n", false);
  if (delta_v) {
    for (const char* key : {"mass_kg", "duration_s", "direction_rtn", "specific_impulse_s"})
      if (const auto given = map.find(key)) given->fail("goes with thrust_n", false);
    manoeuvre.delta_v_m_per_s = vector_of<Rtn>(*delta_v);
  } else {
    read_burn(map, *thrust, manoeuvre);
  }
  map.done();
  return manoeuvre;
}

}  // namespace

const Section& forces_section() {
  static const Section section{
      "forces",
      "What acts on an object that flies by numerical integration.",
      {bound<&FlightForceSettings::gravity_degree>(
           "gravity_degree", form::integer(0, GravityField::highest_degree),
           "Degree and order of the Earth's gravity, EGM2008; 0: a point mass."),
       bound<&FlightForceSettings::sun_moon>(
           "sun_moon", form::flag(),
           "Attraction of Sun and Moon, and of the tides that they raise in the solid Earth."),
       optional("area_to_mass_m2_per_kg", form::number(0.0, 1000.0),
                "Cross-section over mass [m^2/kg]. Without it neither air nor sunlight acts."),
       optional("drag", form::flag(), "Drag of the air.", "on"),
       optional("drag_coefficient", form::number(0.0, 10.0), "Drag coefficient.", "2.2"),
       optional("radiation", form::flag(), "Pressure of sunlight outside the Earth's shadow.",
                "on"),
       optional("radiation_coefficient", form::number(0.0, 10.0),
                "Radiation pressure coefficient: 1 absorbs all light, 2 throws it straight back.",
                "1.3")}};
  return section;
}

const Section& manoeuvre_section() {
  static const Section section{
      "manoeuvre",
      "A change of velocity at once, or a burn of constant thrust. Axes are radial (away from the "
      "Earth's centre), transverse (in the plane of the orbit, forwards) and normal.",
      {optional("at", form::time(), "UTC of the change, or of the start of the burn."),
       optional("at_s", form::number(-longest_before_s, 3.2e8),
                "The same from the start of the run [s], in place of `at`."),
       optional("delta_v_rtn_m_per_s", form::numbers(3, -1e5, 1e5),
                "Change of velocity [m/s]: radial, transverse, normal."),
       optional("thrust_n", form::number(0.0, 1e8), "Thrust [N], in place of it."),
       optional("mass_kg", form::above(0.0, 1e9),
                "Mass of the object at the start of the burn [kg]; needed with thrust."),
       optional("duration_s", form::number(1e-3, 3.2e8),
                "Length of the burn [s]; needed with thrust."),
       optional("direction_rtn", form::direction(),
                "Direction of the acceleration: radial, transverse, normal, of any length. It "
                "turns with the axes; needed with thrust."),
       optional("specific_impulse_s", form::above(0.0, 1e6),
                "Specific impulse [s], by which a burn uses mass. By default the mass stays.")}};
  return section;
}

std::optional<FlightConfig> read_flight(YamlMap& motion, bool numerical, const Utc& start) {
  const auto forces = motion.find("forces"), manoeuvres = motion.find("manoeuvres");
  if (forces && !numerical && !manoeuvres) forces->fail("goes with numerical or manoeuvres", false);
  if (!numerical && !manoeuvres) return std::nullopt;
  FlightConfig flight{.numerical = numerical, .where = motion.value().place()};
  if (forces) flight.forces = read_forces(*forces);
  if (manoeuvres)
    for (const auto& value : manoeuvres->list()) {
      const Manoeuvre manoeuvre = read_manoeuvre(value, start);
      if (!flight.manoeuvres.empty() && manoeuvre.at_s < flight.manoeuvres.back().end_s())
        value.fail("begins before the end of the one before it", false);
      flight.manoeuvres.push_back(manoeuvre);
    }
  if (manoeuvres && flight.manoeuvres.empty()) manoeuvres->fail("must name a manoeuvre", false);
  return flight;
}

void write_flight(JsonWriter& json, const FlightConfig& flight) {
  const FlightForceSettings& f = flight.forces;
  json.key("flight").begin_object().field("numerical", flight.numerical);
  json.list("forces", {double(f.gravity_degree), double(f.sun_moon), f.drag_m2_per_kg,
                       f.radiation_m2_per_kg});
  json.key("manoeuvres").begin_array();
  for (const Manoeuvre& m : flight.manoeuvres) {
    json.begin_object();
    json.list("burn", {m.at_s, m.duration_s, m.thrust_n, m.mass_kg, m.specific_impulse_s});
    json.list("direction", {m.direction.x, m.direction.y, m.direction.z});
    json.list("delta_v_m_per_s", {m.delta_v_m_per_s.x, m.delta_v_m_per_s.y, m.delta_v_m_per_s.z});
    json.end_object();
  }
  json.end_array().end_object();
}

}  // namespace dmise
