#include "bench/bench_fusion_tick.h"

#include <algorithm>
#include <cmath>

#include "bench/figure.h"
#include "bench/timing.h"
#include "core/base/numeric/rng.h"
#include "core/base/units.h"
#include "core/fusion/fusion.h"
#include "core/orbit/sgp4/synthetic_catalogue.h"
#include "core/tracking/propagate.h"
#include "tests/support/fusion_trial.h"
#include "tests/support/tracking_trial.h"

namespace dmise {
namespace {

constexpr std::size_t catalogued = 18470;
constexpr double cadence_s = 10.0;

const Utc start{2458138.5, 0.0};

std::vector<MeanElements> catalogue() { return synthetic_catalogue({.objects = catalogued}); }

/// A hundred sensors around the Earth with thirty detections each.
void bench_tick(bool json) {
  const Clock clock(start);
  FusionTrialSettings settings;
  const RngKey key = rng_key(1, "sites", 0, "bench");
  for (std::uint32_t k = 0; k < 100; ++k)
    settings.sites.push_back({std::asin(1.7 * uniform_of(rng_word(key, k, 0)) - 0.85) / deg,
                              360 * uniform_of(rng_word(key, k, 1)) - 180, 100.0});
  settings.half_angle_rad = 80 * deg;
  settings.sigma_rad = 5 * arcsec;
  settings.limiting_magnitude = 20;
  settings.max_per_frame = 29;
  settings.false_alarms_per_frame = 1;
  FusionTrial trial(catalogue(), clock, settings);
  Fusion fusion(catalogue(), clock, {}, {});
  std::vector<double> times;
  std::size_t detections = 0, live = 0;
  constexpr int ticks = 12;
  for (int k = 0; k < ticks; ++k) {
    const SimTime time = sim_seconds(k * cadence_s);
    auto frames = trial.frames(time, std::uint32_t(k + 1));
    for (const SensorFrame& frame : frames) detections += frame.sources.size();
    const double begin = thread_seconds();
    live = fusion.step(time, std::move(frames)).live;
    times.push_back(thread_seconds() - begin);
  }
  std::ranges::sort(times);
  print_figure({"tick_s", times[ticks / 2], "s", "", 0, 0.2, true}, json);
  print_figure({"tick_worst_s", times.back(), "s", "", 0, 0, true}, json);
  print_figure({"tick_detections", double(detections) / ticks, "1", "", 0, 0, false}, json);
  print_figure({"tick_tracks", double(live), "1", "", 0, 0, false}, json);
}

/// Eight all-sky sites 400 km apart, from dusk on; every fortieth object is in no
/// catalogue. Detections as the score of the all-sky camera has them: 0.83 of the lit and bright.
void bench_sites(const std::string& name, int ticks, bool json) {
  const Clock clock(start);
  FusionTrialSettings settings;
  for (int k = 0; k < 8; ++k)
    settings.sites.push_back({32 + 3.6 * (k / 4), -88 + 4.2 * (k % 4), 200.0});
  settings.half_angle_rad = 50 * deg;
  settings.sigma_rad = 20 * arcsec;
  settings.detection_probability = 0.83;
  settings.false_alarms_per_frame = 0.5;
  settings.limiting_magnitude = 7.0;
  FusionTrial trial(catalogue(), clock, settings);
  std::vector<MeanElements> known;
  for (const MeanElements& e : catalogue())
    if (e.catalogue_number % 40 != 0) known.push_back(e);
  Fusion fusion(std::move(known), clock, {}, {});
  TrackLedger ledger;
  double seconds = 0;
  std::size_t unassociated = 0;
  for (int k = 0; k < ticks; ++k) {
    const SimTime time = sim_seconds(k * cadence_s);
    auto frames = trial.frames(time, std::uint32_t(k + 1));
    const double begin = thread_seconds();
    const FusionTick found = fusion.step(time, std::move(frames));
    seconds += thread_seconds() - begin;
    unassociated += found.unassociated;
    ledger.add(found.tracks);
  }
  const TrackingScore score = ledger.score(trial, 8);
  print_figure({name + "_purity", score.purity(), "1", "", 0, 0.99, false}, json);
  print_figure({name + "_completeness", score.completeness(), "1", "", 0, 0.95, false}, json);
  print_figure({name + "_tracks_of_noise", double(score.of_noise), "1", "", 0, 0, true}, json);
  print_figure({name + "_tracks", double(score.tracks), "1", "", 0, 0, false}, json);
  print_figure({name + "_objects", double(score.objects), "1", "", 0, 0, false}, json);
  print_figure({name + "_detections", double(trial.truths().size()), "1", "", 0, 0, false}, json);
  print_figure({name + "_unassociated", double(unassociated), "1", "", 0, 0, true}, json);
  print_figure({name + "_tick_s", seconds / ticks, "s", "", 0, 0, true}, json);
}

/// Frames of the observations of one time.
std::vector<SensorFrame> frames_of(std::span<const AngleObservation> seen) {
  std::vector<SensorFrame> out;
  for (const AngleObservation& o : seen)
    out.push_back({.sensor = o.sensor,
                   .frame = 1,
                   .time = o.time,
                   .sensor_m = o.sensor_m,
                   .axis = unit(o.sensor_m),
                   .half_angle_rad = pi / 2,
                   .limiting_magnitude = 20,
                   .sources = {{o, 10.0, false}}});
  return out;
}

/// Three sites see an object that is in no catalogue: 60 detections at 1 arcsec.
void bench_three_sites(bool json) {
  const Clock clock(start);
  const ForceModel forces(clock, SimTime{});
  FusionSettings settings;
  settings.acceleration_noise_m2_per_s3 = 0;  // the forces are those of the path
  constexpr int seeds = 100;
  double squares_m2 = 0, worst_m = 0, sum_nees = 0;
  int found = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const TrackingTrial trial = tracking_trial(forces, {}, unsigned(seed));
    Fusion fusion({}, clock, SimTime{}, settings);
    std::optional<Track> last;
    const std::span<const AngleObservation> all = trial.observations;
    for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
      while (end < all.size() && all[end].time == all[begin].time) ++end;
      for (Track& t :
           fusion.step(all[begin].time, frames_of(all.subspan(begin, end - begin))).tracks)
        last = std::move(t);
    }
    if (!last || last->status != TrackStatus::confirmed) continue;
    const auto truth = propagate(forces, trial.truth, last->time);
    if (!truth) continue;
    ++found;
    OrbitEstimate estimate;
    estimate.state = {last->time, last->position_m, last->velocity_m_per_s};
    for (int row = 0, k = 0; row < 6; ++row)
      for (int column = 0; column <= row; ++column, ++k)
        estimate.covariance(row, column) = estimate.covariance(column, row) =
            last->covariance[std::size_t(k)];
    const double error_m = norm(last->position_m - truth->position_m);
    squares_m2 += error_m * error_m;
    worst_m = std::max(worst_m, error_m);
    sum_nees += nees(estimate, *truth) / 6;
  }
  print_figure({"network_found", double(found) / seeds, "1", "", 0, 1, false}, json);
  print_figure({"network_end_error_m", std::sqrt(squares_m2 / found), "m", "", 0, 100, true}, json);
  print_figure({"network_worst_error_m", worst_m, "m", "", 0, 100, true}, json);
  print_figure({"network_nees", sum_nees / found, "1", "", 0, 1.2, true}, json);
}

}  // namespace

int bench_fusion_tick(bool json) {
  bench_tick(json);
  bench_sites("hour", 360, json);
  bench_sites("night", 3600, json);
  bench_three_sites(json);
  return 0;
}

}  // namespace dmise
