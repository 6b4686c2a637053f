#include "sensors/alpaca/telescope_calls.h"

namespace dmise {
namespace {

using Call = MemberCall;
using Devices = Observatory::Devices;

constexpr double sidereal_seconds_per_second = 1.00273790935;
constexpr double arcsec_deg = 1.0 / 3600.0;

/// The answer to a synchronous slew: it comes when the telescope is there.
MemberAnswer when_there(const Call& c) {
  return {.done = [&observatory = c.observatory, station = c.station] {
    bool slewing = false;
    observatory.use(station, [&](const Devices& d) { slewing = d.telescope.is_slewing(d.now); });
    return !slewing;
  }};
}

template <class To>
MemberAnswer slew(const Call& c, const To& to) {
  c.on([&](const Devices& d) { d.telescope.slew_to(to, d.now); });
  return {};
}
MemberAnswer sync(const Call& c, const Equatorial& to) {
  c.on([&](const Devices& d) { d.telescope.sync_to(to, d.now); });
  return {};
}

}  // namespace

std::vector<Member> telescope_motions() {
  return {
      {"athome",
       [](const Call& c) {
         return answer_of(c.of([](const Devices& d) { return d.telescope.is_at_home(d.now); }));
       }},
      {"atpark",
       [](const Call& c) {
         return answer_of(c.of([](const Devices& d) { return d.telescope.is_parked(d.now); }));
       }},
      {"slewing",
       [](const Call& c) {
         return answer_of(c.of([](const Devices& d) { return d.telescope.is_slewing(d.now); }));
       }},
      {"ispulseguiding",
       [](const Call& c) {
         return answer_of(
             c.of([](const Devices& d) { return d.telescope.is_pulse_guiding(d.now); }));
       }},
      {"tracking",
       [](const Call& c) {
         return answer_of(c.of([](const Devices& d) { return d.telescope.is_tracking(d.now); }));
       },
       [](const Call& c) {
         const bool on = c.given.flag("Tracking");
         c.on([&](const Devices& d) { d.telescope.set_tracking(on, d.now); });
         return MemberAnswer{};
       }},
      {"rightascensionrate",
       [](const Call& c) {
         return answer_of(c.of([](const Devices& d) { return d.telescope.ra_rate_deg_per_s(); }) /
                          (hour_deg * arcsec_deg * sidereal_seconds_per_second));
       },
       [](const Call& c) {
         const double rate = c.given.number("RightAscensionRate") * hour_deg * arcsec_deg *
                             sidereal_seconds_per_second;
         c.on([&](const Devices& d) {
           d.telescope.set_rates(rate, d.telescope.dec_rate_deg_per_s(), d.now);
         });
         return MemberAnswer{};
       }},
      {"declinationrate",
       [](const Call& c) {
         return answer_of(c.of([](const Devices& d) { return d.telescope.dec_rate_deg_per_s(); }) /
                          arcsec_deg);
       },
       [](const Call& c) {
         const double rate = c.given.number("DeclinationRate") * arcsec_deg;
         c.on([&](const Devices& d) {
           d.telescope.set_rates(d.telescope.ra_rate_deg_per_s(), rate, d.now);
         });
         return MemberAnswer{};
       }},
      {"guideraterightascension",
       [](const Call& c) {
         return answer_of(
             c.of([](const Devices& d) { return d.telescope.ra_guide_rate_deg_per_s(); }));
       },
       [](const Call& c) {
         const double rate = c.given.number("GuideRateRightAscension");
         c.on([&](const Devices& d) {
           d.telescope.set_guide_rates(rate, d.telescope.dec_guide_rate_deg_per_s(), d.now);
         });
         return MemberAnswer{};
       }},
      {"guideratedeclination",
       [](const Call& c) {
         return answer_of(
             c.of([](const Devices& d) { return d.telescope.dec_guide_rate_deg_per_s(); }));
       },
       [](const Call& c) {
         const double rate = c.given.number("GuideRateDeclination");
         c.on([&](const Devices& d) {
           d.telescope.set_guide_rates(d.telescope.ra_guide_rate_deg_per_s(), rate, d.now);
         });
         return MemberAnswer{};
       }},
      {"slewsettletime",
       [](const Call& c) {
         return answer_of(
             c.of([](const Devices& d) { return int(d.telescope.settings().settle_s); }));
       },
       [](const Call& c) {
         const int settle_s = c.given.integer("SlewSettleTime");
         c.on([&](const Devices& d) { d.telescope.set_settle_s(settle_s); });
         return MemberAnswer{};
       }},
  };
}

std::vector<Member> telescope_commands() {
  return {
      {"abortslew", nullptr,
       [](const Call& c) {
         c.on([](const Devices& d) { d.telescope.abort_slew(d.now); });
         return MemberAnswer{};
       }},
      {"findhome", nullptr,
       [](const Call& c) {
         c.on([](const Devices& d) { d.telescope.find_home(d.now); });
         return MemberAnswer{};
       }},
      {"park", nullptr,
       [](const Call& c) {
         c.on([](const Devices& d) { d.telescope.park(d.now); });
         return MemberAnswer{};
       }},
      {"unpark", nullptr,
       [](const Call& c) {
         c.on([](const Devices& d) { d.telescope.unpark(d.now); });
         return MemberAnswer{};
       }},
      {"setpark", nullptr,
       [](const Call& c) {
         c.on([](const Devices& d) { d.telescope.set_park(d.now); });
         return MemberAnswer{};
       }},
      {"moveaxis", nullptr,
       [](const Call& c) {
         const int axis = axis_of(c);
         const double rate = c.given.number("Rate");
         c.on([&](const Devices& d) { d.telescope.move_axis(axis, rate, d.now); });
         return MemberAnswer{};
       }},
      {"pulseguide", nullptr,
       [](const Call& c) {
         const int direction = c.given.integer("Direction");
         const int ms = c.given.integer("Duration");
         if (direction < 0 || direction > 3) refuse_value("Direction must be 0 to 3");
         const SimTime length{std::int64_t(ms) * 1'000'000};
         c.on([&](const Devices& d) {
           d.telescope.pulse_guide(GuideDirection(direction), length, d.now);
         });
         return MemberAnswer{};
       }},
      {"slewtoaltazasync", nullptr, [](const Call& c) { return slew(c, given_horizontal(c)); }},
      {"slewtocoordinatesasync", nullptr,
       [](const Call& c) {
         slew(c, given_place(c));
         set_target(c);
         return MemberAnswer{};
       }},
      {"slewtotargetasync", nullptr, [](const Call& c) { return slew(c, target_of(c)); }},
      {"slewtoaltaz", nullptr,
       [](const Call& c) {
         slew(c, given_horizontal(c));
         return when_there(c);
       }},
      {"slewtocoordinates", nullptr,
       [](const Call& c) {
         slew(c, given_place(c));
         set_target(c);
         return when_there(c);
       }},
      {"slewtotarget", nullptr,
       [](const Call& c) {
         slew(c, target_of(c));
         return when_there(c);
       }},
      {"synctoaltaz", nullptr,
       [](const Call& c) -> MemberAnswer {
         given_horizontal(c);
         throw DeviceError(DeviceFault::not_implemented,
                           "the telescope synchronises by ICRS places");
       }},
      {"synctocoordinates", nullptr,
       [](const Call& c) {
         sync(c, given_place(c));
         set_target(c);
         return MemberAnswer{};
       }},
      {"synctotarget", nullptr, [](const Call& c) { return sync(c, target_of(c)); }},
  };
}

}  // namespace dmise
