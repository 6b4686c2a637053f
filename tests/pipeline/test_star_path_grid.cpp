#include "sensors/sky/star_path_grid.h"

#include <random>

#include "core/base/numeric/simd_level.h"
#include "core/base/units.h"
#include "core/optics/projection.h"
#include "core/sky/air/air_exposure.h"
#include "core/sky/air/airmass.h"
#include "tests/pipeline/harness.h"

namespace dmise {
namespace {

std::string scenario(const std::string& camera, const std::string& pointing, double exposure_s) {
  return "simulation: {start: 2018-01-21T00:13:40Z, duration_s: 60, tick_s: 5}\n"
         "sensors:\n  - name: eye\n"
         "    site: {latitude_deg: 33.777, longitude_deg: -84.398, height_m: 300}\n"
         "    camera: " +
         camera + "\n    pointing: " + pointing +
         "\n    exposure_s: " + std::to_string(exposure_s) + "\n    cadence_s: 60\n";
}

std::string camera(const char* projection, double focal_length_m) {
  return "{optics: {projection: " + std::string(projection) +
         ", columns: 1600, rows: 1200, pixel_pitch_m: 1.0e-5, focal_length_m: " +
         std::to_string(focal_length_m) +
         ", aperture_m: 0.005, psf_fwhm_px: 1.5}, detector: {quantum_efficiency: 0.5, "
         "full_well_e: 1.0e+5, gain_e_per_dn: 1}, band: {name: V, centre_m: 5.5e-7, width_m: "
         "9.0e-8}}";
}

/// Paths of random directions by the grid beside the exact ones. Returns the share of those that
/// the grid has.
double compare(const std::string& yaml) {
  test::Stage stage(yaml);
  const SensorConfig& sensor = stage.scenario.sensors[0];
  const View view(sensor, frame_times(sensor, 1), stage.states);
  const std::array<SimTime, 3> times{view.times().start, view.times().middle, view.times().end};
  const auto exact = [&](const Vec<Gcrs>& astrometric) -> std::optional<StarPath> {
    StarPath path;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec<Gcrs> seen = view.places(times[k]).seen(astrometric);
      const auto pixel = test::pixel_of(view, seen, times[k]);
      if (!pixel) return std::nullopt;
      path.pixel[k] = *pixel;
      if (k == 1) path.middle = seen;
    }
    path.airmass = airmass(elevation_over(view.up(times[1]), path.middle));
    path.illumination = view.illumination(path.pixel[1]);
    return path;
  };
  const StarPathGrid grid(view, exact);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> along(-4.0, 1604.0), down(-4.0, 1204.0);
  double found = 0, in_frame = 0, worst_px = 0, worst_airmass = 0, worst_rad = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto direction = unproject(sensor.camera.optics, {along(random), down(random)});
    if (!direction) continue;
    const Vec<Gcrs> astrometric =
        view.places(times[1]).star_seen_at(view.camera_from_gcrs(times[1]).inverse() * *direction);
    const auto truly = exact(astrometric);
    if (!truly) continue;
    ++in_frame;
    StarPath path;
    StarPathGrid::Found answer{};
    grid.find({&astrometric, 1}, {&path, 1}, {&answer, 1});
    EXPECT_NE(answer, StarPathGrid::Found::beside) << i;
    if (answer != StarPathGrid::Found::path) continue;
    ++found;
    for (std::size_t k = 0; k < 3; ++k)
      worst_px = std::max(worst_px, std::hypot(path.pixel[k].x_px - truly->pixel[k].x_px,
                                               path.pixel[k].y_px - truly->pixel[k].y_px));
    worst_rad = std::max(worst_rad, norm(path.middle - truly->middle));
    worst_airmass = std::max(worst_airmass, std::abs(path.airmass / truly->airmass - 1));
    EXPECT_NEAR(path.illumination, truly->illumination, 2e-4);
  }
  EXPECT_LT(worst_px, StarPathGrid::tolerance_px);
  EXPECT_LT(worst_rad, 3e-7);
  EXPECT_LT(worst_airmass, 3e-4);
  return found / in_frame;
}

TEST(StarPathGrid, AWideCameraAtTheZenithIsWithinItsTolerance) {
  EXPECT_GT(compare(scenario(camera("gnomonic", 0.008), "zenith", 20)), 0.9);
}

// The horizon is in the field: what the grid can't have is left to the exact path.
TEST(StarPathGrid, AFisheyeDownToTheHorizonIsWithinItsTolerance) {
  EXPECT_GT(compare(scenario(camera("equidistant", 0.004), "zenith", 20)), 0.5);
}

TEST(StarPathGrid, ATelescopeLowOverTheHorizonIsWithinItsTolerance) {
  EXPECT_GT(compare(scenario(camera("gnomonic", 0.5), "{azimuth_deg: 100, elevation_deg: 12}", 5)),
            0.9);
}

// Stars that cross the field are left to the exact path, all of them.
TEST(StarPathGrid, HasNoneOfPathsAcrossTheField) {
  EXPECT_EQ(compare(scenario(camera("gnomonic", 8.0), "{azimuth_deg: 100, elevation_deg: 50}", 50)),
            0.0);
}

TEST(StarPathGrid, InterpolatesTheSameBytesOnEveryInstructionSet) {
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  constexpr std::size_t across = 9, down = 7, count = 101;
  std::vector<double> nodes(across * down * path_values);
  for (double& node : nodes) node = normal(random);
  std::vector<PatchPlace> places(count);
  for (std::size_t i = 0; i < count; ++i)
    places[i] = {2 * (i % 3) * across + 2 * (i % 4), 0.0199 * double(i), 2.0 - 0.0151 * double(i)};
  std::vector<double> reference(count * path_values), other(reference.size());
  sse2::interpolate_paths(nodes.data(), across, places.data(), count, reference.data());
  for (const SimdLevel level : {SimdLevel::avx2, SimdLevel::avx512}) {
    if (level > best_simd_level()) continue;
    kernel_of(level, sse2::interpolate_paths, avx2::interpolate_paths, avx512::interpolate_paths)(
        nodes.data(), across, places.data(), count, other.data());
    EXPECT_EQ(other, reference) << name(level);
  }
}

}  // namespace
}  // namespace dmise
