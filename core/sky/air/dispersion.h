#pragma once
#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "core/effects/accuracy.h"
#include "core/effects/effects.h"
#include "core/frames/vec.h"
#include "core/photometry/band.h"
#include "core/sky/air/refraction.h"

namespace dmise {

/// A part of a source's light: `at` is 0 where the bluest light of the band falls, 1 where the
/// reddest does; the shares of a source sum to 1.
struct SpectrumCell {
  double at, share;
};

/// Distribution of the light of stars over the range of refraction of a band, by B-V and airmass:
/// extinction in the blue moves the mean towards the red.
class BandDispersion {
 public:
  static constexpr int max_cells = 128;

  /// `extinction` [mag/airmass]; empty: of one value at all wavelengths.
  BandDispersion(const Band& band, const Curve& extinction);

  /// Wavelengths between which the band has light [m].
  double blue_m() const { return blue_m_; }
  double red_m() const { return red_m_; }
  /// Adds the cells of a source to `cells`: `count`, a power of two to `max_cells`, of equal
  /// refraction, each at the mean of its light.
  void add_cells(double airmass, double bv, int count, std::vector<SpectrumCell>& cells) const;

 private:
  double blue_m_ = 0.0, red_m_ = 0.0;
  /// Light up to each edge of `max_cells` cells, and its moment: colours x airmasses x edges x 2.
  std::vector<double> sums_;
};

/// The air bends blue light more than red: a point becomes a short spectrum along the vertical, its
/// blue end up, and sources of different colour are lifted by different angles.
class Dispersion {
 public:
  static constexpr std::array<std::string_view, 5> levels{"off", "mean", "1px", "0.3px", "0.1px"};
  /// Widest cell of a spectrum by level [px]; the mean is one cell.
  static constexpr std::array<double, 5> cell_px{0.0, unbounded, 1.0, 0.3, 0.1};
  static constexpr EffectFacts facts{
      "dispersion",
      "the atmosphere spreads a point into a spectrum along the vertical (off unless asked for)",
      "0.7 arcsec across V at 45 deg elevation, 1.4 across B, 1.7 from 0.4 to 0.9 um",
      "IAU SOFA, eraRefco, over the band",
      false,
      true,
      levels};
  static bool applies(const SceneFacts& scene) { return scene.on_ground; }

  /// Light is displaced by up to half of a cell, or by the whole spectrum without the effect.
  static ErrorBound error(int level, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  /// Number of cells into which a level cuts a spectrum of this length.
  static int cells(int level, double length_px);

  /// `air`: refraction at the middle of the band, by which places are computed; `is_refracted`:
  /// whether it is switched on.
  Dispersion(const Band& band, const Curve& extinction, const Refraction& air, bool is_refracted);

  /// Elevation of the bluest and the reddest light of a source above the elevation at which it is
  /// seen [rad].
  struct Ends {
    double blue_rad, red_rad;
  };
  Ends ends(double elevation_rad, double distance_m = Refraction::star) const;
  const BandDispersion& band() const { return *band_; }

 private:
  std::shared_ptr<const BandDispersion> band_;
  Refraction middle_, blue_, red_;
  bool is_refracted_;
};

/// Length of the spectrum of a band's light at an elevation [rad].
double dispersion_rad(const Band& band, const Refraction& air, double elevation_rad);

}  // namespace dmise
