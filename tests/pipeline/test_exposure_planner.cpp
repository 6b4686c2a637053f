#include "sensors/planning/exposure_planner.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/error.h"
#include "core/config/sensors/effect_list.h"
#include "core/effects/frame_effects.h"
#include "core/optics/waves/air_turbulence.h"
#include "core/sky/air/air_effects.h"
#include "core/sky/places/place_effects.h"
#include "tests/pipeline/harness.h"

namespace dmise {
namespace {

const std::string element_set =
    "GOES 16\n"
    "1 41866U 16071A   18019.87773469 -.00000245  00000-0  00000-0 0  9992\n"
    "2 41866   0.0069 115.0916 0001074 269.6956 335.2025  1.00271237  4322\n";

struct Scene {
  std::string accuracy = "standard", start = "2018-01-21T00:15:00Z", camera = "geo-watch",
              place = "site: savannah", pointing = "{azimuth_deg: 168.7, elevation_deg: 52}",
              effects = "{}", more = "";
  double exposure_s = 5.0;
  std::string star_v_mag = "6";

  std::string yaml() const {
    return "accuracy: " + accuracy + "\nsimulation: {start: " + start +
           ", duration_s: 30, tick_s: 5}\nobjects: [{catalogue: objects.tle}]\n"
           "stars: {catalogue: stars.csv, faintest_mag: 15}\neffects: " +
           effects + "\nsensors:\n  - {name: watch, " + place + ", camera: " + camera +
           ", pointing: " + pointing + ", exposure_s: " + std::to_string(exposure_s) +
           ", cadence_s: 10" + more + "}\n";
  }
  FrameProducts frame(int threads = 1) const {
    return test::Stage(yaml(), "ra_deg,dec_deg,mag_v,bv\n49.7,-5.4," + star_v_mag + ",0.65\n",
                       element_set, threads)
        .frame();
  }
};

bool runs(const FrameProducts& frame, const EffectFacts& effect) {
  return frame.plan.effects.has(effect);
}

/// How faint stars a frame's plan draws.
double drawn_to_v_mag(const FrameProducts& frame) {
  return StarBackground::limit_v_mag(frame.plan.effects.level(StarBackground::facts));
}

TEST(ExposurePlanner, EveryStageOfAFrameIsAnEffectOfItsPlan) {
  for (const char* camera : {"geo-watch", "telescope-3m"}) {
    const FrameProducts frame = Scene{.camera = camera}.frame();
    double named_s = 0.0;
    for (const auto& [name, seconds] : frame.times.seconds) {
      EXPECT_TRUE(std::ranges::count(all_effects(), name, &EffectFacts::name))
          << name << " of " << camera;
      named_s += seconds;
    }
    EXPECT_GT(named_s, 0.5 * (frame.total_s - frame.detection_s)) << camera;
  }
}

TEST(ExposurePlanner, ErrorsStayWithinTheBudgetThatIsStated) {
  for (const char* accuracy : {"draft", "standard", "reference", "{position_px: 3}",
                               "{photometry_mag: 0, background_sigma: 1000}"}) {
    const FrameProducts frame = Scene{.accuracy = accuracy}.frame();
    EXPECT_TRUE(frame.plan.error.within(frame.plan.budget)) << accuracy;
    EXPECT_LE(frame.plan.min_cost_s, frame.plan.cost_s) << accuracy;
    EXPECT_EQ(frame.header.error, frame.plan.error);
    EXPECT_FALSE(frame.header.accuracy.empty());
  }
}

TEST(ExposurePlanner, LessAccuracyNeverCostsMore) {
  const double reference_s = Scene{.accuracy = "reference"}.frame().plan.cost_s,
               standard_s = Scene{.accuracy = "standard"}.frame().plan.cost_s,
               draft_s = Scene{.accuracy = "draft"}.frame().plan.cost_s;
  EXPECT_LT(standard_s, reference_s);
  EXPECT_LE(draft_s, standard_s);
}

TEST(ExposurePlanner, KeepsATimePerFrame) {
  const FrameProducts quick = Scene{.accuracy = "{seconds_per_frame: 0.08}"}.frame();
  EXPECT_LE(quick.plan.cost_s, 0.08);
  EXPECT_TRUE(quick.plan.in_time);
  EXPECT_FALSE(Scene{.accuracy = "{seconds_per_frame: 1e-5}"}.frame().plan.in_time);
}

// The Moon's aureole is a thousand full wells: no share of it shows in a saturated pixel, and every
// pixel of the sky would cost ten times the frame.
TEST(ExposurePlanner, SaturatedSkiesNeedNoFinerGrid) {
  const Scene aureole{.accuracy = "{background_sigma: 0.3}",
                      .camera = "omnissa",
                      .place = "site: huntsville",
                      .pointing = "{azimuth_deg: 250, elevation_deg: 60}",
                      .effects = "{photon_noise: off, read_noise: off}",
                      .exposure_s = 10.0};
  Scene every_pixel = aureole;
  every_pixel.effects = "{photon_noise: off, read_noise: off, sky_grid: pixel}";
  const FrameProducts frame = aureole.frame(2), exact = every_pixel.frame(2);
  const int level = frame.plan.effects.level(SkyGrid::facts);
  EXPECT_LT(level, SkyGrid::facts.reference());
  const auto full = std::size_t(std::ranges::count_if(
      exact.counts.pixels, [&](std::uint16_t dn) { return dn >= exact.header.saturation_dn - 1; }));
  EXPECT_GT(full, 1000u);
  int worst_dn = 0;
  for (std::size_t i = 0; i < frame.counts.pixels.size(); ++i)
    worst_dn =
        std::max(worst_dn, std::abs(int(frame.counts.pixels[i]) - int(exact.counts.pixels[i])));
  EXPECT_LE(worst_dn * frame.header.gain_e_per_dn,
            SkyGrid::tolerance[std::size_t(level)] * frame.header.full_well_e +
                frame.header.gain_e_per_dn);
}

TEST(ExposurePlanner, InDaylightThereAreNoStars) {
  const FrameProducts day =
      Scene{.start = "2018-01-21T17:00:00Z", .exposure_s = 0.01, .star_v_mag = "12"}.frame();
  EXPECT_FALSE(runs(day, StarBackground::facts));
  EXPECT_TRUE(runs(day, Daylight::facts));
  EXPECT_FALSE(runs(day, Twilight::facts));
  EXPECT_TRUE(runs(Scene{}.frame(), StarBackground::facts));
}

// Traps take the charge of a Gaussian draw: none is below 0.
TEST(ExposurePlanner, ADraftOfADetectorWithTrapsGoesOnFrameAfterFrame) {
  test::Stage stage(Scene{.accuracy = "draft", .camera = "hawaii-4rg", .exposure_s = 0.5}.yaml(),
                    "ra_deg,dec_deg,mag_v,bv\n49.7,-5.4,6,0.65\n", element_set);
  for (std::uint32_t frame = 1; frame <= 3; ++frame) EXPECT_NO_THROW(stage.frame(frame)) << frame;
}

// Without stars the smooth starlight would stand for those brighter than the catalogue's, too.
TEST(ExposurePlanner, StarsBesideTheFrameCostTheirSearchAlone) {
  const auto plan_with_star_at = [](const std::string& dec_deg) {
    return test::Stage(Scene{.accuracy = "standard"}.yaml(),
                       "ra_deg,dec_deg,mag_v,bv\n49.7," + dec_deg + ",6,0.65\n", element_set)
        .frame();
  };
  const auto cost_of_stars = [](const FrameProducts& frame) {
    return std::ranges::find(frame.plan.planned, &StarBackground::facts, &PlannedEffect::facts)
        ->cost_s;
  };
  const FrameProducts inside = plan_with_star_at("-5.4"), beside = plan_with_star_at("-25.4");
  EXPECT_GE(drawn_to_v_mag(inside), 6.0);
  EXPECT_LT(cost_of_stars(beside), cost_of_stars(inside));
  EXPECT_TRUE(beside.stars.empty());
}

// A field of 8 arcsec, 16 arcsec from where aberration would move the star in its middle.
TEST(ExposurePlanner, CountsStarsWhereAFrameWithoutAberrationHasThem) {
  for (const char* accuracy : {"standard", "reference"}) {
    const Scene scene{.accuracy = accuracy,
                      .camera =
                          "{optics: {columns: 32, rows: 32, pixel_pitch_m: 5e-6, focal_length_m: 4,"
                          " aperture_m: 0.3, psf_fwhm_px: 2}, detector: {quantum_efficiency: 0.8,"
                          " read_noise_e: 5, full_well_e: 100000, gain_e_per_dn: 1.6, bias_dn: 100,"
                          " adc_bits: 16}, band: {name: V, centre_m: 0.55e-6, width_m: 0.09e-6}}",
                      .pointing = "{ra_deg: 49.7, dec_deg: 60}",
                      .effects = "{annual_aberration: off, refraction: off}",
                      .exposure_s = 0.01};
    const FrameProducts frame =
        test::Stage(scene.yaml(), "ra_deg,dec_deg,mag_v,bv\n49.7,60,3,0.65\n", element_set).frame();
    EXPECT_GE(drawn_to_v_mag(frame), 3.0) << accuracy;
    EXPECT_EQ(frame.stars.size(), 1u) << accuracy;
  }
}

TEST(ExposurePlanner, ASensorMayHaveAnAccuracyOfItsOwn) {
  const std::string own = Scene{.accuracy = "reference", .more = ", accuracy: draft"}.yaml();
  const FrameProducts frame =
      test::Stage(own, "ra_deg,dec_deg,mag_v,bv\n49.7,-5.4,6,0.65\n", element_set).frame();
  EXPECT_EQ(frame.header.accuracy, "draft");
  EXPECT_EQ(frame.plan.budget, draft_budget);
}

TEST(ExposurePlanner, WhatIsForcedStays) {
  const FrameProducts frame = Scene{.accuracy = "draft",
                                    .effects =
                                        "{light_deflection: on, scintillation: on, sky_grid: "
                                        "0.02%, extinction: off}"}
                                  .frame();
  EXPECT_TRUE(runs(frame, LightDeflection::facts));
  EXPECT_TRUE(runs(frame, Scintillation::facts));
  EXPECT_FALSE(runs(frame, AirExtinction::facts));
  EXPECT_NE(frame.report.plan.find("sky_grid:0.02%"), std::string::npos) << frame.report.plan;
}

std::string turbulence_level(const std::string& accuracy, const std::string& effects,
                             const std::string& star_v_mag, double exposure_s) {
  const FrameProducts frame = Scene{.accuracy = accuracy,
                                    .camera = "telescope-3m",
                                    .effects = effects,
                                    .more = ", seeing: {r0_m: 0.15, wind_m_per_s: 15}",
                                    .exposure_s = exposure_s,
                                    .star_v_mag = star_v_mag}
                                  .frame();
  return std::string(
      AirTurbulence::levels.at(std::size_t(frame.plan.effects.level(AirTurbulence::facts))));
}

// A 3 m telescope sees an image that moves by pixels in 20 ms, and in 5 s, of more screens than are
// drawn, by what is no error of its reference. With pixels so fine the mean costs no more than
// none.
TEST(ExposurePlanner, TurbulenceIsAsShortAsTheBudgetAsks) {
  EXPECT_EQ(turbulence_level("standard", "{}", "6", 0.02), "short");
  EXPECT_EQ(turbulence_level("draft", "{}", "6", 0.02), "short");
  EXPECT_EQ(turbulence_level("standard", "{}", "6", 5.0), "long");
  EXPECT_EQ(turbulence_level("reference", "{}", "6", 0.02), "short");
  EXPECT_EQ(turbulence_level("{position_px: 1e6, photometry_mag: 1e6, background_sigma: 1e6, "
                             "noise: 1e6}",
                             "{}", "6", 0.02),
            "long");
  EXPECT_EQ(turbulence_level("draft", "{stars: off, objects: off}", "6", 0.02), "off");
  EXPECT_EQ(turbulence_level("standard", "{turbulence: long}", "6", 0.02), "long");
}

TEST(ExposurePlanner, TruthIsOfAllPhysicsWhateverThePlanLeavesOut) {
  const auto truth_of = [](const std::string& accuracy) {
    return Scene{.accuracy = accuracy, .effects = "{shadow: off}"}.frame().truths.at(0);
  };
  const Truth full = truth_of("off"), draft = truth_of("{position_px: 1000}");
  EXPECT_EQ(full.true_ra_rad, draft.true_ra_rad);
  EXPECT_EQ(full.apparent_ra_rad, draft.apparent_ra_rad);
  EXPECT_EQ(full.apparent_dec_rad, draft.apparent_dec_rad);
  EXPECT_EQ(full.true_magnitude, draft.true_magnitude);
}

TEST(ExposurePlanner, ThreadsDoNotChangeAPlannedFrame) {
  for (const char* accuracy : {"draft", "standard", "{seconds_per_frame: 0.1}"}) {
    const FrameProducts one = Scene{.accuracy = accuracy}.frame(1),
                        three = Scene{.accuracy = accuracy}.frame(3);
    EXPECT_EQ(one.counts.pixels, three.counts.pixels) << accuracy;
    EXPECT_EQ(one.report.plan, three.report.plan);
  }
}

TEST(ExposurePlanner, FactsAtTheirLimitsGiveAPlan) {
  for (const double exposure_s : {1e-6, 1.0, 10.0})
    for (const char* start :
         {"2018-01-20T22:58:30Z", "2018-01-21T05:00:00Z", "2018-01-20T12:24:00Z"})
      for (const char* pointing : {"zenith", "{azimuth_deg: 90, elevation_deg: 0.0}",
                                   "{azimuth_deg: 250, elevation_deg: -5}"})
        for (const char* camera : {"omnissa-swir", "telescope-3m"}) {
          const FrameProducts frame =
              Scene{
                  .start = start, .camera = camera, .pointing = pointing, .exposure_s = exposure_s}
                  .frame();
          EXPECT_TRUE(frame.plan.error.within(frame.plan.budget))
              << exposure_s << " " << start << " " << pointing << " " << camera;
          EXPECT_TRUE(std::isfinite(frame.plan.cost_s));
        }
}

}  // namespace
}  // namespace dmise
