#include "bench/effect_shares.h"

#include <algorithm>
#include <array>
#include <vector>

#include "bench/timing.h"
#include "core/optics/projection.h"
#include "core/sky/places/place_effects.h"
#include "sensors/light/sky_layer.h"

namespace dmise {
namespace {

constexpr int share_repeats = 5;

void add_places(const View& view, const StarTable& stars, std::size_t places, EffectTimes& times) {
  constexpr std::size_t most = 1024;
  const std::size_t size = std::min(most, stars.ra_rad.size());
  if (size == 0) return;
  std::vector<std::uint32_t> sample(size);
  for (std::size_t i = 0; i < size; ++i) sample[i] = std::uint32_t(i * stars.ra_rad.size() / size);
  const StarColumns columns{.epoch_jyear = stars.epoch_jyear,
                            .ra_rad = stars.ra_rad,
                            .dec_rad = stars.dec_rad,
                            .pm_ra_cosdec_rad_per_yr = stars.pm_ra_cosdec_rad_per_yr,
                            .pm_dec_rad_per_yr = stars.pm_dec_rad_per_yr,
                            .parallax_rad = stars.parallax_rad};
  std::vector<Vec<Gcrs>> directions(size);
  const auto seconds_with = [&](const EffectSet& set) {
    const ApparentPlaces apparent = view.places(view.times().middle, set);
    return median_seconds(share_repeats, [&] { apparent.stars(columns, sample, directions); });
  };
  const EffectSet& all = view.sensor().effects;
  const double whole_s = seconds_with(all);
  PlaceEffects::for_each([&]<class Effect>() {
    if (!all.has(Effect::facts) || std::is_same_v<Effect, LightTime>) return;  // objects only
    EffectSet others = all;
    others.set(Effect::facts, false);
    times[Effect::facts] =
        std::max(0.0, whole_s - seconds_with(others)) * double(places) / double(size);
  });
}

void add_sky_parts(const View& view, double sky_s, EffectTimes& times) {
  const auto& optics = view.sensor().camera.optics;
  const SkyModel sky = sky_over(view, {});
  const auto enu_from_camera = view.enu_from_gcrs(view.times().middle) *
                               view.camera_from_gcrs(view.times().middle).inverse();
  constexpr int side = 16;
  std::vector<Vec<Enu>> sample;
  for (int i = 0; i < side * side; ++i)
    if (const auto direction = unproject(optics, {(i % side + 0.5) / side * (optics.columns - 1.0),
                                                  (i / side + 0.5) / side * (optics.rows - 1.0)}))
      sample.push_back(enu_from_camera * *direction);
  std::array<double, sky_part_count> part_s{};
  double sum_s = 0.0, s10 = 0.0;
  for (std::size_t i = 0; i < sky_part_count; ++i) {
    part_s[i] = median_seconds(share_repeats, [&] {
      for (const auto& direction : sample) s10 += sky.part_s10(static_cast<SkyPart>(i), direction);
    });
    sum_s += part_s[i];
  }
  if (!(s10 >= 0) || !(sum_s > 0.0)) return;
  std::size_t part = 1;  // after the uniform one
  SkyPartEffects::for_each(
      [&]<class Part>() { times[Part::facts] = sky_s * part_s[part++] / sum_s; });
}

}  // namespace

EffectTimes effect_shares(const View& view, const StarTable& stars, std::size_t star_places,
                          double sky_s) {
  EffectTimes times;
  add_places(view, stars, star_places, times);
  add_sky_parts(view, sky_s, times);
  return times;
}

}  // namespace dmise
