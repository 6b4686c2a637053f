// What do the sky of a frame and the stars of a field cost? One JSON object a line, as `dmise
// bench` prints.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/star_light.h"
#include "core/sky/extinction.h"
#include "core/sky/sky_grid.h"
#include "core/sky/sky_model.h"
#include "core/sky/star_cache.h"

namespace dmise {
namespace {

/// Of processor time, so that other work on the machine does not count.
template <class Work>
double median_ms(int repeats, Work&& work) {
  std::vector<double> ms;
  for (int i = 0; i < repeats; ++i) {
    const std::clock_t start = std::clock();
    work();
    ms.push_back(1e3 * double(std::clock() - start) / CLOCKS_PER_SEC);
  }
  std::sort(ms.begin(), ms.end());
  return ms[ms.size() / 2];
}

void print(const char* name, double value, const char* unit, double target) {
  JsonWriter json;
  json.begin_object().field("name", name).field("value", value).field("unit", unit);
  json.field("target", target).field("met", value <= target).end_object();
  std::puts(json.text().c_str());
}

/// The paper's all-sky camera: 90 deg across 3326 px, gnomonic, at the zenith.
void whole_sky() {
  constexpr int columns = 3326, rows = 2504;
  const double focal_px = columns / 2.0;
  SkyScene scene;
  scene.moon = from_spherical<Enu>(1.0, 60 * deg);
  scene.moon_phase_rad = 0.4;
  scene.sun = from_spherical<Enu>(2.5, -10 * deg);
  const SkyModel sky(*sky_parts_named("urban"), scene, johnson_v(), *extinction_of_site("lick"));
  const PixelFunction radiance = [&](double x, double y) {
    return sky.photons_per_s_m2_sr(
        unit(Vec<Enu>{x - (columns - 1) / 2.0, y - (rows - 1) / 2.0, focal_px}));
  };
  std::vector<float> image(std::size_t(columns) * rows);
  SkyGridReport report;
  const double ms =
      median_ms(7, [&] { report = fill_from_grid(columns, rows, radiance, 0.005, image.data()); });
  double worst = 0.0;
  for (int y = 0; y < rows; y += 3)
    for (int x = 0; x < columns; x += 3) {
      const double exact = radiance(x, y);
      worst = std::max(worst, std::abs(image[std::size_t(y) * columns + x] / exact - 1));
    }
  print("sky.all_parts_ms", ms, "ms", 40);
  print("sky.all_parts_error", worst, "relative", 0.005);
  print("sky.evaluations", double(report.evaluations), "count", double(columns) * rows);
}

void stars(const std::string& catalogue) {
  const StarMap map = load_star_map(catalogue);
  print("sky.catalogue_read_ms", median_ms(3, [&] { load_star_map(catalogue); }), "ms", 1000);
  const StarLight light{Band{}};
  std::vector<std::uint32_t> found;
  double sum = 0.0;
  const auto field = [&](double radius_deg) {
    return median_ms(51, [&] {
      found.clear();
      query_cone(map.stars, map.index, from_spherical<Gcrs>(1.0, 0.5), radius_deg * deg, 9.0,
                 found);
      for (const std::uint32_t i : found)
        sum += light.photons_per_s_m2(map.stars.v_mag[i], map.stars.bv[i]);
    });
  };
  print("sky.stars_1deg_query_ms", field(0.7), "ms", 0.2);
  print("sky.stars_90deg_query_ms", field(52.0), "ms", 5);
  std::fprintf(stderr, "%zu stars in the wide field, %g photons/s/m2\n", found.size(), sum);
}

}  // namespace
}  // namespace dmise

int main(int count, char** arguments) {
  dmise::whole_sky();
  if (count > 1) dmise::stars(arguments[1]);
}
