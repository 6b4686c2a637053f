#include "bench/bench_detect.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bench/detection_trial.h"
#include "bench/figure.h"
#include "bench/status_memory.h"
#include "bench/timing.h"
#include "core/base/error.h"
#include "core/config/yaml/search_path.h"
#include "core/detection/detect.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/detection/streaks/faint_streaks.h"
#include "core/sky/stars/star_cache.h"

namespace dmise {
namespace {

constexpr int columns = 3326, rows = 2504;

unsigned first_seed = 0;

std::shared_ptr<const StarMap> kstars() {
  const std::string path = find_catalogue("stars.dat.gz");
  if (path.empty()) throw Error("bench detect: there are no stars; is DMISE_HOME right?");
  return std::make_shared<const StarMap>(load_star_map(path, ""));
}

/// Fields at galactic latitudes of 90, 30 and 5 deg.
std::vector<StarField> fields_of(const CatalogueSky& sky) {
  return {{&sky, 192.86 * deg, 27.13 * deg},
          {&sky, 270.0 * deg, 66.2 * deg},
          {&sky, 292.8 * deg, 29.0 * deg}};
}

/// Detection in full frames without anything but stars.
struct FrameFigures {
  double seconds = 0.0, peak_mb = 0.0, alarms = 0.0;
  std::uint32_t stars = 0;
};

FrameFigures figures_of(const std::vector<StarField>& fields, int frames, int random_stars,
                        double deeper_mag) {
  FrameFigures out;
  for (int f = 0; f < frames; ++f) {
    const StarField& field = fields[std::size_t(f) % fields.size()];
    const FrameHeader header = trial_header(columns, rows, 20, field, deeper_mag);
    auto frame = trial_frame(header, columns, rows, field, first_seed + 50u + unsigned(f));
    frame.add_stars(random_stars, 300, 2e6);
    const CountImage counts = frame.expose();
    Threads one;
    const double before = status_mb("VmRSS");
    std::ofstream("/proc/self/clear_refs") << "5";  // proc(5): resets the peak
    const double start = thread_seconds();
    const auto result = detect(counts, header, {}, one, field.sky);
    out.seconds += (thread_seconds() - start) / frames;
    out.alarms += double(result.detections.size()) / frames;
    out.stars += result.report.star_like / std::uint32_t(frames);
    out.peak_mb = std::max(out.peak_mb, status_mb("VmHWM") - before);
  }
  return out;
}

void print_frames(const std::string& suffix, const FrameFigures& f, bool json) {
  print_figure({"frame" + suffix + "_s", f.seconds, "s", "", 0, 0.35, true}, json);
  print_figure({"frame" + suffix + "_peak_mb", f.peak_mb, "MB", "", 0, 70, true}, json);
  print_figure({"frame" + suffix + "_stars", double(f.stars), "1", "", 0, 0, true}, json);
  print_figure({"false_alarms_per_frame" + suffix, f.alarms, "1", "", 0, 0.1, true}, json);
}

}  // namespace

void add_detect_options(CLI::App& command) {
  command
      .add_option_function<unsigned>(
          "--seed", [](unsigned seed) { first_seed = 100000 * seed; },
          "other stars, noise and places for each")
      ->check(CLI::Range(0, 1000))
      ->type_name("N");
}

int bench_detect(bool json) {
  const CatalogueSky sky(kstars());
  const std::vector<StarField> fields = fields_of(sky);
  // A magnitude and a half deeper the catalogue has 18,000 stars in the densest of them.
  print_frames("", figures_of(fields, 6, 0, 1.5), json);
  print_frames("_without_catalogue", figures_of({{nullptr, 0.0, 34 * deg}}, 3, 18000, 0.0), json);

  double points = -1e9, streaks = -1e9;
  for (const double length : {0.0, 5.0, 20.0, 100.0, 300.0, 1000.0}) {
    const double threshold = length > 0 ? min_streak_snr(length) : detection_limits::min_snr;
    double worst = -1e9;
    for (const StarField& field : fields)
      worst = std::max(worst, late_by_snr(length, threshold,
                                          length > 600   ? 12
                                          : length > 250 ? 6
                                                         : 3,
                                          field, first_seed + 1000));
    double& all = length > 0 ? streaks : points;
    all = std::max(all, worst);
    if (length > 0)
      print_figure({"pd_shift_streak_" + std::to_string(int(length)) + "_snr", worst, "SNR", "", 0,
                    0.3, true},
                   json);
    else
      print_figure({"pd_shift_points_snr", worst, "SNR", "", 0, 0.3, true}, json);
  }
  print_figure({"pd_shift_streaks_snr", streaks, "SNR", "", 0, 0.3, true}, json);

  // More than 2,000 of each, of all lengths and of SNR 10 to 40.
  const StarField& field = fields[1];
  const DetectionOutcome point = detection_trial(0, 20, 6, 36, field, first_seed + 3000);
  using Trial = std::tuple<double, double, int>;  // length, SNR, frames
  DetectionOutcome streak, faint;
  for (const auto& [length, snr, frames] :
       {Trial{20, 20, 8}, Trial{20, 40, 8}, Trial{40, 20, 8}, Trial{100, 20, 8}, Trial{100, 40, 8},
        Trial{300, 40, 16}})
    streak.add(detection_trial(length, snr, 7, frames, field, first_seed + 4000));
  for (const auto& [length, snr, frames] :
       {Trial{8, 10, 8}, Trial{20, 10, 8}, Trial{40, 10, 8}, Trial{100, 12, 8}, Trial{300, 15, 16}})
    faint.add(detection_trial(length, snr, 7, frames, field, first_seed + 5000));
  using Named = std::pair<const char*, const DetectionOutcome*>;
  for (const auto& [name, o] :
       {Named{"points", &point}, Named{"streaks", &streak}, Named{"faint_streaks", &faint}}) {
    const std::string of = name;
    const double n = std::max(o->found, 1);
    print_figure({"position_over_crlb_" + of, std::sqrt(o->squares_px2 / o->bound_px2), "1", "", 0,
                  1.15, true},
                 json);
    print_figure({"nees_" + of, o->nees / n, "1", "", 0, 1.05, true}, json);
    print_figure({"magnitude_bias_sigma_" + of, std::abs(o->bias_sigma / n), "1", "", 0, 0.2, true},
                 json);
  }
  return 0;
}

}  // namespace dmise
