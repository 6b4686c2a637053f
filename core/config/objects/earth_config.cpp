#include "core/config/objects/earth_config.h"

#include "core/base/files/json.h"
#include "core/config/yaml/bound_key.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

const Section& ellipsoid_section() {
  static const Section section{
      "ellipsoid",
      "An ellipsoid of revolution about the Earth's axis.",
      {required("a_m", form::number(6e6, 7e6), "Equatorial radius [m]."),  // not in km or miles
       required("f", form::number(0.0, 0.1),  // shadow and limb are tested up to it
                "Flattening.")}};
  return section;
}

const Section& origin_section() {
  static const Section section{
      "origin",
      "The place of the scenario's east, north and up.",
      {required("latitude_deg", form::number(-90.0, 90.0), "Geodetic latitude [deg]."),
       required("longitude_deg", form::number(-180.0, 360.0), "Longitude, east [deg]."),
       bound<&Site::height_m>("height_m", form::number(-12e3, 1e9),
                              "Height above the ellipsoid [m].")}};
  return section;
}

Ellipsoid read_ellipsoid(const YamlValue& value) {
  if (!value.is_map()) return value.chosen({wgs84, wgs72, grs80});
  YamlMap map(value, ellipsoid_section());
  const Ellipsoid ellipsoid{map.number("a_m"), map.number("f")};
  map.done();
  return ellipsoid;
}

}  // namespace

std::vector<Key> earth_keys() {
  return {optional("ellipsoid",
                   form::choice({"WGS84", "WGS72", "GRS80"}) | form::map(ellipsoid_section),
                   "The figure of the Earth: of sites, heights, shadow and limb.", "WGS84"),
          optional("origin", form::map(origin_section),
                   "The place of east, north and up, for motions, cameras and positions."),
          bound<&EarthConfig::albedo>(
              "earth_albedo", form::number(0.0, 1.0),
              "Share of the light that the Earth returns, as a diffuse ellipsoid: of its disc "
              "and of earthshine.")};
}

EarthConfig read_earth(YamlMap& simulation) {
  EarthConfig earth;
  read_bound(simulation, earth);
  if (const auto ellipsoid = simulation.find("ellipsoid"))
    earth.ellipsoid = read_ellipsoid(*ellipsoid);
  if (const auto origin = simulation.find("origin")) {
    YamlMap map(*origin, origin_section());
    earth.origin = Site{.latitude_deg = map.number("latitude_deg"),
                        .longitude_deg = map.number("longitude_deg"),
                        .ellipsoid = earth.ellipsoid};
    read_bound(map, *earth.origin);
    map.done();
  }
  return earth;
}

void write_earth(JsonWriter& json, const EarthConfig& earth) {
  if (earth.ellipsoid != wgs84)
    json.key("ellipsoid")
        .begin_object()
        .field("a_m", earth.ellipsoid.equatorial_radius_m)
        .field("f", earth.ellipsoid.flattening)
        .end_object();
  if (earth.origin)
    json.key("origin")
        .begin_object()
        .field("latitude_deg", earth.origin->latitude_deg)
        .field("longitude_deg", earth.origin->longitude_deg)
        .field("height_m", earth.origin->height_m)
        .end_object();
  if (earth.albedo != usual_earth_albedo) json.field("earth_albedo", earth.albedo);
}

}  // namespace dmise
