#pragma once
#include <string>
#include <utility>

#include "core/base/units.h"
#include "core/exchange/export_format.h"
#include "core/time/iso8601.h"

namespace dmise {

/// A run of one sensor "eye" of 200 x 100 px with one frame of 2 s.
inline RunProducts small_run() {
  RunProducts run{.directory = "RUN", .clock = Clock(parse_utc("2018-01-21T00:15:00Z"))};
  run.sensors.push_back(
      {.name = "eye", .site = Site{33.75, -84.4, 300.0}, .columns = 200, .rows = 100});
  run.frames.push_back({.sensor = "eye",
                        .frame = 7,
                        .start = {0},
                        .middle = {1'000'000'000},
                        .end = {2'000'000'000},
                        .column_step_deg = 0.02,
                        .row_step_deg = 0.02,
                        .psf_fwhm_px = 2.0});
  run.frame_index[{"eye", 7}] = 0;
  return run;
}

/// A point at right ascension -10 deg and declination 20 deg, 1 mdeg from where it was measured.
inline Detection small_detection() {
  return {.id = "eye/7/0",
          .sensor = "eye",
          .frame = 7,
          .time = {1'000'000'000},
          .ra_rad = -10.001 * deg,
          .dec_rad = 20.002 * deg,
          .corrected_ra_rad = -10.0 * deg,
          .corrected_dec_rad = 20.0 * deg,
          .covariance_rad2 = {arcsec * arcsec, 0.0, 4.0 * arcsec * arcsec},
          .magnitude = 8.5,
          .snr = 11.6,
          .x_px = 50.0,
          .y_px = 20.0};
}

/// An object that moves from (20, 30) to (60, 50) px, half sunlit.
inline Truth small_truth() {
  return {.sensor = "eye",
          .frame = 7,
          .catalogue_number = 25544,
          .name = "ISS",
          .start = {0},
          .middle = {1'000'000'000},
          .end = {2'000'000'000},
          .true_position_m = {7e6, 0, 0},
          .true_velocity_m_per_s = {0, 7500, 0},
          .true_range_m = 5e5,
          .true_ra_rad = 0.1,
          .true_dec_rad = 0.2,
          .sunlit = 0.5,
          .true_magnitude = 3.0,
          .rendered_signal_e = 1e4,
          .start_x_px = 20,
          .start_y_px = 30,
          .middle_x_px = 40,
          .middle_y_px = 40,
          .end_x_px = 60,
          .end_y_px = 50,
          .in_frame = true,
          .whole = true};
}

inline RunProducts run_with_detection() {
  RunProducts run = small_run();
  run.detections.push_back(small_detection());
  return run;
}

inline RunProducts run_with_truth() {
  RunProducts run = small_run();
  run.truths.push_back(small_truth());
  return run;
}

inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace dmise
