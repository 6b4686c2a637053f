#include "core/config/sensors/detector_config.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/config/output_config.h"
#include "core/config/sensors/camera_config.h"
#include "core/config/yaml/yaml_reader.h"
#include "tests/support/detector_of.h"

namespace dmise {
namespace {

const std::string all =
    "quantum_efficiency: 0.5\ndark_e_per_s: 20\ndark_reference_c: 20\ntemperature_c: -10\n"
    "dark_doubling_k: 6\nprnu_rms: 0.01\nhot_pixel_fraction: 1e-4\nhot_pixel_e_per_s: 5000\n"
    "cosmic_rays_per_px_s: 1e-6\ncosmic_ray_e_per_px: 800\ncosmic_ray_depth_px: 2\n"
    "reference_px: 4\npersistence_fraction: 0.01\npersistence_s: 8\nfull_well_e: 20000\n"
    "blooming: on\ninterpixel_coupling: 0.005\nnonlinearity: 0.02\ncolumn_noise_e: 2\n"
    "read_noise_e: 6\ngain_e_per_dn: 0.4\nbias_dn: 200\nadc_bits: 14\n";

Detector read(const std::string& yaml) { return read_detector(YamlValue::parse(yaml, "c.yaml")); }

std::string complaint(const std::string& what, const std::string& with) {
  std::string yaml = all;
  yaml.replace(yaml.find(what), what.size(), with);
  try {
    read(yaml);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(DetectorConfig, ReadsEveryFigureByItsName) {
  const Detector expected = detector_of({.quantum_efficiency = 1.0,  // read with the band
                                         .dark_e_per_s = 20,
                                         .dark_reference_c = 20,
                                         .temperature_c = -10,
                                         .dark_doubling_k = 6,
                                         .read_noise_e = 6,
                                         .full_well_e = 20000,
                                         .gain_e_per_dn = 0.4,
                                         .bias_dn = 200,
                                         .adc_bits = 14,
                                         .prnu_rms = 0.01,
                                         .hot_pixel_fraction = 1e-4,
                                         .hot_pixel_e_per_s = 5000,
                                         .column_noise_e = 2,
                                         .nonlinearity = 0.02,
                                         .interpixel_coupling = 0.005,
                                         .blooming = true,
                                         .persistence_fraction = 0.01,
                                         .persistence_s = 8,
                                         .cosmic_rays_per_px_s = 1e-6,
                                         .cosmic_ray_e_per_px = 800,
                                         .cosmic_ray_depth_px = 2,
                                         .reference_px = 4});
  EXPECT_EQ(read(all), expected);
  for (const DetectorParameter& p : detector_parameters())
    if (in_every_header(p)) {
      EXPECT_NE(all.find(std::string(p.key) + ":"), std::string::npos) << p.key;
    }
}

TEST(DetectorConfig, TheEfficiencyIsReadWithTheBand) {
  const Camera camera = read_camera(YamlValue::parse(
      "optics: {columns: 8, rows: 8, pixel_pitch_m: 5e-6, focal_length_m: 0.1, aperture_m: 0.05}\n"
      "detector: {full_well_e: 20000, gain_e_per_dn: 0.4, quantum_efficiency: 0.5}\n"
      "band: {filter: bessell-V}\n",
      "c.yaml"));
  EXPECT_EQ(camera.detector.quantum_efficiency, 0.5);
}

TEST(DetectorConfig, TheRestOfADetectorDoesNothing) {
  const Detector d = read("{full_well_e: 20000, gain_e_per_dn: 0.4, dark_reference_c: -20}");
  EXPECT_EQ(d.temperature_c, -20);  // unless it is given, where the dark current is known
  for (const EffectFacts& e :
       {PixelResponse::facts, DarkCurrent::facts, HotPixels::facts, CosmicRays::facts,
        ReferencePixels::facts, Persistence::facts, Blooming::facts, InterpixelCoupling::facts,
        Nonlinearity::facts, ColumnNoise::facts, ReadNoise::facts})
    EXPECT_FALSE(applies(d, e)) << e.name;
}

TEST(DetectorConfig, NonsenseIsRefusedWhereItStands) {
  EXPECT_EQ(complaint("full_well_e: 20000", "full_well_e: 0"),
            "c.yaml:15:14: full_well_e: must be > 0, got 0");
  EXPECT_EQ(complaint("gain_e_per_dn: 0.4", "gain_e_per_dn: 0"),
            "c.yaml:21:16: gain_e_per_dn: must be > 0, got 0");
  EXPECT_EQ(complaint("adc_bits: 14", "adc_bits: 32"),
            "c.yaml:23:11: adc_bits: must be 1..16: counts are 16-bit numbers in frames and "
            "messages, got 32");
  EXPECT_EQ(complaint("adc_bits: 14", "adc_bits: 0"),
            "c.yaml:23:11: adc_bits: must be >= 1, got 0");
  EXPECT_EQ(complaint("adc_bits: 14", "adc_bits: 7"),
            "c.yaml:22:10: bias_dn: must be below 2^adc_bits, got 200");
  EXPECT_EQ(complaint("dark_doubling_k: 6\n", ""),
            "c.yaml:1:1: dark_doubling_k must be > 0 when temperature_c is not dark_reference_c");
  EXPECT_EQ(complaint("prnu_rms: 0.01", "prnu_rm: 0.01"),
            "c.yaml:6:1: prnu_rm: unknown key, did you mean prnu_rms?");
  EXPECT_EQ(complaint("nonlinearity: 0.02", "nonlinearity: .nan"),
            "c.yaml:18:15: nonlinearity: must be a number, got .nan");
  EXPECT_EQ(complaint("full_well_e: 20000\n", ""), "c.yaml:1:1: full_well_e: is missing");
}

TEST(DetectorConfig, WhatDoesNotGoTogetherIsRefusedAtItsKey) {
  const auto with = [](const std::string& more) { return complaint("adc_bits: 14", more); };
  EXPECT_EQ(with("frame_transfer_s: 0.1\nrow_time_us: 10"),
            "c.yaml:24:14: row_time_us: must be 0 with frame_transfer_s: one shutter or the other, "
            "got 10");
  EXPECT_EQ(with("ramp_reads: 7\nfowler_reads: 4"),
            "c.yaml:24:15: fowler_reads: must be at most half of ramp_reads, got 4");
  EXPECT_EQ(
      with("brighter_fatter_per_e: 2e-5"),
      "c.yaml:23:24: brighter_fatter_per_e: times full_well_e must be at most 0.25, got 2e-5");
  EXPECT_EQ(with("em_gain: 0.5").find("c.yaml:23:10: em_gain: must be >= 1"), 0u);
  EXPECT_EQ(with("parallel_cti: 0.1").find("c.yaml:23:15: parallel_cti: must be <= 0.01"), 0u)
      << with("parallel_cti: 0.1");
  EXPECT_EQ(with("row_time_us: 10\nem_gain: 1000\nramp_reads: 16\nfowler_reads: 8"), "");
}

TEST(DetectorConfig, OneBitAndSixteenAreAdcs) {
  EXPECT_EQ(read("{full_well_e: 1, gain_e_per_dn: 1, adc_bits: 1}").adc_bits, 1);
  EXPECT_EQ(read("{full_well_e: 1, gain_e_per_dn: 1, adc_bits: 16}").adc_bits, 16);
}

TEST(DetectorConfig, AnExposureOfTooManyCosmicRaysIsRefused) {
  Camera camera;
  camera.optics.columns = camera.optics.rows = 4096;
  camera.detector.cosmic_rays_per_px_s = 1e-3;
  YamlMap sensor(YamlValue::parse("{short_s: 60, exposure_s: 3600}", "s.yaml"));
  check_exposure(camera, sensor.require("short_s"));
  EXPECT_THROW(check_exposure(camera, sensor.require("exposure_s")), ConfigError);
}

OutputConfig output(const std::string& yaml) { return read_output(YamlValue::parse(yaml, "s")); }

TEST(OutputConfig, NamesWhatIsWanted) {
  const auto all_of_it = output(
      "{fits: {compression: rice}, radiance_exr: true, planes: [sources, noise], saturation: on}");
  EXPECT_TRUE(all_of_it.fits && all_of_it.fits_rice && all_of_it.radiance_exr);
  EXPECT_TRUE(all_of_it.sources && all_of_it.noise && all_of_it.saturation);
  EXPECT_FALSE(all_of_it.background);
  const auto plain = output("{fits: on}");
  EXPECT_TRUE(plain.fits);
  EXPECT_FALSE(plain.fits_rice || plain.saturation || plain.radiance_exr || plain.noise);
  EXPECT_FALSE(output("{fits: off}").fits);
}

TEST(OutputConfig, RefusesWhatThereIsNot) {
  for (const char* bad : {"{fits: {compression: gzip}}", "{planes: [stars]}", "{planes: noise}",
                          "{fits: off, saturation: on}", "{radiance: on}", "{fits: {}}"})
    EXPECT_THROW(output(bad), ConfigError) << bad;
}

}  // namespace
}  // namespace dmise
