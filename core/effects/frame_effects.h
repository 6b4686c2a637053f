#pragma once
#include <algorithm>

#include "core/effects/accuracy.h"
#include "core/effects/effects.h"

// The effects that sensors/light runs as stages of a frame's light, or chooses between: their
// facts, errors and costs, which configuration, documents and the planner need.
namespace dmise {

struct SkyBackground {
  static constexpr EffectFacts facts{"sky", "sky background", "no background and no noise of it",
                                     "the sum of its parts"};
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);
};

struct SpaceObjects {
  static constexpr EffectFacts facts{"objects", "space objects", "no objects",
                                     "diffuse spheres and facets"};
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);
};

/// The size from which on an object with a shape is not drawn as a point.
struct ResolvedShapes {
  /// Angular radius up to which it is a point [px].
  static constexpr std::array<double, 5> tolerance_px{1.0, 0.5, 0.2, 0.05, 0.01};
  static constexpr std::array<std::string_view, 5> levels{"1px", "0.5px", "0.2px", "0.05px",
                                                          "0.01px"};
  static constexpr EffectFacts facts{"resolved_shapes",
                                     "from which radius on objects with a shape are no points",
                                     "a point is displaced or broadened by up to its radius",
                                     "facets drawn by OpenGL, glints laid by area",
                                     true,
                                     true,
                                     levels,
                                     3};
  static bool applies(const SceneFacts& scene) { return scene.shapes; }

  static ErrorBound error(int level, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);
};

struct StarBackground {
  /// V magnitude to which stars are drawn one by one; fainter ones are in the smooth starlight.
  static constexpr std::array<std::string_view, 18> levels{
      "off", "v0", "v1",  "v2",  "v3",  "v4",  "v5",  "v6",  "v7",
      "v8",  "v9", "v10", "v11", "v12", "v13", "v14", "v15", "all"};
  static constexpr EffectFacts facts{
      "stars", "star background", "no stars", "Debian's star catalogues", true, true, levels};
  static bool applies(const SceneFacts& scene) { return scene.stars; }
  /// Returns the limit of a level; infinity at the reference.
  static double limit_v_mag(int level) {
    return level == 0 ? -unbounded : level == facts.reference() ? unbounded : level - 1.0;
  }
  static ErrorBound error(int level, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);
};

/// Stars beyond the catalogue, drawn from star counts.
struct SyntheticBackground {
  static constexpr std::array<std::string_view, 14> levels{"off", "v10", "v11", "v12", "v13",
                                                           "v14", "v15", "v16", "v17", "v18",
                                                           "v19", "v20", "v21", "all"};
  static constexpr EffectFacts facts{
      "synthetic_stars",
      "stars that no catalogue has, where it ends (to `stars.synthetic_to`)",
      "they are in the smooth starlight; a pixel of 10 arcsec in the Milky Way has 0.8 to V = 21",
      "counts of Tycho-2 and USNO-B1.0; Bahcall & Soneira 1980, ApJS 44, 73",
      true,
      true,
      levels};
  static bool applies(const SceneFacts& scene) { return scene.stars && scene.synthetic_stars; }
  static double limit_v_mag(int level) {
    return level == 0 ? -unbounded : level == facts.reference() ? unbounded : level + 9.0;
  }
  static ErrorBound error(int level, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);
  /// Whether a star of so much light stands out of the noise.
  static bool is_seen(double signal_e, const PlanFacts& f);
  /// Returns the lowest level that leaves out no star that the facts ask for.
  static int whole_level(const PlanFacts& f);
};

/// How finely the smooth sky is sampled.
struct SkyGrid {
  /// Relative error of the sky between the pixels at which it is evaluated.
  static constexpr std::array<double, 5> tolerance{0.02, 0.005, 0.001, 0.0002, 0.0};
  /// What `fill_from_grid` is asked for, so that its error, up to 1.2 times that, stays within the
  /// level's.
  static constexpr double asked(int level) { return 0.75 * tolerance[std::size_t(level)]; }
  static constexpr std::array<std::string_view, 5> levels{"2%", "0.5%", "0.1%", "0.02%", "pixel"};
  static constexpr EffectFacts facts{"sky_grid",
                                     "the sky between the pixels at which it is looked at",
                                     "an error of 0.5 % of the sky; every pixel at the reference",
                                     "bicubic patches, cut in four where they do not hold",
                                     true,
                                     true,
                                     levels,
                                     1};
  static ErrorBound error(int level, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);
};

/// Wavelengths of the band for which the blur is computed.
struct PsfWavelengths {
  static constexpr std::array<int, 5> count{1, 2, 3, 5, 9};
  static constexpr std::array<std::string_view, 5> levels{"1", "2", "3", "5", "9"};
  static constexpr EffectFacts facts{
      "psf_wavelengths",
      "wavelengths of the band for which the blur is computed",
      "with one, 0.02 mag x width / wavelength in an aperture of the blur",
      "Fourier optics of the pupil, by wavelength",
      true,
      true,
      levels,
      0};
  static bool applies(const SceneFacts& scene) { return scene.diffracts; }
  static ErrorBound error(int level, const PlanFacts& f);
  /// Returns how many wavelengths a level has: no fewer than the camera asks for.
  static int wavelengths(int level, const PlanFacts& f);
  /// A hundredth of the cost of kernels that are kept, since they are computed once for many
  /// frames. Where the air changes kernels, the first wavelength is charged to turbulence.
  static double cost_s(int level, const PlanFacts& f);
};

struct Occlusion {
  static constexpr EffectFacts facts{
      "occlusion", "objects with a shape hide what is behind them",
      "stars, sky and farther objects shine through an object of many pixels",
      "coverage of each pixel, nearest object first"};
  static bool applies(const SceneFacts& scene) { return scene.shapes; }
  static ErrorBound error(int, const PlanFacts& f);
};

/// How the motion of sources is drawn: exactly along their paths, or as snapshots.
struct Streak {
  static constexpr EffectFacts facts{
      "streak",
      "sources move during the exposure: along their paths, or in N snapshots",
      "C/N of the peak with N snapshots, C depending on the streak's length",
      "the path's integral over each pixel, arc by arc",
      true,
      false};
};

/// What draws light on the focal plane.
struct Drawing {
  static constexpr EffectFacts facts{
      "evaluator",
      "what draws points and sky: the analytic deposit, or OpenGL",
      "2e-5 of the brightest pixel between the two",
      "an error function a pixel; OpenGL additive blending in 32 bits",
      true,
      false};
};

}  // namespace dmise
