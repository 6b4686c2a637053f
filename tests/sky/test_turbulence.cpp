#include "core/sky/air/turbulence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/sky/air/scintillation.h"

namespace dmise {
namespace {

// The 5/7 model at 0.5 um: r0 = 4.96 cm, isoplanatic angle 6.89 urad.
TEST(Turbulence, HufnagelValley57) {
  const Turbulence s = turbulence(HufnagelValley{}, 0.5 * um);
  EXPECT_NEAR(s.r0_m, 0.0496, 0.005 * 0.0496);
  EXPECT_NEAR(s.isoplanatic_angle_rad, 6.89e-6, 0.005 * 6.89e-6);
}

TEST(Turbulence, R0GoesAsWavelengthToTheSixFifthsAndAirmassToTheMinusThreeFifths) {
  const double r0 = turbulence(HufnagelValley{}, 0.5 * um).r0_m;
  EXPECT_NEAR(turbulence(HufnagelValley{}, 2.2 * um).r0_m / r0, std::pow(4.4, 1.2), 1e-9);
  EXPECT_NEAR(turbulence(HufnagelValley{}, 0.5 * um, 2.0).r0_m / r0, std::pow(2.0, -0.6), 1e-9);
}

// A constant layer has its integral in closed form.
TEST(Turbulence, TableOfOneLayer) {
  const Cn2Table layer{{1000, 3000}, {1e-16, 1e-16}};
  const double k = 2 * pi / (0.55 * um);
  EXPECT_NEAR(turbulence(layer, 0.55 * um).r0_m, std::pow(0.423 * k * k * 2e-13, -0.6), 1e-9);
  const double moment = 1e-16 * 3.0 / 8.0 * (std::pow(3000, 8.0 / 3) - std::pow(1000, 8.0 / 3));
  EXPECT_NEAR(turbulence(layer, 0.55 * um).isoplanatic_angle_rad * 1e6,
              std::pow(2.914 * k * k * moment, -0.6) * 1e6, 1e-6);
  EXPECT_THROW(turbulence(Cn2Table{{3000, 1000}, {1e-16, 1e-16}}, 1 * um), Error);
  EXPECT_THROW(turbulence(Cn2Table{{0, 1000}, {1e-16, 0}}, 1 * um), Error);
  EXPECT_THROW(turbulence(layer, 0.0), Error);
}

// A slew of 0.8 deg/s moves the layer at 10 km by 140 m/s.
TEST(Turbulence, TrackingALowOrbitAddsWind) {
  const TurbulenceWind still{.ground_m_per_s = 0, .jet_m_per_s = 0, .slew_rad_per_s = 0.8 * deg};
  EXPECT_NEAR(layer_speed_m_per_s(still, 10e3), 140, 1);
  const Cn2Table at_10_km{{9990, 10010}, {1e-15, 1e-15}};
  const Turbulence s = turbulence(at_10_km, 0.5 * um, 1.0, still);
  EXPECT_NEAR(s.wind_m_per_s, 139.6, 0.2);
  EXPECT_NEAR(s.tau0_s, s.r0_m / 139.6, 1e-3 * s.tau0_s);
}

TEST(Turbulence, WithoutGroundLayerAndJetThereIsLittleLeft) {
  const Turbulence s =
      turbulence(HufnagelValley{0.0, 0.0}, 0.5 * um);  // 2.7e-16 is left of the model
  EXPECT_GT(s.r0_m, 0.1);
  EXPECT_TRUE(std::isfinite(s.tau0_s));
}

// Young: about 4 % for 0.3 m, 0.1 s, X = 1.5.
TEST(Scintillation, Young) {
  EXPECT_NEAR(scintillation_sigma(0.3, 0.1, 1.5, 0.0), 0.04, 0.002);
  EXPECT_NEAR(scintillation_sigma(1.0, 100, 1.0, 0.0), std::sqrt(10e-6 / 100), 1e-12);
  EXPECT_NEAR(scintillation_sigma(1.0, 10, 1.0, 4000) / scintillation_sigma(1.0, 10, 1.0, 0),
              std::exp(-0.5), 1e-12);
  EXPECT_TRUE(std::isfinite(scintillation_sigma(0.3, 0.0, 1.5, 0.0)));
  EXPECT_THROW(scintillation_sigma(0.0, 1.0, 1.0, 0.0), Error);
}

}  // namespace
}  // namespace dmise
