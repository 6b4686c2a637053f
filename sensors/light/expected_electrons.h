#pragma once
#include <limits>
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/products/truth.h"
#include "sensors/light/star_layer.h"
#include "sensors/objects/object_shapes.h"
#include "sensors/scene/gl_evaluator.h"
#include "sensors/scene/optics_stage.h"
#include "sensors/scene/view.h"

namespace dmise {

/// What puts light on the plane of one sensor.
struct LightSources {
  const StarLayer* stars = nullptr;  // null: none
  double faintest_star_mag = 9.5;
  const ObjectShapes* shapes = nullptr;               // null: all objects are points
  GlEvaluator* evaluator = nullptr;                   // null: light is deposited
  const std::vector<std::size_t>* objects = nullptr;  // in the field; null: yet to be found

  /// Returns V of the faintest stars asked for.
  double limit_v_mag(const EffectSet& effects) const;

  /// Returns which stars are drawn one by one: to the limit asked for or the catalogue's, and
  /// synthetic ones.
  DrawnStars drawn(const EffectSet& effects) const;
};

/// Optional outputs of an exposure's light.
struct LightOptions {
  ExpectedElectronImage* sky = nullptr;     // filled with the light of the sky alone
  std::vector<StarTruth>* stars = nullptr;  // gets the stars as they were drawn
};

/// The sources of an exposure's light.
struct LightTruth {
  std::vector<Truth> objects;
  std::uint32_t stars = 0;  // that left light in the frame
};

/// Fills `image` with the electrons that the exposure of `view` expects of every pixel: the sky,
/// objects from the nearest on, stars behind them, blurred by `optics`. The band is that of the
/// view's camera: the whole or a part. Adds the seconds of each stage to `times`. Behind a closed
/// shutter nothing is expected.
LightTruth expected_electrons(const View& view, const LightSources& sources, OpticsStage& optics,
                              ExpectedElectronImage& image, Threads& threads, EffectTimes& times,
                              const LightOptions& options = {});

}  // namespace dmise
