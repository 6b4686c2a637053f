#include <cmath>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/sky/bodies/moon_disc.h"
#include "tests/pipeline/body_scenes.h"

// Light of Sun, Moon and Earth beside the field.
namespace dmise::test {
namespace {

/// A camera in the light of Sun, Moon and Earth, none of which is in its field.
std::string stray(const Vec<Gcrs>& at_m, const Vec<Gcrs>& boresight, const std::string& table) {
  return in_space(at_m, towards(boresight), camera(16, 16, 0.1, "", ", stray_light: " + table));
}

// The irradiances of the Sun (V = -26.76, as all light here), the Moon and a Lambert Earth that is
// far away, times the transmittance, a pixel's area and the exposure, by hand.
TEST(StrayLightInFrame, IsIrradianceTimesTransmittance) {
  const Vec<Gcrs> at_m = unit(Vec<Gcrs>{bodies().sun_m.y, -bodies().sun_m.x, 0}) * 4e8;
  const Vec<Gcrs> to_sun = bodies().sun_m - at_m, to_moon = bodies().moon_m - at_m;
  const Vec<Gcrs> boresight = unit(cross(to_sun, to_moon) + to_sun * 0.1);
  const auto transmittance = [](double angle_rad) {  // the table falls a decade each 30 deg
    return std::pow(10.0, -4.0 - angle_rad / deg / 30.0);
  };
  Stage stage(stray(at_m, boresight,
                    "{angle_deg: [0, 30, 90, 180], transmittance: [1.0e-4, 1.0e-5, 1.0e-7, "
                    "1.0e-10]}"));
  const Band& band = stage.scenario.sensors[0].camera.band;
  const double au = norm(to_sun) / 149597870700.0;
  const double a = angle_rad(to_sun + at_m, at_m), size = 6371e3 / norm(at_m);
  const double sun = sunlight_photons_per_s_m2(-26.76, band) / (au * au);
  const double moon_phase = angle_rad(bodies().sun_m - bodies().moon_m, -to_moon) / deg;
  const double v_moon = -12.73 + 0.026 * moon_phase + 4e-9 * std::pow(moon_phase, 4) +
                        5 * std::log10(norm(to_moon) / 384.4e6);
  const double earth =
      sun * (2.0 / 3) * 0.3 * size * size * (std::sin(a) + (pi - a) * std::cos(a)) / pi;
  const double irradiance =
      sun * transmittance(angle_rad(boresight, to_sun)) +
      moonlight_photons_per_s_m2(v_moon, band) * transmittance(angle_rad(boresight, to_moon)) +
      earth * transmittance(angle_rad(boresight, -at_m));
  const double expected =
      irradiance * 1e-10 * stage.scenario.sensors[0].camera.detector.quantum_efficiency;
  const auto image = light_of(stage);
  EXPECT_NEAR(image.at(8, 8) / expected, 1.0, 2e-3);
  EXPECT_EQ(image.at(0, 0), image.at(15, 15));
}

TEST(StrayLightInFrame, ATableOfOneRowHoldsAtEveryAngle) {
  StrayLight one;
  one.angle_deg = {40.0};
  one.transmittance = {3e-6};
  for (const double angle_deg : {0.0, 39.0, 40.0, 41.0, 180.0})
    EXPECT_EQ(one.at(angle_deg * deg), 3e-6);
  StrayLight baffled;  // nothing from 60 deg on
  baffled.angle_deg = {20.0, 60.0};
  baffled.transmittance = {1e-4, 0.0};
  EXPECT_DOUBLE_EQ(baffled.at(40 * deg), 5e-5);
  EXPECT_EQ(baffled.at(90 * deg), 0.0);
  EXPECT_EQ(StrayLight{}.at(1.0), 0.0);
}

// In the Earth's shadow there is the Moon's and nothing of the Sun; and nothing where it is off.
TEST(StrayLightInFrame, IsDarkInTheEarthsShadowAndOffWithoutATable) {
  const std::string table = "{angle_deg: [40], transmittance: [1.0e-6]}";
  const Vec<Gcrs> night_m = -unit(bodies().sun_m) * 6900e3, day_m = -night_m;
  const Vec<Gcrs> aside = cross(unit(night_m), Vec<Gcrs>{0, 0, 1});
  Stage day(stray(day_m, aside, table)), night(stray(night_m, aside, table));
  EXPECT_LT(light_of(night).at(8, 8), 2e-6f * light_of(day).at(8, 8));
  Stage none(in_space(day_m, towards(aside), camera(16, 16, 0.1), ", earth_disc: off"));
  EXPECT_EQ(sum_of(light_of(none)), 0.0);
}

}  // namespace
}  // namespace dmise::test
