#include <cmath>

#include "core/sky/places/atmospheric_refraction.h"
#include "sensors/alpaca/alpaca_devices.h"
#include "sensors/alpaca/telescope_calls.h"

namespace dmise {
namespace {

using Call = MemberCall;
using Devices = Observatory::Devices;

// ASCOM's numbers.
constexpr int german_polar = 2, j2000 = 2, sidereal_drive = 0;

/// Sets what is fixed.
MemberAnswer fixed(const Call&) {
  throw DeviceError(DeviceFault::not_implemented, "the scenario says this; it can't be set");
}

const Site& no_site() {
  static const Site none;
  return none;
}
Site site(const Call& c) { return site_of(c.sensor()).value_or(no_site()); }

MemberAnswer telescope_state(const Call& c) {
  StateItems items;
  c.on([&](const Devices& d) {
    Telescope& t = d.telescope;
    const Horizontal h = t.horizontal_place(d.now);
    const Equatorial e = t.place(d.now);
    items.add("Altitude", h.elevation_rad / deg);
    items.add("AtHome", t.is_at_home(d.now));
    items.add("AtPark", t.is_parked(d.now));
    items.add("Azimuth", h.azimuth_rad / deg);
    items.add("Declination", e.dec_deg);
    items.add("IsPulseGuiding", t.is_pulse_guiding(d.now));
    items.add("RightAscension", e.ra_deg / hour_deg);
    items.add("SideOfPier", int(t.side(d.now)));
    items.add("Slewing", t.is_slewing(d.now));
    items.add("Tracking", t.is_tracking(d.now));
    items.add("UTCDate", c.observatory.utc(d.now) + "Z");
  });
  items.add("SiderealTime", c.observatory.sidereal_time_rad(c.station) / deg / hour_deg);
  return items.take();
}

std::vector<Member> telescope_places() {
  return {
      {"altitude",
       [](const Call& c) {
         return answer_of(c.of([](const Devices& d) {
           return d.telescope.horizontal_place(d.now).elevation_rad;
         }) / deg);
       }},
      {"azimuth",
       [](const Call& c) {
         return answer_of(c.of([](const Devices& d) {
           return d.telescope.horizontal_place(d.now).azimuth_rad;
         }) / deg);
       }},
      {"rightascension",
       [](const Call& c) {
         return answer_of(c.of([](const Devices& d) { return d.telescope.place(d.now).ra_deg; }) /
                          hour_deg);
       }},
      {"declination",
       [](const Call& c) {
         return answer_of(c.of([](const Devices& d) { return d.telescope.place(d.now).dec_deg; }));
       }},
      {"siderealtime",
       [](const Call& c) {
         return answer_of(c.observatory.sidereal_time_rad(c.station) / deg / hour_deg);
       }},
      {"sideofpier",
       [](const Call& c) {
         return answer_of(c.of([](const Devices& d) { return int(d.telescope.side(d.now)); }));
       },
       fixed},
      {"destinationsideofpier",
       [](const Call& c) {
         const Equatorial to = place_of(ra_h(c), dec_deg(c));
         return answer_of(
             c.of([&](const Devices& d) { return int(d.telescope.destination_side(to, d.now)); }));
       }},
      {"utcdate",
       [](const Call& c) { return answer_of(c.observatory.utc(c.observatory.now()) + "Z"); },
       fixed},
      {"sitelatitude", [](const Call& c) { return answer_of(site(c).latitude_deg); }, fixed},
      {"sitelongitude",
       [](const Call& c) { return answer_of(std::remainder(site(c).longitude_deg, 360.0)); },
       fixed},
      {"siteelevation", [](const Call& c) { return answer_of(site(c).height_m); }, fixed},
      {"targetrightascension",
       [](const Call& c) { return answer_of(needed(c.session.target_ra_h)); },
       [](const Call& c) {
         c.session.target_ra_h = ra_h(c, "TargetRightAscension");
         return MemberAnswer{};
       }},
      {"targetdeclination",
       [](const Call& c) { return answer_of(needed(c.session.target_dec_deg)); },
       [](const Call& c) {
         c.session.target_dec_deg = dec_deg(c, "TargetDeclination");
         return MemberAnswer{};
       }},
  };
}

std::vector<Member> telescope_facts() {
  return {
      {"alignmentmode", [](const Call&) { return answer_of(german_polar); }},
      {"equatorialsystem", [](const Call&) { return answer_of(j2000); }},
      {"aperturearea",
       [](const Call& c) { return answer_of(c.sensor().camera.optics.collecting_area_m2()); }},
      {"aperturediameter",
       [](const Call& c) { return answer_of(c.sensor().camera.optics.aperture_m); }},
      {"focallength",
       [](const Call& c) { return answer_of(c.sensor().camera.optics.focal_length_m); }},
      {"doesrefraction",
       [](const Call& c) {
         return answer_of(c.sensor().effects.has(AtmosphericRefraction::facts));
       },
       fixed},
      {"devicestate", telescope_state},
      {"canfindhome", answer_yes},
      {"canpark", answer_yes},
      {"canpulseguide", answer_yes},
      {"cansetdeclinationrate", answer_yes},
      {"cansetguiderates", answer_yes},
      {"cansetpark", answer_yes},
      {"cansetpierside", answer_no},
      {"cansetrightascensionrate", answer_yes},
      {"cansettracking", answer_yes},
      {"canslew", answer_yes},
      {"canslewaltaz", answer_yes},
      {"canslewaltazasync", answer_yes},
      {"canslewasync", answer_yes},
      {"cansync", answer_yes},
      {"cansyncaltaz", answer_no},
      {"canunpark", answer_yes},
      {"canmoveaxis", [](const Call& c) { return answer_of(axis_of(c) < 2); }},
      {"axisrates",
       [](const Call& c) {
         if (axis_of(c) == 2) return MemberAnswer{.value = "[]"};
         const double rate =
             c.of([](const Devices& d) { return d.telescope.settings().slew_rate_deg_per_s; });
         JsonWriter json;
         json.begin_array().begin_object().field("Maximum", rate).field("Minimum", 0.0);
         return MemberAnswer{.value = json.end_object().end_array().take()};
       }},
      {"trackingrates", [](const Call&) { return MemberAnswer{.value = "[0]"}; }},
      {"trackingrate", [](const Call&) { return answer_of(sidereal_drive); },
       [](const Call& c) {
         if (c.given.integer("TrackingRate") != sidereal_drive)
           refuse_value("TrackingRate must be 0, sidereal: rates of tracking do the rest");
         return MemberAnswer{};
       }},
  };
}

}  // namespace

const std::vector<Member>& telescope_members() {
  static const std::vector<Member> members = [] {
    std::vector<Member> all = telescope_places();
    for (const auto& more : {telescope_facts(), telescope_motions(), telescope_commands()})
      all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return members;
}

}  // namespace dmise
