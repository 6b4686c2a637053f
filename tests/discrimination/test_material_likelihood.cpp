#include "core/discrimination/material_likelihood.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/numeric/rng.h"
#include "core/config/objects/material_config.h"

namespace dmise {
namespace {

const Band r{.name = "R95", .centre_m = 0.95e-6, .width_m = 0.001e-6};
const Band swir{.name = "SWIR140", .centre_m = 1.40e-6, .width_m = 0.001e-6};

// Table 3 of the DMISE-GHOST paper: 0.39 over 0.025, and 0.025 over 0.025.
TEST(MaterialSignature, OfCellsIsThatOfTheLaboratory) {
  setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
  const MaterialLibrary& library = MaterialLibrary::shipped();
  const std::array bands{r, swir};
  const auto silicon = signature_of(*library.find("silicon-cell"), bands).reflectance;
  EXPECT_NEAR(silicon[1] / silicon[0], 15.6, 0.05);
  const auto germanium = signature_of(*library.find("germanium-cell"), bands).reflectance;
  EXPECT_NEAR(germanium[1] / germanium[0], 1.0, 0.005);
}

const std::vector<MaterialSignature> cells{{"silicon", {0.025, 0.39}},
                                           {"germanium", {0.025, 0.025}}};

TEST(CompareMaterials, FindsTheOneThatFits) {
  const std::array<Measured, 2> light{{{2.5, 0.2}, {2.4, 0.3}}};
  const auto fits = compare_materials(light, cells);
  EXPECT_EQ(fits[0].name, "germanium");
  EXPECT_GT(fits[0].probability, 0.999999);
  EXPECT_NEAR(fits[0].probability + fits[1].probability, 1.0, 1e-12);
  EXPECT_NEAR(fits[0].amplitude, 98.77, 0.01);  // (2.5/0.04 + 2.4/0.09) / (0.025 (1/0.04 + 1/0.09))
  EXPECT_NEAR(fits[0].chi2, 0.01 / (0.04 + 0.09), 1e-9);
}

// Materials whose reflectances differ by a factor are the same to it.
TEST(CompareMaterials, CannotTellShadesOfOneColourApart) {
  const std::vector<MaterialSignature> greys{{"light", {0.8, 0.8}}, {"dark", {0.1, 0.1}}};
  const std::array<Measured, 2> light{{{1.0, 0.1}, {1.1, 0.1}}};
  const auto fits = compare_materials(light, greys);
  EXPECT_NEAR(fits[0].probability, 0.5, 1e-12);
  EXPECT_EQ(fits[0].name, "light");
}

TEST(CompareMaterials, RefusesNoMaterialsAndOtherBands) {
  const std::array<Measured, 1> light{{{1.0, 0.1}}};
  EXPECT_THROW(compare_materials(light, {}), Error);
  EXPECT_THROW(compare_materials(light, cells), Error);
}

// The closed form against draws, where a tenth is mistaken.
TEST(MistakenProbability, IsTheShareOfDraws) {
  const RngKey key = rng_key(1, "materials", 1, "draws");
  const std::array sigma{1.0, 0.8};
  const double amplitude = 60.0;
  ConfusionMatrix matrix({"silicon", "germanium"});
  constexpr int draws = 60000;
  const std::vector<MaterialSignature> two{{"silicon", {0.025, 0.06}},
                                           {"germanium", {0.025, 0.025}}};
  for (std::uint32_t i = 0; i < draws; ++i) {
    const auto& actual = two[i % 2];
    std::array<Measured, 2> light;
    for (std::size_t b = 0; b < 2; ++b)
      light[b] = {amplitude * actual.reflectance[b] +
                      sigma[b] * double(normal_of(rng_word(key, i, std::uint32_t(b)))),
                  sigma[b]};
    matrix.add(actual.name, compare_materials(light, two)[0].name);
  }
  for (std::size_t m = 0; m < 2; ++m) {
    const double share = double(matrix.count(m, 1 - m)) / double(matrix.total(m));
    const double expected = mistaken_probability(two[m], two[1 - m], amplitude, sigma);
    EXPECT_GT(expected, 0.02);
    // Beside draws, what falls opposite to both.
    EXPECT_NEAR(share, expected, 4 * std::sqrt(expected / (draws / 2.0)) + 0.1 * expected) << m;
  }
  EXPECT_THROW(matrix.add("silicon", "gold"), Error);
}

}  // namespace
}  // namespace dmise
