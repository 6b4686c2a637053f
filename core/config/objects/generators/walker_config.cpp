#include "core/config/objects/generators/walker_config.h"

#include "core/base/units.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/frames/geodesy.h"

namespace dmise {
namespace {

constexpr int max_satellites = max_walker_satellites;
constexpr double min_axis_m = 6.5e6, max_axis_m = 1e9;  // SGP4 has no orbit within the air
constexpr double equatorial_radius_m = Ellipsoid{}.equatorial_radius_m;  // WGS 84

int satellites_of(YamlMap& map, const YamlValue& value) {
  const auto total = map.find("total"), per_plane = map.find("per_plane");
  if (bool(total) == bool(per_plane)) value.fail("needs either total or per_plane", false);
  const auto planes = map.require("planes").integer();
  if (total && total->integer() % planes != 0) total->fail("must be a multiple of planes");
  const auto count = total ? total->integer() : per_plane->integer() * planes;
  if (count > max_satellites)
    value.fail("must have at most " + std::to_string(max_satellites) + " satellites", false);
  return int(count);
}

double axis_of(YamlMap& map, const YamlValue& value) {
  const auto axis = map.find("semi_major_axis_m"), height = map.find("height_m");
  if (bool(axis) == bool(height))
    value.fail("needs either height_m or semi_major_axis_m (from the Earth's centre)", false);
  return axis ? axis->number() : equatorial_radius_m + height->number();
}

std::vector<Key> orbit_keys() {
  return {optional("height_m", form::number(min_axis_m - equatorial_radius_m, max_axis_m),
                   "Semi-major axis less 6378137 m [m]."),
          optional("semi_major_axis_m", form::number(min_axis_m, max_axis_m),
                   "Semi-major axis [m], in place of the height."),
          required("inclination_deg", form::number(0.0, 180.0), "Inclination [deg]."),
          optional("raan_deg", form::number(-360.0, 360.0),
                   "Right ascension of the first node [deg], in TEME of the epoch.", "0"),
          optional("argument_of_latitude_deg", form::number(-360.0, 360.0),
                   "The first satellite's angle from its node [deg].", "0"),
          optional("epoch", form::time(), "UTC of the elements.", "start of the run")};
}

/// Reads `orbit_keys`.
Walker read_orbit(YamlMap& map, const YamlValue& value, const Utc& start) {
  Walker orbit;
  orbit.semi_major_axis_m = axis_of(map, value);
  orbit.inclination_rad = map.number("inclination_deg") * deg;
  orbit.raan_rad = map.number("raan_deg") * deg;
  orbit.argument_of_latitude_rad = map.number("argument_of_latitude_deg") * deg;
  const auto epoch = map.find("epoch");
  orbit.epoch = epoch ? epoch->time() : start;
  return orbit;
}

}  // namespace

const Section& walker_section() {
  static const Section section{
      "walker",
      "A constellation of circular orbits T/P/F (Walker 1984): mean elements for SGP4, without "
      "drag.",
      with_keys({optional("total", form::integer(1, max_satellites),
                          "Satellites T; a multiple of the planes."),
                 optional("per_plane", form::integer(1, max_satellites),
                          "Satellites in each plane, in place of the total."),
                 required("planes", form::integer(1, max_satellites), "Planes P."),
                 optional("phasing", form::integer(0, max_satellites - 1),
                          "F, below P: a satellite is F * 360 deg / T ahead of the one in the "
                          "plane to the west.",
                          "0"),
                 optional("raan_spread_deg", form::above(0.0, 360.0),
                          "Range over which the nodes are spread [deg]: 360 is a Walker delta, "
                          "180 a star.",
                          "360")},
                orbit_keys())};
  return section;
}

const Section& train_section() {
  static const Section section{
      "train", "Satellites behind each other in one plane, as after a launch.",
      with_keys({required("count", form::integer(1, max_satellites), "Satellites."),
                 required("spacing_s", form::above(0.0, 86400.0),
                          "Time after which the next one passes the same latitude [s].")},
                orbit_keys())};
  return section;
}

Walker read_walker(const YamlValue& value, const Utc& start) {
  YamlMap map(value, walker_section());
  const int satellites = satellites_of(map, value);
  Walker walker = read_orbit(map, value, start);
  walker.planes = int(map.require("planes").integer());
  walker.per_plane = satellites / walker.planes;
  if (const auto phasing = map.find("phasing")) {
    walker.phasing = int(phasing->integer());
    if (walker.phasing >= walker.planes) phasing->fail("must be below the number of planes");
  }
  walker.raan_spread_rad = map.number("raan_spread_deg") * deg;
  map.done();
  return walker;
}

Walker read_train(const YamlValue& value, const Utc& start) {
  YamlMap map(value, train_section());
  Walker train = read_orbit(map, value, start);
  train.per_plane = int(map.require("count").integer());
  train.spacing_s = map.number("spacing_s");
  map.done();
  return train;
}

}  // namespace dmise
