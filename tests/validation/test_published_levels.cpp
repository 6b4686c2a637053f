// Models of families of which no measurement is at hand, beside published mean magnitudes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <utility>

#include "bench/validation/brightness.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double earth_m = 6371e3;

/// An observer at x on the ground sees an object at an elevation and azimuth (from y), with the
/// Sun below his horizon at azimuth 0.
struct Sight {
  double height_m, elevation_deg, azimuth_deg, sun_elevation_deg;

  Vec<Gcrs> direction(double elevation_rad, double azimuth_rad) const {
    return {std::sin(elevation_rad), std::cos(elevation_rad) * std::cos(azimuth_rad),
            std::cos(elevation_rad) * std::sin(azimuth_rad)};
  }
  ObservedLight light() const {
    const Vec<Gcrs> observer_m{earth_m, 0, 0};
    const Vec<Gcrs> line = direction(elevation_deg * deg, azimuth_deg * deg);
    const double up = earth_m * line.x, there_m = earth_m + height_m;
    const double range_m = -up + std::sqrt(up * up + there_m * there_m - earth_m * earth_m);
    const Vec<Gcrs> position_m = observer_m + line * range_m;
    return {.scene = {.position_m = position_m,
                      .velocity_m_per_s = unit(cross(Vec<Gcrs>{0, 0, 1}, position_m)) * 7.6e3,
                      .sun_m = direction(sun_elevation_deg * deg, 0.0) * au_m},
            .observer_m = observer_m};
  }
};

struct PublishedLevels : testing::Test {
  PublishedLevels() { setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1); }

  static double v_mag(const std::string& model, const ObservedLight& light) {
    static std::map<std::string, std::pair<std::shared_ptr<const ObjectModel>, ModelLight>> known;
    auto found = known.find(model);
    if (found == known.end()) {
      const auto shape = shipped_object_model(model);
      found = known.emplace(model, std::pair(shape, ModelLight(*shape))).first;
    }
    return found->second.second.v_mag(light);
  }
  static double overhead_in_twilight_mag(const std::string& model) {
    return v_mag(model, Sight{550e3, 90, 0, -18}.light());
  }
  /// Mean at 1000 km over all azimuths and elevations of 30 to 90 deg, at a phase of about 90 deg.
  static double standard_mag(const std::string& model, double height_m) {
    double sum = 0.0;
    int count = 0;
    for (double elevation = 30; elevation <= 90; elevation += 10)
      for (double azimuth = 0; azimuth < 360; azimuth += 15) {
        const ObservedLight light = Sight{height_m, elevation, azimuth, -12}.light();
        const Vec<Gcrs> line = light.observer_m - light.scene.position_m;
        if (std::abs(angle_rad(line, light.scene.sun_m - light.scene.position_m) / deg - 90) > 15)
          continue;
        sum += v_mag(model, light) - 5.0 * std::log10(norm(line) / 1e6);
        ++count;
      }
    EXPECT_GT(count, 5);
    return sum / count;
  }
};

// Characteristic magnitudes, overhead at the end of astronomical twilight: 6.2 of VisorSats, to
// which the model was made, and 5.5 of Post-VisorSats, whose model was fitted to other
// measurements. Mallama & Respler 2022, arXiv:2210.17268.
TEST_F(PublishedLevels, StarlinksOverheadAtTheEndOfTwilight) {
  EXPECT_NEAR(overhead_in_twilight_mag("starlink-visorsat"), 6.2, 0.05);
  EXPECT_NEAR(overhead_in_twilight_mag("starlink-v1.5"), 5.5, 0.3);
}

// VisorSats have a mean of 5.92 at a distance of 550 km: Mallama 2021, arXiv:2101.00374. Where in
// the sky he observed is assumed: in dark twilight, above 30 deg.
TEST_F(PublishedLevels, VisorSatsOnTheMeanAt550Km) {
  double sum = 0.0;
  int count = 0;
  for (const double sun : {-12.0, -15.0, -18.0})
    for (double elevation = 30; elevation <= 90; elevation += 10)
      for (double azimuth = 0; azimuth < 360; azimuth += 15) {
        const ObservedLight light = Sight{550e3, elevation, azimuth, sun}.light();
        const double range_m = norm(light.observer_m - light.scene.position_m);
        sum += v_mag("starlink-visorsat", light) - 5.0 * std::log10(range_m / 550e3);
        ++count;
      }
  EXPECT_NEAR(sum / count, 5.92, 0.2);
}

// Observers state about 4 for SL-16 and 5 for SL-8, to which one reflectance was made.
TEST_F(PublishedLevels, RocketBodiesAt1000Km) {
  EXPECT_NEAR(standard_mag("sl-16-rocket-body", 840e3), 4.0, 0.2);
  EXPECT_NEAR(standard_mag("sl-8-rocket-body", 960e3), 5.0, 0.2);
}

// Active communications satellites have V of 10 to 13 away from the glints of their wings, and are
// brightest at the smallest phase.
TEST_F(PublishedLevels, GeostationarySatellites) {
  const auto at_phase = [](double phase_deg, double sun_declination_deg) {
    const double geo_m = 42164e3;
    const Vec<Gcrs> sun{-std::cos(phase_deg * deg), std::sin(phase_deg * deg),
                        std::tan(sun_declination_deg * deg)};
    return ObservedLight{.scene = {.position_m = {geo_m, 0, 0},
                                   .velocity_m_per_s = {0, 3075, 0},
                                   .sun_m = unit(sun) * au_m},
                         .observer_m = {earth_m, 0, 0}};
  };
  double last = 0.0;
  for (double phase_deg = 10; phase_deg <= 60; phase_deg += 10) {
    const double v = v_mag("geo-comsat", at_phase(phase_deg, 15));
    EXPECT_GT(v, 10.0) << phase_deg;
    EXPECT_LT(v, 13.0) << phase_deg;
    EXPECT_GT(v, last) << phase_deg;
    last = v;
  }
  // Near an equinox the wings mirror the Sun to the Earth at the smallest phase.
  EXPECT_LT(v_mag("geo-comsat", at_phase(0.5, 0)), 10.0);
}

}  // namespace
}  // namespace dmise
