#include "core/materials/material.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace dmise {
namespace {

TEST(Material, SandfordRobertsonReflectsItsTableAtNormalIncidence) {
  const Material m = sandford_robertson_of("m", {{0.5e-6, 1.5e-6}, {0.1, 0.5}}, 0.3, 0.3, 0.2);
  EXPECT_NO_THROW(check_material(m));
  EXPECT_NEAR(directional_reflectance(brdf_at(m, 0.5e-6), 1.0), 0.1, 1e-12);
  EXPECT_NEAR(directional_reflectance(brdf_at(m, 1.0e-6), 1.0), 0.3, 1e-12);
  EXPECT_NEAR(directional_reflectance(brdf_at(m, 9.0e-6), 1.0), 0.5, 1e-12);
}

TEST(Material, OfAConstantTableIsTheSameInEveryBand) {
  Material m;
  m.reflectance = {{0.3e-6, 2e-6}, {0.4, 0.4}};
  for (const double centre_m : {0.45e-6, 1.4e-6, 10e-6}) {
    const Brdf brdf = brdf_in_band(m, {.centre_m = centre_m, .width_m = 0.1e-6});
    EXPECT_NEAR(std::get<Lambert>(brdf).reflectance, 0.4, 1e-12);
  }
}

// A table linear in wavelength over a narrow band: its value at the middle.
TEST(Material, BandMeanOfANarrowBandIsTheValueThere) {
  Material m;
  m.reflectance = {{0.5e-6, 1.0e-6}, {0.0, 1.0}};
  const Brdf brdf = brdf_in_band(m, {.centre_m = 0.7e-6, .width_m = 1e-9});
  EXPECT_NEAR(std::get<Lambert>(brdf).reflectance, 0.4, 1e-4);
}

TEST(Material, ThatBreaksEnergyAtOneWavelengthIsRefused) {
  Material m;
  m.model = Material::Model::phong;
  m.diffuse = {{0.5e-6, 1.0e-6}, {0.2, 0.9}};
  m.specular = {{0.5e-6, 1.0e-6}, {0.3, 0.3}};
  EXPECT_THROW(check_material(m), Error);
  m.specular.value[1] = 0.1;
  EXPECT_NO_THROW(check_material(m));
  m.temperature_k = -3;
  EXPECT_THROW(check_material(m), Error);
}

}  // namespace
}  // namespace dmise
