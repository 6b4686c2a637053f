#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/frames/sky_frames.h"
#include "tests/pipeline/wiring.h"

namespace dmise {
namespace {

constexpr double aperture_m = 0.2, focal_length_m = 0.2, pixel_m = 1e-5, exposure_s = 1000.0;
constexpr double wavelength_um = 0.5, width_um = 0.02;

/// A camera far from the Earth in a band about 500 nm, under the sky of its place.
std::string far_out(const std::string& pointing, const std::string& sky) {
  return test::scenario(
      "2018-01-21T00:15:00Z", exposure_s, "platform: eye",
      "{optics: {columns: 32, rows: 32, pixel_pitch_m: 1.0e-5, focal_length_m: 0.2, aperture_m: "
      "0.2}, detector: {quantum_efficiency: 1, full_well_e: 1.0e+9, gain_e_per_dn: 1}, band: "
      "{name: green, centre_m: 0.5e-6, width_m: 0.02e-6}}",
      pointing, exposure_s, exposure_s,
      sky +
          ", detection: off, effects: {photon_noise: off, dark_current: off, read_noise: off, "
          "full_well: off, quantisation: off}",
      "", "objects:\n  - name: eye\n    motion: {fixed: {gcrs_m: [42000000, 1000000, 2000000]}}\n");
}

double median_e(const std::string& yaml) {
  auto counts = test::Stage(yaml).frame().counts.pixels;
  std::ranges::nth_element(counts, counts.begin() + std::ptrdiff_t(counts.size() / 2));
  return double(counts[counts.size() / 2]);
}

/// Ecliptic longitude of the Sun from the camera.
double sun_longitude_rad() {
  test::Stage stage(far_out("{ra_deg: 0, dec_deg: 90}", ""));
  const View view(stage.scenario.sensors[0], frame_times(stage.scenario.sensors[0], 1),
                  stage.states);
  const SimTime middle = view.times().middle;
  return to_spherical(ecliptic_from_gcrs() *
                      unit(view.environment().sun_m - view.observer(middle).position_m))[0];
}

std::string towards(double longitude_rad, double latitude_rad) {
  const auto [ra, dec] = to_spherical(ecliptic_from_gcrs().inverse() *
                                      from_spherical<Ecliptic>(longitude_rad, latitude_rad));
  return "{ra_deg: " + std::to_string(std::fmod(ra / deg + 360.0, 360.0)) +
         ", dec_deg: " + std::to_string(dec / deg) + "}";
}

struct Node {
  double from_sun_deg, latitude_deg;
  double brightness;  // [1e-8 W/m2/sr/um]
};

// Reference: Leinert et al. 1998, A&AS 127, 1, table 17, zodiacal light at 500 nm; the rest is
// written out here. Longitudes are both ahead of the Sun and behind it.
TEST(SpaceSky, HoldsTheZodiacalLightOfLeinertsTable) {
  const double sun_rad = sun_longitude_rad();
  constexpr double photon_j = 6.62607015e-34 * 299792458.0 / (wavelength_um * 1e-6);
  constexpr double area_m2 = pi / 4 * aperture_m * aperture_m;
  constexpr double pixel_sr = pixel_m * pixel_m / (focal_length_m * focal_length_m);
  for (const Node& node : {Node{45, 0, 910}, Node{-60, 30, 183}, Node{90, 0, 259},
                           Node{120, 60, 77}, Node{180, 0, 230}, Node{0, 90, 77}}) {
    const double expected_e =
        node.brightness * 1e-8 * width_um / photon_j * area_m2 * pixel_sr * exposure_s;
    const double seen_e =
        median_e(far_out(towards(sun_rad + node.from_sun_deg * deg, node.latitude_deg * deg),
                         ", sky: {preset: space, parts: {faint_starlight: off}}"));
    EXPECT_NEAR(seen_e, expected_e, 0.02 * expected_e)
        << node.from_sun_deg << " " << node.latitude_deg;
  }
}

TEST(SpaceSky, IsThatOfAPlatformUnlessAFigureIsGiven) {
  const std::string at = "{ra_deg: 100, dec_deg: 40}";
  const double usual = median_e(far_out(at, "")), named = median_e(far_out(at, ", sky: space"));
  EXPECT_EQ(usual, named);
  const double dust =
      median_e(far_out(at, ", sky: {preset: space, parts: {faint_starlight: off}}"));
  EXPECT_GT(usual, dust);
  const double figure = median_e(far_out(at, ", sky: 21"));
  EXPECT_EQ(median_e(far_out(at, ", sky: {preset: space, zenith_mag_per_arcsec2: 21}")), figure);
  EXPECT_EQ(median_e(far_out("{ra_deg: 20, dec_deg: -60}", ", sky: 21")), figure);
}

}  // namespace
}  // namespace dmise
