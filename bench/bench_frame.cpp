#include "bench/bench_frame.h"

#include <fftw3.h>
#include <algorithm>
#include <functional>
#include <vector>

#include "bench/bench_all_sky.h"
#include "bench/figure.h"
#include "bench/timing.h"
#include "core/detector/exposure/expose.h"
#include "core/detector/noise/poisson.h"
#include "core/optics/blur/deposit.h"
#include "core/optics/waves/fft.h"
#include "sensors/scene/optics_stage.h"

namespace dmise {
namespace {

constexpr int repeats = 5;
constexpr int columns = 3326, rows = 2504;  // the paper's all-sky camera

double seconds(const std::function<void()>& work) { return median_seconds(repeats, work); }

void measure_poisson(bool json) {
  const RngKey key = rng_key(1, "bench", 1, "photon_noise");
  const auto rate = [&](float mean) {
    // As in a frame: in pieces, in the cache.
    constexpr std::size_t piece = 16384, pieces = 256;
    std::vector<float> means(piece, mean), deviates(piece);
    const double s = seconds([&] {
      for (std::size_t i = 0; i < pieces; ++i)
        poisson(key, std::uint32_t(i * piece), means.data(), piece, deviates.data());
    });
    return double(piece * pieces) / s * 1e-6;
  };
  print_figure({"poisson_1e4_mpx_per_s", rate(1e4f), "Mpx/s", "", 0, 250}, json);
  print_figure({"poisson_5_mpx_per_s", rate(5.0f), "Mpx/s", "", 0, 60}, json);
}

std::vector<Arc> trails(int width, int height) {
  std::vector<Arc> arcs;
  const RngKey key = rng_key(1, "bench", 1, "stars");
  for (std::uint32_t i = 0; i < 15000; ++i) {
    const auto u = [&](std::uint32_t draw) { return uniform_of(rng_word(key, i, draw)); };
    const PixelPosition at{u(0) * width, u(1) * height}, half{0.5 + u(2), u(3) - 0.5};
    arcs.push_back({at - half, at, at + half, 1e4});
  }
  return arcs;
}

void measure_deposit(bool json) {
  Threads one(1);
  ExpectedElectronImage image(columns, rows, 100.0f);
  const PsfTable psf = make_psf_table(1.5 / fwhm_per_sigma);
  const auto arcs = trails(columns, rows);
  print_figure(
      {"star_trails_15000_ms", 1e3 * seconds([&] { deposit(arcs, psf, view_of(image), one); }),
       "ms", "", 0, 30, true},
      json);
  const Arc streak{{100, 100}, {300, 250}, {500, 400}, 1e6};
  print_figure({"streak_500px_ms", 1e3 * seconds([&] {
                                     deposit({&streak, 1}, psf, view_of(image), one);
                                   }),
                "ms"},
               json);
}

/// The detector that frames are exposed on.
Detector exposed_detector() {
  Detector detector;
  detector.dark_e_per_s = 0.02;
  detector.read_noise_e = 9.3;
  detector.full_well_e = 25500;
  detector.gain_e_per_dn = 0.35;
  detector.bias_dn = 1000;
  return detector;
}

void measure_detector(bool json) {
  Threads one(1);
  const Detector detector = exposed_detector();
  const ExpectedElectronImage light(columns, rows, 2000.0f);
  CountImage counts;
  EffectTimes times;
  const double s = seconds([&] {
    expose(light, detector, {.seed = 1, .sensor = "bench", .frame = 1, .exposure_s = 20}, {}, one,
           counts, &times);
  });
  print_figure({"detector_ms", 1e3 * s, "ms"}, json);
  for (const EffectFacts* effect : {&PhotonNoise::facts, &DarkCurrent::facts, &FullWell::facts,
                                    &ReadNoise::facts, &Quantisation::facts})
    print_figure({std::string(effect->name) + "_ms", 1e3 * times[*effect] / repeats, "ms"}, json);
}

// The two plain transforms of a padded frame, as a library user would run them.
double two_transforms_s(int columns, int rows) {
  FftBuffer buffer(std::size_t(rows) * std::size_t(columns + 2));
  auto* spectrum = reinterpret_cast<fftwf_complex*>(buffer.data());
  const fftwf_plan there =
      fftwf_plan_dft_r2c_2d(rows, columns, buffer.data(), spectrum, FFTW_ESTIMATE);
  const fftwf_plan back =
      fftwf_plan_dft_c2r_2d(rows, columns, spectrum, buffer.data(), FFTW_ESTIMATE);
  const double s = seconds([&] {
    fftwf_execute(there);
    fftwf_execute(back);
  });
  fftwf_destroy_plan(there);
  fftwf_destroy_plan(back);
  return s;
}

// Stars and streaks of a 4096 x 4096 telescope through the whole of its optics: deposits on the
// grid, diffraction with an obscuration and spiders, a long exposure, jitter, pixel integration.
void measure_optics(bool json) {
  Threads one(1);
  SensorConfig sensor;
  sensor.name = "bench";
  sensor.exposure_s = 10;
  auto& optics = sensor.camera.optics;
  optics = {.focal_length_m = 3.0,
            .aperture_m = 0.3,
            .obscuration = 0.35,
            .pixel_pitch_m = 9e-6,
            .columns = 4096,
            .rows = 4096};
  optics.spread.model = PointSpread::Model::diffraction;
  optics.spread.method = PointSpread::Method::transform;
  optics.spread.spiders = 4;
  optics.spread.spider_width_m = 0.004;
  optics.spread.jitter_rad = 0.5e-6;
  sensor.seeing = SensorSeeing{.r0_m = 0.06, .outer_scale_m = 25, .wind_m_per_s = 8};
  OpticsStage stage(sensor, 1, one);
  const FrameTimes exposure{
      .frame = 1, .start = {0}, .middle = sim_seconds(5), .end = sim_seconds(10)};
  ExpectedElectronImage light(optics.columns, optics.rows);
  const auto arcs = trails(optics.columns, optics.rows);
  double begin_s = 0.0;
  stage.begin(exposure, 1e4);  // the kernel, once
  const double ours = seconds([&] {
    const double start = thread_seconds();
    stage.begin(exposure, 1e4);
    stage.add(arcs, light);
    begin_s = thread_seconds() - start;
    stage.finish(light);
  });
  const int cells = 4096 * stage.plan().oversampling + 2 * stage.plan().half_cells;
  const double anchor = two_transforms_s(good_fft_size(cells, true), good_fft_size(cells));
  print_figure({"full_chain_4096_ms", 1e3 * ours, "ms", "two FFTW transforms [ms]", 1e3 * anchor},
               json);
  print_figure({"full_chain_4096_deposit_ms", 1e3 * begin_s, "ms", "full chain [ms]", 1e3 * ours},
               json);
  const Detector detector = exposed_detector();
  CountImage counts;
  const double detector_s = seconds([&] {
    expose(light, detector, {.seed = 1, .sensor = "bench", .frame = 1, .exposure_s = 10}, {}, one,
           counts);
  });
  print_figure(
      {"full_chain_4096_detector_ms", 1e3 * detector_s, "ms", "full chain [ms]", 1e3 * ours}, json);
  print_figure({"full_chain_4096_ratio", ours / anchor, "1", "", 0, 2.0, true}, json);
}

}  // namespace

int bench_frame(bool json) {
  measure_all_sky(json);  // first, because it measures memory
  measure_poisson(json);
  measure_deposit(json);
  measure_detector(json);
  measure_optics(json);
  return 0;
}

}  // namespace dmise
