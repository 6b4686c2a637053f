#include "sensors/pipeline/expected_electrons.h"

#include <algorithm>
#include <cmath>

#include "core/effects/light_effects.h"
#include "sensors/pipeline/object_layer.h"
#include "sensors/pipeline/objects_in_field.h"
#include "sensors/pipeline/screen.h"
#include "sensors/pipeline/sky_layer.h"
#include "sensors/pipeline/stopwatch.h"

namespace dmise {
namespace {

/// Electrons of a source that just stands out of a pixel's noise of sky, dark current and read-out.
double faintest_e(const View& view, const RateImage& sky) {
  const auto& d = view.sensor().camera.detector;
  const double sky_e = sky.at(sky.columns / 2, sky.rows / 2);
  const double noise_e =
      std::sqrt(sky_e + d.dark_e_per_s * view.times().seconds() + d.read_noise_e * d.read_noise_e);
  return 10.0 * std::max(1.0, noise_e);
}

}  // namespace

double LightSources::drawn_to_v_mag(const EffectSet& effects) const {
  if (!stars || !effects.has(effect::stars)) return -std::numeric_limits<double>::infinity();
  return std::min(faintest_star_mag, stars->faintest_filled_v_mag());
}

LightTruth expected_electrons(const View& view, const LightSources& sources, OpticsStage& optics,
                              RateImage& image, Threads& threads, EffectTimes& times,
                              const LightOptions& options) {
  const EffectSet& effects = view.sensor().effects;
  const double drawn_to_v_mag = sources.drawn_to_v_mag(effects);
  LightTruth truth;
  fill_sky(view, drawn_to_v_mag, image, threads, times, sources.evaluator);
  if (options.sky) *options.sky = image;
  {
    Stopwatch timing(times[effect::psf]);
    optics.begin(view.times(), faintest_e(view, image));
  }
  Screen screen(image.columns, image.rows);
  if (effects.has(effect::objects))
    truth.objects = draw_objects(view, objects_in_field(view, sources.shapes), sources.shapes,
                                 optics, screen, image, times);
  if (!screen.empty()) {
    RateImage behind(image.columns, image.rows);
    fill_sky_behind(view, drawn_to_v_mag, behind, threads);
    screen.take_hidden(behind, image);
  }
  if (sources.stars && effects.has(effect::stars))
    truth.stars = sources.stars->draw(view, optics, screen, image, sources.faintest_star_mag,
                                      options.stars, times);
  {
    Stopwatch timing(times[effect::psf]);
    optics.finish(image);
  }
  apply_image_optics(acting_optics(view.sensor().camera.optics.image, effects), image, threads,
                     times);
  return truth;
}

}  // namespace dmise
