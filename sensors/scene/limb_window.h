#pragma once
#include <functional>
#include <vector>

#include "core/base/parallel.h"
#include "core/optics/blur/extended_light.h"
#include "core/sky/limb_line.h"
#include "sensors/scene/bodies_in_field.h"
#include "sensors/scene/view.h"

namespace dmise {

/// Integrates over pixels what shines low over the Earth. Its cost goes with the pixels that see
/// lines below a height, and one part in thirty of the others.
class LimbWindow {
 public:
  /// Photons/s/m2/sr along a line in an apparent direction (unit).
  using Light = std::function<double(const LimbLine&, const Vec<Gcrs>&)>;
  struct Source {
    Light light;
    double top_m;        // over the ground; no line that stays above it sees light
    bool before_ground;  // lines that end at the ground see light, too
  };

  /// `view` and `threads` must outlive it. `margin_px`: how far beside the frame light counts.
  LimbWindow(const View& view, int margin_px, Source source, Threads& threads);

  /// The light in electrons of the exposure.
  const ExtendedLight& drawn();

 private:
  /// What a row sees at one time.
  struct Row {
    LimbSight sight;
    Rotation<Gcrs, CameraFrame> gcrs_from_camera;
  };
  struct Look {
    double height_m, radiance;  // height: above all where nothing is imaged
    bool imaged;
  };
  std::vector<SimTime> times() const;
  Row row_at(SimTime t, int row) const;
  void add(SimTime t, float share);
  Look look(const Row& row, double x_px, double y_px) const;
  void add_tile(const std::vector<Row>& rows, float share, const DiscBox& tile);
  double sampled(const Row& row, double x_px, double y_px, double min_places) const;
  void add_pixels(const std::vector<Row>& rows, float share, const DiscBox& tile);
  const Row& of(const std::vector<Row>& rows, int y) const {
    return rows[rows.size() == 1 ? 0 : std::size_t(y)];
  }

  const View& view_;
  const Optics& optics_;
  Source source_;
  Threads& threads_;
  ExtendedLight window_;
};

}  // namespace dmise
