#pragma once
#include <functional>
#include <span>

#include "core/base/parallel.h"
#include "core/optics/blur/extended_light.h"
#include "sensors/scene/bodies_in_field.h"
#include "sensors/scene/view.h"

namespace dmise {

/// Photons/s/m2/sr from an apparent direction (unit), < 0 beside the disc.
using Radiance = std::function<double(const Vec<Gcrs>&)>;

/// How a disc looks in one frame.
struct Disc {
  DiscBox box;                              // over all times
  double radius_px = 1e9, finest_px = 1e9;  // finest: width of the narrowest part of it
  bool changes_within_pixels = false;       // the corners of a pixel do not tell its light
  bool is_large = false;                    // against tiles, and nothing but its edges is uneven
  int rows_together = 1;                    // behind a rolling shutter it stands still so long
  std::function<Radiance(SimTime)> at = {};
  std::function<DiscBox(SimTime)> box_at = {};  // at one time; none: it may be anywhere in the box
};

/// Integrates a disc over the pixels of its box.
class DiscWindow {
 public:
  /// All must outlive it. `times`: at which the disc is drawn.
  DiscWindow(const View& view, const Disc& disc, std::size_t times, Threads& threads);

  /// Adds the disc of one time, which stands for a share of the exposure; of a rolling shutter it
  /// is the time of the first row, and each row has its own.
  void add(SimTime t, double share);
  /// From mean radiance to electrons; returns the light.
  const ExtendedLight& finish();

 private:
  using Look = std::function<double(double x_px, double y_px)>;
  void add_rows(SimTime t, double share, int first, int last);
  void add_tile(const Look& look, double share, const DiscBox& tile);
  void add_pixels(const Look& look, double share, const DiscBox& tile);
  double sampled(const Look& look, double x, double y) const;

  const View& view_;
  const Optics& optics_;
  const Disc& disc_;
  Threads& threads_;
  ExtendedLight window_;
  int samples_ = 8;  // along a side of a pixel on an edge
};

}  // namespace dmise
