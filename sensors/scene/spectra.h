#pragma once
#include <optional>
#include <vector>

#include "core/optics/blur/deposit.h"
#include "core/sky/air/dispersion.h"
#include "sensors/scene/view.h"

namespace dmise {

/// Where the bluest and the reddest light of a source in the band falls.
struct SpectrumEnds {
  PixelPosition blue, red;
};

/// Spreads the light of points and trails of one exposure along the vertical, at the sensor's level
/// of `Dispersion`.
class Spectra {
 public:
  /// Empty where the effect does not act.
  static std::optional<Spectra> over(const View& view);

  /// Ends of the spectrum of a source that is seen in an apparent direction, at `pixel`.
  SpectrumEnds ends(const Vec<Gcrs>& apparent, double distance_m, const Vec<Gcrs>& up,
                    const Rotation<CameraFrame, Gcrs>& camera, PixelPosition pixel) const;

  /// Adds arcs with the light of `arc` to `spread`, from its path by the bluest light to that by
  /// the reddest. `apparent`: in mid exposure.
  void add(const Arc& arc, const Arc& blue, const Arc& red, const Vec<Gcrs>& apparent, double bv,
           std::vector<Arc>& spread) const;

 private:
  Spectra(const View& view, const Curve& extinction);

  const Optics& optics_;
  Dispersion dispersion_;
  Vec<Gcrs> up_;  // in mid exposure
  int level_;
};

}  // namespace dmise
