#pragma once
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "core/base/files/text_file.h"
#include "core/base/units.h"
#include "core/image/fits_file.h"
#include "core/products/frame_header.h"
#include "tests/support/detector_of.h"

namespace dmise::test {

/// A header with every field set to something that is not its default, of a camera at the equator
/// of the sky; the WCS has a second-order distortion.
inline FrameHeader sample_header(int columns = 200, int rows = 150) {
  FrameHeader h;
  h.sensor = "atlanta";
  h.frame = 7;
  h.start = {10'000'000'000};
  h.middle = {20'000'000'000};
  h.end = {30'000'000'000};
  h.start_utc = "2018-01-20T23:40:10.000000000";
  h.middle_utc = "2018-01-20T23:40:20.000000000";
  h.end_utc = "2018-01-20T23:40:30.000000000";
  h.exposure_s = 20.0;
  h.mount = "fixed";
  h.software = "dmise 0.1.0";
  h.scenario_digest = "0123456789abcdef0123456789abcdef";
  h.seed = 18446744073709551615u;
  h.gain_e_per_dn = 0.35;
  h.bias_dn = 250.0;
  h.read_noise_e = 9.3;
  h.dark_e_per_s = 0.02;
  h.full_well_e = 25500.0;
  h.detector = detector_of({.quantum_efficiency = 0.54,
                            .dark_reference_c = -10.0,
                            .temperature_c = -10.0,
                            .dark_doubling_k = 6.0,
                            .adc_bits = 14,
                            .prnu_rms = 0.01,
                            .hot_pixel_fraction = 1e-4,
                            .hot_pixel_e_per_s = 50.0,
                            .column_noise_e = 1.5,
                            .nonlinearity = 0.02,
                            .interpixel_coupling = 0.005,
                            .blooming = true,
                            .persistence_fraction = 0.003,
                            .persistence_s = 120.0,
                            .cosmic_rays_per_px_s = 1e-8,
                            .cosmic_ray_e_per_px = 900.0,
                            .cosmic_ray_depth_px = 2.0,
                            .reference_px = 4});
  h.saturation_dn = 65535.0;
  h.psf_fwhm_px = 1.7;
  h.band = {"V", 0.55e-6, 0.128e-6};
  h.zero_point_mag = 17.3;
  h.extinction_mag_per_airmass = 0.17;
  h.focal_length_px = 1663.0;
  const double scale_deg = std::atan(1.0 / h.focal_length_px) / deg;
  h.wcs.crpix_x = (columns - 1) / 2.0;
  h.wcs.crpix_y = (rows - 1) / 2.0;
  h.wcs.ra_rad = 1.1;
  h.wcs.dec_rad = 0.6;
  h.wcs.cd_deg = {scale_deg, 0.0, 0.0, -scale_deg};
  h.wcs.order = 2;
  h.wcs.a = {0, 0, 1e-6, 0, 2e-6, 0, -1e-6, 0, 0};
  h.wcs.b = {0, 0, -2e-6, 0, 1e-6, 0, 3e-6, 0, 0};
  h.wcs.ap = {0, 0, -1e-6, 0, -2e-6, 0, 1e-6, 0, 0};
  h.wcs.bp = {0, 0, 2e-6, 0, -1e-6, 0, -3e-6, 0, 0};
  h.wcs.rms_px = 0.001;
  h.wcs.max_px = 0.003;
  h.camera_from_gcrs = {Quaternion{0.5, 0.5, 0.5, 0.5}, Quaternion{0.6, 0.0, 0.8, 0.0},
                        Quaternion{0.0, 0.28, 0.0, 0.96}};
  h.sensor_position_m = {5.1e6, 1.2e6, 3.5e6};
  h.sensor_velocity_m_per_s = {-87.5, 372.0, 0.1};
  h.earth_velocity_m_per_s = {-26000.0, -13500.0, -5850.0};
  h.site = SitePlace{33.777 * deg, -84.398 * deg, 300.0, {517000.0, -5281000.0, 3525000.0}};
  h.air = Weather{.pressure_hpa = 977.5, .temperature_c = 13.0, .humidity = 0.25};
  return h;
}

/// Counts with structure: every value occurs, neighbours differ.
inline CountImage sample_counts(int columns = 200, int rows = 150) {
  CountImage counts(columns, rows);
  std::uint32_t state = 1;
  for (auto& pixel : counts.pixels) {
    state = state * 1664525u + 1013904223u;
    pixel = std::uint16_t(300 + (state >> 26));
  }
  counts.pixels.front() = 0;
  counts.pixels.back() = 65535;
  return counts;
}

/// Bytes of the file that `write_frame` writes.
inline std::string encoded(const CountImage& counts, const FrameHeader& header,
                           FitsCompression compression = FitsCompression::none,
                           const FlagImage* flags = nullptr) {
  if (compression == FitsCompression::none) return encode_frame(counts, header, flags);
  const std::string path = std::filesystem::temp_directory_path().string() + "/encoded-" +
                           std::to_string(getpid()) + ".fits";
  write_frame(path, counts, header, compression, flags);
  std::string bytes = read_text_file(path);
  std::filesystem::remove(path);
  return bytes;
}

}  // namespace dmise::test
