#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "core/orbit/elements/catalogue.h"
#include "core/time/iso8601.h"
#include "core/visibility/passes.h"
#include "tests/support/data.h"
#include "tests/support/sightings_one_by_one.h"

namespace dmise::test {

/// A camera of square pixels whose frame is `wide_deg` x `high_deg` (gnomonic).
inline Optics flat_camera(double wide_deg, double high_deg) {
  const double x = std::tan(0.5 * wide_deg * deg), y = std::tan(0.5 * high_deg * deg);
  Optics o{.projection = Projection::gnomonic, .aperture_m = 0.1, .pixel_pitch_m = 1e-6};
  o.columns = 3000;
  o.rows = int(std::lround(3000 * y / x));
  o.focal_length_m = 1500.0 * 1e-6 / x;
  return o;
}

/// A fisheye whose frame holds all within 90 deg of its boresight.
inline Optics all_sky_camera() {
  Optics o{.projection = Projection::equidistant, .aperture_m = 0.1, .pixel_pitch_m = 1e-6};
  o.columns = o.rows = 2000;
  o.focal_length_m = 1000.0 * 1e-6 / (0.5 * pi);
  return o;
}

inline SensorConfig at_atlanta(const Optics& optics, double mask_deg = 0.0) {
  SensorConfig s{.name = "atlanta", .place = SiteConfig{"", 33.777, -84.398, 300.0}};
  s.camera.optics = optics;
  s.pointing = PointUp{};
  s.mask_deg = mask_deg;
  return s;
}

/// Everything that a search needs, kept together.
struct Watch {
  SensorConfig sensor;
  TimeGrid grid;
  EphemerisTable sky;
  Sgp4Batch batch;
  SensorTrack track;
  Threads threads;

  Watch(const SensorConfig& sensor_, const std::vector<MeanElements>& elements,
        const std::string& start, double duration_s, double step_s,
        std::optional<std::size_t> platform = std::nullopt,
        std::optional<std::size_t> target = std::nullopt, int thread_count = 1)
      : sensor(sensor_),
        grid(covering_grid({0}, sim_seconds(duration_s), sim_seconds(step_s))),
        sky(Clock(parse_utc(start)), grid.from, grid.last()),
        batch(elements),
        track(sensor, sky, batch, platform, target),
        threads(thread_count) {}
  Watch(const Watch&) = delete;

  Sightings sightings() { return find_sightings(batch, track, grid, threads); }
  Sightings one_by_one() { return find_sightings_one_by_one(batch, track, grid); }
  std::vector<Pass> passes() { return passes_of(batch, track, sightings().intervals, threads); }
};

inline std::vector<MeanElements> debian_catalogue() {
  return read_catalogue(catalogue_path("demo.tle")).elements;
}

}  // namespace dmise::test
