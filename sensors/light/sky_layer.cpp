#include "sensors/light/sky_layer.h"

#include <algorithm>

#include "core/effects/frame_effects.h"
#include "sensors/sky/thermal_optics.h"

namespace dmise {
namespace {

double tolerance_of(const View& view) {
  return SkyGrid::asked(view.sensor().effects.level(SkyGrid::facts));
}

void fill(const View& view, const PixelFunction& electrons, ExpectedElectronImage& image,
          Threads& threads) {
  const double tolerance = tolerance_of(view);
  if (tolerance > 0.0)
    fill_from_grid(image.columns, image.rows, electrons, tolerance, image.pixels.data(), threads);
  else
    fill_every_pixel(image.columns, image.rows, electrons, image.pixels.data(), threads);
}

void fill_with(const View& view, const SkyModel& sky, ExpectedElectronImage& image,
               Threads& threads, GlEvaluator* evaluator = nullptr) {
  const auto& optics = view.sensor().camera.optics;
  const PixelFunction electrons = electrons_of(view, sky);
  if (!evaluator) return fill(view, electrons, image, threads);
  std::fill(image.pixels.begin(), image.pixels.end(), 0.0f);
  evaluator->add_sky(patches_of_grid(optics.columns, optics.rows, electrons,
                                     std::max(tolerance_of(view), SkyGrid::asked(2)), threads),
                     image);
}

}  // namespace

void fill_sky(const View& view, const DrawnStars& drawn, ExpectedElectronImage& image,
              Threads& threads, GlEvaluator* evaluator) {
  if (!acts<SkyBackground>(view.sensor().effects, view.scene())) {
    std::fill(image.pixels.begin(), image.pixels.end(), 0.0f);
    return;
  }
  fill_with(view, sky_over(view, drawn), image, threads, evaluator);
}

void add_thermal_optics(const View& view, std::span<ExpectedElectronImage* const> images,
                        Threads& threads) {
  const auto& optics = view.sensor().camera.optics;
  ExpectedElectronImage warm(optics.columns, optics.rows);
  fill(view, thermal_optics_electrons(view), warm, threads);
  for (ExpectedElectronImage* to : images)
    if (to)
      for (std::size_t i = 0; i < warm.pixels.size(); ++i) to->pixels[i] += warm.pixels[i];
}

void fill_sky_behind(const View& view, const DrawnStars& drawn, ExpectedElectronImage& image,
                     Threads& threads) {
  SkyParts parts = sky_parts_over(view, drawn);
  if (view.on_ground())
    parts = {.zodiacal_light = parts.zodiacal_light, .faint_starlight = parts.faint_starlight};
  fill_with(view, sky_of(view, parts), image, threads);
}

}  // namespace dmise
