#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/config/objects/material_config.h"
#include "core/config/yaml/yaml_reader.h"
#include "tests/materials/brdf_value.h"

namespace dmise {
namespace {

const MaterialLibrary& library() {
  static const MaterialLibrary all(DMISE_SOURCE_DIR "/launch/materials/library.yaml");
  return all;
}

double reflectance(const char* name, double wavelength_m) {
  return directional_reflectance(brdf_at(*library().find(name), wavelength_m), 1.0);
}

// Reference: cell reflectances of the paper.
TEST(MaterialLibrary, CellsReflectWhatThePaperGives) {
  EXPECT_NEAR(reflectance("silicon-cell", 0.95e-6), 0.025, 1e-6);
  EXPECT_NEAR(reflectance("silicon-cell", 1.40e-6), 0.39, 1e-6);
  EXPECT_NEAR(reflectance("germanium-cell", 0.95e-6), 0.025, 1e-6);
  EXPECT_NEAR(reflectance("germanium-cell", 1.40e-6), 0.025, 1e-6);
}

TEST(MaterialLibrary, EveryMaterialStatesItsSourceAndConservesEnergy) {
  EXPECT_GE(library().all().size(), 8u);
  for (const auto& [name, material] : library().all()) {
    EXPECT_FALSE(material.source.empty()) << name;
    for (double wavelength_m = 0.3e-6; wavelength_m < 2.5e-6; wavelength_m += 0.01e-6)
      for (int i = 0; i <= 20; ++i)
        EXPECT_LE(directional_reflectance(brdf_at(material, wavelength_m), i / 20.0), 1.0 + 1e-9)
            << name;
  }
}

// By quadrature over the hemisphere that is seen, at incidence from the normal to grazing: what
// leaves is no more than what falls in, whatever the closed form says.
TEST(MaterialLibrary, NoMaterialReflectsMoreThanFallsInAtAnyGeometry) {
  constexpr int steps = 256;
  for (const auto& [name, material] : library().all())
    for (const double wavelength_m : {0.4e-6, 0.6e-6, 1.4e-6})
      for (const double cos_in : {1.0, 0.9, 0.6, 0.3, 0.1, 0.02, 1e-3}) {
        const Brdf brdf = brdf_at(material, wavelength_m);
        const double sin_in = std::sqrt(1 - cos_in * cos_in);
        double sum = 0;
        for (int i = 0; i < steps; ++i)
          for (int j = 0; j < steps; ++j) {
            const double cos_out = (i + 0.5) / steps, azimuth = pi * (j + 0.5) / steps;
            const double cos_phase =
                cos_in * cos_out + sin_in * std::sqrt(1 - cos_out * cos_out) * std::cos(azimuth);
            sum += reflected_per_sr(brdf, {cos_in, cos_out, cos_phase});
          }
        const double reflectance = sum * 2 * pi / (double(steps) * steps) / cos_in;
        EXPECT_LE(reflectance, 1.0 + 2e-3) << name << " " << wavelength_m << " " << cos_in;
        EXPECT_GE(reflectance, 0.0);
      }
}

std::string complaint(const std::string& text) {
  try {
    YamlMap map(YamlValue::parse(text, "m.yaml"));
    read_material("panel", map.require("panel"));
    return "";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

TEST(MaterialLibrary, WrongMaterialsPointAtTheirLine) {
  EXPECT_EQ(complaint("panel: {model: lambert, reflectance: 0.3}"), "");
  EXPECT_EQ(complaint("panel: {model: lambert, reflectance: 1.3}"),
            "m.yaml:1:38: panel.reflectance: must be <= 1, got 1.3");
  EXPECT_EQ(complaint("panel: {model: shiny}").substr(0, 30), "m.yaml:1:16: panel.model: must");
  EXPECT_NE(complaint("panel: {model: lambert, wavelength_um: [0.5, 0.6], reflectance: [0.1]}")
                .find("must have as many numbers as wavelength_um (2), got 1"),
            std::string::npos);
  EXPECT_NE(complaint("panel: {model: sandford-robertson, grazing: 0.6, lobe_width: 0.4, "
                      "emissivity: 0.6, diffuse: 0.1}")
                .find("emissivity + diffuse must be <= G(grazing) = 0.664564"),
            std::string::npos);
  EXPECT_NE(complaint("panel: {model: lambert, reflectance: 0.3, shine: 2}").find("unknown key"),
            std::string::npos);
}

}  // namespace
}  // namespace dmise
