#include "core/visibility/ephemeris_table.h"

#include <algorithm>

namespace dmise {
namespace {

constexpr std::int64_t hour_ns = 3'600'000'000'000;

std::int64_t hour_of(SimTime t) {
  return t.ns >= 0 ? t.ns / hour_ns : -((-t.ns + hour_ns - 1) / hour_ns);
}

}  // namespace

EphemerisTable::EphemerisTable(const Clock& clock, SimTime from, SimTime to,
                               const Ellipsoid& ellipsoid)
    : clock_(clock), ellipsoid_(ellipsoid) {
  const auto sun_at = [&](std::int64_t k) { return solar_system(clock.tt({k * hour_ns})).sun_m; };
  const auto moon_at = [&](std::int64_t half_hours) {
    return dmise::moon_m(clock.tt({half_hours * (hour_ns / 2)}));
  };
  Vec<Gcrs> sun = sun_at(hour_of(from)), moon = moon_at(2 * hour_of(from));
  for (std::int64_t k = hour_of(from); k <= hour_of(to); ++k) {
    const Vec<Gcrs> next = sun_at(k + 1), half = moon_at(2 * k + 1), end = moon_at(2 * k + 2);
    hours_.push_back({.start = {k * hour_ns},
                      .earth = earth_orientation(clock, {k * hour_ns + hour_ns / 2}),
                      .sun_m = sun,
                      .sun_step_m = next - sun,
                      .moon_m = moon,
                      .moon_step_m = half * 4.0 - moon * 3.0 - end,
                      .bend_m = (end - half * 2.0 + moon) * 2.0});
    sun = next;
    moon = end;
  }
}

const EphemerisTable::Hour& EphemerisTable::hour(SimTime t) const {
  const std::int64_t k = (t.ns - hours_.front().start.ns) / hour_ns;
  return hours_[std::size_t(std::clamp<std::int64_t>(k, 0, std::int64_t(hours_.size()) - 1))];
}

Vec<Gcrs> EphemerisTable::sun_m(SimTime t) const {
  const Hour& h = hour(t);
  return h.sun_m + h.sun_step_m * (double((t - h.start).ns) / double(hour_ns));
}

Vec<Gcrs> EphemerisTable::moon_m(SimTime t) const {
  const Hour& h = hour(t);
  const double share = double((t - h.start).ns) / double(hour_ns);
  return h.moon_m + (h.moon_step_m + h.bend_m * share) * share;
}

Sunlight::Sunlight(const EphemerisTable& sky, SimTime t)
    : gcrs_from_teme_(sky.earth(t).gcrs_from_teme(t)),
      sun_m_(sky.sun_m(t)),
      shadow_(sun_m_, sky.surface(t)) {}

double Sunlight::fraction(const Vec<Teme>& position_m) const {
  const Vec<Gcrs> p = gcrs_from_teme_ * position_m;
  const double components[3] = {p.x, p.y, p.z};
  double fraction = 0.0;
  shadow_.sunlit_fractions(components, {&fraction, 1});
  return fraction;
}

}  // namespace dmise
