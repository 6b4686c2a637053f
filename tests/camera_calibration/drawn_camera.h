#pragma once

#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "core/base/files/whole_file.h"
#include "core/camera_calibration/calibrate_camera.h"
#include "tests/ingest/foreign_file.h"

namespace dmise::test {

/// A camera whose frames are drawn by the standard library.
struct DrawnCamera {
  int columns = 128, rows = 96;
  double gain_e_per_dn = 1.5, read_noise_e = 6.0, bias_dn = 300.0, prnu_rms = 0.01;
  double full_well_e = 60000.0;
  std::mt19937_64 random{253};
  std::vector<double> response{};

  std::vector<double> counts(double light_e) {
    std::normal_distribution<double> normal;
    const auto pixels = std::size_t(columns * rows);
    while (response.size() < pixels) response.push_back(1 + prnu_rms * normal(random));
    std::vector<double> out;
    for (std::size_t i = 0; i < pixels; ++i) {
      double e = 0.0;
      if (light_e > 0) e = double(std::poisson_distribution<long>(light_e * response[i])(random));
      e = std::min(e, full_well_e) + read_noise_e * normal(random);
      out.push_back(std::clamp(std::round(e / gain_e_per_dn + bias_dn), 0.0, 65535.0));
    }
    return out;
  }
};

/// A directory of frames, removed at the end.
struct FrameDirectory {
  std::filesystem::path path;
  std::vector<CalibrationFile> files{};

  FrameDirectory() {
    path = std::filesystem::path(testing::TempDir()) / "calibrate";
    std::filesystem::remove_all(path);
    std::filesystem::create_directories(path);
  }
  ~FrameDirectory() { std::filesystem::remove_all(path); }
  FrameDirectory(const FrameDirectory&) = delete;
  FrameDirectory& operator=(const FrameDirectory&) = delete;

  void add(const DrawnCamera& camera, std::vector<double> counts, const std::string& kind,
           double exposure_s, std::vector<std::string> cards = {}) {
    if (!kind.empty()) cards.push_back(card("IMAGETYP", "'" + kind + "'"));
    cards.push_back(card("EXPTIME", std::to_string(exposure_s)));
    const std::string name = (path / (std::to_string(files.size()) + ".fits")).string();
    write_file_whole(name, encoded({.bitpix = USHORT_IMG,
                                    .shape = {camera.columns, camera.rows},
                                    .values = std::move(counts),
                                    .cards = std::move(cards)}));
    files.push_back({name});
  }
  /// Biases, and pairs of flats of rising light.
  void add_all(DrawnCamera& camera, const std::string& bias, const std::string& flat) {
    for (int i = 0; i < 6; ++i) add(camera, camera.counts(0.0), bias, 0.0);
    for (const double light_e : {2000.0, 10000.0, 25000.0, 45000.0})
      for (int i = 0; i < 2; ++i) add(camera, camera.counts(light_e), flat, light_e / 1000);
  }
  CameraCalibration calibrated() const {
    Threads threads;
    return calibrate_camera(files, {}, {.name = "drawn", .band = "bessell-V"}, nullptr, threads);
  }
};

}  // namespace dmise::test
