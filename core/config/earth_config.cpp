#include "core/config/earth_config.h"

#include <array>

#include "core/base/json.h"

namespace dmise {
namespace {

struct NamedEllipsoid {
  std::string_view name;
  Ellipsoid ellipsoid;
};
constexpr std::array<NamedEllipsoid, 3> named{
    {{"WGS84", wgs84}, {"WGS72", wgs72}, {"GRS80", grs80}}};

const Bounds radius_m = Bounds::between(6e6, 7e6);    // km and miles are refused
const Bounds flattening = Bounds::between(0.0, 0.1);  // shadow and limb are tested up to it
const Bounds origin_height_m = Bounds::between(-12e3, 1e9);

Ellipsoid read_ellipsoid(const YamlValue& value) {
  if (value.is_map()) {
    YamlMap map(value);
    const Ellipsoid ellipsoid{map.number("a_m", radius_m), map.number("f", flattening)};
    map.done();
    return ellipsoid;
  }
  std::array<std::string_view, named.size()> names;
  for (std::size_t k = 0; k < names.size(); ++k) names[k] = named[k].name;
  const std::string name = value.choice(names);
  for (const auto& one : named)
    if (one.name == name) return one.ellipsoid;
  return {};
}

}  // namespace

EarthConfig read_earth(YamlMap& simulation) {
  EarthConfig earth;
  if (const auto ellipsoid = simulation.find("ellipsoid"))
    earth.ellipsoid = read_ellipsoid(*ellipsoid);
  if (const auto origin = simulation.find("origin")) {
    YamlMap map(*origin);
    earth.origin = Site{.latitude_deg = map.number("latitude_deg", Bounds::between(-90, 90)),
                        .longitude_deg = map.number("longitude_deg", Bounds::between(-180, 360)),
                        .height_m = map.number_or("height_m", 0.0, origin_height_m),
                        .ellipsoid = earth.ellipsoid};
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
}

}  // namespace dmise
