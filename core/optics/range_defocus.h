#pragma once
#include <array>
#include <string_view>

#include "core/effects/effects.h"

namespace dmise {

struct Optics;
struct PsfPlan;

/// What is at a finite range has its focus behind that of the stars: focal length^2 / range of
/// defocus, which is a disc of aperture / range on the sky (a ring with an obscuration). Each
/// object has the defocus of its range in mid exposure, in steps.
struct RangeDefocus {
  /// Share of an object's light that a level misplaces at most.
  static constexpr std::array<double, 5> misplaced{1.0, 0.1, 0.03, 0.01, 0.003};
  static constexpr std::array<std::string_view, 5> levels{"off", "10%", "3%", "1%", "0.3%"};
  static constexpr EffectFacts facts{
      "range_defocus",
      "objects are out of focus by their range (share of their light that may be misplaced)",
      "objects are as sharp as stars: a disc of aperture / range is missing",
      "a spherical wavefront; geometrical disc of a Gaussian; Smith 2008, Modern Optical "
      "Engineering",
      true,
      true,
      levels,
      3};
  static bool applies(const SceneFacts& scene) { return scene.blurs; }
  static ErrorBound error(int level, const PlanFacts& f);
  /// A kernel and the transforms about each object that is out of focus.
  static double cost_s(int level, const PlanFacts& f);
};

/// By how much less the detector is behind the focus of an object at a range than behind that of
/// stars: focal length^2 / range.
double range_defocus_m(const Optics& optics, double range_m);

/// Variance of a disc along an axis, or of the ring of an obscured pupil [px^2].
double disc_variance_px2(const Optics& optics, double disc_px);

/// How defocus compares with the rest of a camera's blur, in a measure along which equal steps
/// misplace equal shares of light.
class DefocusScale {
 public:
  DefocusScale(const Optics& optics, const PsfPlan& in_focus);

  /// Disc of a defocus [px], with its sign; its size is no more than `widest_disc_px`.
  double disc_px(double defocus_m) const;
  /// Share of a point's light that is misplaced, at most, if a disc has the place of another, 0..1.
  double misplaced(double disc_px, double other_px) const;
  /// The defocus by which one is drawn: `in_focus_m` where the difference misplaces no more than
  /// `share` of the light, else the middle of its step.
  double stepped_m(double defocus_m, double in_focus_m, double share) const;

 private:
  double measure(double disc_px) const;

  double px_per_m_;  // diameter of the disc over defocus
  double width_px_;  // blur without defocus
  double ring_;      // steps of a ring are narrower than of a disc
  double airy_px_;   // 0: its rings are blurred away
};

}  // namespace dmise
