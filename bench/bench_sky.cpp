#include "bench/bench_sky.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/figure.h"
#include "bench/timing.h"
#include "core/base/units.h"
#include "core/config/yaml/search_path.h"
#include "core/optics/projection.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/star_light.h"
#include "core/sky/air/extinction.h"
#include "core/sky/places/apparent.h"
#include "core/sky/sky_grid.h"
#include "core/sky/sky_model.h"
#include "core/sky/stars/star_cache.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

/// The paper's all-sky camera, 90 deg across 3326 px, gnomonic, at the zenith; with Moon and dawn.
void whole_sky(bool json) {
  constexpr int columns = 3326, rows = 2504, sampled = 7;
  const Optics optics{.focal_length_m = columns / 2.0 * 5.4e-6,
                      .aperture_m = 0.0375,
                      .pixel_pitch_m = 5.4e-6,
                      .columns = columns,
                      .rows = rows};
  SkyScene scene;
  scene.moon = from_spherical<Enu>(1.0, 60 * deg);
  scene.moon_phase_rad = 0.4;
  scene.sun = from_spherical<Enu>(2.5, -10 * deg);
  const SkyModel sky(*sky_parts_named("urban"), scene, johnson_v(), *extinction_of_site("lick"));
  const PixelFunction radiance = [&](double x, double y) {
    const auto seen = unproject(optics, {x, y});
    if (!seen || seen->z <= 0) return 0.0;
    return sky.photons_per_s_m2_sr({seen->x, seen->y, seen->z}) *
           pixel_solid_angle_sr(optics, {x, y});
  };
  std::vector<float> image(std::size_t(columns) * rows);
  Threads one(1);
  const double ms = 1e3 * median_seconds(7, [&] {
                      fill_from_grid(columns, rows, radiance, 0.005, image.data(), one);
                    });
  double worst = 0.0;
  const double exact_ms = sampled * sampled * 1e3 * median_seconds(1, [&] {
                            for (int y = 0; y < rows; y += sampled)
                              for (int x = 0; x < columns; x += sampled) {
                                const double got = image[std::size_t(y) * columns + std::size_t(x)];
                                worst = std::max(worst, std::abs(got / radiance(x, y) - 1));
                              }
                          });
  print_figure({"all_parts_ms", ms, "ms", "every pixel evaluated", exact_ms, 40, true}, json);
  print_figure({"all_parts_error", worst, "1", "", 0, 0.005, true}, json);
}

/// Stars of one field for a frame: search, apparent places with refraction, photon rates.
void stars(bool json) {
  const std::string path = find_catalogue("stars.dat.gz");
  if (path.empty()) {
    std::fprintf(stderr, "bench sky: no stars: the benchmarks of stars are skipped\n");
    return;
  }
  const StarMap map = load_star_map(path);
  const StarTable& c = map.stars;
  const Clock clock(parse_utc("2018-01-21T03:00:00Z"));
  const Observer observer =
      ground_observer({33.777, -84.398, 300.0}, earth_orientation(clock, {}), {}, clock.tt({}),
                      solar_system(clock.tt({})), Refraction(standard_weather(300.0)));
  const StarLight light{Band{}};
  double rate_sum = 0.0;  // prevents elimination of the work
  std::size_t drawn = 0;
  const Vec<Gcrs> zenith = unit(observer.position_m);
  const auto field_ms = [&](double radius_deg, double faintest_v_mag) {
    std::vector<std::uint32_t> found;
    std::vector<Vec<Gcrs>> places;
    return 1e3 * median_seconds(21, [&] {
             found.clear();
             query_cone(map, zenith, radius_deg * deg, faintest_v_mag, found);
             places.resize(found.size());
             const ApparentPlaces apparent(observer, EffectSet{});
             apparent.stars({c.epoch_jyear,
                             c.ra_rad,
                             c.dec_rad,
                             c.pm_ra_cosdec_rad_per_yr,
                             c.pm_dec_rad_per_yr,
                             c.parallax_rad,
                             {}},
                            found, places);
             for (const std::uint32_t i : found)
               rate_sum += light.photons_per_s_m2(c.v_mag[i], c.bv[i]);
             drawn = found.size();
           });
  };
  const double wide_ms = field_ms(52.0, 8.1);
  const auto wide = double(drawn);
  print_figure({"stars_90deg_ms", wide_ms * 1e4 / wide, "ms", "", 0, 5, true}, json);
  print_figure({"stars_1deg_ms", field_ms(0.71, 9.0), "ms", "", 0, 0.2, true}, json);
  print_figure({"catalogue_read_ms", 1e3 * median_seconds(3, [&] { load_star_map(path); }), "ms",
                "", 0, 0, true},
               json);
  const auto cache =
      std::filesystem::temp_directory_path() / ("dmise-bench-stars-" + std::to_string(getpid()));
  std::filesystem::create_directories(cache);
  load_star_map(path, cache);
  print_figure({"catalogue_shared_ms", 1e3 * median_seconds(9, [&] { load_star_map(path, cache); }),
                "ms", "", 0, 0, true},
               json);
  std::filesystem::remove_all(cache);
  if (!(rate_sum > 0)) std::fprintf(stderr, "bench sky: no star in the field\n");
}

}  // namespace

int bench_sky(bool json) {
  whole_sky(json);
  stars(json);
  return 0;
}

}  // namespace dmise
