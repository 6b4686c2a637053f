#include "bench/whole_field.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "bench/effect_scene.h"
#include "bench/scene_dice.h"
#include "core/base/error.h"
#include "core/base/units.h"
#include "core/config/yaml/search_path.h"
#include "core/effects/frame_effects.h"
#include "core/optics/projection.h"
#include "sensors/accuracy/scene_frames.h"
#include "sensors/light/sky_layer.h"
#include "sensors/planning/exposure_planner.h"

namespace dmise {
namespace {

constexpr int samples_a_side = 160;
constexpr double zenith_chance = 0.6, night_chance = 0.3, orbit_chance = 0.2;

/// A time at which the Sun is about as high over a place as wanted, by its mean motion.
std::string time_with_sun_at(SceneDice& dice, double longitude_deg, double latitude_deg,
                             double wanted_deg) {
  int month = 1, day = 1, best_month = 1, best_day = 1;
  double best_hour = 0.0, nearest_deg = 1e9;
  for (int tries = 0; tries < 500; ++tries) {
    month = 1 + dice.below(12), day = 1 + dice.below(28);
    const double hour = dice.uniform(0.0, 24.0);
    const double sine = sine_of_sun_altitude(month, day, hour, longitude_deg, latitude_deg);
    const double off_deg = std::abs(std::asin(std::clamp(sine, -1.0, 1.0)) / deg - wanted_deg);
    if (off_deg > nearest_deg) continue;
    nearest_deg = off_deg;
    best_month = month, best_day = day, best_hour = hour;
  }
  char text[64];
  std::snprintf(text, sizeof text, "2021-%02d-%02dT%02d:%02d:%02dZ", best_month, best_day,
                int(best_hour), int(best_hour * 60.0) % 60, int(best_hour * 3600.0) % 60);
  return text;
}

struct DrawnField {
  std::string yaml, what;
};

DrawnField draw_field(const std::string& camera, SceneDice& dice) {
  static constexpr const char* skies[] = {"dark", "dark", "suburban",
                                          "{preset: urban, cities: [{azimuth_deg: 200}]}"};
  char text[2000], what[160];
  const double exposure_s = dice.log_uniform(0.3, 30.0);
  if (dice.chance(orbit_chance)) {
    std::snprintf(
        text, sizeof text,
        "simulation: {start: 2021-%02d-%02dT%02d:00:00Z, duration_s: 40, tick_s: 40}\n"
        "detection: off\n"
        "objects:\n  - {name: carrier, motion: {two_body: {position_m: [7.2e6, 0, 0],"
        " velocity_m_per_s: [0, 7440, 0]}}}\n"
        "sensors:\n  - {name: eye, platform: carrier, camera: %s, pointing: {ra_deg: %.3f, "
        "dec_deg: %.3f}, sky: space, exposure_s: %.3f, cadence_s: 40, first_exposure_s: 0.5}\n",
        1 + dice.below(12), 1 + dice.below(28), dice.below(24), camera.c_str(),
        dice.uniform(-60.0, 60.0), dice.uniform(-60.0, 60.0), exposure_s);
    std::snprintf(what, sizeof what, "orbit, whole %s, %.2g s", camera.c_str(), exposure_s);
    return {text, what};
  }
  const double latitude = dice.uniform(-60.0, 60.0), longitude = dice.uniform(-180.0, 180.0);
  const double sun_deg = dice.chance(night_chance) ? -30.0 : dice.uniform(-19.0, -3.0);
  const std::string start = time_with_sun_at(dice, longitude, latitude, sun_deg);
  const char* sky = skies[dice.below(4)];
  std::string pointing = "zenith";
  if (!dice.chance(zenith_chance)) {
    char own[96];
    std::snprintf(own, sizeof own, "{azimuth_deg: %.2f, elevation_deg: %.2f}",
                  dice.uniform(0.0, 360.0), dice.uniform(5.0, 90.0));
    pointing = own;
  }
  std::snprintf(text, sizeof text,
                "simulation: {start: %s, duration_s: 40, tick_s: 40}\ndetection: off\n"
                "sensors:\n  - {name: eye, site: {latitude_deg: %.3f, longitude_deg: %.3f, "
                "height_m: 300}, camera: %s, pointing: %s, sky: %s, exposure_s: %.3f, "
                "cadence_s: 40, first_exposure_s: 0.5}\n",
                start.c_str(), latitude, longitude, camera.c_str(), pointing.c_str(), sky,
                exposure_s);
  std::snprintf(what, sizeof what, "ground, whole %s, %s, %s, Sun at %.0f deg, %.2g s",
                camera.c_str(), pointing.c_str(), sky, sun_deg, exposure_s);
  return {text, what};
}

/// Pixels at which the sky itself is evaluated, with their light and noise.
class SampledSky {
 public:
  SampledSky(const View& view, const PlanFacts& facts) : facts_(facts) {
    const Optics& optics = view.sensor().camera.optics;
    const SkyModel sky = sky_over(view, drawn);
    const PixelFunction electrons = electrons_of(view, sky);
    const auto pixel = [](int i, int pixels) {
      return std::min(pixels - 1, int((i + 0.37) * pixels / samples_a_side));
    };
    for (int j = 0; j < samples_a_side; ++j)
      for (int i = 0; i < samples_a_side; ++i) {
        const int x = pixel(i, optics.columns), y = pixel(j, optics.rows);
        const double light_e = electrons(x, y);
        if (light_e > 0.0 && light_e < facts.saturated_e) samples_.push_back({x, y, light_e});
      }
  }

  bool empty() const { return samples_.empty(); }
  /// The largest error of an image, over the noise.
  double error_of(const ExpectedElectronImage& image) const {
    double largest = 0.0;
    for (const Sample& s : samples_) {
      const double noise_e =
          std::sqrt(s.light_e + facts_.dark_e + facts_.read_noise_e * facts_.read_noise_e);
      largest = std::max(largest, std::abs(image.at(s.x, s.y) - s.light_e) / noise_e);
    }
    return largest;
  }

  static constexpr DrawnStars drawn{};

 private:
  struct Sample {
    int x, y;
    double light_e;
  };
  const PlanFacts& facts_;
  std::vector<Sample> samples_;
};

}  // namespace

std::vector<std::string> shipped_cameras() {
  std::vector<std::string> names;
  const std::string one = find_preset("cameras", "omnissa", "");
  if (one.empty()) throw Error("there is no camera omnissa");
  for (const auto& file :
       std::filesystem::directory_iterator(std::filesystem::path(one).parent_path()))
    if (file.path().extension() == ".yaml") names.push_back(file.path().stem());
  std::ranges::sort(names);
  return names;
}

SceneTrial try_whole_field(const std::string& camera, int number, std::uint64_t seed,
                           const std::filesystem::path& directory, Threads& threads) {
  SceneDice dice(seed, std::uint32_t(number));
  const DrawnField field = draw_field(camera, dice);
  std::filesystem::create_directories(directory);
  SceneTrial trial{.scene = {number, (directory / "scene.yaml").string(), field.what}};
  std::ofstream(trial.scene.path) << field.yaml;
  const SceneFrames frames(load_scenario(trial.scene.path), "eye", 1, threads);
  const SensorConfig& sensor = frames.sensor();
  const View view(sensor, frames.times(), frames.states(), frames.scenario().seed);
  const PlanFacts facts =
      ExposurePlanner(sensor, nullptr, frames.scenario().faintest_star_mag, nullptr)
          .facts(view, {});
  const SampledSky sampled(view, facts);
  trial.background_pixels = sampled.empty() ? 0 : 1;
  std::vector<ErrorBound> measured;
  ExpectedElectronImage image(sensor.camera.optics.columns, sensor.camera.optics.rows);
  for (int level = 0; level < SkyGrid::facts.reference(); ++level) {
    SensorConfig as = sensor;
    as.effects.set_level(SkyGrid::facts, level);
    const View looked(as, frames.times(), frames.states(), frames.scenario().seed);
    fill_sky(looked, SampledSky::drawn, image, threads);
    measured.push_back({.background_sigma = sampled.error_of(image)});
    trial.levels.push_back({.scene = number,
                            .effect = std::string(SkyGrid::facts.name),
                            .level = std::string(SkyGrid::levels[std::size_t(level)]),
                            .bound = SkyGrid::error(level, facts),
                            .measured = measured.back(),
                            .budget = standard_budget,
                            .has_background = !sampled.empty()});
  }
  measured.push_back({});
  for (const Accuracy& accuracy : {draft_accuracy(), standard_accuracy()}) {
    SensorConfig as = sensor;
    as.accuracy = accuracy;
    const View asked(as, frames.times(), frames.states(), frames.scenario().seed);
    const EffectPlan plan =
        ExposurePlanner(as, nullptr, frames.scenario().faintest_star_mag, nullptr).plan(asked, {});
    trial.plans.push_back({number, accuracy.name, accuracy.budget, plan.error,
                           measured[std::size_t(plan.effects.level(SkyGrid::facts))]});
  }
  return trial;
}

}  // namespace dmise
