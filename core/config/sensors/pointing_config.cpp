#include "core/config/sensors/pointing_config.h"

#include <cmath>
#include <iterator>

#include "core/base/printable.h"
#include "core/config/yaml/bound_key.h"
#include "core/config/yaml/vector_values.h"

namespace dmise {
namespace {

constexpr double min_sine_to_up = 1e-6;  // between boresight and up
constexpr double max_offset_deg = 80.0;  // between a target's image and the boresight

constexpr const char* tracking_names[] = {"fixed", "sidereal", "target", "moving"};

Forms any_angle() { return form::number(-360.0, 360.0); }
Forms latitude() { return form::number(-90.0, 90.0); }
Forms any_rate() { return form::number(-60.0, 60.0); }

const Section& body_section() {
  static const Section section{
      "body",
      "A camera fixed to the body of its platform. Either `boresight` or `body_from_camera` is "
      "needed.",
      {optional("boresight", form::direction(), "Direction in body axes."),
       optional("up", form::direction(), "Direction in body axes that is up in the image.",
                "z, or y if the boresight is near z"),
       optional("body_from_camera", form::quaternion(),
                "Unit quaternion [w, x, y, z] in place of both.")}};
  return section;
}

const Section& scan_section() {
  static const Section section{
      "scan",
      "A camera that turns uniformly about an axis. It begins at an azimuth and elevation, or at "
      "a right ascension and declination.",
      {optional("azimuth_deg", any_angle(), "From north through east [deg], on the ground."),
       optional("elevation_deg", latitude(), "Above the horizon [deg], on the ground."),
       optional("ra_deg", any_angle(), "Right ascension, ICRS [deg]."),
       optional("dec_deg", latitude(), "Declination, ICRS [deg]."),
       required("axis", form::direction(),
                "Axis of the turn: in GCRS, or east, north, up for a start by azimuth."),
       required("rate_deg_per_s", any_rate(), "Rate, right-handed about the axis [deg/s].")}};
  return section;
}

const Section& enu_section() {
  static const Section section{
      "enu",
      "A camera in east, north and up of `simulation.origin`, wherever the sensor is. Either "
      "`look` or `look_at_m` is needed.",
      {optional("look", form::direction(), "Direction to look along."),
       optional("look_at_m", form::numbers(3, -1e12, 1e12), "Place to look at [m]."),
       optional("up", form::direction(), "Direction that is up in the image.",
                "[0, 0, 1], or north along the vertical")}};
  return section;
}

const Section& park_section() {
  static const Section section{
      "park",
      "Where a cued sensor looks without a task.",
      {required("azimuth_deg", any_angle(), "From north through east [deg]."),
       required("elevation_deg", form::number(0.0, 90.0), "Above the horizon [deg].")}};
  return section;
}

const Section& cued_section() {
  static const Section section{
      "cued",
      "A sensor that observes what the fusion node tells it to.",
      {optional("park", form::map(park_section), "Where it looks without a task.",
                "azimuth 180, elevation 60"),
       bound<&CueSettings::slew_deg_per_s>("slew_deg_per_s", form::above(0.0, 360.0),
                                           "Fastest turn of the mount [deg/s]."),
       bound<&CueSettings::slew_deg_per_s2>(
           "slew_deg_per_s2", form::number(0.0, 1000.0),
           "Acceleration of the mount [deg/s^2]. 0: it has its speed at once."),
       bound<&CueSettings::mount>(
           "mount", form::choice({"great_circle", "altazimuth"}),
           "Whether the mount slews along a great circle, or about azimuth and elevation."),
       optional("azimuth_deg_per_s", form::above(0.0, 360.0),
                "Fastest turn in azimuth [deg/s], of an altazimuth mount.", "slew_deg_per_s"),
       optional("azimuth_deg_per_s2", form::number(0.0, 1000.0),
                "Acceleration in azimuth [deg/s^2], of an altazimuth mount. 0: it has its speed at "
                "once.",
                "slew_deg_per_s2"),
       optional("azimuth_range_deg", form::numbers(2, -3600.0, 3600.0),
                "Least and greatest azimuth that cables allow [deg], of an altazimuth mount.",
                "[-270, 270]"),
       bound<&CueSettings::settle_s>("settle_s", form::number(0.0, 3600.0),
                                     "Time to settle after a slew [s]."),
       bound<&CueSettings::min_elevation_deg>("least_elevation_deg", form::number(0.0, 89.0),
                                              "Lowest elevation that it observes at [deg]."),
       bound<&CueSettings::greatest_elevation_deg>(
           "greatest_elevation_deg", form::number(0.0, 90.0),
           "Highest elevation that it observes at [deg], above the lowest."),
       bound<&CueSettings::sun_exclusion_deg>("sun_exclusion_deg", form::number(0.0, 180.0),
                                              "Least angle from the Sun [deg]."),
       bound<&CueSettings::moon_exclusion_deg>("moon_exclusion_deg", form::number(0.0, 180.0),
                                               "Least angle from the Moon [deg]."),
       bound<&CueSettings::exposures>("exposures", form::integer(1, 1000),
                                      "Most exposures of one task."),
       bound<&CueSettings::sigma_arcsec>("sigma_arcsec", form::number(1e-3, 3600.0),
                                         "Expected error of a detection along each axis [arcsec]."),
       bound<&CueSettings::limiting_magnitude>("limiting_magnitude", form::number(-30.0, 40.0),
                                               "Faintest magnitude that it detects."),
       bound<&CueSettings::min_gain_nats>("least_gain_nats", form::number(0.0, 1000.0),
                                          "Least information that a task must promise [nats].")}};
  return section;
}

PointHorizon read_horizon(YamlMap& map) {
  PointHorizon horizon{.azimuth_deg = map.number("azimuth_deg"),
                       .elevation_deg = map.number("elevation_deg")};
  read_bound(map, horizon);
  return horizon;
}

PointSky read_sky_place(YamlMap& map) {
  PointSky sky{.ra_deg = map.number("ra_deg"), .dec_deg = map.number("dec_deg")};
  read_bound(map, sky);
  return sky;
}

PointBody read_body(const YamlValue& value) {
  YamlMap map(value, body_section());
  const auto quaternion = map.find("body_from_camera");
  const auto boresight = map.find("boresight"), up = map.find("up");
  map.done();
  if (bool(quaternion) == bool(boresight))
    value.fail("give either boresight (and up) or body_from_camera", false);
  if (quaternion) {
    if (up) up->fail("goes with boresight", false);
    return {rotation_in<Body, CameraFrame>(*quaternion)};
  }
  const Vec<Body> z = direction_of<Body>(*boresight);
  const Vec<Body> least = std::abs(z.z) < 0.9 ? Vec<Body>{0, 0, 1} : Vec<Body>{0, 1, 0};
  const Vec<Body> upwards = up ? direction_of<Body>(*up) : least;
  if (norm(cross(z, upwards)) < min_sine_to_up) up->fail("must not be along boresight", false);
  const Vec<Body> x = unit(cross(z, upwards)), y = cross(z, x);
  PointBody body;
  body.body_from_camera.m = {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
  return body;
}

PointEnu read_enu(const YamlValue& value, const std::optional<Site>& origin) {
  if (!origin) value.fail("needs simulation.origin, the place of east, north and up", false);
  YamlMap map(value, enu_section());
  PointEnu enu{.origin = *origin, .where = value.place()};
  const auto look = map.find("look"), at = map.find("look_at_m"), up = map.find("up");
  map.done();
  if (bool(look) == bool(at)) value.fail("give either look or look_at_m (and up)", false);
  if (up) enu.up = direction_of<Enu>(*up);
  if (at) {
    enu.at_m = vector_of<Enu>(*at);
    return enu;
  }
  enu.look = direction_of<Enu>(*look);
  if (norm(cross(enu.look, enu.up)) >= min_sine_to_up) return enu;
  if (up) up->fail("must not be along look", false);
  enu.up = {0, 1, 0};  // along the vertical north is up
  return enu;
}

PointScan read_scan(const YamlValue& value, bool on_ground) {
  YamlMap map(value, scan_section());
  const bool horizon = map.find("azimuth_deg") || map.find("elevation_deg");
  if (horizon && !on_ground)
    value.fail("azimuth and elevation are for a sensor on the ground", false);
  PointScan scan;
  if (horizon)
    scan.start = PointHorizon{.azimuth_deg = map.number("azimuth_deg"),
                              .elevation_deg = map.number("elevation_deg")};
  else
    scan.start = PointSky{.ra_deg = map.number("ra_deg"), .dec_deg = map.number("dec_deg")};
  const auto axis = map.require("axis");
  const Vec<Body> direction = direction_of<Body>(axis);
  scan.axis = {direction.x, direction.y, direction.z};
  scan.rate_deg_per_s = map.number("rate_deg_per_s");
  map.done();
  return scan;
}

PointCued read_cued(const YamlValue& value) {
  PointCued cued{.where = value.place()};
  if (value.is_scalar()) return cued;  // on
  YamlMap map(value, cued_section());
  if (const auto park = map.find("park")) {
    YamlMap place(*park, park_section());
    cued.park = {.azimuth_deg = place.number("azimuth_deg"),
                 .elevation_deg = place.number("elevation_deg")};
    place.done();
  }
  CueSettings& c = cued.cue;
  read_bound(map, c);
  for (const char* key : {"azimuth_deg_per_s", "azimuth_deg_per_s2", "azimuth_range_deg"})
    if (const auto axis = map.find(key); axis && c.mount != MountKind::altazimuth)
      axis->fail("is of an altazimuth mount; set mount: altazimuth", false);
  const auto in_azimuth = [&](const char* key, double in_elevation) {
    const auto value = map.find(key);
    return value ? value->number() : in_elevation;
  };
  c.azimuth_deg_per_s = in_azimuth("azimuth_deg_per_s", c.slew_deg_per_s);
  c.azimuth_deg_per_s2 = in_azimuth("azimuth_deg_per_s2", c.slew_deg_per_s2);
  if (const auto range = map.find("azimuth_range_deg")) {
    const auto limits = range->numbers();
    if (!(limits[0] < limits[1])) range->fail("must rise");
    c.azimuth_range_deg = {limits[0], limits[1]};
  }
  if (c.greatest_elevation_deg < c.min_elevation_deg)
    map.require("greatest_elevation_deg").number(Bounds::between(c.min_elevation_deg, 90.0));
  map.done();
  return cued;
}

}  // namespace

const char* tracking_name(Tracking tracking) { return tracking_names[std::size_t(tracking)]; }

double turn_rate_deg_per_s(const Pointing& pointing) {
  if (const auto* p = std::get_if<PointHorizon>(&pointing))
    return std::hypot(p->azimuth_rate_deg_per_s, p->elevation_rate_deg_per_s);
  if (const auto* p = std::get_if<PointSky>(&pointing))
    return std::hypot(p->ra_rate_deg_per_s, p->dec_rate_deg_per_s);
  const auto* scan = std::get_if<PointScan>(&pointing);
  return scan ? std::abs(scan->rate_deg_per_s) : 0.0;
}

const Section& pointing_section() {
  static const Section section{
      "pointing",
      "Where the camera points: by azimuth and elevation, by right ascension and declination, at a "
      "target, fixed to the platform's body or to east, north and up, scanning, or cued. One of "
      "these may be given; without "
      "any it points up.",
      {optional("azimuth_deg", any_angle(), "From north through east [deg], on the ground."),
       optional("elevation_deg", latitude(), "Above the horizon [deg], on the ground."),
       bound<&PointHorizon::azimuth_rate_deg_per_s>("azimuth_rate_deg_per_s", any_rate(),
                                                    "Rate of the azimuth [deg/s]."),
       bound<&PointHorizon::elevation_rate_deg_per_s>("elevation_rate_deg_per_s", any_rate(),
                                                      "Rate of the elevation [deg/s]."),
       optional("ra_deg", any_angle(), "Right ascension, ICRS [deg]."),
       optional("dec_deg", latitude(), "Declination, ICRS [deg]."),
       bound<&PointSky::ra_rate_deg_per_s>("ra_rate_deg_per_s", any_rate(),
                                           "Rate of the right ascension [deg/s]."),
       bound<&PointSky::dec_rate_deg_per_s>("dec_rate_deg_per_s", any_rate(),
                                            "Rate of the declination [deg/s]."),
       optional("target", form::text(), "Catalogue number or name of the object to point at."),
       optional("place", form::choice({"apparent", "geometric"}),
                "Whether the target's apparent direction is pointed at, or the straight line.",
                "apparent"),
       optional("offset_deg", form::numbers(2, -max_offset_deg, max_offset_deg),
                "Place of the target's image from the boresight [deg], along columns and rows.",
                "[0, 0]"),
       optional("body", form::map(body_section), "Fixed to the body of the platform."),
       optional("enu", form::map(enu_section), "Fixed to east, north and up of the origin."),
       optional("scan", form::map(scan_section), "Turns uniformly about an axis."),
       optional("cued", form::flag() | form::map(cued_section),
                "Observes what the fusion node tells it to."),
       optional("tracking", form::choice({std::begin(tracking_names), std::end(tracking_names)}),
                "What the camera follows during an exposure. By default what its pointing "
                "suggests."),
       bound<&SensorConfig::roll_deg>(
           "roll_deg", any_angle(),
           "Turns the image's up, which is north or the zenith, towards east [deg].")}};
  return section;
}

Forms pointing_forms() { return form::choice({"zenith"}) | form::map(pointing_section); }

void read_pointing(const YamlValue& value, bool on_ground, SensorConfig& sensor,
                   const std::optional<Site>& origin) {
  if (value.is_scalar()) {
    value.choice();
    sensor.pointing = PointUp{};
    return;
  }
  YamlMap map(value, pointing_section());
  const bool horizon = map.find("azimuth_deg") || map.find("elevation_deg");
  const bool sky = map.find("ra_deg") || map.find("dec_deg");
  const auto target = map.find("target"), body = map.find("body"), scan = map.find("scan"),
             enu = map.find("enu");
  auto cued = map.find("cued");
  if (cued && cued->is_scalar() && !cued->flag()) cued.reset();
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
    if (const auto place = map.find("place")) at.geometric = place->choice() == "geometric";
    if (const auto offset = map.find("offset_deg")) {
      const auto xy = offset->numbers();
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
    sensor.tracking =
        tracking->chosen({Tracking::fixed, Tracking::sidereal, Tracking::target, Tracking::moving});
    if (sensor.tracking == Tracking::target && !target && !cued)
      tracking->fail("there is no target to track", false);
    if (sensor.tracking == Tracking::moving && !moves && !scan)
      tracking->fail("needs a moving pointing: rates or scan", false);
    if (sensor.tracking == Tracking::fixed && !on_ground && (sky || target || scan))
      tracking->fail("in orbit, fixed needs a zenith or body pointing; use sidereal or target");
  }
  read_bound(map, sensor);
  if (cued && sensor.tracking == Tracking::fixed)
    map.require("tracking").fail("a cued sensor follows its target or the stars");
  if (body && sensor.roll_deg != 0.0)
    map.require("roll_deg").fail("a camera fixed to a body is rolled by up", false);
  if (enu && sensor.roll_deg != 0.0)
    map.require("roll_deg").fail("a camera in east, north and up is rolled by up", false);
  map.done();
}

}  // namespace dmise
