#pragma once
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/sequences/sequence_frame.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"
#include "core/wcs/wcs.h"
#include "tests/support/simulated_frame.h"

namespace dmise::simulated {

/// Exposures of 2 s every 5 s of a field with stars, through a mount that stands still or turns
/// with the stars. A pixel is 10.3 arcsec: stars drift by 1.46 px/s.
struct SimulatedSequence {
  static constexpr int size = 256;
  static constexpr double focal_px = 20000.0, exposure_s = 2.0, cadence_s = 5.0, sky_e = 900.0;
  static constexpr double turn_rad_per_s = 7.292115e-5;

  bool fixed = true;
  int frames = 8, stars = 60;
  unsigned field = 7;  // seed of the stars
  /// Changes the expected electrons of a frame.
  std::function<void(SimulatedFrame&, int frame)> add = [](SimulatedFrame&, int) {};
  /// Changes the counts of a frame.
  std::function<void(CountImage&, int frame)> spoil = [](CountImage&, int) {};

  double time_s(int frame) const { return cadence_s * (frame - frames / 2); }

  FrameHeader header(int frame) const {
    const double ra_rad = 0.3 + (fixed ? turn_rad_per_s * time_s(frame) : 0.0);
    FrameHeader h = camera_header(size, size, focal_px, 0.1, exposure_s, fixed, ra_rad);
    h.frame = std::uint32_t(frame + 1);
    h.psf_fwhm_px = 2.4;
    const Clock clock(parse_utc("2024-03-05T20:00:00Z"));
    const auto text = [&](double after_s) {
      return format_utc(clock.utc(sim_seconds(100 + time_s(frame) + after_s)), 3);
    };
    h.start_utc = text(0);
    h.middle_utc = text(exposure_s / 2);
    h.end_utc = text(exposure_s);
    return h;
  }

  /// Flux of a point of this SNR in the noise of the sky [e-].
  static double flux_e(double snr) {
    const double sigma_px = std::sqrt(2.4 * 2.4 / 8 / std::log(2.0) + 1.0 / 12);
    return snr * std::sqrt(sky_e + 9.3 * 9.3) * std::sqrt(4 * pi) * sigma_px;
  }

  std::vector<SequenceFrame> draw() const {
    std::vector<SequenceFrame> out;
    for (int i = 0; i < frames; ++i) {
      const FrameHeader h = header(i);
      SimulatedFrame frame(h, size, size, sky_e, unsigned(100 + i));
      add_stars(frame);
      add(frame, i);
      out.push_back({"frame-" + std::to_string(i), frame.expose(), h});
      spoil(out.back().counts, i);
    }
    return out;
  }

 private:
  /// Each frame has the same stars of the sky, also beside the frame in the middle.
  void add_stars(SimulatedFrame& frame) const {
    SimulatedFrame places(frame.header(), 1, 1, 0, field);  // for its random numbers
    const Wcs middle = header(frames / 2).wcs;
    for (int i = 0; i < 4 * stars; ++i) {
      const PixelPosition at{places.uniform(-1.5 * size, 2.5 * size), places.uniform(0, size)};
      const double snr = 4 * std::pow(places.uniform(1e-3, 1), -0.9);
      const auto here = wcs_pixel(frame.header().wcs, wcs_direction(middle, at));
      if (here) frame.add_star(here->x_px, here->y_px, flux_e(std::min(snr, 400.0)));
    }
  }
};

}  // namespace dmise::simulated
