#include "core/config/motion_config.h"

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/config/plausibility.h"
#include "core/config/vector_values.h"
#include "core/config/yaml_reader.h"
#include "core/frames/geodesy.h"
#include "core/frames/oblate_earth.h"
#include "core/orbit/geodetic_track.h"
#include "core/orbit/kepler.h"
#include "core/orbit/tle.h"
#include "core/time/clock.h"

namespace dmise {
namespace {

constexpr double farthest_m = 1e12;
constexpr double least_height_m = 0.01;  // of a fixed object above the ellipsoid

Forms angle() { return form::number(-360.0, 360.0); }
Forms position() { return form::numbers(3, -farthest_m, farthest_m); }

const Section& two_body_section() {
  static const Section section{
      "two_body",
      "A conic about the Earth's centre, in GCRS axes: by elements, or by position and velocity.",
      {optional("epoch", form::time(), "UTC of the elements.", "start of the run"),
       optional("gm_m3_per_s2", form::positive(), "Gravity of the centre [m^3/s^2].",
                "3.986004415e14"),
       optional("position_m", position(), "Position at the epoch [m]."),
       optional("velocity_m_per_s", form::numbers(3, -1e6, 1e6), "Velocity at the epoch [m/s]."),
       optional("semi_major_axis_m", form::above(0.0, farthest_m),
                "Semi-major axis [m]; of a closed orbit."),
       optional("periapsis_m", form::above(0.0, farthest_m),
                "Least distance from the Earth's centre [m], in place of the axis."),
       optional("eccentricity", form::number(0.0, 1000.0), "Eccentricity; needed with elements."),
       optional("inclination_deg", form::number(0.0, 180.0),
                "Inclination [deg]; needed with elements."),
       optional("raan_deg", angle(), "Right ascension of the ascending node [deg].", "0"),
       optional("argument_of_perigee_deg", angle(), "Argument of perigee [deg].", "0"),
       optional("true_anomaly_deg", angle(), "True anomaly [deg].", "0"),
       optional("mean_anomaly_deg", angle(), "Mean anomaly [deg], in place of the true one.")}};
  return section;
}

const Section& fixed_section() {
  static const Section section{
      "fixed",
      "A constant place: geodetic over the scenario's ellipsoid, or a vector.",
      {optional("latitude_deg", form::number(-90.0, 90.0), "Geodetic latitude [deg]."),
       optional("longitude_deg", form::number(-180.0, 360.0), "Longitude, east [deg]."),
       optional("height_m", form::number(least_height_m, farthest_m),
                "Height above the ellipsoid [m]."),
       optional("itrs_m", position(), "Place in ITRS, which turns with the Earth [m]."),
       optional("gcrs_m", position(), "Place in GCRS, which does not [m].")}};
  return section;
}

const Section& enu_motion_section() {
  static const Section section{
      "enu_motion",
      "A place, a straight line or a track in east, north and up of `simulation.origin`. Either "
      "`position_m` or `track` is needed.",
      {optional("position_m", position(), "Place at the start of the run [m]."),
       optional("velocity_m_per_s", form::numbers(3, -1e6, 1e6), "Velocity [m/s].", "[0, 0, 0]"),
       optional("track", form::text(), "A CSV file of time_s, east_m, north_m, up_m.")}};
  return section;
}

const Section& sgp4_section() {
  static const Section section{"sgp4",
                               "One element set.",
                               {required("line1", form::text(), "First line of a TLE."),
                                required("line2", form::text(), "Second line of a TLE.")}};
  return section;
}

template <class F>
void require_outside_earth(const YamlValue& value, const Vec<F>& position_m,
                           const Ellipsoid& ellipsoid) {
  const OblateEarth body{.ellipsoid = ellipsoid};
  if (norm(body.stretched(Vec<Gcrs>{position_m.x, position_m.y, position_m.z})) <
      ellipsoid.equatorial_radius_m)
    value.fail("is inside the Earth");
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
  const auto angle = [&](const char* key) { return map.number_or(key, 0.0) * deg; };
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

TwoBodyMotion read_two_body(const YamlValue& value, const Utc& start, const Ellipsoid& ellipsoid,
                            std::vector<std::string>& warnings) {
  YamlMap map(value, two_body_section());
  TwoBodyMotion motion;
  const auto epoch = map.find("epoch");
  motion.epoch = Clock(epoch ? epoch->time() : start).tai({0});
  motion.gm_m3_per_s2 = map.number_or("gm_m3_per_s2", earth_gm_m3_per_s2);
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

MotionModel read_fixed(const YamlValue& value, const Ellipsoid& ellipsoid) {
  YamlMap map(value, fixed_section());
  const auto itrs = map.find("itrs_m"), gcrs = map.find("gcrs_m");
  const auto latitude = map.find("latitude_deg");
  if (int(bool(itrs)) + int(bool(gcrs)) + int(bool(latitude)) != 1)
    value.fail("give one of latitude_deg with longitude_deg and height_m, itrs_m, gcrs_m", false);
  MotionModel model;
  if (itrs) {
    const auto place = vector_of<Itrs>(*itrs);
    require_outside_earth(*itrs, place, ellipsoid);
    model = ConstantPosition<Itrs>{place};
  } else if (gcrs) {
    const auto place = vector_of<Gcrs>(*gcrs);
    require_outside_earth(*gcrs, place, ellipsoid);
    model = ConstantPosition<Gcrs>{place};
  } else {
    model = ConstantPosition<Itrs>{itrs_from_geodetic({.latitude_deg = latitude->number(),
                                                       .longitude_deg = map.number("longitude_deg"),
                                                       .height_m = map.number("height_m"),
                                                       .ellipsoid = ellipsoid})};
  }
  map.done();
  return model;
}

MeanElements read_sgp4(const YamlValue& value) {
  YamlMap map(value, sgp4_section());
  const auto line1 = map.require("line1"), line2 = map.require("line2");
  map.done();
  try {
    return parse_tle(line1.text(), line2.text());
  } catch (const ConfigError& e) {
    value.fail(e.what(), false);
  }
}

/// A straight line from the start of the run, or a track; in east, north and up of the origin.
MotionConfig read_enu(const YamlValue& value, const Utc& start, const std::string& name,
                      const EarthConfig& earth) {
  if (!earth.origin) value.fail("needs simulation.origin, the place of east, north and up", false);
  MotionConfig motion;
  YamlMap map(value, enu_motion_section());
  const auto track = map.find("track"), position = map.find("position_m"),
             velocity = map.find("velocity_m_per_s");
  map.done();
  if (bool(track) == bool(position))
    value.fail("give either position_m (and velocity_m_per_s) or track", false);
  const Tai begin = Clock(start).tai({0});
  if (track) {
    if (velocity) velocity->fail("goes with position_m", false);
    motion.trajectory_path = track->existing_file();
    motion.model = MotionModel(read_enu_track(motion.trajectory_path, begin, name, *earth.origin));
    return motion;
  }
  const auto itrs_from_enu = enu_from_itrs(*earth.origin).inverse();
  const Vec<Itrs> place =
      itrs_from_geodetic(*earth.origin) + itrs_from_enu * vector_of<Enu>(*position);
  require_outside_earth(*position, place, earth.ellipsoid);
  if (velocity)
    motion.model = MotionModel(
        StraightMotion<Itrs>{begin, {place, itrs_from_enu * vector_of<Enu>(*velocity)}});
  else
    motion.model = MotionModel(ConstantPosition<Itrs>{place});
  return motion;
}

}  // namespace

const Section& motion_section() {
  static const Section section{
      "motion",
      "How an object moves; one of these.",
      {optional("two_body", form::map(two_body_section), "A conic about the Earth's centre."),
       optional("oem", form::text(), "A CCSDS OEM beside the scenario."),
       optional("fixed", form::map(fixed_section), "A constant place."),
       optional("track", form::text(),
                "A CSV file of time_s, latitude_deg, longitude_deg, height_m."),
       optional("enu", form::map(enu_motion_section),
                "In east, north and up of the scenario's origin."),
       optional("sgp4", form::map(sgp4_section), "One element set."),
       optional("node", form::text(), "A node of `nodes` says where it is at every tick.")}};
  return section;
}

MotionConfig read_motion(const YamlValue& value, const Utc& start, const std::string& name,
                         const EarthConfig& earth) {
  YamlMap map(value, motion_section());
  MotionConfig motion;
  const auto two_body = map.find("two_body"), oem = map.find("oem"), fixed = map.find("fixed"),
             track = map.find("track"), enu = map.find("enu"), sgp4 = map.find("sgp4"),
             node = map.find("node");
  map.done();
  if (map.keys().size() != 1)
    value.fail("give one of two_body, oem, fixed, track, enu, sgp4, node", false);
  if (enu) return read_enu(*enu, start, name, earth);
  if (two_body)
    motion.model = MotionModel(read_two_body(*two_body, start, earth.ellipsoid, motion.warnings));
  if (oem || track) motion.trajectory_path = (oem ? oem : track)->existing_file();
  if (oem) motion.model = MotionModel(read_oem(motion.trajectory_path));
  if (track)
    motion.model = MotionModel(
        read_geodetic_track(motion.trajectory_path, Clock(start).tai({0}), name, earth.ellipsoid));
  if (fixed) motion.model = read_fixed(*fixed, earth.ellipsoid);
  if (sgp4) motion.model = read_sgp4(*sgp4);
  if (node) {
    motion.node_where = node->place();
    motion.model = MotionModel(NodeMotion{.node = node->text()});
  }
  return motion;
}

}  // namespace dmise
