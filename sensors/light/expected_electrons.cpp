#include "sensors/light/expected_electrons.h"

#include <algorithm>
#include <cmath>

#include "core/base/stopwatch.h"
#include "core/effects/frame_effects.h"
#include "core/sky/bodies/earth_disc.h"
#include "core/sky/bodies/limb_airglow.h"
#include "core/sky/bodies/moon_disc.h"
#include "core/sky/bodies/planets.h"
#include "core/sky/bodies/sun_disc.h"
#include "core/sky/limb_air.h"
#include "sensors/light/disc_layer.h"
#include "sensors/light/object_layer.h"
#include "sensors/light/planet_layer.h"
#include "sensors/light/sky_layer.h"
#include "sensors/light/stray_light.h"
#include "sensors/objects/objects_in_field.h"
#include "sensors/scene/limb_layer.h"
#include "sensors/scene/occlusion_mask.h"

namespace dmise {
namespace {

/// What the stages of a frame's light work on.
struct LightFrame {
  const View& view;
  const LightSources& sources;
  OpticsStage& optics;
  ExpectedElectronImage& image;
  Threads& threads;
  EffectTimes& times;
  const LightOptions& options;
  DrawnStars drawn;
  OcclusionMask mask{image.columns, image.rows};
  LightTruth truth{};
  /// Light of Sun, Moon, Earth and its air in the frame, where a shape may cover it; empty: none.
  ExpectedElectronImage discs{};

  template <class Draw>
  void add_disc(const Draw& draw) {
    const bool may_be_covered = sources.shapes && !sources.shapes->empty();
    if (!may_be_covered && !options.sky) return draw(view, optics, image, threads);
    ExpectedElectronImage disc(image.columns, image.rows);
    draw(view, optics, disc, threads);
    if (discs.pixels.empty()) discs = ExpectedElectronImage(image.columns, image.rows);
    for (ExpectedElectronImage* to : {&image, &discs, options.sky})
      if (to)
        for (std::size_t i = 0; i < disc.pixels.size(); ++i) to->pixels[i] += disc.pixels[i];
  }
};

/// Electrons of a source that just stands out of a pixel's noise of sky, dark current and read-out.
double faintest_e(const View& view, const ExpectedElectronImage& sky) {
  const auto& d = view.sensor().camera.detector;
  const double sky_e = sky.at(sky.columns / 2, sky.rows / 2);
  const double noise_e =
      std::sqrt(sky_e + d.dark_e_per_s * view.times().seconds() + d.read_noise_e * d.read_noise_e);
  return 10.0 * std::max(1.0, noise_e);
}

struct SkyStage : SkyBackground {
  static void apply(LightFrame& f) {
    fill_sky(f.view, f.drawn, f.image, f.threads, f.sources.evaluator);
    if (f.options.sky) *f.options.sky = f.image;
  }
  static void leave_out(LightFrame& f) { apply(f); }
};

/// The blur before the first source: kernels of the exposure.
struct KernelStage {
  static constexpr const EffectFacts& facts = PointSpread::facts;
  static void apply(LightFrame& f) { f.optics.begin(f.view.times(), faintest_e(f.view, f.image)); }
};

struct StrayLightStage : StrayLight {
  static void apply(LightFrame& f) {
    const auto light_e = float(stray_light_e(f.view));
    for (ExpectedElectronImage* to : {&f.image, f.options.sky})
      if (to)
        for (float& pixel : to->pixels) pixel += light_e;
  }
};

struct ThermalOpticsStage : ThermalOptics {
  static void apply(LightFrame& f) {
    ExpectedElectronImage* const images[] = {&f.image, f.options.sky};
    add_thermal_optics(f.view, images, f.threads);
  }
};

/// A disc in the field, or the air around one.
template <class Effect, auto draw>
struct DiscStage : Effect {
  static void apply(LightFrame& f) { f.add_disc(draw); }
};

struct ObjectStage : SpaceObjects {
  static void apply(LightFrame& f) {
    f.truth.objects = draw_objects(
        f.view, f.sources.objects ? *f.sources.objects : objects_in_field(f.view, f.sources.shapes),
        f.sources.shapes, f.optics, f.mask, f.image);
  }
};

/// Sky and discs behind what objects cover.
struct OcclusionStage : Occlusion {
  static void apply(LightFrame& f) {
    if (f.mask.empty()) return;
    if (!f.discs.pixels.empty()) f.mask.take_hidden(f.discs, f.image);
    if (!f.view.sensor().effects.has(SkyBackground::facts)) return;
    ExpectedElectronImage behind(f.image.columns, f.image.rows);
    fill_sky_behind(f.view, f.drawn, behind, f.threads);
    f.mask.take_hidden(behind, f.image);
  }
};

struct StarStage : StarBackground {
  static void apply(LightFrame& f) {
    if (f.sources.stars)
      f.truth.stars = f.sources.stars->draw(f.view, f.optics, f.mask, f.image,
                                            f.sources.limit_v_mag(f.view.sensor().effects),
                                            f.options.stars, f.times);
  }
};

/// Planets that are smaller than a pixel.
struct PlanetStage {
  static constexpr const EffectFacts& facts = Planets::facts;
  static bool applies(const SceneFacts& scene) { return Planets::applies(scene); }
  static void apply(LightFrame& f) {
    draw_planet_points(f.view, f.optics, f.mask, f.image, f.options.stars);
  }
};

/// The blur after the last source.
struct BlurStage {
  static constexpr const EffectFacts& facts = PointSpread::facts;
  static void apply(LightFrame& f) { f.optics.finish(f.image); }
};

/// In the order in which they run. A stage has the facts of its effect and
///   static void apply(LightFrame&);
///   static void leave_out(LightFrame&);   where there is something to do when the effect is off
using LightStages =
    EffectList<SkyStage, StrayLightStage, ThermalOpticsStage, KernelStage,
               DiscStage<SunDisc, draw_sun>, DiscStage<MoonDisc, draw_moon>,
               DiscStage<Planets, draw_planet_discs>, DiscStage<EarthDisc, draw_earth>,
               DiscStage<LimbAir, draw_limb_air>, DiscStage<LimbAirglow, draw_limb_airglow>,
               ObjectStage, OcclusionStage, StarStage, PlanetStage, BlurStage>;

/// Runs a stage. Its effect is charged what the stage does not charge to others.
template <class Stage>
void run(LightFrame& frame) {
  double stage_s = 0.0;
  const double before_s = frame.times.sum_s();
  {
    Stopwatch timing(stage_s);
    Stage::apply(frame);
  }
  frame.times[Stage::facts] += std::max(0.0, stage_s - (frame.times.sum_s() - before_s));
}

/// Truth of an exposure behind a closed shutter: objects are there, without light.
LightTruth without_light(LightFrame& f) {
  if (f.view.sensor().effects.has(SpaceObjects::facts)) {
    f.optics.begin(f.view.times(), 1.0);
    ObjectStage::apply(f);
    for (Truth& truth : f.truth.objects) {
      truth.rendered_signal_e = truth.rendered_x_px = truth.rendered_y_px = 0.0;
      truth.in_frame = false;
    }
  }
  std::ranges::fill(f.image.pixels, 0.0f);
  if (f.options.sky) *f.options.sky = f.image;
  return std::move(f.truth);
}

}  // namespace

double LightSources::limit_v_mag(const EffectSet& effects) const {
  return std::min(faintest_star_mag,
                  StarBackground::limit_v_mag(effects.level(StarBackground::facts)));
}

DrawnStars LightSources::drawn(const EffectSet& effects) const {
  if (!stars || !effects.has(StarBackground::facts)) return {};
  return stars->field().drawn(limit_v_mag(effects), effects);
}

LightTruth expected_electrons(const View& view, const LightSources& sources, OpticsStage& optics,
                              ExpectedElectronImage& image, Threads& threads, EffectTimes& times,
                              const LightOptions& options) {
  const EffectSet& effects = view.sensor().effects;
  LightFrame frame{.view = view,
                   .sources = sources,
                   .optics = optics,
                   .image = image,
                   .threads = threads,
                   .times = times,
                   .options = options,
                   .drawn = sources.drawn(effects)};
  if (view.shutter_closed()) return without_light(frame);
  LightStages::for_each([&]<class Stage>() {
    if (acts<Stage>(effects, view.scene()))
      run<Stage>(frame);
    else if constexpr (requires { Stage::leave_out(frame); })
      Stage::leave_out(frame);
  });
  const ImageOptics image_optics = acting_optics(view.sensor().camera.optics.image, effects);
  apply_image_optics(image_optics, image, threads, times);
  if (options.sky) apply_image_optics(image_optics, *options.sky, threads, times);
  return std::move(frame.truth);
}

}  // namespace dmise
