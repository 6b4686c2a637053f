#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/base/error.h"
#include "core/config/schema.h"
#include "core/config/sensors/effect_list.h"
#include "core/config/sensors/effects_config.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/effects/frame_effects.h"
#include "core/effects/plan_facts.h"
#include "core/optics/image_optics.h"

namespace dmise {
namespace {

Accuracy read(const std::string& text) {
  return read_accuracy(YamlMap(YamlValue::parse("accuracy: " + text, "a.yaml"), scenario_section())
                           .require("accuracy"));
}

std::string complaint(const std::string& text) {
  try {
    read(text);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

EffectSet effects(const std::string& text) {
  EffectSet set;
  read_effects(YamlValue::parse(text, "e.yaml"), set);
  return set;
}

TEST(AccuracyConfig, NamesStandForBudgets) {
  EXPECT_EQ(read("standard").budget, standard_budget);
  EXPECT_EQ(read("draft").budget, draft_budget);
  EXPECT_EQ(read("reference").budget, ErrorBound{});
  EXPECT_FALSE(read("off").is_planned());
}

TEST(AccuracyConfig, ABudgetTakesWhatItDoesNotNameFromTheStandard) {
  const Accuracy accuracy = read("{position_px: 0.2, noise: 0}");
  EXPECT_EQ(accuracy.budget.position_px, 0.2);
  EXPECT_EQ(accuracy.budget.noise, 0.0);
  EXPECT_EQ(accuracy.budget.photometry_mag, standard_budget.photometry_mag);
  EXPECT_EQ(read("{seconds_per_frame: 0.2}").seconds_per_frame, 0.2);
}

TEST(AccuracyConfig, WhatIsNoBudgetIsRefusedInOneLine) {
  EXPECT_EQ(complaint("fine"),
            "a.yaml:1:11: accuracy: must be one of draft, standard, reference, off, got fine");
  for (const char* text :
       {"{position_px: -1}", "{position_px: .nan}", "{position_px: .inf}", "{noise: 1e7}",
        "{seconds_per_frame: 0}", "{seconds_per_frame: 1, noise: 0.1}", "{}", "[1]",
        "{positions_px: 1}", "{photometry_mag: much}"}) {
    EXPECT_NE(complaint(text).find("a.yaml:1:"), std::string::npos) << text;
    EXPECT_EQ(complaint(text).find('\n'), std::string::npos) << text;
  }
}

TEST(EffectLevels, AnEffectCanBeForcedToALevel) {
  EXPECT_EQ(StarBackground::limit_v_mag(effects("stars: v7").level(StarBackground::facts)), 7.0);
  EXPECT_EQ(effects("{sky_grid: pixel}").level(SkyGrid::facts), SkyGrid::facts.reference());
  EXPECT_EQ(effects("{photon_noise: gaussian}").level(PhotonNoise::facts), PhotonNoise::gaussian);
  const int level = effects("{psf_wavelengths: 5}").level(PsfWavelengths::facts);
  EXPECT_EQ(PsfWavelengths::count.at(std::size_t(level)), 5);
  EXPECT_TRUE(effects("{stars: off}").is_forced(StarBackground::facts));
  EXPECT_FALSE(effects("{stars: off}").has(StarBackground::facts));
  EXPECT_EQ(effects("{stars: on}").level(StarBackground::facts), StarBackground::facts.unplanned());
}

TEST(EffectLevels, EveryLevelCanBeNamed) {
  for (const EffectFacts* effect : all_effects())
    for (std::size_t i = 0; effect->switchable && i < effect->levels.size(); ++i)
      EXPECT_EQ(
          effects("{" + std::string(effect->name) + ": " + std::string(effect->levels[i]) + "}")
              .level(*effect),
          int(i))
          << effect->name << " " << effect->levels[i];
}

TEST(EffectLevels, ALevelThatThereIsNotIsRefused) {
  for (const char* text : {"{stars: v99}", "{sky_grid: off}", "{sky_grid: [1]}", "{psf: gaussian}",
                           "{photon_noise: exactly}"})
    EXPECT_THROW(effects(text), ConfigError) << text;
}

TEST(EffectLevels, EveryEffectWithAChoiceStatesItsErrorAndTheFirstLevelIsTheLeastAccurate) {
  // What has another choice than its level, is asked for by scenarios alone, or always runs.
  const std::set<std::string_view> as_asked{"earthshine", "moonlight", "thermal_emission", "glints",
                                            "streak",     "evaluator", "quantisation"};
  SensorConfig sensor;
  sensor.place = SiteConfig{};
  sensor.sky.parts = *sky_parts_named("suburban");
  sensor.camera.optics.spread.model = PointSpread::Model::diffraction;
  sensor.camera.optics.vignetting.natural = true;
  sensor.camera.optics.image.ghost_fraction = 1e-3;
  sensor.instrument.offset_s = 1e-3;
  sensor.instrument.sine_frequency_hz = {1.0};
  sensor.instrument.sine_rms_rad = {1e-6};
  sensor.instrument.bias_rad = {1e-6, 0, 0};
  Detector& d = sensor.camera.detector;
  d.dark_e_per_s = d.read_noise_e = d.column_noise_e = 1.0;
  d.prnu_rms = d.interpixel_coupling = d.nonlinearity = d.persistence_fraction = 0.01;
  d.hot_pixel_fraction = d.hot_pixel_e_per_s = d.cosmic_rays_per_px_s = d.frame_transfer_s = 0.1;
  d.parallel_cti = d.row_time_us = d.pixel_gain_rms = d.read_noise_spread = 0.01;
  d.brighter_fatter_per_e = 1e-7;
  d.em_gain = 100.0;
  d.ramp_reads = 8;
  d.reference_px = 4;
  d.persistence_s = 10.0;
  d.blooming = true;
  const auto list = plannable_effects(sensor, {.clouds = true,
                                               .gases = true,
                                               .stars = true,
                                               .shapes = true,
                                               .glints = true,
                                               .vignettes = true,
                                               .diffracts = true,
                                               .turbulent = true,
                                               .synthetic_stars = true,
                                               .blurs = true,
                                               .blur_varies = true,
                                               .focus_drifts = true,
                                               .stray_light = true,
                                               .thermal = true,
                                               .warm_optics = true,
                                               .sun_in_field = true,
                                               .moon_in_field = true,
                                               .earth_in_field = true,
                                               .planets_in_field = true,
                                               .daylight = true,
                                               .limb_in_field = true});
  for (const EffectFacts* effect : all_effects())
    EXPECT_TRUE(
        std::any_of(list.begin(), list.end(),
                    [&](const PlannableEffect& p) { return p.facts->name == effect->name; }) ||
        effect->name == FullWell::facts.name)  // blooming has its limit
        << effect->name;
  PlanFacts facts;
  facts.sky = {{.sky_e = 100.0, .noise_e = 12.0}};
  for (const auto& effect : list) {
    EXPECT_EQ(!effect.error, as_asked.contains(effect.facts->name)) << effect.facts->name;
    double former = unbounded;
    for (int level = 0; effect.error && level < effect.facts->reference(); ++level) {
      const ErrorBound error = effect.error(level, facts);
      double sum = 0.0;
      for (const auto& kind : error_kinds) {
        EXPECT_GE(error.*kind.value, 0.0) << effect.facts->name;
        sum += error.*kind.value;
      }
      EXPECT_LE(sum, former) << effect.facts->name << " level " << level;
      former = sum;
    }
  }
}

}  // namespace
}  // namespace dmise
