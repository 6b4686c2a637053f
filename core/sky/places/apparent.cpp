#include "core/sky/places/apparent.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/effects/plan_facts.h"

namespace dmise {
namespace {

/// The Sun does not bend light over the distances of satellites: it is put far away.
constexpr double no_sun_au = 1e9;

/// Prefetches the motion of a star. Always inlined: the compiler removes calls of a function that
/// does nothing else.
[[gnu::always_inline]] inline void prefetch(const StarColumns& c,
                                            std::span<const Vec<Gcrs>> directions,
                                            std::uint32_t star) {
  __builtin_prefetch(c.pm_ra_cosdec_rad_per_yr.data() + star);
  __builtin_prefetch(c.pm_dec_rad_per_yr.data() + star);
  __builtin_prefetch(c.parallax_rad.data() + star);
  __builtin_prefetch(directions.data() + star);
}

}  // namespace

ErrorBound Parallax::error(int, const PlanFacts& f) { return f.shifted_stars(f.star_parallax_rad); }

double Parallax::cost_s(int level, const PlanFacts& f) { return level * 2e-9 * f.stars; }

ErrorBound LightTime::error(int, const PlanFacts& f) { return f.shifted_objects(f.light_time_rad); }

ApparentPlaces::ApparentPlaces(const Observer& observer, const EffectSet& effects)
    : observer_m_(observer.position_m),
      effects_(effects, SceneFacts{.on_ground = observer.air.has_value()}, observer) {
  Vec<Gcrs> star_velocity_c, satellite_velocity_c;
  bool stars = false, satellites = false;
  effects_.for_each([&]<class Effect>(const Effect& effect) {
    if constexpr (requires { effect.velocity_c; }) {
      stars = true;
      star_velocity_c += effect.velocity_c;
      if (!Effect::displaces_satellites) return;
      satellites = true;
      satellite_velocity_c += effect.velocity_c;
    }
  });
  const double sun_distance_au = norm(observer.position_m - observer.solar_system.sun_m) / au_m;
  if (stars) of_stars_.emplace(star_velocity_c, sun_distance_au);
  if (satellites) of_satellites_.emplace(satellite_velocity_c, no_sun_au);
}

Vec<Gcrs> ApparentPlaces::star(const StarPlace& star) const {
  return seen(astrometric(CataloguedStar(star)));
}

Vec<Gcrs> ApparentPlaces::astrometric(const CataloguedStar& catalogued) const {
  Vec<Gcrs> place = catalogued.outward;
  effects_.for_each([&](const auto& effect) {
    if constexpr (requires { effect.apply(catalogued, place); }) effect.apply(catalogued, place);
  });
  return unit(place);
}

void ApparentPlaces::astrometric(const StarColumns& c, std::span<const std::uint32_t> which,
                                 std::span<const Vec<Gcrs>> directions, std::span<Vec<Gcrs>> places,
                                 SimdLevel level) const {
  if (places.size() != which.size()) throw Error("stars: one place a star");
  CatalogueMotion motion;
  effects_.for_each([&]<class Effect>(const Effect& effect) {
    constexpr bool moves_one = requires(const CataloguedStar& star, Vec<Gcrs>& place) {
      effect.apply(star, place);
    };
    constexpr bool moves_many = requires { effect.apply(c.epoch_jyear, motion); };
    static_assert(moves_one == moves_many, "an effect that moves a star moves many, too");
    if constexpr (moves_many) effect.apply(c.epoch_jyear, motion);
  });
  constexpr std::size_t room = 256;  // stars at a time
  double x[room], y[room], z[room], pm_ra[room], pm_dec[room], parallax[room];
  const auto move = kernel_of(level, sse2::move_stars, avx2::move_stars, avx512::move_stars);
  for (std::size_t begin = 0; begin < which.size(); begin += room) {
    const std::size_t count = std::min(room, which.size() - begin);
    const std::size_t whole = (count + 7) / 8 * 8;
    for (std::size_t k = 0; k < whole; ++k) {
      constexpr std::size_t ahead = 24;
      const std::size_t last = which.size() - 1;
      prefetch(c, directions, which[std::min(begin + k + ahead, last)]);
      const std::uint32_t i = which[std::min(begin + k, last)];
      x[k] = directions[i].x, y[k] = directions[i].y, z[k] = directions[i].z;
      pm_ra[k] = c.pm_ra_cosdec_rad_per_yr[i], pm_dec[k] = c.pm_dec_rad_per_yr[i];
      parallax[k] = c.parallax_rad[i];
    }
    move(motion, {x, y, z, pm_ra, pm_dec, parallax}, whole);
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t i = which[begin + k];
      const Vec<Gcrs>& from = directions[i];
      constexpr double at_the_pole2 = 1e-18;  // east and north are by right ascension there
      if (from.x * from.x + from.y * from.y < at_the_pole2)
        places[begin + k] =
            astrometric(CataloguedStar({.ra_rad = c.ra_rad[i],
                                        .dec_rad = c.dec_rad[i],
                                        .pm_ra_cosdec_rad_per_yr = c.pm_ra_cosdec_rad_per_yr[i],
                                        .pm_dec_rad_per_yr = c.pm_dec_rad_per_yr[i],
                                        .parallax_rad = c.parallax_rad[i],
                                        .epoch_jyear = c.epoch_jyear},
                                       from));
      else
        places[begin + k] = {x[k], y[k], z[k]};
    }
  }
}

Vec<Gcrs> ApparentPlaces::seen(const Vec<Gcrs>& astrometric) const {
  const Vec<Gcrs> above_air = bent_and_aberrated(astrometric);
  const auto* refraction = effects_.find<AtmosphericRefraction>();
  return refraction ? refraction->apply(above_air, Refraction::star) : above_air;
}

Vec<Gcrs> ApparentPlaces::bent_and_aberrated(Vec<Gcrs> direction) const {
  effects_.for_each([&](const auto& effect) {
    if constexpr (requires { direction = effect.apply(direction); })
      direction = effect.apply(direction);
  });
  return of_stars_ ? of_stars_->apply(direction) : direction;
}

Vec<Gcrs> ApparentPlaces::star_seen_at(const Vec<Gcrs>& apparent) const {
  const auto* refraction = effects_.find<AtmosphericRefraction>();
  const Vec<Gcrs> above_air = refraction ? refraction->undo(unit(apparent)) : unit(apparent);
  // The rest falls by a factor v/c each time.
  Vec<Gcrs> star = above_air;
  for (int i = 0; i < 8; ++i) {
    const Vec<Gcrs> missed = above_air - bent_and_aberrated(star);
    star = unit(star + missed);
    if (norm(missed) < 1e-12) break;
  }
  return star;
}

void ApparentPlaces::stars(const StarColumns& c, std::span<const std::uint32_t> which,
                           std::span<Vec<Gcrs>> directions) const {
  if (directions.size() != which.size()) throw Error("stars: one direction a star");
  const bool radial = !c.radial_velocity_m_per_s.empty();
  for (std::size_t k = 0; k < which.size(); ++k) {
    const std::uint32_t i = which[k];
    directions[k] = star({.ra_rad = c.ra_rad[i],
                          .dec_rad = c.dec_rad[i],
                          .pm_ra_cosdec_rad_per_yr = c.pm_ra_cosdec_rad_per_yr[i],
                          .pm_dec_rad_per_yr = c.pm_dec_rad_per_yr[i],
                          .parallax_rad = c.parallax_rad[i],
                          .radial_velocity_m_per_s = radial ? c.radial_velocity_m_per_s[i] : 0.0,
                          .epoch_jyear = c.epoch_jyear});
  }
}

void ApparentPlaces::finish(const Vec<Gcrs>& line_m, SatellitePlace& place) const {
  if (!(dot(line_m, line_m) > 0.0)) throw Error("no direction to a satellite at the observer");
  place.astrometric = unit(line_m);
  place.aberrated = of_satellites_ ? of_satellites_->apply(place.astrometric) : place.astrometric;
  const auto* refraction = effects_.find<AtmosphericRefraction>();
  place.direction = refraction ? refraction->apply(place.aberrated, norm(line_m)) : place.aberrated;
}

}  // namespace dmise
