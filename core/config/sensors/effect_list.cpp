#include "core/config/sensors/effect_list.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "core/config/sensors/instrument_config.h"
#include "core/detector/detector.h"
#include "core/effects/frame_effects.h"
#include "core/effects/plan_facts.h"
#include "core/facets/earthshine.h"
#include "core/facets/glints.h"
#include "core/facets/moonlight.h"
#include "core/optics/image_optics.h"
#include "core/optics/range_defocus.h"
#include "core/optics/waves/air_turbulence.h"
#include "core/photometry/planck.h"
#include "core/sky/air/air_effects.h"
#include "core/sky/air/dispersion.h"
#include "core/sky/bodies/earth_disc.h"
#include "core/sky/bodies/limb_airglow.h"
#include "core/sky/bodies/limb_extinction.h"
#include "core/sky/bodies/moon_disc.h"
#include "core/sky/bodies/occultation.h"
#include "core/sky/bodies/planets.h"
#include "core/sky/bodies/shadow.h"
#include "core/sky/bodies/sun_disc.h"
#include "core/sky/limb_air.h"
#include "core/sky/places/place_effects.h"

namespace dmise {
namespace {

// Digests name these wherever they run, any other effect only where a scenario switches it, so that
// a new effect leaves the digests of older scenarios as they are.
constexpr std::string_view always_listed[] = {"proper_motion",
                                              "parallax",
                                              "light_deflection",
                                              "annual_aberration",
                                              "diurnal_aberration",
                                              "light_time",
                                              "refraction",
                                              "extinction",
                                              "clouds",
                                              "scintillation",
                                              "shadow",
                                              "earthshine",
                                              "earth_occultation",
                                              "stars",
                                              "objects",
                                              "sky",
                                              "airglow",
                                              "zodiacal_light",
                                              "faint_starlight",
                                              "scattered_moonlight",
                                              "twilight",
                                              "light_pollution",
                                              "psf",
                                              "prnu",
                                              "photon_noise",
                                              "dark_current",
                                              "hot_pixels",
                                              "cosmic_rays",
                                              "reference_pixels",
                                              "persistence",
                                              "full_well",
                                              "blooming",
                                              "interpixel_coupling",
                                              "nonlinearity",
                                              "column_noise",
                                              "read_noise",
                                              "quantisation"};

/// The effects that make expected electrons of sources and of the sky, in the order in which they
/// run. The parts of the sky and the effects of the air and of the image have lists of their own.
using LightEffects =
    EffectList<SkyBackground, SkyGrid, Airglow, ZodiacalLight, FaintStarlight, ScatteredMoonlight,
               Twilight, Daylight, LightPollution, ThermalSky, StrayLight, ThermalOptics, SunDisc,
               MoonDisc, Planets, EarthDisc, LimbAir, LimbAirglow, SpaceObjects, ResolvedShapes,
               EarthShadow, Earthshine, Moonlight, ThermalEmission, Glints, StarBackground,
               SyntheticBackground, EarthOccultation, LimbExtinction, AirExtinction, GasAbsorption,
               CloudCover, Scintillation, MovingScintillation, Dispersion, Vignetting, Streak,
               Occlusion, Drawing, PointSpread, AirTurbulence, PsfWavelengths, FieldBlur,
               FocusDrift, RangeDefocus>;

std::vector<const EffectFacts*> list() {
  std::vector<const EffectFacts*> all;
  const auto add = [&]<class Effect>() { all.push_back(&Effect::facts); };
  InstrumentEffects::for_each(add);
  PlaceEffects::for_each(add);
  LightEffects::for_each(add);
  ImageEffects::for_each(add);
  DetectorEffects::for_each(add);
  return all;
}

/// Whether an effect is a part of the sky.
template <class Effect>
constexpr bool is_sky_part = !std::is_null_pointer_v<decltype(sky_part<Effect>)>;

/// Calls `visit.template operator()<Effect>(parameters)` for the effects that apply to a sensor
/// with these optics and detector, switched on or not.
template <class Visit>
void for_each_in(const SensorConfig& sensor, const SceneFacts& scene, const ImageOptics& optics,
                 const Detector& detector, Visit&& visit) {
  const auto visit_in_scene = [&]<class Effect>() {
    if constexpr (requires { Effect::applies(scene); })
      if (!Effect::applies(scene)) return;
    if constexpr (is_sky_part<Effect>)
      if (!(sensor.sky.parts.*sky_part<Effect>)) return;
    visit.template operator()<Effect>(sensor);
  };
  InstrumentEffects::for_each([&]<class Effect>() {
    const Effect& effect = sensor.instrument;
    if (effect.applies()) visit.template operator()<Effect>(effect);
  });
  if (!scene.shutter_closed) {
    PlaceEffects::for_each(visit_in_scene);
    LightEffects::for_each(visit_in_scene);
    ImageEffects::for_each([&]<class Effect>() {
      if (static_cast<const Effect&>(optics).applies()) visit.template operator()<Effect>(optics);
    });
  }
  DetectorEffects::for_each([&]<class Effect>() {
    if (static_cast<const Effect&>(detector).applies(detector))
      visit.template operator()<Effect>(detector);
  });
}

}  // namespace

std::span<const EffectFacts* const> all_effects() {
  static const std::vector<const EffectFacts*> all = list();
  return all;
}

SceneFacts scene_facts(const SensorConfig& sensor) {
  const PointSpread& spread = sensor.camera.optics.spread;
  const bool of_file = spread.model == PointSpread::Model::file;
  const bool diffracts = spread.model == PointSpread::Model::diffraction;
  return {.on_ground = std::holds_alternative<SiteConfig>(sensor.place),
          .clouds = sensor.weather.clouds.has_value(),
          .gases = sensor.weather.pwv_mm.has_value(),
          .vignettes = sensor.camera.optics.vignetting.any(),
          .blur_of_file = of_file && sensor.effects.has(PointSpread::facts),
          .diffracts = diffracts || (of_file && spread.measured->wavelengths() > 1),
          .turbulent = diffracts && sensor.seeing && std::isfinite(sensor.seeing->r0_m) &&
                       sensor.effects.has(PointSpread::facts),
          .synthetic_stars = sensor.synthetic_stars_to_v_mag.has_value(),
          .blurs = sensor.effects.has(PointSpread::facts),
          .blur_varies =
              sensor.camera.optics.spread.varying.any() && sensor.effects.has(PointSpread::facts),
          .focus_drifts =
              sensor.camera.optics.spread.drift.any() && sensor.effects.has(PointSpread::facts),
          .stray_light = sensor.camera.optics.stray_light.any(),
          .thermal = is_thermal(sensor.camera.band),
          .warm_optics = sensor.camera.optics.thermal.any() && is_thermal(sensor.camera.band)};
}

std::vector<const EffectFacts*> effects_in(const SensorConfig& sensor, const SceneFacts& scene) {
  std::vector<const EffectFacts*> running;
  const EffectSet& switched = sensor.effects;
  for_each_in(sensor, scene, acting_optics(sensor.camera.optics.image, switched),
              acting_detector(sensor.camera.detector, switched), [&]<class Effect>(const auto&) {
                if (is_sky_part<Effect> && !switched.has(SkyBackground::facts)) return;
                if (switched.has(Effect::facts)) running.push_back(&Effect::facts);
              });
  return running;
}

namespace {

/// An effect with its error and cost: by `parameters`, or by static functions of an effect that has
/// no parameters.
template <class Effect, class Parameters>
PlannableEffect plannable(const Parameters& parameters) {
  PlannableEffect p{.facts = &Effect::facts};
  const auto has_static_error = requires(const PlanFacts& f) { Effect::error(0, f); };
  const auto has_static_cost = requires(const PlanFacts& f) { Effect::cost_s(0, f); };
  if constexpr (has_static_error) {
    p.error = [](int level, const PlanFacts& f) { return Effect::error(level, f); };
  } else if constexpr (requires(const Effect& e, const PlanFacts& f) { e.error(0, f); }) {
    const Effect effect = parameters;
    p.error = [effect](int level, const PlanFacts& f) { return effect.error(level, f); };
  }
  if constexpr (has_static_cost)
    p.cost_s = [](int level, const PlanFacts& f) { return Effect::cost_s(level, f); };
  return p;
}

}  // namespace

std::vector<PlannableEffect> plannable_effects(const SensorConfig& sensor,
                                               const SceneFacts& scene) {
  std::vector<PlannableEffect> list;
  for_each_in(
      sensor, scene, sensor.camera.optics.image, sensor.camera.detector,
      [&]<class Effect>(const auto& parameters) { list.push_back(plannable<Effect>(parameters)); });
  return list;
}

EffectSet recorded_effects(std::span<const PlannableEffect> effects, const SensorConfig& sensor,
                           std::uint32_t frame) {
  const auto fail = [&](const std::string& reason) {
    throw ConfigError("recorded plan of " + sensor.name + ", frame " + std::to_string(frame) +
                      ": " + reason);
  };
  const auto recorded = sensor.recorded_plans.find(frame);
  if (recorded == sensor.recorded_plans.end()) fail("there is none");
  EffectSet set = sensor.effects;
  for (const auto& effect : effects) {
    const EffectFacts& facts = *effect.facts;
    const auto named = recorded->second.find(std::string(facts.name));
    if (named == recorded->second.end())
      fail("no level of " + std::string(facts.name) + ", which the scenario has");
    const auto level = std::ranges::find(facts.levels, named->second);
    if (level == facts.levels.end())
      fail(std::string(facts.name) + " has no level " + printable(named->second));
    set.force_level(facts, int(level - facts.levels.begin()));
  }
  for (const auto& planned : recorded->second)
    if (std::ranges::none_of(effects, [&](const PlannableEffect& effect) {
          return effect.facts->name == planned.first;
        }))
      fail(printable(planned.first) + " is no effect of the scenario's sensor");
  return set;
}

namespace {

/// The keys in use; all of them for a lens without vignetting, for documents.
std::vector<ParameterValue> parameters_of(const Vignetting& v) {
  std::vector<ParameterValue> numbers;
  if (v.table.empty())
    numbers = {{"natural", {double(v.natural)}}, {"corner", {v.corner}}, {"power", {v.power}}};
  if (v.table.empty() && v.any()) return numbers;
  numbers.push_back({name(v.table_radius), v.table.at()});
  numbers.push_back({"relative_illumination", v.table.value()});
  return numbers;
}

std::vector<ParameterValue> parameters_of(const FieldBlur& field) {
  std::vector<ParameterValue> numbers;
  const bool all = !field.any(), widths = !field.fwhm_radial_px.empty();
  std::vector<double> terms;
  for (const FieldTerm& t : field.wavefront) {
    terms.push_back(t.noll);
    for (const double rms_m : t.rms_m.value()) terms.push_back(1e9 * rms_m);
  }
  numbers.push_back({name(field.radius),
                     widths || all ? field.fwhm_radial_px.at() : field.wavefront[0].rms_m.at()});
  if (widths || all) {
    numbers.push_back({"fwhm_radial_px", field.fwhm_radial_px.value()});
    numbers.push_back({"fwhm_tangential_px", field.fwhm_tangential_px.value()});
  }
  if (!widths || all) numbers.push_back({"zernike_nm", terms});
  return numbers;
}

std::vector<double> numbers_in(const InstrumentParameter& p, const SensorConfig& sensor) {
  return numbers_of(p, sensor.instrument);
}
std::vector<double> numbers_in(const ImageParameter& p, const SensorConfig& sensor) {
  return {sensor.camera.optics.image.*p.value};
}
template <class DetectorEffect>
std::vector<double> numbers_in(const ParameterOf<DetectorEffect>& p, const SensorConfig& sensor) {
  return {p.number_of(sensor.camera.detector)};
}

}  // namespace

std::vector<ParameterValue> parameters_in(const SensorConfig& sensor, const EffectFacts& effect) {
  const Camera& camera = sensor.camera;
  if (effect.name == Vignetting::facts.name) return parameters_of(camera.optics.vignetting);
  if (effect.name == FieldBlur::facts.name) return parameters_of(camera.optics.spread.varying);
  if (effect.name == FocusDrift::facts.name) {
    std::vector<ParameterValue> numbers;
    for (const FocusParameter& p : focus_parameters())
      numbers.push_back({p.key, {camera.optics.spread.drift.*p.value}});
    return numbers;
  }
  if (effect.name == StrayLight::facts.name)
    return {{"angle_deg", camera.optics.stray_light.angle_deg},
            {"transmittance", camera.optics.stray_light.transmittance}};
  if (effect.name == ThermalOptics::facts.name)
    return {{"emissivity", {camera.optics.thermal.emissivity}},
            {"window_emissivity", {camera.optics.thermal.window_emissivity}}};
  if (effect.name == EarthDisc::facts.name) return {{"earth_albedo", {sensor.earth_albedo}}};
  if (effect.name == Streak::facts.name && sensor.effects.snapshots() > 0)
    return {{"snapshots", {double(sensor.effects.snapshots())}}};
  std::vector<ParameterValue> numbers;
  const auto add = [&]<class Effect>() {
    if (Effect::facts.name == effect.name)
      for (const auto& p : Effect::parameters()) numbers.push_back({p.key, numbers_in(p, sensor)});
  };
  InstrumentEffects::for_each(add);
  ImageEffects::for_each(add);
  DetectorEffects::for_each(add);
  return numbers;
}

std::string effects_markdown() {
  std::vector<std::string> never_off;
  for (const EffectFacts* effect : all_effects())
    if (effect->switchable && !effect->can_be_off())
      never_off.push_back("`" + std::string(effect->name) + "`");
  std::string text =
      "# Effects\n\n"
      "Written by `dmise list effects > docs/models/effects.md`, in the order in which they run.\n"
      "Each can be switched in a scenario, `effects: {NAME: off}`, for all sensors or one, or set "
      "to\n"
      "a level, `{stars: v9}`; without levels it is off or on. These have levels alone and can't "
      "be\n"
      "off: " +
      joined(never_off) +
      ".\n"
      "`streak` (`integration: analytic | snapshots`, `snapshots: N`) and `evaluator` (`analytic "
      "|\n"
      "opengl`) have other choices. `dmise check` shows which may run and with what, `dmise "
      "explain`\n"
      "which do and why.\n\n"
      "| effect | what it does | left out | source | levels | parameters |\n"
      "|---|---|---|---|---|---|\n";
  for (const EffectFacts* effect : all_effects()) {
    std::string keys;
    for (const auto& parameter : parameters_in({}, *effect))
      keys += (keys.empty() ? "`" : ", `") + std::string(parameter.key) + "`";
    text += "| `" + std::string(effect->name) + "` | ";
    for (const auto cell : {effect->what, effect->error_if_off, effect->source})
      text += std::string(cell) + " | ";
    std::string levels;
    if (effect->levels.size() > 2)
      for (const auto level : effect->levels)
        levels += (levels.empty() ? "" : ", ") + std::string(level);
    text += levels + " | " + keys + " |\n";
  }
  return text;
}

std::vector<std::string> effects_in_digest(const EffectSet& effects) {
  std::vector<std::string> names;
  const auto add = [&](const EffectFacts& effect) {
    const int level = effects.level(effect);
    const bool graded = level > 0 && level != effect.unplanned() && effect.levels.size() > 2;
    const bool least = level == 0 && effects.is_forced(effect);
    names.push_back(std::string(effect.name) +
                    (graded || least ? ":" + std::string(effect.levels[std::size_t(level)]) : "") +
                    (effects.is_forced(effect) ? "!" : ""));
  };
  const auto named = [](std::string_view name) {
    return *std::ranges::find(all_effects(), name, &EffectFacts::name);
  };
  for (const auto name : always_listed)
    if (effects.has(*named(name)) || effects.is_forced(*named(name))) add(*named(name));
  for (const EffectFacts* effect : all_effects())
    if (std::ranges::find(always_listed, effect->name) == std::end(always_listed) &&
        (effects.level(*effect) != effect->unplanned() || effects.is_forced(*effect)))
      add(*effect);
  return names;
}

}  // namespace dmise
