#include "core/config/objects/conic_config.h"

#include <cmath>
#include <limits>

#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/config/yaml/vector_values.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/frames/oblate_earth.h"
#include "core/orbit/kepler.h"
#include "core/time/clock.h"

namespace dmise {
namespace {

constexpr double farthest_element_m = 1e12;

Forms angle() { return form::number(-360.0, 360.0); }

/// The keys of a state.
std::vector<Key> state_keys() {
  return {
      optional("epoch", form::time(), "UTC of the elements.", "start of the run"),
      optional("position_m", form::numbers(3, -farthest_element_m, farthest_element_m),
               "Position at the epoch [m]."),
      optional("velocity_m_per_s", form::numbers(3, -1e6, 1e6), "Velocity at the epoch [m/s]."),
      optional("semi_major_axis_m", form::above(0.0, farthest_element_m),
               "Semi-major axis [m]; of a closed orbit."),
      optional("periapsis_m", form::above(0.0, farthest_element_m),
               "Least distance from the Earth's centre [m], in place of the axis."),
      optional("eccentricity", form::number(0.0, 1000.0), "Eccentricity; needed with elements."),
      optional("inclination_deg", form::number(0.0, 180.0),
               "Inclination [deg]; needed with elements."),
      optional("raan_deg", angle(), "Right ascension of the ascending node [deg].", "0"),
      optional("argument_of_perigee_deg", angle(), "Argument of perigee [deg].", "0"),
      optional("true_anomaly_deg", angle(), "True anomaly [deg].", "0"),
      optional("mean_anomaly_deg", angle(), "Mean anomaly [deg], in place of the true one.")};
}

KeplerElements read_elements(YamlMap& map) {
  KeplerElements k;
  const auto eccentricity = map.require("eccentricity");
  k.eccentricity = eccentricity.number();
  const auto axis = map.find("semi_major_axis_m"), periapsis = map.find("periapsis_m");
  if (bool(axis) == bool(periapsis))
    map.value().fail("needs either semi_major_axis_m or periapsis_m (from the Earth's centre)",
                     false);
  if (axis && k.eccentricity >= 1)
    eccentricity.fail("must be < 1 with semi_major_axis_m; open orbits need periapsis_m");
  k.periapsis_m = axis ? axis->number() * (1 - k.eccentricity) : periapsis->number();
  k.inclination_rad = map.number("inclination_deg") * deg;
  const auto angle = [&](const char* key) { return map.number(key) * deg; };
  k.raan_rad = angle("raan_deg");
  k.argument_of_perigee_rad = angle("argument_of_perigee_deg");
  k.true_anomaly_rad = angle("true_anomaly_deg");
  if (!(1 + k.eccentricity * std::cos(k.true_anomaly_rad) > 0))
    map.require("true_anomaly_deg").fail("must be inside the asymptotes");
  if (const auto mean = map.find("mean_anomaly_deg")) {
    if (map.find("true_anomaly_deg"))
      mean->fail("give either true_anomaly_deg or mean_anomaly_deg", false);
    if (k.eccentricity >= 1) mean->fail("open orbits need true_anomaly_deg", false);
    const double e_rad = eccentric_anomaly_rad(mean->number() * deg, k.eccentricity);
    k.true_anomaly_rad =
        std::atan2(std::sqrt((1 - k.eccentricity) * (1 + k.eccentricity)) * std::sin(e_rad),
                   std::cos(e_rad) - k.eccentricity);
  }
  return k;
}

/// Warnings of orbits that a model can compute with but no object in the scene has, mostly wrong
/// units, in the mapping `two_body`, whose orbit has these apsides from the Earth's centre
/// (apoapsis infinite for open orbits). Each line is `file:line:column: key: reason, got value`;
/// empty: all values are usual.
std::vector<std::string> unusual_orbit_values(const YamlValue& two_body, double periapsis_m,
                                              double apoapsis_m, const Ellipsoid& ellipsoid) {
  const double radius_m = ellipsoid.equatorial_radius_m;
  if (periapsis_m >= radius_m) return {};
  YamlMap map(two_body);
  const auto axis = map.find("semi_major_axis_m"), lowest = map.find("periapsis_m");
  const YamlValue& at = axis ? *axis : lowest ? *lowest : two_body;
  std::string text = "the orbit comes to " + formatted("%.4g", periapsis_m / 1e3) +
                     " km from the Earth's centre, inside the Earth: the object is not in the "
                     "scene there";
  if (apoapsis_m < radius_m)
    text = "the orbit is inside the Earth, " + formatted("%.4g", apoapsis_m / 1e3) +
           " km from its centre at most: the object is never in the scene";
  const double as_km = 1e3 * (axis || lowest ? at.number() : 0.0);
  if (apoapsis_m < radius_m && as_km > radius_m)
    text += " (in kilometres? that is " + formatted("%.4g", as_km) + ")";
  return {at.complaint(text, axis || lowest)};
}

}  // namespace

const Section& two_body_section() {
  static const Section section{
      "two_body",
      "A conic about the Earth's centre, in GCRS axes: by elements, or by position and velocity.",
      with_keys({optional("gm_m3_per_s2", form::positive(), "Gravity of the centre [m^3/s^2].",
                          "3.986004415e14")},
                state_keys())};
  return section;
}

const Section& numerical_section() {
  static const Section section{
      "numerical",
      "A state in GCRS axes, by osculating elements or by position and velocity, from which the "
      "object flies by numerical integration.",
      state_keys()};
  return section;
}

void require_outside_earth(const YamlValue& value, const Vec<Gcrs>& position_m,
                           const Ellipsoid& ellipsoid) {
  const OblateEarth body{.ellipsoid = ellipsoid};
  if (norm(body.stretched(position_m)) < ellipsoid.equatorial_radius_m)
    value.fail("is inside the Earth");
}

TwoBodyMotion read_conic(const YamlValue& value, const Section& section, const Utc& start,
                         const Ellipsoid& ellipsoid, std::vector<std::string>& warnings) {
  YamlMap map(value, section);
  TwoBodyMotion motion;
  const auto epoch = map.find("epoch");
  motion.epoch = Clock(epoch ? epoch->time() : start).tai({0});
  if (section.find("gm_m3_per_s2")) motion.gm_m3_per_s2 = map.number("gm_m3_per_s2");
  const auto position = map.find("position_m"), velocity = map.find("velocity_m_per_s");
  if (position || velocity) {
    motion.state.position_m = vector_of<Gcrs>(map.require("position_m"));
    motion.state.velocity_m_per_s = vector_of<Gcrs>(map.require("velocity_m_per_s"));
    require_outside_earth(*position, motion.state.position_m, ellipsoid);
  } else {
    const KeplerElements k = read_elements(map);
    motion.state = state_of(k, motion.gm_m3_per_s2);
    const double apoapsis_m = k.eccentricity < 1
                                  ? k.periapsis_m * (1 + k.eccentricity) / (1 - k.eccentricity)
                                  : std::numeric_limits<double>::infinity();
    warnings = unusual_orbit_values(value, k.periapsis_m, apoapsis_m, ellipsoid);
  }
  map.done();
  return motion;
}

}  // namespace dmise
