#include "sensors/light/object_light.h"

#include <algorithm>
#include <map>

#include "core/effects/frame_effects.h"
#include "core/sky/bodies/earth_disc.h"
#include "core/sky/bodies/limb_airglow.h"
#include "core/sky/bodies/moon_disc.h"
#include "core/sky/bodies/planets.h"
#include "core/sky/bodies/sun_disc.h"
#include "core/sky/limb_air.h"
#include "sensors/objects/objects_in_field.h"

namespace dmise {
namespace {

/// Indices of the objects of `truths`.
std::vector<std::size_t> indices_of(const View& view, const LightSources& sources,
                                    const std::vector<Truth>& truths) {
  const auto all = sources.objects ? *sources.objects : objects_in_field(view, sources.shapes);
  std::map<std::pair<std::uint32_t, std::string>, std::size_t> by_name;
  for (const std::size_t i : all) {
    const auto& object = view.states().roster().objects[i];
    by_name.emplace(std::pair(object.catalogue_number, object.name), i);
  }
  std::vector<std::size_t> indices;
  for (const Truth& t : truths) indices.push_back(by_name.at({t.catalogue_number, t.name}));
  return indices;
}

}  // namespace

void take_object_lights(const View& view, const FrameTimes& commanded, const LightSources& sources,
                        OpticsStage& optics, const std::vector<Truth>& truths,
                        const ElectronImage& noise, Threads& threads,
                        const ObjectLightTaker& take) {
  if (std::none_of(truths.begin(), truths.end(), [](const Truth& t) { return t.in_frame; })) return;
  SensorConfig dark = view.sensor();
  for (const EffectFacts* other :
       {&SkyBackground::facts, &StarBackground::facts, &StrayLight::facts, &ThermalOptics::facts,
        &SunDisc::facts, &MoonDisc::facts, &Planets::facts, &EarthDisc::facts, &LimbAir::facts,
        &LimbAirglow::facts})
    dark.effects.force(*other, false);
  const View in_the_dark(dark, commanded, view.states(), view.seed());
  const auto indices = indices_of(view, sources, truths);
  const auto& grid = dark.camera.optics;
  EffectTimes elsewhere;
  LightSources alone = sources;
  alone.stars = nullptr;
  const auto draw = [&](const std::vector<std::size_t>& objects, ExpectedElectronImage& image) {
    alone.objects = &objects;
    expected_electrons(in_the_dark, alone, optics, image, threads, elsewhere);
  };
  const int border_px = acting_detector(dark.camera.detector, dark.effects).reference_px;
  ExpectedElectronImage light(grid.columns, grid.rows);
  // What has a shape hides what is behind it.
  const bool may_hide =
      std::any_of(truths.begin(), truths.end(), [](const Truth& t) { return t.resolved; });
  const auto is_nearer = [&](std::size_t a, std::size_t b) {
    return std::pair(truths[a].true_range_m, a) < std::pair(truths[b].true_range_m, b);
  };
  for (std::size_t k = 0; k < truths.size(); ++k) {
    if (!truths[k].in_frame) continue;
    std::vector<std::size_t> nearer;
    if (may_hide)
      for (std::size_t j = 0; j < truths.size(); ++j)
        if (truths[j].resolved && is_nearer(j, k)) nearer.push_back(indices[j]);
    if (nearer.empty()) {
      draw({indices[k]}, light);
    } else {
      ExpectedElectronImage others(grid.columns, grid.rows);
      draw(nearer, others);
      nearer.push_back(indices[k]);
      draw(nearer, light);
      for (std::size_t i = 0; i < light.pixels.size(); ++i)
        light.pixels[i] = std::max(0.0f, light.pixels[i] - others.pixels[i]);
    }
    visit_border(border_px, grid.columns, grid.rows, 0, light.pixels.size(),
                 [&](std::size_t begin, std::size_t end) {
                   std::fill(light.pixels.begin() + std::ptrdiff_t(begin),
                             light.pixels.begin() + std::ptrdiff_t(end), 0.0f);
                 });
    take(truths[k], light, noise);
  }
}

}  // namespace dmise
