#include "sensors/light/object_light.h"

#include <algorithm>
#include <numeric>

#include "tests/pipeline/shape_scenes.h"

namespace dmise::test {
namespace {

struct Lights {
  FrameProducts frame;
  std::vector<Truth> truths;
  std::vector<ExpectedElectronImage> images;
};

/// The frame of a stage, and the light of each of its objects alone.
Lights lights_of(Stage& stage) {
  Lights lights;
  const auto& sensor = stage.scenario.sensors[0];
  OutputConfig output;
  output.sources = output.noise = true;
  PipelineSettings settings{.sensor = sensor,
                            .clock = make_clock(stage.scenario),
                            .digest = "test",
                            .output = output,
                            .shapes = std::make_shared<const ObjectShapes>(
                                stage.scenario.own_objects, sensor.camera.band, sensor.effects)};
  settings.object_light = [&](const Truth& truth, const ExpectedElectronImage& light,
                              const ElectronImage& noise) {
    EXPECT_EQ(noise.pixels.size(), light.pixels.size());
    lights.truths.push_back(truth);
    lights.images.push_back(light);
  };
  FramePipeline pipeline(settings, stage.stars, stage.threads);
  lights.frame = pipeline.run(frame_times(sensor, 1), stage.states);
  return lights;
}

double sum(const ExpectedElectronImage& image) {
  return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0);
}

const std::string gaussian =
    "{columns: 128, rows: 128, pixel_pitch_m: 1.0e-5, focal_length_m: 1, aperture_m: 0.2, "
    "psf_fwhm_px: 2}";
const std::string diffraction =
    "{columns: 128, rows: 128, pixel_pitch_m: 1.0e-5, focal_length_m: 1, aperture_m: 0.02, psf: "
    "diffraction, method: transform}";
const std::string ghost =
    "{columns: 128, rows: 128, pixel_pitch_m: 1.0e-5, focal_length_m: 1, aperture_m: 0.2, "
    "psf_fwhm_px: 2, ghost_fraction: 0.01, ghost_radius_px: 20}";

std::string point(const Sight& sight, const std::string& name, double right_px, double down_px) {
  constexpr double range_m = 50e3;
  return shape_at(name, sight, range_m, right_px * range_m * 1e-5, down_px * range_m * 1e-5,
                  "    radius_m: 0.005\n");  // no brighter than the sky
}

/// Beside a sky: what a run has in its plane of sources is the sum of the lights.
void expect_sum_is_the_sources(const std::string& optics, const std::string& objects,
                               const std::string& target, std::size_t count) {
  Stage stage(text_of({.objects = objects,
                       .pointing = "{target: " + target + "}",
                       .optics = optics,
                       .effects = ""}));
  const Lights lights = lights_of(stage);
  ASSERT_EQ(lights.images.size(), count);
  const double exposure_s = lights.frame.header.exposure_s;
  for (std::size_t k = 0; k < count; ++k)
    EXPECT_NEAR(sum(lights.images[k]) / lights.truths[k].rendered_signal_e, 1.0, 0.02);
  const auto& sources = lights.frame.planes.sources.pixels;
  const float brightest = *std::max_element(sources.begin(), sources.end());
  for (std::size_t i = 0; i < sources.size(); ++i) {
    double all_e = 0.0;
    for (const auto& image : lights.images) all_e += image.pixels[i];
    ASSERT_NEAR(all_e, sources[i] * exposure_s, 1e-4 * brightest * exposure_s) << i;
  }
}

TEST(ObjectLight, OfAllObjectsIsThePlaneOfSources) {
  const Sight sight = lit_sight();
  const std::string three =
      point(sight, "one", 0, 0) + point(sight, "two", 3, 1) + point(sight, "three", -40, 20);
  for (const auto& optics : {gaussian, diffraction, ghost})
    expect_sum_is_the_sources(optics, three, "one", 3);
}

// A black plate hides the middle quarter of a white one and a point behind it.
TEST(ObjectLight, WhatIsHiddenHasNone) {
  const Sight sight = lit_sight();
  const auto plate = [&](const char* name, double range_m, double side_px, const char* paint) {
    const std::string side = std::to_string(range_m * side_px * 1e-5);
    return shape_at(name, sight, range_m, 0, 0,
                    facing(sight) + "    geometry: {model: plate, size_m: [" + side + ", " + side +
                        "], front: " + paint + ", back: " + paint +
                        ", materials: " + DMISE_SOURCE_DIR + "/tests/pipeline/plain.yaml}\n");
  };
  const std::string objects = plate("far", 2000, 64, "white") + plate("near", 1000, 32, "dark") +
                              point(sight, "beside", 50, 0) + point(sight, "behind", 2, 2);
  Stage stage(text_of({.objects = objects, .pointing = "{target: far}", .optics = gaussian}));
  const Lights lights = lights_of(stage);
  for (std::size_t k = 0; k < lights.images.size(); ++k) {
    const std::string& name = lights.truths[k].name;
    EXPECT_NE(name, "behind");
    if (name == "near") {
      EXPECT_LT(sum(lights.images[k]), 1.0);
    }
    if (name != "far") continue;
    EXPECT_GT(lights.images[k].at(40, 40), 1000.0f);
    EXPECT_LT(lights.images[k].at(64, 64), 1e-3f * lights.images[k].at(40, 40));
  }
}

// Pixels of a border of 16 px collect nothing: an object on its rim has half of its light, one
// within none.
TEST(ObjectLight, InReferencePixelsIsNone) {
  const Sight sight = lit_sight();
  const std::string objects =
      point(sight, "middle", 0, 0) + point(sight, "rim", -48, 3) + point(sight, "within", 60, -60);
  for (const auto& optics : {gaussian, diffraction, ghost}) {
    std::string text =
        text_of({.objects = objects, .pointing = "{target: middle}", .optics = optics});
    text.insert(text.find("full_well_e"), "reference_px: 16, ");
    Stage stage(text);
    const Lights lights = lights_of(stage);
    const double all_e = truth_named(lights.frame, "middle").rendered_signal_e;
    const Truth& rim = truth_named(lights.frame, "rim");
    EXPECT_NEAR(rim.rendered_signal_e / all_e, 0.5, 0.01);
    EXPECT_GT(rim.rendered_x_px, 15.5);
    EXPECT_TRUE(rim.in_frame);
    EXPECT_TRUE(rim.whole);
    EXPECT_FALSE(truth_named(lights.frame, "within").in_frame);
    EXPECT_EQ(truth_named(lights.frame, "within").rendered_signal_e, 0.0);
    EXPECT_EQ(lights.frame.report.objects_rendered, 2u);
    ASSERT_EQ(lights.images.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NEAR(sum(lights.images[k]) / lights.truths[k].rendered_signal_e, 1.0, 0.02);
      for (int i = 0; i < 128; ++i) EXPECT_EQ(lights.images[k].at(15, i), 0.0f);
    }
  }
}

}  // namespace
}  // namespace dmise::test
