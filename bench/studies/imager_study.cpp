#include "bench/studies/imager_study.h"

#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <future>
#include <map>

#include "core/base/error.h"
#include "core/config/objects/material_config.h"
#include "core/config/yaml/search_path.h"
#include "core/detector/exposure/expected_noise.h"
#include "core/detector/exposure/expected_signal.h"
#include "core/detector/exposure/expose.h"
#include "core/discrimination/aperture_fraction.h"
#include "core/discrimination/material_likelihood.h"
#include "core/image/fits_file.h"
#include "sensors/accuracy/scene_frames.h"

namespace dmise {
namespace {

constexpr const char* objects[][2] = {{"STARLINK-1014", "silicon"}, {"unknown", "germanium"}};
constexpr int window_columns = 256, window_rows = 768;
constexpr int piece_px = 48;

std::string paper_file(const char* name) {
  return home_directory() + "/launch/scenarios/paper/" + name;
}

/// One band of the window, before the draws of its detector.
struct BandWindow {
  SensorConfig sensor;
  FrameHeader header;
  ExpectedElectronImage light;
  ElectronImage noise;
  Exposure exposure;
  double fraction = 1.0;
  std::map<std::string, PixelPosition> places;
};

BandWindow window_of(const Scenario& scenario, const std::string& sensor, const Aperture& aperture,
                     Threads& threads) {
  const SceneFrames scene(scenario, sensor, 1, threads);
  const FrameProducts frame = scene.make(scene.sensor());
  BandWindow window{.sensor = scene.sensor(),
                    .header = frame.header,
                    .light = frame.planes.background,
                    .noise = {},
                    .exposure = scene.exposure(),
                    .fraction = aperture_fraction(scene.sensor().camera.optics,
                                                  scene.sensor().camera.band.centre_m, aperture),
                    .places = {}};
  // Both planes are rates.
  for (std::size_t i = 0; i < window.light.pixels.size(); ++i)
    window.light.pixels[i] =
        float((double(frame.planes.background.pixels[i]) + double(frame.planes.sources.pixels[i])) *
              window.exposure.exposure_s);
  window.noise = expected_noise(window.light, window.sensor.camera.detector, window.exposure,
                                window.sensor.effects, threads);
  for (const Truth& truth : frame.truths)
    window.places[truth.name] = {truth.rendered_x_px, truth.rendered_y_px};
  return window;
}

/// Standard deviation of an aperture's flux by the noise of every pixel.
double noise_of(const BandWindow& window, PixelPosition at, const Aperture& aperture) {
  double variance = 0.0, area = 0.0, ring = 0.0;
  std::size_t ring_pixels = 0;
  for (int y = 0; y < window.noise.rows; ++y)
    for (int x = 0; x < window.noise.columns; ++x) {
      const double dx = x - at.x_px, dy = y - at.y_px, away = std::hypot(dx, dy);
      const double v = double(window.noise.at(x, y)) * double(window.noise.at(x, y));
      if (away >= aperture.inner_px && away <= aperture.outer_px) {
        ring += v;
        ++ring_pixels;
      }
      if (away > aperture.radius_px + 1.0) continue;
      const double weight = pixel_in_circle(dx, dy, aperture.radius_px);
      variance += weight * weight * v;
      area += weight;
    }
  const double n = double(ring_pixels);
  return std::sqrt(variance + area * area * ring / n / n);
}

/// Light in an aperture above its ring, of an image without noise.
double light_of(const ElectronImage& image, PixelPosition at, const Aperture& aperture) {
  double light = 0.0, area = 0.0, ring = 0.0;
  std::size_t ring_pixels = 0;
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.columns; ++x) {
      const double dx = x - at.x_px, dy = y - at.y_px, away = std::hypot(dx, dy);
      if (away >= aperture.inner_px && away <= aperture.outer_px) {
        ring += double(image.at(x, y));
        ++ring_pixels;
      }
      const double weight = pixel_in_circle(dx, dy, aperture.radius_px);
      light += weight * double(image.at(x, y));
      area += weight;
    }
  return light - area * ring / double(ring_pixels);
}

/// What the detector makes of the light without noise and without faults of single pixels.
ElectronImage without_noise(const BandWindow& window, Threads& threads) {
  Detector detector = window.sensor.camera.detector;
  detector.prnu_rms = detector.hot_pixel_fraction = detector.cosmic_rays_per_px_s = 0.0;
  return expected_signal(window.light, detector, window.exposure, window.sensor.effects, threads);
}

/// What is exposed for one object in one band.
struct Cutout {
  ExpectedElectronImage light;
  PixelPosition at;
};

Cutout piece_about(const ExpectedElectronImage& light, PixelPosition at) {
  const int x0 = int(std::lround(at.x_px)) - piece_px / 2;
  const int y0 = int(std::lround(at.y_px)) - piece_px / 2;
  Cutout piece{ExpectedElectronImage(piece_px, piece_px), {at.x_px - x0, at.y_px - y0}};
  for (int y = 0; y < piece_px; ++y)
    for (int x = 0; x < piece_px; ++x)
      piece.light.pixels[std::size_t(y * piece_px + x)] = light.at(x0 + x, y0 + y);
  return piece;
}

struct Sums {
  double sum = 0.0, square = 0.0;
  std::size_t count = 0;

  void add(double value) {
    sum += value;
    square += value * value;
    ++count;
  }
  double mean() const { return sum / double(count); }
  double scatter() const {
    return std::sqrt(std::max(0.0, square - sum * mean()) / double(count - 1));
  }
};

}  // namespace

double SeedStudy::bias_sigma() const {
  return std::abs(mean - truth) / (scatter / std::sqrt(double(seeds)));
}

std::vector<SeedStudy> study_seeds(std::size_t seeds, const Aperture& aperture, Exposed exposed,
                                   Threads& threads) {
  Scenario scenario = load_scenario(paper_file("space-imager.yaml"));
  for (SensorConfig& sensor : scenario.sensors) {
    sensor.camera.optics.columns = window_columns;
    sensor.camera.optics.rows = window_rows;
  }
  const BandWindow bands[2] = {window_of(scenario, "red", aperture, threads),
                               window_of(scenario, "swir", aperture, threads)};
  const MaterialLibrary cells(paper_file("cells.yaml"));
  const Band both[2] = {bands[0].sensor.camera.band, bands[1].sensor.camera.band};
  std::vector<SeedStudy> studies;
  for (const auto& [object, material] : objects) {
    const auto reflectance = signature_of(*cells.find(material), both).reflectance;
    studies.push_back({.object = object,
                       .material = material,
                       .truth = reflectance[1] / reflectance[0],
                       .seeds = seeds});
  }
  std::vector<Sums> ratios(2), z(2), fluxes(2), sky(2);
  std::array<std::array<Cutout, 2>, 2> pieces;  // by object and band
  if (exposed == Exposed::pieces)
    for (std::size_t o = 0; o < 2; ++o)
      for (std::size_t b = 0; b < 2; ++b)
        pieces[o][b] = piece_about(bands[b].light, bands[b].places.at(studies[o].object));
  CountImage counts[2];
  const auto expose_band = [&](std::size_t b, const ExpectedElectronImage& light,
                               std::uint64_t seed) {
    Exposure exposure = bands[b].exposure;
    exposure.seed = seed;
    expose(light, bands[b].sensor.camera.detector, exposure, bands[b].sensor.effects, threads,
           counts[b]);
  };
  for (std::size_t seed = 1; seed <= seeds; ++seed) {
    if (exposed == Exposed::window)
      for (std::size_t b = 0; b < 2; ++b) expose_band(b, bands[b].light, seed);
    for (std::size_t o = 0; o < 2; ++o) {
      Measured light[2];
      if (exposed == Exposed::pieces)
        for (std::size_t b = 0; b < 2; ++b)
          expose_band(b, pieces[o][b].light, seed + o * seeds);  // else both had the same noise
      for (std::size_t b = 0; b < 2; ++b) {
        const FrameHeader& h = bands[b].header;
        const PixelPosition at =
            exposed == Exposed::pieces ? pieces[o][b].at : bands[b].places.at(studies[o].object);
        const auto flux =
            aperture_flux(counts[b], {h.gain_e_per_dn, h.bias_dn, h.saturation_dn}, at, aperture);
        if (b == 0) fluxes[o].add(flux.flux_e);
        light[b] =
            reflected({flux.flux_e, flux.sigma_e},
                      full_sunlight_e(h.v_solar_zero_point_mag(), h.exposure_s), bands[b].fraction);
      }
      const Measured ratio = flux_ratio(light[1], light[0]);
      ratios[o].add(ratio.value);
      z[o].add((ratio.value - studies[o].truth) / ratio.sigma);
    }
  }
  const ElectronImage quiet[2] = {without_noise(bands[0], threads),
                                  without_noise(bands[1], threads)};
  for (std::size_t o = 0; o < 2; ++o) {
    SeedStudy& s = studies[o];
    double share[2];  // light over full sunlight, by band
    for (std::size_t b = 0; b < 2; ++b)
      share[b] =
          light_of(quiet[b], bands[b].places.at(s.object), aperture) /
          full_sunlight_e(bands[b].header.v_solar_zero_point_mag(), bands[b].header.exposure_s) /
          bands[b].fraction;
    s.without_noise = share[1] / share[0];
    s.mean = ratios[o].mean();
    s.scatter = ratios[o].scatter();
    s.z_width = z[o].scatter();
    s.snr_r = fluxes[o].mean() / fluxes[o].scatter();
    double square = 0.0;
    for (std::size_t b = 0; b < 2; ++b) {
      // What the longer band has follows from the ratio.
      const PixelPosition at = bands[b].places.at(s.object);
      double flux_e = fluxes[o].mean();
      if (b == 1)
        flux_e *= s.truth * bands[1].fraction / bands[0].fraction *
                  full_sunlight_e(bands[1].header.v_solar_zero_point_mag(), 1.0) /
                  full_sunlight_e(bands[0].header.v_solar_zero_point_mag(), 1.0);
      square += std::pow(noise_of(bands[b], at, aperture) / flux_e, 2);
    }
    s.theory = s.truth * std::sqrt(square);
  }
  return studies;
}

double sequence_seconds() {
  const auto directory =
      std::filesystem::temp_directory_path() / ("bench-paper-" + std::to_string(getpid()));
  std::filesystem::create_directories(directory);
  const auto begun = std::chrono::steady_clock::now();
  const Scenario scenario = load_scenario(paper_file("space-imager.yaml"));
  const auto expose_all = [&](const std::string& name) {
    Threads one(1);
    const SensorConfig& sensor = sensor_named(scenario, name);
    const std::uint32_t frames = frames_within(sensor, scenario.duration);
    const SceneFrames scene(scenario, name, frames, one);
    const auto pipeline = scene.pipeline(scene.sensor(), false);
    for (std::uint32_t k = 1; k <= frames; ++k) {
      FrameProducts frame = pipeline->run(frame_times(scene.sensor(), k), scene.states());
      write_frame((directory / (name + "-" + std::to_string(k) + ".fits")).string(), frame.counts,
                  frame.header);
      pipeline->give_back(std::move(frame.counts));
    }
  };
  std::vector<std::future<void>> sensors;
  for (const SensorConfig& sensor : scenario.sensors)
    sensors.push_back(std::async(std::launch::async, expose_all, sensor.name));
  for (auto& sensor : sensors) sensor.get();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  std::filesystem::remove_all(directory);
  return took.count();
}

}  // namespace dmise
