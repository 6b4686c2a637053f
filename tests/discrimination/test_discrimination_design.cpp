#include "core/discrimination/discrimination_design.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/config/objects/material_config.h"
#include "core/config/sensors/camera_config.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

class Design : public testing::Test {
 protected:
  Design() {
    setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
    const Camera camera = read_camera(
        YamlValue::load(std::string(DMISE_SOURCE_DIR) + "/launch/cameras/hawaii-4rg.yaml"));
    imager.optics = camera.optics;
    imager.quantum_efficiency = camera.detector.quantum_efficiency;
    imager.dark_e_per_s = camera.detector.dark_e_per_s;
    imager.read_noise_e = camera.detector.read_noise_e;
    const MaterialLibrary& library = MaterialLibrary::shipped();
    materials = {*library.find("silicon-cell"), *library.find("germanium-cell")};
  }

  SpectralImager imager;
  ReflectingTarget target{.area_m2 = 0.1, .range_m = 2.4e6};
  std::array<Band, 2> bands{Band{.name = "R95", .centre_m = 0.925e-6, .width_m = 0.05e-6},
                            Band{.name = "SWIR140", .centre_m = 1.425e-6, .width_m = 0.05e-6}};
  std::array<Material, 2> materials;
};

TEST_F(Design, ExposureIsWhereTheErrorIsWhatWasAskedFor) {
  const auto seconds = exposure_for(imager, target, bands, materials, 0.01);
  ASSERT_TRUE(seconds);
  EXPECT_NEAR(wrong_probability(imager, target, bands, materials, *seconds), 0.01, 1e-6);
  EXPECT_GT(wrong_probability(imager, target, bands, materials, 0.9 * *seconds), 0.01);
}

// With read noise alone the signal needed is fixed: exposure grows as the distance squared.
TEST_F(Design, ExposureGrowsAsTheSquareOfDistanceUnderReadNoise) {
  imager.sky_v_mag_per_arcsec2 = 30.0;
  imager.dark_e_per_s = 0.0;
  imager.read_noise_e = 1000.0;
  const auto near = exposure_for(imager, target, bands, materials);
  target.range_m *= 3.0;
  const auto far = exposure_for(imager, target, bands, materials);
  EXPECT_NEAR(*far / *near, 9.0, 0.1);
}

TEST_F(Design, BandsOfOneReflectanceTellNothing) {
  const MaterialLibrary& library = MaterialLibrary::shipped();
  EXPECT_FALSE(exposure_for(imager, target, bands,
                            {*library.find("white-paint"), *library.find("black-paint")}));
}

// Silicon turns from dark to bright at its band edge near 1.1 um, germanium does not.
TEST_F(Design, TheBestBandsLieOnBothSidesOfTheBandEdge) {
  const auto pairs = compare_band_pairs(imager, target, materials, 0.40e-6, 1.80e-6, 0.05e-6);
  ASSERT_EQ(pairs.size(), 28u * 27u / 2u);
  EXPECT_LT(pairs[0].shorter.centre_m, 1.1e-6);
  EXPECT_GT(pairs[0].longer.centre_m, 1.1e-6);
  EXPECT_LE(*pairs[0].exposure_s, *exposure_for(imager, target, bands, materials));
}

TEST_F(Design, CurvesAreMonotone) {
  const DiscriminationDesign d = design(imager, target, bands, materials);
  for (std::size_t i = 1; i < d.right_by_exposure.size(); ++i)
    EXPECT_GE(d.right_by_exposure[i][1], d.right_by_exposure[i - 1][1]);
  for (std::size_t i = 1; i < d.by_range_m.size(); ++i)
    EXPECT_GE(d.by_range_m[i].exposure_s.value_or(1e9),
              d.by_range_m[i - 1].exposure_s.value_or(1e9));
  for (std::size_t i = 1; i < d.by_aperture_m.size(); ++i)
    EXPECT_LE(*d.by_aperture_m[i].exposure_s, *d.by_aperture_m[i - 1].exposure_s);
}

}  // namespace
}  // namespace dmise
