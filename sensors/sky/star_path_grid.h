#pragma once
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/base/pixel.h"
#include "core/frames/vec.h"
#include "core/sky/places/apparent.h"
#include "sensors/scene/view.h"
#include "sensors/sky/star_path_kernels.h"

namespace dmise {

/// A star's way over the detector, and what its light meets on it.
struct StarPath {
  std::array<PixelPosition, 3> pixel;  // start, middle, end
  Vec<Gcrs> middle;                    // apparent direction in mid exposure
  double airmass = 1.0;                // 1 in space
  double illumination = 1.0;           // in the middle pixel
};

/// Paths of many stars of one exposure. What moves a star from its astrometric place to a pixel
/// (deflection, aberration, refraction, the camera's turning) is computed exactly at nodes over the
/// detector and interpolated by biquadratic patches: within 2e-4 px, 1e-7 rad, 1e-4 of airmass and
/// illumination of the exact path. A patch that is farther off in its two places of largest error
/// has none, nor has one at the horizon or beside the image of the sky.
class StarPathGrid {
 public:
  /// Returns the exact path of a star without motion and parallax; nothing if it has no image.
  using Exact = std::function<std::optional<StarPath>(const Vec<Gcrs>& astrometric)>;

  StarPathGrid(const View& view, const Exact& exact);

  /// Most that a path is off [px].
  static constexpr double tolerance_px = 2e-4;

  enum class Found : char { path, none, beside };
  /// The paths of stars at astrometric places (unit). `none`: the exact path is to be taken.
  /// `beside`: it is not near the frame. The spans are of one size.
  void find(std::span<const Vec<Gcrs>> astrometric, std::span<StarPath> paths,
            std::span<Found> found) const;

 private:
  // Differences from the astrometric place: of three pixels, of a direction; airmass, illumination.
  static constexpr std::size_t values = 11;
  using Node = std::array<double, path_values>;

  void make(double spacing_px, double margin_px, const Exact& exact);
  PixelPosition node_at(double column, double row) const;
  std::optional<Node> look(PixelPosition pixel, const Exact& exact) const;
  PatchPlace place_in(std::size_t patch_column, std::size_t patch_row, double u, double v) const;
  void interpolate(std::span<const PatchPlace> places, std::span<Node> out) const;
  bool holds(std::size_t patch_column, std::size_t patch_row, const Exact& exact) const;
  double bad_share() const;

  const Optics* optics_;
  Rotation<CameraFrame, Gcrs> camera_;
  double spacing_px_ = 64.0, left_ = 0.0, top_ = 0.0;
  std::size_t columns_ = 0, rows_ = 0;  // patches, each two spacings wide
  std::vector<Node> nodes_;
  std::vector<char> has_node_, good_;
};

}  // namespace dmise
