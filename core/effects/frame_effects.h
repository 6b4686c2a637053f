#pragma once
#include "core/effects/effects.h"

// The effects that sensors/pipeline runs as stages of a frame's light, or chooses between; here is
// what configuration and documents need of them.
namespace dmise {

struct SkyBackground {
  static constexpr EffectFacts facts{"sky", "sky background", "no background and no noise of it",
                                     "the sum of its parts"};
};

struct SpaceObjects {
  static constexpr EffectFacts facts{"objects", "space objects", "no objects",
                                     "diffuse spheres and facets"};
};

struct StarBackground {
  static constexpr EffectFacts facts{"stars", "star background", "no stars",
                                     "Debian's star catalogues"};
  static bool applies(const SceneFacts& scene) { return scene.stars; }
};

struct Occlusion {
  static constexpr EffectFacts facts{
      "occlusion", "objects with a shape hide what is behind them",
      "stars, sky and farther objects shine through an object of many pixels",
      "coverage of each pixel, nearest object first"};
  static bool applies(const SceneFacts& scene) { return scene.shapes; }
};

/// How light moves over the plane: along its path, exactly, or as snapshots.
struct Streak {
  static constexpr EffectFacts facts{
      "streak",
      "sources move during the exposure: along their paths, or in N snapshots",
      "C/N of the peak with N snapshots, C depending on the streak's length",
      "the path's integral over each pixel, arc by arc",
      true,
      false};
};

/// What puts light on the plane.
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
