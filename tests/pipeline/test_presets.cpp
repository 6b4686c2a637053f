#include <cmath>
#include <filesystem>

#include "core/base/units.h"
#include "core/config/yaml/search_path.h"
#include "core/optics/projection.h"
#include "core/photometry/star_light.h"
#include "core/sky/air/air_effects.h"
#include "core/sky/places/place_effects.h"
#include "tests/pipeline/harness.h"

// Every camera of launch/cameras, and one of a user's.
namespace dmise {
namespace {

std::string scenario_with(const std::string& camera) {
  return "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 10, tick_s: 5, seed: 1}\n"
         "objects: [{catalogue: objects.tle}]\nstars: {catalogue: stars.csv, faintest_mag: 15}\n"
         "sensors:\n"
         "  - {name: watch, site: savannah, camera: " +
         camera + ", pointing: {ra_deg: 50, dec_deg: 30}, exposure_s: 2, cadence_s: 5}\n";
}

const std::string one_star = "ra_deg,dec_deg,mag_v,bv\n50,30,7,0.65\n";
const std::string no_objects =
    "GOES 16\n"
    "1 41866U 16071A   18019.87773469 -.00000245  00000-0  00000-0 0  9992\n"
    "2 41866   0.0069 115.0916 0001074 269.6956 335.2025  1.00271237  4322\n";

/// What is known of a preset: of the paper, or of the class that its source text names.
struct Facts {
  const char* name;
  double aperture_m, pixel_arcsec, field_deg;  // across the columns
  double field_tolerance_deg;
};

void PrintTo(const Facts& facts, std::ostream* out) { *out << facts.name; }

constexpr Facts presets[] = {
    {"all-sky-scmos", 0.0016, 300.0, 213.3, 0.1},
    {"fast-survey-1m", 1.0, 1.375, 2.35, 0.01},
    {"geo-watch", 0.075, 8.25, 7.6, 0.05},
    {"gt-sort", 0.5, 0.67, 0.19, 0.002},
    {"hawaii-4rg", 0.15, 0.879, 1.0, 1e-4},
    {"hawaii-4rg-10um", 0.15, 1.637, 1.862, 1e-3},
    {"hawaii-4rg-swir", 0.15, 0.879, 1.0, 1e-4},
    {"omnissa", 0.0375, 124.0, 90.0, 1e-6},
    {"omnissa-swir", 0.0034, 644.0, 90.0, 1e-6},
    {"raven", 0.4, 2.32, 1.32, 0.01},
    {"sst", 3.5, 2.157, 2.45, 0.01},
    {"star-tracker", 0.0341, 77.8, 21.87, 0.02},
    {"telescope-3m", 3.0, 0.0189, 9.68 / 3600, 0.02 / 3600},
    {"wide-field-cmos", 0.0857, 18.9, 10.73, 0.02},
};

class Presets : public testing::TestWithParam<Facts> {};

TEST_P(Presets, HasTheFieldAndApertureOfItsSource) {
  test::Stage stage(scenario_with(GetParam().name), one_star, no_objects);
  const Optics& optics = stage.scenario.sensors[0].camera.optics;
  EXPECT_EQ(optics.aperture_m, GetParam().aperture_m);
  EXPECT_NEAR(optics.pixel_angle_rad() / arcsec, GetParam().pixel_arcsec,
              0.004 * GetParam().pixel_arcsec);
  const auto edge = unproject(optics, {-0.5, (optics.rows - 1) / 2.0});
  ASSERT_TRUE(edge);
  EXPECT_NEAR(2 * angle_rad(*edge, Vec<CameraFrame>{0, 0, 1}) / deg, GetParam().field_deg,
              GetParam().field_tolerance_deg);
}

// A frame of the middle of its field: a V = 7 star gives the electrons of its photons.
TEST_P(Presets, SeesAStarWithTheElectronsOfItsPhotons) {
  test::Stage stage(scenario_with(GetParam().name), one_star, no_objects);
  Camera& camera = stage.scenario.sensors[0].camera;
  camera.optics.columns = std::min(camera.optics.columns, 256);
  camera.optics.rows = std::min(camera.optics.rows, 200);
  // The mount points at the place of the catalogue; a field of seconds of arc needs the star there.
  for (const EffectFacts& e :
       {AirExtinction::facts, Scintillation::facts, AtmosphericRefraction::facts,
        AnnualAberration::facts, DiurnalAberration::facts, LightDeflection::facts})
    stage.scenario.sensors[0].effects.set(e, false);
  const auto frame = stage.frame();
  const double area_m2 =
      pi / 4 * std::pow(camera.optics.aperture_m, 2) * (1 - std::pow(camera.optics.obscuration, 2));
  const double expected_e = StarLight(camera.band).photons_per_s_m2(7, 0.65) * area_m2 *
                            camera.optics.transmission * camera.detector.quantum_efficiency * 2;
  ASSERT_EQ(frame.stars.size(), 1u);
  EXPECT_NEAR(frame.stars[0].signal_e / expected_e, 1.0, 1e-3);
  EXPECT_EQ(frame.header.detector, acting_detector(camera.detector, {}));
}

INSTANTIATE_TEST_SUITE_P(Camera, Presets, testing::ValuesIn(presets), [](const auto& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(CameraPresets, AreAllInTheTableAbove) {
  setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
  std::vector<std::string> names;
  for (const auto& facts : presets) names.push_back(facts.name);
  EXPECT_EQ(preset_names("cameras"), names);
}

TEST(UserCamera, IsAYamlFileByItsPath) {
  const auto path = std::filesystem::path(testing::TempDir()) / "user-camera.yaml";
  std::ofstream(path) << "name: mine\n"
                         "optics: {columns: 96, rows: 80, pixel_pitch_m: 9e-6,"
                         " focal_length_m: 0.2, aperture_m: 0.1}\n"
                         "detector: {full_well_e: 20000, gain_e_per_dn: 0.5, prnu_rms: 0.01}\n"
                         "band: {centre_m: 0.6e-6, width_m: 0.1e-6}\n";
  test::Stage stage(scenario_with(path.string()), one_star, no_objects);
  const auto frame = stage.frame();
  EXPECT_EQ(frame.counts.columns, 96);
  EXPECT_EQ(frame.header.detector->prnu_rms, 0.01);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace dmise
