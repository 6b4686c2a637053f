#include "core/config/pointing_config.h"

#include <cmath>

#include "core/base/json.h"
#include "core/base/printable.h"

namespace dmise {
namespace {

const Bounds any_angle = Bounds::between(-360.0, 360.0);
const Bounds latitude = Bounds::between(-90.0, 90.0);
const Bounds any_rate = Bounds::between(-60.0, 60.0);
constexpr double least_sine = 1e-6;       // between boresight and up
constexpr double most_offset_deg = 80.0;  // of a target's image from the boresight

template <class F = Body>
Vec<F> read_axis(const YamlValue& value) {
  const auto v = value.numbers(3, Bounds::between(-1e9, 1e9));
  const Vec<F> axis{v[0], v[1], v[2]};
  if (!(norm(axis) > 0)) value.fail("must not be zero", false);
  return unit(axis);
}

PointHorizon read_horizon(YamlMap& map) {
  return {.azimuth_deg = map.number("azimuth_deg", any_angle),
          .elevation_deg = map.number("elevation_deg", latitude),
          .azimuth_rate_deg_per_s = map.number_or("azimuth_rate_deg_per_s", 0.0, any_rate),
          .elevation_rate_deg_per_s = map.number_or("elevation_rate_deg_per_s", 0.0, any_rate)};
}

PointSky read_sky_place(YamlMap& map) {
  return {.ra_deg = map.number("ra_deg", any_angle),
          .dec_deg = map.number("dec_deg", latitude),
          .ra_rate_deg_per_s = map.number_or("ra_rate_deg_per_s", 0.0, any_rate),
          .dec_rate_deg_per_s = map.number_or("dec_rate_deg_per_s", 0.0, any_rate)};
}

PointBody read_body(const YamlValue& value) {
  YamlMap map(value);
  const auto quaternion = map.find("body_from_camera");
  const auto boresight = map.find("boresight"), up = map.find("up");
  map.done();
  if (bool(quaternion) == bool(boresight))
    value.fail("give either boresight (and up) or body_from_camera", false);
  if (quaternion) {
    if (up) up->fail("goes with boresight", false);
    const auto q = quaternion->numbers(4, Bounds::between(-2, 2));
    const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    if (!(length > 0.5 && length < 2.0))
      quaternion->fail("must be a unit quaternion [w, x, y, z]", false);
    return {rotation_of<Body, CameraFrame>({q[0], q[1], q[2], q[3]})};
  }
  const Vec<Body> z = read_axis(*boresight);
  const Vec<Body> least = std::abs(z.z) < 0.9 ? Vec<Body>{0, 0, 1} : Vec<Body>{0, 1, 0};
  const Vec<Body> upwards = up ? read_axis(*up) : least;
  if (norm(cross(z, upwards)) < least_sine) up->fail("must not be along boresight", false);
  const Vec<Body> x = unit(cross(z, upwards)), y = cross(z, x);
  PointBody body;
  body.body_from_camera.m = {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
  return body;
}

PointEnu read_enu(const YamlValue& value, const std::optional<Site>& origin) {
  if (!origin) value.fail("needs simulation.origin, the place of east, north and up", false);
  YamlMap map(value);
  PointEnu enu{.origin = *origin, .where = value.place()};
  const auto look = map.find("look"), at = map.find("look_at_m"), up = map.find("up");
  map.done();
  if (bool(look) == bool(at)) value.fail("give either look or look_at_m (and up)", false);
  if (up) enu.up = read_axis<Enu>(*up);
  if (at) {
    const auto place = at->numbers(3, Bounds::between(-1e12, 1e12));
    enu.at_m = Vec<Enu>{place[0], place[1], place[2]};
    return enu;
  }
  enu.look = read_axis<Enu>(*look);
  if (norm(cross(enu.look, enu.up)) >= least_sine) return enu;
  if (up) up->fail("must not be along look", false);
  enu.up = {0, 1, 0};  // along the vertical north is up
  return enu;
}

PointScan read_scan(const YamlValue& value, bool on_ground) {
  YamlMap map(value);
  const bool horizon = map.find("azimuth_deg") || map.find("elevation_deg");
  if (horizon && !on_ground)
    value.fail("azimuth and elevation are for a sensor on the ground", false);
  PointScan scan;
  if (horizon)
    scan.start = PointHorizon{.azimuth_deg = map.number("azimuth_deg", any_angle),
                              .elevation_deg = map.number("elevation_deg", latitude)};
  else
    scan.start = PointSky{.ra_deg = map.number("ra_deg", any_angle),
                          .dec_deg = map.number("dec_deg", latitude)};
  const auto axis = map.require("axis");
  const Vec<Body> direction = read_axis(axis);
  scan.axis = {direction.x, direction.y, direction.z};
  scan.rate_deg_per_s = map.number("rate_deg_per_s", any_rate);
  map.done();
  return scan;
}

PointCued read_cued(const YamlValue& value) {
  PointCued cued{.where = value.place()};
  if (value.is_scalar() && value.flag()) return cued;
  YamlMap map(value);
  if (const auto park = map.find("park")) {
    YamlMap place(*park);
    cued.park = {.azimuth_deg = place.number("azimuth_deg", any_angle),
                 .elevation_deg = place.number("elevation_deg", Bounds::between(0.0, 90.0))};
    place.done();
  }
  CueSettings& c = cued.cue;
  const Bounds rate{.least = 0.0, .most = 360.0, .least_open = true};
  c.slew_deg_per_s = map.number_or("slew_deg_per_s", c.slew_deg_per_s, rate);
  c.slew_deg_per_s2 =
      map.number_or("slew_deg_per_s2", c.slew_deg_per_s2, Bounds::between(0.0, 1000.0));
  if (const auto mount = map.find("mount"))
    c.mount = mount->choice({"great_circle", "altazimuth"}) == "altazimuth"
                  ? MountKind::altazimuth
                  : MountKind::great_circle;
  for (const char* key : {"azimuth_deg_per_s", "azimuth_deg_per_s2", "azimuth_range_deg"})
    if (const auto axis = map.find(key); axis && c.mount != MountKind::altazimuth)
      axis->fail("is of an altazimuth mount; set mount: altazimuth", false);
  c.azimuth_deg_per_s = map.number_or("azimuth_deg_per_s", c.azimuth_deg_per_s, rate);
  c.azimuth_deg_per_s2 =
      map.number_or("azimuth_deg_per_s2", c.azimuth_deg_per_s2, Bounds::between(0.0, 1000.0));
  if (const auto range = map.find("azimuth_range_deg")) {
    const auto limits = range->numbers(2, Bounds::between(-3600.0, 3600.0));
    if (!(limits[0] < limits[1])) range->fail("must rise");
    c.azimuth_range_deg = {limits[0], limits[1]};
  }
  c.settle_s = map.number_or("settle_s", c.settle_s, Bounds::between(0.0, 3600.0));
  c.least_elevation_deg =
      map.number_or("least_elevation_deg", c.least_elevation_deg, Bounds::between(0.0, 89.0));
  c.greatest_elevation_deg = map.number_or("greatest_elevation_deg", c.greatest_elevation_deg,
                                           Bounds::between(c.least_elevation_deg, 90.0));
  c.sun_exclusion_deg =
      map.number_or("sun_exclusion_deg", c.sun_exclusion_deg, Bounds::between(0.0, 180.0));
  c.moon_exclusion_deg =
      map.number_or("moon_exclusion_deg", c.moon_exclusion_deg, Bounds::between(0.0, 180.0));
  if (const auto exposures = map.find("exposures")) c.exposures = int(exposures->integer(1, 1000));
  c.sigma_arcsec = map.number_or("sigma_arcsec", c.sigma_arcsec, Bounds::between(1e-3, 3600.0));
  c.limiting_magnitude =
      map.number_or("limiting_magnitude", c.limiting_magnitude, Bounds::between(-30.0, 40.0));
  c.least_gain_nats =
      map.number_or("least_gain_nats", c.least_gain_nats, Bounds::between(0.0, 1000.0));
  map.done();
  return cued;
}

}  // namespace

const char* tracking_name(Tracking tracking) {
  switch (tracking) {
    case Tracking::fixed:
      return "fixed";
    case Tracking::sidereal:
      return "sidereal";
    case Tracking::target:
      return "target";
    case Tracking::moving:
      return "moving";
  }
  return "unknown";
}

double turn_rate_deg_per_s(const Pointing& pointing) {
  if (const auto* p = std::get_if<PointHorizon>(&pointing))
    return std::hypot(p->azimuth_rate_deg_per_s, p->elevation_rate_deg_per_s);
  if (const auto* p = std::get_if<PointSky>(&pointing))
    return std::hypot(p->ra_rate_deg_per_s, p->dec_rate_deg_per_s);
  const auto* scan = std::get_if<PointScan>(&pointing);
  return scan ? std::abs(scan->rate_deg_per_s) : 0.0;
}

void read_pointing(const YamlValue& value, bool on_ground, SensorConfig& sensor,
                   const std::optional<Site>& origin) {
  if (value.is_scalar()) {
    value.choice({"zenith"});
    sensor.pointing = PointUp{};
    return;
  }
  YamlMap map(value);
  const bool horizon = map.find("azimuth_deg") || map.find("elevation_deg");
  const bool sky = map.find("ra_deg") || map.find("dec_deg");
  const auto target = map.find("target"), body = map.find("body"), scan = map.find("scan"),
             cued = map.find("cued"), enu = map.find("enu");
  const int kinds = int(horizon) + int(sky) + int(bool(target)) + int(bool(body)) +
                    int(bool(scan)) + int(bool(cued)) + int(bool(enu));
  if (kinds > 1)
    value.fail(
        "give one of azimuth_deg and elevation_deg, ra_deg and dec_deg, target, body, scan, cued, "
        "enu",
        false);
  Tracking natural = Tracking::fixed;
  if (horizon) {
    if (!on_ground) value.fail("azimuth and elevation are for a sensor on the ground", false);
    sensor.pointing = read_horizon(map);
  } else if (sky) {
    sensor.pointing = read_sky_place(map);
    natural = Tracking::sidereal;
  } else if (target) {
    PointTarget at{.object = printable(target->text()), .where = target->place()};
    if (const auto place = map.find("place"))
      at.geometric = place->choice({"apparent", "geometric"}) == "geometric";
    if (const auto offset = map.find("offset_deg")) {
      const auto xy = offset->numbers(2, Bounds::between(-most_offset_deg, most_offset_deg));
      at.offset_x_deg = xy[0];
      at.offset_y_deg = xy[1];
    }
    sensor.pointing = at;
    natural = Tracking::target;
  } else if (body) {
    if (on_ground) body->fail("is for a sensor aboard a platform", false);
    sensor.pointing = read_body(*body);
  } else if (scan) {
    sensor.pointing = read_scan(*scan, on_ground);
  } else if (enu) {
    sensor.pointing = read_enu(*enu, origin);
  } else if (cued) {
    if (!on_ground) cued->fail("is for a sensor on the ground", false);
    sensor.pointing = read_cued(*cued);
    natural = Tracking::target;
  } else {
    sensor.pointing = PointUp{};
  }
  for (const auto& of_target : {map.find("place"), map.find("offset_deg")})
    if (of_target && !target) of_target->fail("goes with target", false);
  const bool moves = turn_rate_deg_per_s(sensor.pointing) > 0.0;
  sensor.tracking = moves || scan ? Tracking::moving : natural;
  if (const auto tracking = map.find("tracking")) {
    const std::string name = tracking->choice({"fixed", "sidereal", "target", "moving"});
    sensor.tracking = name == "fixed"      ? Tracking::fixed
                      : name == "sidereal" ? Tracking::sidereal
                      : name == "target"   ? Tracking::target
                                           : Tracking::moving;
    if (sensor.tracking == Tracking::target && !target && !cued)
      tracking->fail("there is no target to track", false);
    if (sensor.tracking == Tracking::moving && !moves && !scan)
      tracking->fail("needs a moving pointing: rates or scan", false);
    if (sensor.tracking == Tracking::fixed && !on_ground && (sky || target || scan))
      tracking->fail("in orbit, fixed needs a zenith or body pointing; use sidereal or target");
  }
  sensor.roll_deg = map.number_or("roll_deg", 0.0, any_angle);
  if (cued && sensor.tracking == Tracking::fixed)
    map.require("tracking").fail("a cued sensor follows its target or the stars");
  if (body && sensor.roll_deg != 0.0)
    map.require("roll_deg").fail("a camera fixed to a body is rolled by up", false);
  if (enu && sensor.roll_deg != 0.0)
    map.require("roll_deg").fail("a camera in east, north and up is rolled by up", false);
  map.done();
}

namespace {

struct PointingWriter {
  JsonWriter& json;

  void operator()(PointUp) const { json.value("zenith"); }
  void operator()(const PointHorizon& p) const {
    json.begin_object().field("azimuth_deg", p.azimuth_deg).field("elevation_deg", p.elevation_deg);
    if (turn_rate_deg_per_s(p) > 0.0)
      json.field("azimuth_rate_deg_per_s", p.azimuth_rate_deg_per_s)
          .field("elevation_rate_deg_per_s", p.elevation_rate_deg_per_s);
    json.end_object();
  }
  void operator()(const PointSky& p) const {
    json.begin_object().field("ra_deg", p.ra_deg).field("dec_deg", p.dec_deg);
    if (turn_rate_deg_per_s(p) > 0.0)
      json.field("ra_rate_deg_per_s", p.ra_rate_deg_per_s)
          .field("dec_rate_deg_per_s", p.dec_rate_deg_per_s);
    json.end_object();
  }
  void operator()(const PointTarget& p) const {
    json.begin_object().field("target", p.object);
    json.field("place", p.geometric ? "geometric" : "apparent");
    if (p.offset_x_deg != 0.0 || p.offset_y_deg != 0.0) {
      json.key("offset_deg").begin_array().value(p.offset_x_deg).value(p.offset_y_deg);
      json.end_array();
    }
    json.end_object();
  }
  void operator()(const PointBody& p) const {
    json.begin_object().key("body_from_camera").begin_array();
    for (const auto& row : p.body_from_camera.m)
      for (const double x : row) json.value(x);
    json.end_array().end_object();
  }
  void operator()(const PointEnu& p) const {  // the origin is the scenario's
    const auto vector = [&](const char* key, const Vec<Enu>& v) {
      json.key(key).begin_array().value(v.x).value(v.y).value(v.z).end_array();
    };
    json.begin_object().key("enu").begin_object();
    p.at_m ? vector("look_at_m", *p.at_m) : vector("look", p.look);
    vector("up", p.up);
    json.end_object().end_object();
  }
  void operator()(const PointScan& p) const {
    json.begin_object().key("scan");
    std::visit(*this, p.start);
    json.key("axis").begin_array().value(p.axis[0]).value(p.axis[1]).value(p.axis[2]).end_array();
    json.field("rate_deg_per_s", p.rate_deg_per_s).end_object();
  }
  void operator()(const PointCued& p) const {
    const CueSettings& c = p.cue;
    json.begin_object().key("cued").begin_object().key("park");
    (*this)(p.park);
    json.field("slew_deg_per_s", c.slew_deg_per_s).field("slew_deg_per_s2", c.slew_deg_per_s2);
    if (c.mount == MountKind::altazimuth) {
      json.field("mount", "altazimuth").field("azimuth_deg_per_s", c.azimuth_deg_per_s);
      json.field("azimuth_deg_per_s2", c.azimuth_deg_per_s2).key("azimuth_range_deg");
      json.begin_array().value(c.azimuth_range_deg[0]).value(c.azimuth_range_deg[1]).end_array();
    }
    if (c.greatest_elevation_deg < 90)
      json.field("greatest_elevation_deg", c.greatest_elevation_deg);
    json.field("settle_s", c.settle_s).field("least_elevation_deg", c.least_elevation_deg);
    json.field("sun_exclusion_deg", c.sun_exclusion_deg);
    json.field("moon_exclusion_deg", c.moon_exclusion_deg).field("exposures", c.exposures);
    json.field("sigma_arcsec", c.sigma_arcsec).field("limiting_magnitude", c.limiting_magnitude);
    json.field("least_gain_nats", c.least_gain_nats).end_object().end_object();
  }
};

}  // namespace

void write_pointing(JsonWriter& json, const Pointing& pointing) {
  std::visit(PointingWriter{json}, pointing);
}

}  // namespace dmise
