#pragma once
#include <cmath>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "core/astrometry/plate_solver.h"
#include "core/sky/stars/star_cache.h"
#include "tests/support/data.h"

namespace dmise::test {

inline const StarMap& kstars() {
  static const StarMap map = load_star_map(catalogue_path("stars.dat.gz"));
  return map;
}

/// Stars at random places, of which there are 4 times as many in 1.25 mag, to V = 12.
inline StarMap random_sky(std::uint32_t count) {
  std::mt19937_64 random(1);
  const auto uniform = [&] { return double(random() >> 11) * 0x1p-53; };
  StarCatalogue c;
  for (std::uint32_t i = 0; i < count; ++i)
    append_star(c, {.id = i,
                    .ra_rad = 2 * pi * uniform(),
                    .dec_rad = std::asin(2 * uniform() - 1),
                    .v_mag = 12.0 + 1.25 / std::log(4.0) * std::log(1 - uniform())});
  return star_map_of(std::move(c));
}

/// As many a square degree as Tycho-2 has to V = 11.
inline const StarMap& crowded_sky() {
  static const StarMap map = random_sky(400'000);
  return map;
}

/// The sky of the date from above the air, at rest beside the Earth's centre.
inline PlateSky sky_of(const StarMap& map, double jd = 2458139.5) {
  const Tt tt{jd, 0.0};
  return PlateSky(map, space_observer({7e6, 0, 0}, {0, 7.5e3, 0}, tt, solar_system(tt)));
}

/// A camera that points at a place with a roll (0: rows to the south).
inline Rotation<CameraFrame, Gcrs> pointing(double ra_deg, double dec_deg, double roll_deg) {
  const Vec<Gcrs> z = from_spherical<Gcrs>(ra_deg * deg, dec_deg * deg);
  const Vec<Gcrs> west = {std::sin(ra_deg * deg), -std::cos(ra_deg * deg), 0};
  const Vec<Gcrs> south = cross(z, west);
  const double c = std::cos(roll_deg * deg), s = std::sin(roll_deg * deg);
  const Vec<Gcrs> x = west * c + south * s, y = cross(z, x);
  Rotation<CameraFrame, Gcrs> r;
  r.m = {{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
  return r;
}

struct SeenPlate {
  PlateModel truth;
  PlateHint belief;
  std::vector<PlateSource> sources;
};

struct PlateCase {
  std::string projection = "gnomonic";
  double width_deg = 20;
  double ra_deg = 100, dec_deg = 20, roll_deg = 30;
  int columns = 2000, rows = 1500;
};

inline void PrintTo(const PlateCase& c, std::ostream* out) {
  *out << c.projection << ' ' << c.width_deg << " deg at " << c.ra_deg << ' ' << c.dec_deg;
}

/// Images of the brightest stars in a frame, with normal errors; then wrong ones at random.
inline SeenPlate seen_plate(const PlateSky& sky, const PlateCase& c, std::size_t stars,
                            double sigma_px, unsigned seed, int spurious = 0,
                            bool mirrored = false) {
  SeenPlate p;
  p.truth.projection =
      Projection::make(*Projection::index_of_name(c.projection), std::vector<double>{});
  p.truth.camera_from_gcrs = pointing(c.ra_deg, c.dec_deg, c.roll_deg);
  if (mirrored) p.truth.camera_from_gcrs = flipped(p.truth.camera_from_gcrs);
  p.truth.focal_length_px = 0.5 * c.columns / p.truth.projection.height(0.5 * c.width_deg * deg);
  p.truth.centre = {(c.columns - 1) / 2.0, (c.rows - 1) / 2.0};
  p.truth.unit_px = 0.5 * std::hypot(c.columns, c.rows);
  p.belief = {c.columns, c.rows, p.truth.projection, 0.0, std::nullopt};
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto uniform = [&](double to) { return to * double(random() >> 11) * 0x1p-53; };
  const auto half = p.truth.projection.axis_angle_rad(p.truth.unit_px / p.truth.focal_length_px, 0);
  for (const SeenStar& s : sky.brightest(p.truth.axis(), half.value_or(2.0), 20 * stars)) {
    if (p.sources.size() >= stars) break;
    const auto at = p.truth.pixel(s.direction);
    if (!at || at->x_px < 0 || at->y_px < 0 || at->x_px > c.columns - 1 || at->y_px > c.rows - 1)
      continue;
    const double mag = s.v_mag + 0.3 * (s.bv - 0.65) + 0.05 * normal(random);
    p.sources.push_back({.x_px = at->x_px + sigma_px * normal(random),
                         .y_px = at->y_px + sigma_px * normal(random),
                         .flux = 1e6 * std::pow(10, -0.4 * mag),
                         .covariance_px2 = {sigma_px * sigma_px, 0, sigma_px * sigma_px}});
  }
  const std::size_t real = p.sources.size();
  for (int i = 0; i < spurious; ++i)
    p.sources.push_back({.x_px = uniform(c.columns - 1),
                         .y_px = uniform(c.rows - 1),
                         .flux = real ? p.sources[random() % real].flux : 1.0 + uniform(100),
                         .covariance_px2 = {sigma_px * sigma_px, 0, sigma_px * sigma_px}});
  return p;
}

/// Largest distance of the images of directions over the frame by two plates [px].
inline double difference_px(const PlateModel& a, const PlateModel& b, int columns, int rows) {
  double most = 0.0;
  for (int j = 0; j <= 8; ++j)
    for (int i = 0; i <= 8; ++i) {
      const PixelPosition at{i * (columns - 1) / 8.0, j * (rows - 1) / 8.0};
      const auto direction = a.direction(at);
      if (!direction) continue;
      const auto other = b.pixel(*direction);
      if (!other) return 1e9;
      most = std::max(most, std::hypot(other->x_px - at.x_px, other->y_px - at.y_px));
    }
  return most;
}

}  // namespace dmise::test
