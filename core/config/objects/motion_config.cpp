#include "core/config/objects/motion_config.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/config/objects/conic_config.h"
#include "core/config/yaml/vector_values.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/frames/geodesy.h"
#include "core/orbit/elements/tle.h"
#include "core/orbit/geodetic_track.h"
#include "core/orbit/sp3.h"
#include "core/time/clock.h"

namespace dmise {
namespace {

constexpr double farthest_m = 1e12;
constexpr double min_height_m = 0.01;  // least height of a fixed object above the ellipsoid

Forms position() { return form::numbers(3, -farthest_m, farthest_m); }

const Section& fixed_section() {
  static const Section section{
      "fixed",
      "A constant place: geodetic over the scenario's ellipsoid, or a vector.",
      {optional("latitude_deg", form::number(-90.0, 90.0), "Geodetic latitude [deg]."),
       optional("longitude_deg", form::number(-180.0, 360.0), "Longitude, east [deg]."),
       optional("height_m", form::number(min_height_m, farthest_m),
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

MotionConfig read_sp3_motion(const YamlValue& file, const std::string& satellite) {
  MotionConfig motion;
  motion.trajectory_path = file.existing_file();
  Trajectory orbit = read_sp3(motion.trajectory_path, satellite);
  motion.satellite = orbit.segments.front().object_name;
  motion.model = MotionModel(std::move(orbit));
  return motion;
}

}  // namespace

const Section& motion_section() {
  static const Section section{
      "motion",
      "How an object moves; one of these.",
      {optional("two_body", form::map(two_body_section), "A conic about the Earth's centre."),
       optional("oem", form::text(), "A CCSDS OEM beside the scenario."),
       optional("sp3", form::text(), "An SP3-c or SP3-d beside the scenario."),
       optional("satellite", form::text(),
                "The satellite of the SP3, such as L71; needed if it has several."),
       optional("numerical", form::map(numerical_section),
                "A state from which it flies by numerical integration."),
       optional("forces", form::map(forces_section),
                "What acts on it; with `numerical` or `manoeuvres`."),
       optional("manoeuvres", form::list(form::map(manoeuvre_section), 1),
                "Changes of its velocity, in order; with numerical, two_body, sgp4, oem or sp3. "
                "From the first on the object flies by numerical integration."),
       optional("fixed", form::map(fixed_section), "A constant place."),
       optional("track", form::text(),
                "A CSV file of time_s, latitude_deg, longitude_deg, height_m."),
       optional("enu", form::map(enu_motion_section),
                "In east, north and up of the scenario's origin."),
       optional("sgp4", form::map(sgp4_section), "One element set."),
       optional("proximity", form::map(proximity_section), "Near another object."),
       optional("node", form::text(), "A node of `nodes` says where it is at every tick.")}};
  return section;
}

MotionConfig read_motion(const YamlValue& value, const Utc& start, const std::string& name,
                         const EarthConfig& earth) {
  YamlMap map(value, motion_section());
  MotionConfig motion;
  const auto two_body = map.find("two_body"), oem = map.find("oem"), sp3 = map.find("sp3"),
             fixed = map.find("fixed"), track = map.find("track"), enu = map.find("enu"),
             sgp4 = map.find("sgp4"), node = map.find("node"), satellite = map.find("satellite"),
             numerical = map.find("numerical"), manoeuvres = map.find("manoeuvres"),
             forces = map.find("forces"), proximity = map.find("proximity");
  map.done();
  const auto beside = {bool(satellite), bool(manoeuvres), bool(forces)};
  if (map.keys().size() - std::size_t(std::count(beside.begin(), beside.end(), true)) != 1)
    value.fail(
        "give one of two_body, numerical, oem, sp3, fixed, track, enu, sgp4, proximity, node",
        false);
  if (satellite && !sp3) satellite->fail("goes with sp3", false);
  if (manoeuvres && !(numerical || two_body || sgp4 || oem || sp3))
    manoeuvres->fail("go with numerical, two_body, sgp4, oem or sp3", false);
  if (enu) return read_enu(*enu, start, name, earth);
  if (sp3) motion = read_sp3_motion(*sp3, satellite ? satellite->text() : "");
  motion.flight = read_flight(map, numerical.has_value(), start);
  if (two_body)
    motion.model = MotionModel(
        read_conic(*two_body, two_body_section(), start, earth.ellipsoid, motion.warnings));
  if (numerical)
    motion.model = MotionModel(
        read_conic(*numerical, numerical_section(), start, earth.ellipsoid, motion.warnings));
  if (oem || track) motion.trajectory_path = (oem ? oem : track)->existing_file();
  if (oem) motion.model = MotionModel(read_oem(motion.trajectory_path));
  if (track)
    motion.model = MotionModel(
        read_geodetic_track(motion.trajectory_path, Clock(start).tai({0}), name, earth.ellipsoid));
  if (fixed) motion.model = read_fixed(*fixed, earth.ellipsoid);
  if (sgp4) motion.model = read_sgp4(*sgp4);
  if (proximity) motion.proximity = read_proximity(*proximity);
  if (node) {
    motion.node_where = node->place();
    motion.model = MotionModel(NodeMotion{.node = node->text()});
  }
  return motion;
}

}  // namespace dmise
