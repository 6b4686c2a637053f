#include "core/config/sensors/instrument_config.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/files/text_file.h"
#include "core/base/units.h"
#include "core/config/sensors/effect_list.h"
#include "core/config/sensors/sensor_config.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

SensorConfig sensor_with(const std::string& keys, const std::string& first_s = "10") {
  setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
  return read_sensor(YamlValue::parse("{name: a, site: atlanta, camera: raven, pointing: zenith, "
                                      "exposure_s: 2, cadence_s: 5, first_exposure_s: " +
                                          first_s + ", " + keys + "}",
                                      "s.yaml"),
                     {}, {}, true, sim_seconds(60));
}

std::string complaint(const std::string& keys, const std::string& first_s = "10") {
  try {
    sensor_with(keys, first_s);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(InstrumentConfig, ReadsUnitsIntoSi) {
  const Instrument i =
      sensor_with(
          "clock_error: {offset_ms: -20, drift_ppm: 3, jitter_ms: 0.5}, pointing_error: {bias_deg: "
          "[2, 0, -5], drift_arcsec_per_s: [0.1, 0.2, 0.3], jitter_arcsec: 4}")
          .instrument;
  EXPECT_DOUBLE_EQ(i.offset_s, -0.02);
  EXPECT_DOUBLE_EQ(i.drift, 3e-6);
  EXPECT_DOUBLE_EQ(i.clock_rms_s, 0.5e-3);
  EXPECT_EQ(i.bias_rad, (ImageAxes{2 * deg, 0, -5 * deg}));
  EXPECT_EQ(i.drift_rad_per_s, (ImageAxes{0.1 * arcsec, 0.2 * arcsec, 0.3 * arcsec}));
  EXPECT_EQ(i.pointing_rms_rad, (ImageAxes{4 * arcsec, 4 * arcsec, 0}));
  const Instrument j =
      sensor_with("pointing_error: {bias_arcsec: [1, 2, 3], jitter_arcsec: [1, 2, 3]}").instrument;
  EXPECT_EQ(j.bias_rad, (ImageAxes{1 * arcsec, 2 * arcsec, 3 * arcsec}));
  EXPECT_EQ(j.pointing_rms_rad, j.bias_rad);
  EXPECT_FALSE(j.ClockError::applies());
}

TEST(InstrumentConfig, TheExampleOfTheDocumentsIsRead) {
  const std::string page = read_text_file(DMISE_SOURCE_DIR "/docs/models/frames.md");
  const std::string heading = "## What the sensor believes\n\n";
  const std::size_t from = page.find(heading) + heading.size();
  const std::string example = page.substr(from, page.find("\n\n", from) - from);
  setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
  const YamlValue sensor = YamlValue::parse(
      "    name: a\n    site: atlanta\n    camera: raven\n    pointing: zenith\n"
      "    exposure_s: 2\n    cadence_s: 5\n" +
          example + "\n",
      "frames.md");
  EXPECT_EQ(read_sensor(sensor, {}, {}, true, sim_seconds(60)).instrument.offset_s, 0.02);
}

TEST(InstrumentConfig, WhatCannotBeIsNamed) {
  const std::pair<std::string, std::string> cases[] = {
      {"clock_error: {offset_ms: 1e9}", "clock_error.offset_ms: must be <= 60000, got 1e9"},
      {"clock_error: {offset_ms: .nan}", "clock_error.offset_ms"},
      {"clock_error: {jitter_ms: -1}", "clock_error.jitter_ms"},
      {"clock_error: {}", "clock_error: needs one of offset_ms, drift_ppm, jitter_ms"},
      {"clock_error: 5", "clock_error"},
      {"vibration: {}",
       "vibration: needs one of psd_hz, psd_arcsec2_per_hz, sine_hz, sine_rms_arcsec"},
      {"vibration: {psd_hz: [1, 2]}",
       "vibration: psd_hz and psd_arcsec2_per_hz must have the same number of items"},
      {"vibration: {psd_hz: [1], psd_arcsec2_per_hz: [1]}", "must have two frequencies or more"},
      {"vibration: {psd_hz: [2, 2], psd_arcsec2_per_hz: [1, 1]}", "psd_hz must rise"},
      {"vibration: {sine_hz: [5], sine_rms_arcsec: [1, 2]}", "the same number of items"},
      {"vibration: {sine_hz: [5], sine_rms_arcsec: [-1]}", "sine_rms_arcsec"},
      {"vibration: {sine_hz: [50], sine_rms_arcsec: [9000]}", "at most 1000 px wide"},
      {"clock_error: {ofset_ms: 5}", "did you mean offset_ms?"},
      {"pointing_error: {bias_deg: 2}", "pointing_error.bias_deg"},
      {"pointing_error: {bias_deg: [1, 2]}", "pointing_error.bias_deg"},
      {"pointing_error: {bias_deg: [1, 2, 181]}", "pointing_error.bias_deg"},
      {"pointing_error: {bias_deg: [1, 2, 3], bias_arcsec: [1, 2, 3]}",
       "pointing_error.bias_arcsec: give one of bias_deg and bias_arcsec"},
      {"pointing_error: {jitter_arcsec: [1, 2, -3]}", "pointing_error.jitter_arcsec"},
      {"pointing_error: {drift_arcsec_per_s: [20000, 0, 0]}",
       "exposure_s: the camera must turn by no more than 10 deg within an exposure"}};
  for (const auto& [keys, message] : cases)
    EXPECT_NE(complaint(keys).find(message), std::string::npos) << keys << ": " << complaint(keys);
}

TEST(InstrumentConfig, NoExposureBeginsBeforeTheRunOrEndsAfterIt) {
  EXPECT_EQ(complaint("clock_error: {offset_ms: 2000}", "2"), "");
  EXPECT_NE(complaint("clock_error: {offset_ms: 2000}", "1")
                .find("clock_error: the first exposure may begin before the run; first_exposure_s "
                      "must be >= 2"),
            std::string::npos);
  EXPECT_NE(
      complaint("clock_error: {jitter_ms: 1}", "0").find("first_exposure_s must be >= 0.00635"),
      std::string::npos);
  EXPECT_EQ(complaint("effects: {clock_error: off}, clock_error: {offset_ms: 2000}", "1"), "");
  EXPECT_NE(complaint("clock_error: {offset_ms: -60000}").find("may end after the run does"),
            std::string::npos);
}

TEST(InstrumentConfig, IsInTheDigestIfItIsNotZero) {
  const auto digest = [](const std::string& keys) {
    JsonWriter json;
    json.begin_object();
    write_instrument_json(json, sensor_with(keys).instrument);
    return json.end_object().take();
  };
  EXPECT_EQ(digest("clock_error: {offset_ms: 0}"), "{}");
  EXPECT_NE(digest("clock_error: {offset_ms: 1}"), digest("clock_error: {offset_ms: 2}"));
  EXPECT_NE(digest("pointing_error: {bias_deg: [1, 0, 0]}"),
            digest("pointing_error: {bias_deg: [0, 1, 0]}"));
}

TEST(InstrumentConfig, EffectsApplyWhereTheyAreGiven) {
  const auto names = [](const std::string& keys) {
    const SensorConfig sensor = sensor_with(keys);
    std::string text;
    for (const EffectFacts* effect : effects_in(sensor, scene_facts(sensor)))
      if (effect->name.ends_with("_error")) text += std::string(effect->name) + " ";
    return text;
  };
  EXPECT_EQ(names("detection: on"), "");
  EXPECT_EQ(names("pointing_error: {jitter_arcsec: 1}"), "pointing_error ");
  EXPECT_EQ(names("clock_error: {offset_ms: 1}, pointing_error: {jitter_arcsec: 1}"),
            "clock_error pointing_error ");
}

}  // namespace
}  // namespace dmise
