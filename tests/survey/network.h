#pragma once
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "core/config/make_clock.h"
#include "orbit-node/load_objects.h"
#include "sensors/frame/make_sensor.h"
#include "sensors/survey/sensor_survey.h"

namespace dmise::test {

/// A middle-sized piece of the paper's all-sky camera.
inline constexpr const char* piece_of_all_sky =
    "{name: piece, optics: {projection: gnomonic, columns: 800, rows: 800, pixel_pitch_m: 5.4e-6, "
    "focal_length_m: 8.98e-3, aperture_m: 0.0375, transmission: 0.8, psf_fwhm_px: 1.5, "
    "equivalent_aperture: true}, detector: {quantum_efficiency: 0.54, dark_e_per_s: 0.02, "
    "read_noise_e: 9.3, full_well_e: 25500, gain_e_per_dn: 0.35, bias_dn: 100, adc_bits: 16}, "
    "band: {name: V, centre_m: 0.55e-6, width_m: 0.128e-6}}";

/// A scenario with everything that a survey needs.
struct Network {
  /// `sensors`: lines of YAML without their indent.
  Network(const std::string& simulation, const std::vector<std::string>& sensors,
          const std::string& objects = "[{catalogue: demo}]", int thread_count = 2)
      : threads(thread_count) {
    setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
    directory =
        std::filesystem::path(testing::TempDir()) /
        (std::string("survey-") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(directory);
    std::ofstream file(directory / "scenario.yaml");
    file << "simulation: " << simulation << "\nobjects: " << objects
         << "\nstars: {catalogue: kstars}\nsensors:\n";
    for (const auto& sensor : sensors) file << "  - " << sensor << "\n";
    file.close();
    scenario = load_scenario((directory / "scenario.yaml").string());
    population = load_objects(scenario, make_clock(scenario));
    shells = shells_of(population, {600.0, 1000.0});
    scene = std::make_unique<SurveyScene>(scenario, population, make_clock(scenario),
                                          load_stars(scenario), threads);
  }
  ~Network() { std::filesystem::remove_all(directory); }
  Network(const Network&) = delete;

  SensorSurvey survey(std::size_t sensor = 0) {
    return survey_sensor(*scene, scenario.sensors.at(sensor), shells, threads);
  }

  std::filesystem::path directory;
  Threads threads;
  Scenario scenario;
  ObjectPopulation population;
  Shells shells;
  std::unique_ptr<SurveyScene> scene;
};

inline const std::string evening = "{start: 2018-01-21T00:15:00Z, duration_s: 1800, tick_s: 10}";

inline std::string zenith_camera(const std::string& name, const std::string& more = "",
                                 const std::string& site = "atlanta") {
  return "{name: " + name + ", site: " + site + ", camera: " + piece_of_all_sky +
         ", pointing: zenith, exposure_s: 10, cadence_s: 20, sky: dark" + more + "}";
}

}  // namespace dmise::test
