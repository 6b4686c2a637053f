#include <algorithm>
#include <array>
#include <cmath>

#include "sensors/indi/property_items.h"
#include "sensors/observatory/satellite_path.h"

namespace dmise {
namespace {

using Call = IndiCall;
using Given = IndiGiven;
using Devices = Observatory::Devices;

constexpr double hour_deg = 15.0;
constexpr IndiRange hours{"%010.6m", 0.0, 24.0, 0.0, 2e-6};  // a tenth of an arcsecond
constexpr IndiRange degrees{"%010.6m", -90.0, 90.0, 0.0, 3e-5};
constexpr IndiRange arcsec_per_s{"%.6f", -3600.0, 3600.0, 0.0, 1e-6};
constexpr IndiRange milliseconds{"%.f", 0.0, 60000.0, 100.0};
constexpr IndiRange of_sidereal{"%g", 0.01, 200.0, 0.1};

constexpr std::array speed_names{"SLEW_GUIDE", "SLEW_CENTERING", "SLEW_FIND", "SLEW_MAX"};

/// Motion by hand at one of the four speeds.
double speed_deg_per_s(const Telescope& telescope, int speed) {
  const double fastest = telescope.settings().slew_rate_deg_per_s;
  const std::array speeds{sidereal_deg_per_s, 16.0 * sidereal_deg_per_s, fastest / 3.0, fastest};
  return std::min(speeds[std::size_t(speed)], fastest);
}

IndiReading coordinates(const Call& c) {
  return c.of([&](const Devices& d) {
    const Equatorial place = c.observatory.of_date(d.telescope.place(d.now), d.now);
    const IndiState state = d.telescope.is_slewing(d.now)    ? IndiState::busy
                            : d.telescope.is_tracking(d.now) ? IndiState::ok
                                                             : IndiState::idle;
    return IndiReading{{number_item("RA", "RA (hh:mm:ss)", place.ra_deg / hour_deg, hours),
                        number_item("DEC", "DEC (dd:mm:ss)", place.dec_deg, degrees)},
                       state};
  });
}

void set_coordinates(const Call& c, const Given& given) {
  const Equatorial of_date{std::fmod(given.number("RA"), 24.0) * hour_deg, given.number("DEC")};
  c.on([&](const Devices& d) {
    const Equatorial icrs = c.observatory.icrs_of(of_date, d.now);
    if (c.session.coordinates == "SYNC")
      d.telescope.sync_to(icrs, d.now);
    else
      d.telescope.go_to(icrs, c.session.coordinates == "TRACK", d.now);
  });
}

IndiReading coordinate_use(const Call& c) {
  const std::string& use = c.session.coordinates;
  return {{switch_item("TRACK", "Track", use == "TRACK"),
           switch_item("SLEW", "Slew", use == "SLEW"), switch_item("SYNC", "Sync", use == "SYNC")}};
}

IndiReading parking(const Call& c) {
  return c.of([](const Devices& d) {
    const bool going = d.telescope.is_parking(d.now), parked = d.telescope.is_parked(d.now);
    IndiReading reading{{switch_item("PARK", "Park(ed)", going || parked),
                         switch_item("UNPARK", "UnPark(ed)", !going && !parked)}};
    if (going) reading.state = IndiState::busy;
    return reading;
  });
}

void set_parking(const Call& c, const Given& given) {
  c.on([&](const Devices& d) {
    given.chosen == "PARK" ? d.telescope.park(d.now) : d.telescope.unpark(d.now);
  });
}

IndiReading tracking(const Call& c) {
  return c.of([](const Devices& d) {
    const bool on = d.telescope.is_tracking(d.now);
    return IndiReading{{switch_item("TRACK_ON", "On", on), switch_item("TRACK_OFF", "Off", !on)},
                       on ? IndiState::ok : IndiState::idle};
  });
}

IndiReading track_mode(const Call& c) {
  return {{switch_item("TRACK_SIDEREAL", "Sidereal", !c.session.custom_rate),
           switch_item("TRACK_CUSTOM", "Custom", c.session.custom_rate)}};
}

void set_track_mode(const Call& c, const Given& given) {
  const bool custom = given.chosen == "TRACK_CUSTOM";
  if (!custom) c.on([](const Devices& d) { d.telescope.set_rates(0.0, 0.0, d.now); });
  c.session.custom_rate = custom;
}

/// The rates of the axes: in right ascension what follows the stars is the sidereal rate.
IndiReading track_rate(const Call& c) {
  return c.of([](const Devices& d) {
    const double ra = sidereal_deg_per_s - d.telescope.ra_rate_deg_per_s();
    const double dec = d.telescope.dec_rate_deg_per_s();
    return IndiReading{{number_item("TRACK_RATE_RA", "RA (arcsecs/s)", ra * 3600, arcsec_per_s),
                        number_item("TRACK_RATE_DE", "DE (arcsecs/s)", dec * 3600, arcsec_per_s)}};
  });
}

void set_track_rate(const Call& c, const Given& given) {
  const double ra = sidereal_deg_per_s - given.number("TRACK_RATE_RA") / 3600;
  const double dec = given.number("TRACK_RATE_DE") / 3600;
  c.on(
      [&](const Devices& d) { d.telescope.set_rates(std::abs(ra) < 1e-9 ? 0.0 : ra, dec, d.now); });
  c.session.custom_rate = true;
}

constexpr std::size_t max_time_bytes = 40;

IndiReading element_set(const Call& c) {
  return {{text_item("TLE", "TLE", c.session.element_set)}};
}

void set_element_set(const Call& c, const Given& given) {
  const std::string& text = given.text("TLE");
  elements_in(text);  // refuses what is none
  c.session.element_set = text;
}

/// A note of the client's: the telescope follows from when it is told to.
IndiReading pass_window(const Call& c) {
  return {{text_item("SAT_PASS_WINDOW_START", "Start UTC", c.session.pass_start),
           text_item("SAT_PASS_WINDOW_END", "End UTC", c.session.pass_end)}};
}

void set_pass_window(const Call& c, const Given& given) {
  for (const char* item : {"SAT_PASS_WINDOW_START", "SAT_PASS_WINDOW_END"})
    if (given.text(item).size() > max_time_bytes) refuse_value("the time is too long");
  c.session.pass_start = given.text("SAT_PASS_WINDOW_START");
  c.session.pass_end = given.text("SAT_PASS_WINDOW_END");
}

IndiReading satellite(const Call& c) {
  return c.of([](const Devices& d) {
    const bool on = d.telescope.is_following() && d.telescope.is_tracking(d.now);
    IndiReading reading{
        {switch_item("SAT_TRACK", "Track", on), switch_item("SAT_HALT", "Halt", !on)}};
    if (on) reading.state = IndiState::busy;
    return reading;
  });
}

/// Halted it stays with the stars.
void follow_satellite(const Call& c, const Given& given) {
  if (given.chosen == "SAT_TRACK") {
    if (c.session.element_set.empty()) refuse_value("SAT_TLE_TEXT was not set");
    return c.observatory.follow_satellite(c.station, c.session.element_set);
  }
  c.on([](const Devices& d) {
    if (d.telescope.is_following()) d.telescope.abort_slew(d.now);
  });
}

struct GuideAxis {
  int axis;  // as of `Telescope::move_axis`
  const char *plus, *minus;
  GuideDirection plus_direction, minus_direction;
};
constexpr GuideAxis north_south{1, "TIMED_GUIDE_N", "TIMED_GUIDE_S", GuideDirection::north,
                                GuideDirection::south};
constexpr GuideAxis west_east{0, "TIMED_GUIDE_E", "TIMED_GUIDE_W", GuideDirection::east,
                              GuideDirection::west};

IndiReading guiding(const Call& c, const GuideAxis& a) {
  IndiReading reading{{number_item(a.plus, a.plus, 0.0, milliseconds),
                       number_item(a.minus, a.minus, 0.0, milliseconds)}};
  if (c.of([&](const Devices& d) { return d.telescope.is_pulse_guiding(a.axis, d.now); }))
    reading.state = IndiState::busy;
  return reading;
}

void guide(const Call& c, const Given& given, const GuideAxis& a) {
  const double plus_ms = given.number(a.plus), minus_ms = given.number(a.minus);
  if (plus_ms > 0.0 && minus_ms > 0.0) refuse_value("one direction at a time");
  const auto direction = plus_ms > 0.0 ? a.plus_direction : a.minus_direction;
  const SimTime length = sim_seconds(std::max(plus_ms, minus_ms) / 1000.0);
  c.on([&](const Devices& d) { d.telescope.pulse_guide(direction, length, d.now); });
}

IndiReading guide_rate(const Call& c) {
  return c.of([](const Devices& d) {
    const double ra = d.telescope.ra_guide_rate_deg_per_s() / sidereal_deg_per_s;
    const double dec = d.telescope.dec_guide_rate_deg_per_s() / sidereal_deg_per_s;
    return IndiReading{{number_item("GUIDE_RATE_WE", "W/E Rate", ra, of_sidereal),
                        number_item("GUIDE_RATE_NS", "N/S Rate", dec, of_sidereal)}};
  });
}

void set_guide_rate(const Call& c, const Given& given) {
  const double ra = given.number("GUIDE_RATE_WE") * sidereal_deg_per_s;
  const double dec = given.number("GUIDE_RATE_NS") * sidereal_deg_per_s;
  c.on([&](const Devices& d) { d.telescope.set_guide_rates(ra, dec, d.now); });
}

struct MotionAxis {
  int axis;
  const char *plus, *minus;
};
constexpr MotionAxis up_down{1, "MOTION_NORTH", "MOTION_SOUTH"};
constexpr MotionAxis left_right{0, "MOTION_EAST", "MOTION_WEST"};

IndiReading motion(const Call& c, const MotionAxis& a) {
  const double rate =
      c.of([&](const Devices& d) { return d.telescope.axis_rate_deg_per_s(a.axis); });
  IndiReading reading{
      {switch_item(a.plus, a.plus, rate > 0.0), switch_item(a.minus, a.minus, rate < 0.0)}};
  if (rate != 0.0) reading.state = IndiState::busy;
  return reading;
}

void move(const Call& c, const Given& given, const MotionAxis& a) {
  c.on([&](const Devices& d) {
    const double speed = speed_deg_per_s(d.telescope, c.session.slew_speed);
    const double rate = given.chosen.empty() ? 0.0 : given.chosen == a.plus ? speed : -speed;
    d.telescope.move_axis(a.axis, rate, d.now);
  });
}

IndiReading slew_speed(const Call& c) {
  IndiReading reading;
  for (int i = 0; i < int(speed_names.size()); ++i)
    reading.items.push_back(switch_item(speed_names[std::size_t(i)], speed_names[std::size_t(i)],
                                        i == c.session.slew_speed));
  return reading;
}

void set_slew_speed(const Call& c, const Given& given) {
  c.session.slew_speed = int(std::ranges::find(speed_names, given.chosen) - speed_names.begin());
}

IndiReading pier_side(const Call& c) {
  const bool east =
      c.of([](const Devices& d) { return d.telescope.side(d.now); }) == PierSide::east;
  return {{switch_item("PIER_WEST", "West (pointing east)", !east),
           switch_item("PIER_EAST", "East (pointing west)", east)}};
}

void abort_motion(const Call& c, const Given&) {
  c.on([](const Devices& d) {
    if (d.telescope.is_slewing(d.now) || d.telescope.is_following()) d.telescope.abort_slew(d.now);
  });
}

IndiReading site(const Call& c) {
  const Site site = site_of(c.sensor()).value_or(Site{});
  const double east_deg = std::fmod(site.longitude_deg + 360.0, 360.0);
  return {{number_item("LAT", "Lat (dd:mm:ss)", site.latitude_deg, degrees),
           number_item("LONG", "Lon (dd:mm:ss)", east_deg, {"%012.8m", 0.0, 360.0}),
           number_item("ELEV", "Elevation (m)", site.height_m, {"%g", -200.0, 10000.0})},
          IndiState::ok};
}

IndiReading time_utc(const Call& c) {
  return {{text_item("UTC", "UTC Time", c.observatory.utc(c.observatory.now())),
           text_item("OFFSET", "UTC Offset", "0")},
          IndiState::ok};
}

IndiReading optics(const Call& c) {
  const Optics& o = c.sensor().camera.optics;
  const IndiRange mm{"%g", 0.0, 100000.0};
  const double aperture_mm = o.aperture_m * 1e3, focal_mm = o.focal_length_m * 1e3;
  return {{number_item("TELESCOPE_APERTURE", "Aperture (mm)", aperture_mm, mm),
           number_item("TELESCOPE_FOCAL_LENGTH", "Focal Length (mm)", focal_mm, mm),
           number_item("GUIDER_APERTURE", "Guider Aperture (mm)", aperture_mm, mm),
           number_item("GUIDER_FOCAL_LENGTH", "Guider Focal Length (mm)", focal_mm, mm)},
          IndiState::ok};
}

std::vector<IndiProperty> pointing() {
  return {
      {numbers("EQUATORIAL_EOD_COORD", "Eq. Coordinates", main_group), coordinates,
       set_coordinates},
      {one_of("ON_COORD_SET", "On Set", main_group), coordinate_use,
       [](const Call& c, const Given& given) { c.session.coordinates = given.chosen; }},
      {at_most_one("TELESCOPE_ABORT_MOTION", "Abort Motion", main_group),
       [](const Call&) { return button("ABORT", "Abort"); }, abort_motion},
      {one_of("TELESCOPE_PARK", "Parking", main_group), parking, set_parking},
      {at_most_one("TELESCOPE_PARK_OPTION", "Park Options", site_group),
       [](const Call&) { return button("PARK_CURRENT", "Current"); },
       [](const Call& c, const Given&) {
         c.on([](const Devices& d) { d.telescope.set_park(d.now); });
       }},
      {one_of("TELESCOPE_TRACK_STATE", "Tracking", main_group), tracking,
       [](const Call& c, const Given& given) {
         c.on([&](const Devices& d) {
           d.telescope.set_tracking(given.chosen == "TRACK_ON", d.now);
         });
       }},
      {one_of("TELESCOPE_TRACK_MODE", "Track Mode", main_group), track_mode, set_track_mode},
      {numbers("TELESCOPE_TRACK_RATE", "Track Rates", main_group), track_rate, set_track_rate},
      {texts("SAT_TLE_TEXT", "Orbit", satellite_group), element_set, set_element_set},
      {texts("SAT_PASS_WINDOW", "Pass Window", satellite_group), pass_window, set_pass_window},
      {one_of("SAT_TRACKING_STAT", "Sat Tracking", satellite_group), satellite, follow_satellite},
      {one_of("TELESCOPE_PIER_SIDE", "Pier Side", main_group), pier_side},
  };
}

std::vector<IndiProperty> motions() {
  return {
      {at_most_one("TELESCOPE_MOTION_NS", "Motion N/S", motion_group),
       [](const Call& c) { return motion(c, up_down); },
       [](const Call& c, const Given& given) { move(c, given, up_down); }},
      {at_most_one("TELESCOPE_MOTION_WE", "Motion W/E", motion_group),
       [](const Call& c) { return motion(c, left_right); },
       [](const Call& c, const Given& given) { move(c, given, left_right); }},
      {one_of("TELESCOPE_SLEW_RATE", "Slew Rate", motion_group), slew_speed, set_slew_speed},
      {numbers("TELESCOPE_TIMED_GUIDE_NS", "Guide N/S", motion_group),
       [](const Call& c) { return guiding(c, north_south); },
       [](const Call& c, const Given& given) { guide(c, given, north_south); }},
      {numbers("TELESCOPE_TIMED_GUIDE_WE", "Guide E/W", motion_group),
       [](const Call& c) { return guiding(c, west_east); },
       [](const Call& c, const Given& given) { guide(c, given, west_east); }},
      {numbers("GUIDE_RATE", "Guiding Rate", motion_group), guide_rate, set_guide_rate},
  };
}

/// KStars takes the place and time of its mount from updates, not from definitions.
std::vector<IndiProperty> facts() {
  return {
      {.title = numbers("GEOGRAPHIC_COORD", "Scope Location", site_group),
       .read = site,
       .updated_when_defined = true},
      {.title = texts("TIME_UTC", "UTC", site_group),
       .read = time_utc,
       .told_when_asked = true,
       .updated_when_defined = true},
      {numbers("TELESCOPE_INFO", "Scope Properties", options_group), optics},
  };
}

}  // namespace

const std::vector<IndiProperty>& indi_telescope_properties() {
  static const std::vector<IndiProperty> properties = [] {
    std::vector<IndiProperty> all = facts();
    for (const auto& more : {pointing(), motions()})
      all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return properties;
}

}  // namespace dmise
