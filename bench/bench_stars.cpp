#include "bench/bench_stars.h"

#include <malloc.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "bench/figure.h"
#include "bench/status_memory.h"
#include "bench/timing.h"
#include "core/base/units.h"
#include "core/frames/sky_frames.h"
#include "core/sky/stars/star_map_file.h"
#include "core/sky/stars/synthetic_stars.h"

namespace dmise {
namespace {

struct Options {
  std::size_t stars = 1'000'000;
  std::string directory;
};
Options& options() {
  static Options chosen;
  return chosen;
}

/// Stars all over the sky, twice as many a magnitude fainter, to V = 20.
StarCatalogue random_sky(std::size_t count) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  StarCatalogue catalogue;
  for (std::size_t i = 0; i < count; ++i)
    append_star(catalogue, {.id = std::uint32_t(i),
                            .ra_rad = 2 * pi * uniform(random),
                            .dec_rad = std::asin(2 * uniform(random) - 1),
                            .pm_ra_cosdec_rad_per_yr = 1e-8 * uniform(random),
                            .pm_dec_rad_per_yr = 1e-8 * uniform(random),
                            .v_mag = std::max(2.0, 20 + std::log2(1 - uniform(random))),
                            .bv = uniform(random)});
  return catalogue;
}

void measure_index(const std::string& path, bool json) {
  constexpr int fields = 21;
  malloc_trim(0);
  const double before_mb = status_mb("RssAnon");
  const double began_s = thread_seconds();
  const OpenedStarMap opened = open_star_map(path);
  print_figure({"index_open_ms", 1e3 * (thread_seconds() - began_s), "ms"}, json);
  print_figure({"index_stars", double(opened.map.stars.size()), "1"}, json);
  std::vector<std::uint32_t> found;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  double stars = 0.0;
  const double field_s = median_seconds(fields, [&] {
    found.clear();
    query_cone(opened.map,
               from_spherical<Gcrs>(2 * pi * uniform(random), std::asin(2 * uniform(random) - 1)),
               0.5 * deg, 99.0, found);
    stars += double(found.size()) / fields;
  });
  const std::string name = options().stars == 100'000'000 ? "field_of_1e8_ms" : "field_ms";
  print_figure({name, 1e3 * field_s, "ms", "", 0, 50, true}, json);
  print_figure({"field_stars", stars, "1"}, json);
  print_figure(
      {"private_mb", std::max(0.0, status_mb("RssAnon") - before_mb), "MB", "", 0, 20, true}, json);
}

void measure_synthetic(bool json) {
  const SyntheticStars sky(nullptr, 0.0, 21.0);
  std::size_t stars = 0;
  const double field_s = median_seconds(5, [&](int k) {
    const Vec<Galactic> plane = from_spherical<Galactic>((40 + 10 * k) * deg, 1 * deg);
    stars = sky.around(galactic_from_gcrs().inverse() * plane, 0.36 * deg, 21.0).id.size();
  });
  print_figure({"synthetic_field_ms", 1e3 * field_s, "ms"}, json);
  print_figure({"synthetic_field_stars", double(stars), "1"}, json);
}

}  // namespace

void add_stars_options(CLI::App& app) {
  app.add_option("--stars", options().stars,
                 "stars of the index; 100000000 take 8 GB of disk and "
                 "11 GB of memory")
      ->check(CLI::Range(std::size_t(1), std::size_t(1'000'000'000)))
      ->capture_default_str();
  app.add_option("--directory", options().directory, "where the index is put meanwhile");
}

int bench_stars(bool json) {
  namespace fs = std::filesystem;
  const fs::path place =
      options().directory.empty() ? fs::temp_directory_path() : fs::path(options().directory);
  const std::string path = (place / ("bench-" + std::to_string(getpid()) + ".stars")).string();
  try {
    write_star_map(path, star_map_of(random_sky(options().stars)), {});
    measure_index(path, json);
  } catch (...) {
    fs::remove(path);
    throw;
  }
  fs::remove(path);
  measure_synthetic(json);
  return 0;
}

}  // namespace dmise
