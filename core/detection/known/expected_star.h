#pragma once
#include <optional>
#include <vector>

#include "core/base/pixel.h"
#include "core/frames/vec.h"
#include "core/photometry/star_light.h"
#include "core/products/frame_header.h"
#include "core/sky/air/refraction.h"

namespace dmise {

/// A star of a catalogue, or a planet, where a frame should show it.
struct ExpectedStar {
  PixelPosition place;     // in mid exposure
  double signal_e = 0.0;   // in the whole exposure
  double radius_px = 0.0;  // a planet's disc; 0 for a star
  // Most and least light of a variable star, relative to `signal_e`.
  double most = 1.0, least = 1.0;

  bool varies() const { return most > least; }
};

/// Where a frame should show sources and with which light, by the header's WCS, zero point, band
/// and air, without noise and clouds.
class ExpectedStars {
 public:
  /// Takes sources of at least `min_signal_e`, in the frame and up to `beyond_px` beside it.
  /// `header` must outlive it.
  ExpectedStars(const FrameHeader& header, int columns, int rows, double min_signal_e,
                double beyond_px);

  /// V of the faintest sources that may have as much light.
  double faintest_v_mag() const;
  /// A source at an astrometric place (unit); nothing where the frame does not show it.
  std::optional<ExpectedStar> at(const Vec<Gcrs>& direction, double v_mag,
                                 const StarColour& colour) const;
  /// The planets.
  std::vector<ExpectedStar> planets() const;

 private:
  const FrameHeader& header_;
  int columns_, rows_;
  double min_signal_e_, beyond_px_;
  StarLight light_;
  double sunlike_;  // light of a star of V = 0 and the colour of what the zero point is for
  Vec<Gcrs> zenith_;
  std::optional<Refraction> refraction_;
};

}  // namespace dmise
