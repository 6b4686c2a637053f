#pragma once
#include <algorithm>

#include "core/effects/plan_facts.h"

// The effects that sensors/pipeline runs as stages of a frame's light, or chooses between: their
// facts, errors and costs, which configuration, documents and the planner need.
namespace dmise {

struct SkyBackground {
  static constexpr EffectFacts facts{"sky", "sky background", "no background and no noise of it",
                                     "the sum of its parts"};
  static ErrorBound error(int, const PlanFacts& f) {
    return f.without_light([](const SkySample& s) { return 1.1 * s.sky_e; });
  }
  static double cost_s(int level, const PlanFacts& f) { return level * 0.9e-9 * f.pixels(); }
};

struct SpaceObjects {
  static constexpr EffectFacts facts{"objects", "space objects", "no objects",
                                     "diffuse spheres and facets"};
  static ErrorBound error(int, const PlanFacts& f) {
    return f.objects > 0 ? not_bounded : ErrorBound{};
  }
  static double cost_s(int level, const PlanFacts& f) {
    return level * (20e-6 * double(f.objects - f.shapes) + 1e-3 * double(f.shapes));
  }
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

  static ErrorBound error(int level, const PlanFacts& f) {
    double largest_px = 0.0;  // of those that are points
    for (const double radius_px : f.shape_radius_px)
      if (radius_px <= tolerance_px[std::size_t(level)])
        largest_px = std::max(largest_px, radius_px);
    return f.shifted_objects(largest_px * f.pixel_rad);
  }
  static double cost_s(int level, const PlanFacts& f) {
    constexpr double shape_s = 38e-3;
    return shape_s * double(std::ranges::count_if(f.shape_radius_px, [&](double radius_px) {
             return radius_px > tolerance_px[std::size_t(level)];
           }));
  }
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
  static double cost_s(int level, const PlanFacts& f) {
    constexpr double search_s = 20e-6, star_s = 1.4e-6;
    if (level == 0) return 0.0;
    return search_s +
           star_s * (level == facts.reference() ? f.stars : f.stars_to(limit_v_mag(level)));
  }
};

/// Stars beyond the catalogue, drawn from star counts.
struct SyntheticBackground {
  static constexpr std::array<std::string_view, 14> levels{"off", "v10", "v11", "v12", "v13",
                                                           "v14", "v15", "v16", "v17", "v18",
                                                           "v19", "v20", "v21", "all"};
  static constexpr EffectFacts facts{
      "synthetic_stars",
      "stars that no catalogue has, where it ends (if `stars.synthetic_to` asks for them)",
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
  static double cost_s(int level, const PlanFacts& f) {
    constexpr double star_s = 0.7e-6;
    const double limit = limit_v_mag(level);
    return level == 0 ? 0.0 : star_s * f.synthetic_brighter[PlanFacts::limit(limit)];
  }
};

/// How finely the smooth sky is sampled.
struct SkyGrid {
  /// Relative error of the sky between the pixels at which it is evaluated.
  static constexpr std::array<double, 5> tolerance{0.02, 0.005, 0.001, 0.0002, 0.0};
  static constexpr std::array<std::string_view, 5> levels{"2%", "0.5%", "0.1%", "0.02%", "pixel"};
  static constexpr EffectFacts facts{"sky_grid",
                                     "the sky between the pixels at which it is looked at",
                                     "an error of 0.5 % of the sky; every pixel at the reference",
                                     "bicubic patches, cut in four where they do not hold",
                                     true,
                                     true,
                                     levels,
                                     1};
  /// Error on uncut patches of 32 px [e-]: relative 0.7 times the size of a patch in radians for
  /// the zodiacal table, which bends at its nodes, and 1.5 times its square for the other parts.
  /// Moonlight has a kink 9 deg from the Moon and rises towards it; clouds have edges.
  static double of_patches(const SkySample& s, const PlanFacts& f) {
    if (std::isfinite(f.cloud_detail_px)) return s.sky_e;
    constexpr double beyond_kink_rad = 0.2;
    const double patch_rad = 32.0 * f.pixel_rad, zodiacal_e = s.of(SkyPart::zodiacal_light);
    double missed_e =
        0.7 * patch_rad * zodiacal_e + 1.5 * patch_rad * patch_rad * (s.sky_e - zodiacal_e);
    if (f.nearest_moon_rad < beyond_kink_rad) {
      const double rises = patch_rad / f.nearest_moon_rad;
      missed_e += std::min(1.0, 1.3 * patch_rad + rises * rises) * f.moonlight_e(s);
    }
    return missed_e;
  }
  /// Bound of the error that cutting leaves [e-]. Cutting does not find pieces of cloud that are
  /// smaller than a patch.
  static double of_cut(int level, const SkySample& s, const PlanFacts& f) {
    constexpr double smallest_px = 64.0;
    const double share =
        f.cloud_detail_px < smallest_px ? 1.0 : 0.9 * tolerance[std::size_t(level)];
    const double brightest_e = s.sky_e - s.of(SkyPart::scattered_moonlight) + f.moonlight_e(s);
    return share * std::min(brightest_e, (1.0 + share) * f.saturated_e);
  }
  static ErrorBound error(int level, const PlanFacts& f) {
    return f.without_light(
        [&](const SkySample& s) { return std::min(of_cut(level, s, f), of_patches(s, f)); });
  }
  static double cost_s(int level, const PlanFacts& f) {
    constexpr std::array<double, 4> looks_more{0.0, 0.05, 4.0, 20.0};
    if (level == facts.reference()) return f.sky_look_s * f.pixels();
    const bool is_cut = std::any_of(f.sky.begin(), f.sky.end(), [&](const SkySample& s) {
      return of_patches(s, f) > of_cut(level, s, f);
    });
    return is_cut ? looks_more[std::size_t(level)] * f.sky_look_s * f.sky_looks() : 0.0;
  }
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
  static int wavelengths(int level, const PlanFacts& f) {
    return std::max(count[std::size_t(level)], f.least_wavelengths);
  }
  /// A hundredth of the cost of kernels that are kept, since they are computed once for many
  /// frames. Of kernels that the air changes the first wavelength is charged to turbulence.
  static double cost_s(int level, const PlanFacts& f) {
    const int wavelengths = PsfWavelengths::wavelengths(level, f);
    return f.kernel_s * (f.kernels_change ? wavelengths - 1.0 : 0.01 * wavelengths);
  }
};

struct Occlusion {
  static constexpr EffectFacts facts{
      "occlusion", "objects with a shape hide what is behind them",
      "stars, sky and farther objects shine through an object of many pixels",
      "coverage of each pixel, nearest object first"};
  static bool applies(const SceneFacts& scene) { return scene.shapes; }
  static ErrorBound error(int, const PlanFacts& f) {
    return f.shapes > 0 ? not_bounded : ErrorBound{};
  }
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
