#pragma once
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/base/image.h"
#include "core/base/units.h"
#include "core/detection/known/star_motion.h"
#include "core/products/frame_header.h"

namespace dmise::simulated {

/// A header of a camera with gnomonic projection at declination `dec_rad` and right ascension
/// `ra_rad`, columns to the north (long axis north-south), whose star field turns with the Earth
/// for `exposure_s` (fixed mount), or not.
inline FrameHeader camera_header(int columns, int rows, double focal_length_px, double dec_rad,
                                 double exposure_s, bool fixed_mount, double ra_rad = 0.0) {
  FrameHeader h;
  h.sensor = "test";
  h.frame = 1;
  h.exposure_s = exposure_s;
  h.middle = sim_seconds(exposure_s / 2);
  h.end = sim_seconds(exposure_s);
  h.start_utc = "2018-01-20T23:40:00.000";
  h.middle_utc = "2018-01-20T23:40:10.000";
  h.end_utc = "2018-01-20T23:40:20.000";
  h.mount = fixed_mount ? "fixed" : "sidereal";
  h.software = "test";
  h.gain_e_per_dn = 0.5;
  h.bias_dn = 100.0;
  h.read_noise_e = 9.3;
  h.full_well_e = 32000.0;
  h.saturation_dn = 64000.0;
  h.psf_fwhm_px = 1.7;
  h.zero_point_mag = 17.0;
  h.focal_length_px = focal_length_px;
  const double c = std::cos(dec_rad), s = std::sin(dec_rad);
  const double ca = std::cos(ra_rad), sa = std::sin(ra_rad);
  const Rotation<CameraFrame, Gcrs> middle{
      {{{-s * ca, -s * sa, c}, {sa, -ca, 0}, {c * ca, c * sa, s}}}};
  const auto at = [&](double seconds) {
    const double turn_rad = fixed_mount ? 7.292115e-5 * seconds : 0.0;
    Rotation<Gcrs, Gcrs> earth;
    earth.m = {{{std::cos(turn_rad), std::sin(turn_rad), 0},
                {-std::sin(turn_rad), std::cos(turn_rad), 0},
                {0, 0, 1}}};
    return quaternion_of(middle * earth);
  };
  h.camera_from_gcrs = {at(-exposure_s / 2), at(0), at(exposure_s / 2)};
  const double scale_deg = std::atan(1.0 / focal_length_px) / deg;
  h.wcs.crpix_x = (columns - 1) / 2.0;
  h.wcs.crpix_y = (rows - 1) / 2.0;
  h.wcs.ra_rad = ra_rad;
  h.wcs.dec_rad = dec_rad;
  h.wcs.cd_deg = {0.0, -scale_deg, scale_deg, 0.0};
  return h;
}

/// Expected electrons, built up source by source by brute force (pixel integrals by erf, lines by
/// many points): independent of the detector's models and of the renderer.
class SimulatedFrame {
 public:
  SimulatedFrame(const FrameHeader& header, int columns, int rows, double sky_e, unsigned seed)
      : header_(header), electrons_(columns, rows, float(sky_e)), random_(seed) {}

  FrameHeader& header() { return header_; }
  const ExpectedElectronImage& electrons() const { return electrons_; }
  std::mt19937_64& random() { return random_; }
  double uniform(double from, double to) {
    return from + (to - from) * double(random_() >> 11) * 0x1p-53;
  }

  void add_point(double x, double y, double flux_e) { add_curve(x, y, 0, 0, flux_e, 0, 0); }
  void add_star(double x, double y, double flux_e) {
    const StarMotion motion(header_, electrons_.columns, electrons_.rows);
    const auto d = motion.trail_at({x, y});
    add_curve(x, y, d.x_px, d.y_px, flux_e, 0, 0);
  }
  void add_streak(double x, double y, double length, double angle_rad, double flux_e,
                  double slope = 0, double sagitta = 0) {
    add_curve(x, y, length * std::cos(angle_rad), length * std::sin(angle_rad), flux_e, slope,
              sagitta);
  }
  /// `count` stars at random places, in number 10^(0.4 * 1.1 m)-like: N(> flux) as flux^-1.1.
  void add_stars(int count, double min_e, double max_e) {
    for (int i = 0; i < count; ++i) {
      const double x = uniform(-5, electrons_.columns + 5), y = uniform(-5, electrons_.rows + 5);
      const double u = uniform(0, 1), p = -1 / 1.1;
      const double top = std::pow(max_e / min_e, -1.1);
      add_star(x, y, min_e * std::pow(1 - u * (1 - top), p));
    }
  }

  /// The expected electrons, to be changed.
  ExpectedElectronImage& expected() { return electrons_; }
  /// Photon noise (normal where it is large), read noise, gain, full well, ADC.
  CountImage expose() {
    CountImage counts(electrons_.columns, electrons_.rows);
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < counts.pixels.size(); ++i) {
      const double mean = electrons_.pixels[i];
      double e = mean;
      if (mean < 50) {
        std::poisson_distribution<int> poisson(mean);
        e = poisson(random_);
      } else {
        e += std::sqrt(mean) * normal(random_);
      }
      e = std::min(e, header_.full_well_e) + header_.read_noise_e * normal(random_);
      const double dn = std::round(e / header_.gain_e_per_dn + header_.bias_dn);
      counts.pixels[i] = std::uint16_t(std::clamp(dn, 0.0, 65535.0));
    }
    return counts;
  }

 private:
  void add_curve(double x, double y, double dx, double dy, double flux_e, double slope,
                 double sagitta) {
    const double sigma = header_.psf_fwhm_px / std::sqrt(8 * std::log(2.0));
    const double length = std::hypot(dx, dy);
    const int steps = length > 0 ? int(std::ceil(length / (0.2 * sigma))) + 1 : 1;
    for (int i = 0; i < steps; ++i) {
      const double r = (2 * i + 1.0) / steps - 1;  // -1 .. 1
      const double bend = sagitta * (1.0 / 3 - r * r);
      const double nx = length > 0 ? -dy / length : 0, ny = length > 0 ? dx / length : 0;
      deposit(x + dx * r / 2 + nx * bend, y + dy * r / 2 + ny * bend,
              flux_e / steps * (1 + slope * r), sigma);
    }
  }
  void deposit(double x, double y, double flux_e, double sigma) {
    const int reach = int(std::ceil(6 * sigma));
    const int x0 = std::max(0, int(std::lround(x)) - reach);
    const int x1 = std::min(electrons_.columns - 1, int(std::lround(x)) + reach);
    const int y0 = std::max(0, int(std::lround(y)) - reach);
    const int y1 = std::min(electrons_.rows - 1, int(std::lround(y)) + reach);
    if (x1 < x0 || y1 < y0) return;
    const auto share = [&](double from) {
      const double k = 1 / (sigma * std::sqrt(2.0));
      return 0.5 * (std::erf((from + 0.5) * k) - std::erf((from - 0.5) * k));
    };
    weights_.resize(std::size_t(x1 - x0 + 1));
    for (int px = x0; px <= x1; ++px) weights_[std::size_t(px - x0)] = share(px - x);
    for (int py = y0; py <= y1; ++py) {
      const double row = flux_e * share(py - y);
      for (int px = x0; px <= x1; ++px)
        electrons_.at(px, py) += float(row * weights_[std::size_t(px - x0)]);
    }
  }

  FrameHeader header_;
  ExpectedElectronImage electrons_;
  std::mt19937_64 random_;
  std::vector<double> weights_;
};

}  // namespace dmise::simulated
