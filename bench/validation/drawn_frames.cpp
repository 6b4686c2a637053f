#include "bench/validation/drawn_frames.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/formatted.h"
#include "core/base/numeric/rng.h"
#include "core/base/units.h"
#include "core/config/make_clock.h"
#include "core/config/scenario_text.h"
#include "core/optics/projection.h"
#include "core/score/scored_run.h"
#include "core/score/trail.h"
#include "orbit-node/load_objects.h"
#include "sensors/frame/frame_pipeline.h"
#include "sensors/frame/make_sensor.h"
#include "sensors/objects/state_window_source.h"
#include "sensors/survey/exposure_forecast.h"

namespace dmise {
namespace {

constexpr int side = 4;  // objects along an edge of the frame
constexpr double jitter_px = 60.0;
constexpr double min_snr = 3.0, max_snr = 100.0;
constexpr double near_m = 800e3, far_m = 4000e3;  // ranges of streaks
constexpr double geo_range_m = 37500e3;
constexpr double earth_rate_rad_per_s = 7.292115e-5;

/// The sky of a frame is not that of the one before, and what stands over the ground is in one
/// frame.
constexpr const char* sensor_yaml = R"(
  - name: %s
    site: la-palma
    camera:
      optics: {columns: 1000, rows: 1000, pixel_pitch_m: 9e-6, focal_length_m: 0.6, aperture_m: 0.3, transmission: 0.8, psf_fwhm_px: 2}
      detector: {quantum_efficiency: 0.8, dark_e_per_s: 0.1, read_noise_e: 5, full_well_e: 80000, gain_e_per_dn: 1.5, bias_dn: 300}
      band: {name: V, centre_m: 0.55e-6, width_m: 0.128e-6}
    pointing: {azimuth_deg: 90, azimuth_rate_deg_per_s: 0.3, elevation_deg: %g, tracking: %s}
    exposure_s: %g
    cadence_s: 10
    sky: dark
)";

/// An evening of La Palma, the Sun 18 to 24 deg below the horizon.
Scenario drawn_scenario(int frames, std::uint64_t seed) {
  std::string text = formatted(
      "simulation: {start: 2021-03-12T20:50:00Z, duration_s: %d, tick_s: 1, seed: %llu}\n"
      "stars: {catalogue: kstars, synthetic_to: limit}\nsensors:",
      10 * frames, static_cast<unsigned long long>(seed));
  text += formatted(sensor_yaml, streak_sensor, 70.0, "sidereal", 0.2);
  text += formatted(sensor_yaml, point_sensor, 56.0, "fixed", 5.0);
  return scenario_of_text(text, "drawn");
}

/// Uniform numbers of one object.
class Dice {
 public:
  Dice(const RngKey& key, std::uint32_t object) : key_(key), object_(object) {}
  double uniform(double low, double high) {
    return low + (high - low) * uniform_of(rng_word(key_, object_, draw_++));
  }
  double log_uniform(double low, double high) { return low * std::pow(high / low, uniform(0, 1)); }

 private:
  RngKey key_;
  std::uint32_t object_, draw_ = 0;
};

/// An object of a frame, and the SNR that it shall have.
struct Placed {
  const SensorConfig* sensor = nullptr;
  std::uint32_t frame = 0;
  double snr = 0.0;
};

/// A circular orbit of any direction, or at rest over the ground.
Vec<Gcrs> velocity_at(const Vec<Gcrs>& position_m, bool streak, double angle_rad) {
  const Vec<Gcrs> east{-position_m.y, position_m.x, 0.0};
  if (!streak) return east * earth_rate_rad_per_s;
  const Vec<Gcrs> along = unit(east), north = cross(unit(position_m), along);
  const double speed = std::sqrt(earth_gm_m3_per_s2 / norm(position_m));
  return (along * std::cos(angle_rad) + north * std::sin(angle_rad)) * speed;
}

/// Object `k` of a frame, `number` of all.
OwnObject object_in(const View& view, const Clock& clock, std::uint32_t k, std::uint32_t number,
                    Placed& placed) {
  const bool streak = view.sensor().name == streak_sensor;
  const Optics& optics = view.sensor().camera.optics;
  Dice dice(rng_key(view.seed(), view.sensor().name, view.times().frame, "drawn_object"), k);
  const double cell_px = optics.columns / double(side);
  const PixelPosition pixel{(k % side + 0.5) * cell_px + dice.uniform(-jitter_px, jitter_px),
                            (k / side + 0.5) * cell_px + dice.uniform(-jitter_px, jitter_px)};
  const SimTime middle = view.times().middle;
  const Vec<Gcrs> line = view.camera_from_gcrs(middle).inverse() * *unproject(optics, pixel);
  const double range_m = streak ? dice.log_uniform(near_m, far_m) : geo_range_m;
  const Vec<Gcrs> position_m = view.observer(middle).position_m + line * range_m;
  placed.snr = dice.log_uniform(min_snr, max_snr);
  OwnObject object;
  object.name = formatted("%s-%u-%u", view.sensor().name.c_str(), view.times().frame, k);
  object.where = object.name;
  object.catalogue_number = first_own_number + number;
  object.motion.model = MotionModel(
      TwoBodyMotion{clock.tai(middle),
                    {position_m, velocity_at(position_m, streak, dice.uniform(0.0, 2.0 * pi))}});
  return object;
}

/// Objects of radius 1 m for all frames of all sensors.
std::vector<Placed> place_objects(Scenario& scenario, const Clock& clock, Threads& threads) {
  std::vector<Placed> all;
  const ObjectPopulation none;
  const StateSource source(none, clock, threads);
  for (const SensorConfig& sensor : scenario.sensors) {
    const StateWindowSource windows(scenario, sensor, clock);
    for (std::uint32_t f = 1; f <= frames_within(sensor, scenario.duration); ++f) {
      const FrameTimes times = frame_times(sensor, f);
      const StateWindow window = windows.around(times, none, source);
      const View view(sensor, times, window, scenario.seed);
      for (std::uint32_t k = 0; k < side * side; ++k) {
        all.push_back({&sensor, f});
        scenario.own_objects.push_back(
            object_in(view, clock, k, std::uint32_t(all.size() - 1), all.back()));
      }
    }
  }
  return all;
}

/// By the first object of a frame, and the object.
using Looks = std::map<std::pair<std::uint32_t, std::uint32_t>, ExpectedDetection>;

/// What the survey expects in each frame of its own objects and those of the frames beside it.
Looks looks_of(const Scenario& scenario, const Clock& clock, const std::vector<Placed>& placed,
               Threads& threads) {
  constexpr std::uint32_t in_frame = side * side;
  const ObjectPopulation population = load_objects(scenario, clock);
  const SurveyScene scene(scenario, population, clock, load_stars(scenario), threads);
  Looks out;
  for (std::uint32_t from = 0; from < placed.size(); from += in_frame) {
    std::vector<std::uint32_t> near;
    for (std::uint32_t k = from - std::min(from, in_frame);
         k < std::min<std::size_t>(placed.size(), from + 2 * in_frame); ++k)
      near.push_back(k);
    const SensorConfig& sensor = *placed[from].sensor;
    const auto looks =
        ExposureForecaster(scene, sensor).of(frame_times(sensor, placed[from].frame), near);
    for (const ExpectedDetection& look : looks->looks) out[{from, look.object}] = look;
  }
  return out;
}

/// The light of a sphere goes by the square of its radius.
void give_light(const std::vector<Placed>& placed, const Looks& looks, Scenario& scenario) {
  for (const auto& [at, look] : looks)
    if (look.snr > 0.0 && at.first == at.second - at.second % (side * side))
      scenario.own_objects[at.second].sphere.radius_m *=
          std::sqrt(placed[at.second].snr / look.snr);
}

/// Trails of stars with more light in a pixel of length than three times a pixel's noise.
std::vector<TrueTrail> loud_trails(const FrameProducts& frame) {
  constexpr double loud = 3.0, shortest_px = 3.0;
  std::vector<TrueTrail> trails;
  for (const StarTruth& star : frame.stars) {
    const double length_px = std::max(
        shortest_px, std::hypot(star.end.x_px - star.start.x_px, star.end.y_px - star.start.y_px));
    if (star.signal_e > loud * frame.report.noise_e * length_px)
      trails.emplace_back(star.start, star.middle, star.end);
  }
  return trails;
}

void add_distances(const FrameProducts& frame, ScoredDraws& out) {
  const std::vector<TrueTrail> trails = loud_trails(frame);
  for (const Truth& truth : frame.truths) {
    const TrueSource source = source_of(truth);
    if (!source.light) continue;
    double& nearest_px = out.star_px[{source.frame, source.id}] = HUGE_VAL;
    for (const TrueTrail& trail : trails)
      nearest_px = std::min(nearest_px, trail.nearest(*source.light).distance_px);
  }
}

/// Adds a frame to those with as many stars.
void add_frame(const FrameProducts& frame, RunSensor sensor, ScoreInput& input) {
  sensor.name += frame.report.stars_rendered < stars_of_dense_frame ? few_stars : many_stars;
  input.frames.push_back(frame_of(frame.report, sensor));
  for (const Truth& truth : frame.truths) {
    input.truths.push_back(source_of(truth));
    input.truths.back().sensor = sensor.name;
  }
  for (const Detection& d : frame.detections)
    input.detections.push_back({sensor.name, std::to_string(d.frame), d});
}

ScoreInput render(const Scenario& scenario, const Clock& clock, Threads& threads,
                  ScoredDraws& out) {
  const ObjectPopulation population = load_objects(scenario, clock);
  const StateSource source(population, clock, threads);
  const auto stars = load_stars(scenario);
  ScoreInput input{.source = "drawn frames", .status = "complete"};
  for (const SensorConfig& sensor : scenario.sensors) {
    const Optics& optics = sensor.camera.optics;
    const RunSensor described{.name = sensor.name, .columns = optics.columns, .rows = optics.rows};
    const StateWindowSource windows(scenario, sensor, clock);
    const bool points = sensor.name == point_sensor;
    PipelineSettings settings = sensor_settings(scenario, sensor.name, "");
    settings.star_truth = points;
    FramePipeline pipeline(std::move(settings), stars, threads);
    for (std::uint32_t f = 1; f <= frames_within(sensor, scenario.duration); ++f) {
      const FrameTimes times = frame_times(sensor, f);
      FrameProducts frame = pipeline.run(times, windows.around(times, population, source));
      add_frame(frame, described, input);
      if (points) add_distances(frame, out);
      pipeline.give_back(std::move(frame.counts));
    }
  }
  return input;
}

}  // namespace

double ScoredDraws::expected(const TrueSource& truth) const {
  const auto at = probability.find({truth.frame, truth.id});
  return at == probability.end() ? 0.0 : at->second;
}

ScoredDraws draw_frames(int frames, std::uint64_t seed, Threads& threads) {
  Scenario scenario = drawn_scenario(frames, seed);
  const Clock clock = make_clock(scenario);
  const std::vector<Placed> placed = place_objects(scenario, clock, threads);
  give_light(placed, looks_of(scenario, clock, placed, threads), scenario);
  ScoredDraws out;
  for (const auto& [at, look] : looks_of(scenario, clock, placed, threads))
    out.probability[{std::to_string(placed[at.first].frame),
                     formatted("%u %s", first_own_number + at.second,
                               scenario.own_objects[at.second].name.c_str())}] = look.probability;
  out.score = score(render(scenario, clock, threads, out), {});
  return out;
}

}  // namespace dmise
