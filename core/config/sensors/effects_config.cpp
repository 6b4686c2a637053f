#include "core/config/sensors/effects_config.h"

#include <algorithm>
#include <iterator>

#include "core/base/formatted.h"
#include "core/config/sensors/effect_list.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/effects/frame_effects.h"
#include "core/sky/places/place_effects.h"

namespace dmise {
namespace {

/// Snapshots of an exposure, if it is drawn from snapshots.
constexpr int usual_snapshots = 16;

/// "off", "on" or the name of a level.
void read_level(const YamlValue& value, const EffectFacts& effect, EffectSet& effects) {
  const std::string text = value.is_scalar() ? value.text() : "";
  const auto found = std::find(effect.levels.begin(), effect.levels.end(), text);
  if (found != effect.levels.end() && effect.levels.size() > 2) {
    effects.force_level(effect, int(found - effect.levels.begin()));
  } else if (!effect.can_be_off()) {
    value.choice(effect.levels);
  } else if (effect.levels.size() == 2) {
    effects.force(effect, value.flag());
  } else {
    static constexpr std::string_view flags[] = {"on", "off", "true", "false", "yes", "no"};
    if (std::find(std::begin(flags), std::end(flags), text) == std::end(flags)) {
      std::vector<std::string_view> names(effect.levels.begin(), effect.levels.end());
      names.push_back("on");
      value.choice(names);
    }
    effects.force(effect, value.flag());
  }
}

Forms forms_of(const EffectFacts& effect) {
  std::vector<std::string> levels;
  for (const auto level : effect.levels)
    if (level != "off" && level != "on") levels.emplace_back(level);
  if (levels.empty()) return form::flag();
  return effect.can_be_off() ? form::choice(levels) | form::flag() : form::choice(levels);
}

const Section& effects_section() {
  static const Section section = [] {
    Section made{
        "effects",
        "Effects switched on or off, or set to a level. What is not named is left to the plan.",
        {}};
    for (const EffectFacts* effect : all_effects())
      if (effect->switchable)
        made.keys.push_back(optional(
            std::string(effect->name), forms_of(*effect),
            sentence_of(effect->what) + " Left out: " + std::string(effect->error_if_off) + ".",
            effect->usual ? "by the plan" : "off"));
    made.keys.push_back(
        optional("aberration", form::flag(), "Annual and diurnal aberration together."));
    made.keys.push_back(optional("integration", form::choice({"analytic", "snapshots"}),
                                 "How trails are drawn: exactly, or as a sum of snapshots.",
                                 "analytic"));
    made.keys.push_back(optional("snapshots", form::integer(1, 100000),
                                 "Snapshots of an exposure, with `integration: snapshots`.",
                                 std::to_string(usual_snapshots)));
    made.keys.push_back(optional("evaluator", form::choice({"analytic", "opengl"}),
                                 "What draws the snapshots.", "analytic"));
    return made;
  }();
  return section;
}

const Section& accuracy_section() {
  static const Section section = [] {
    Section made{
        "accuracy",
        "How accurate frames must be, or how long one may take. A plan leaves out what this does "
        "not call for.",
        {optional("seconds_per_frame", form::above(0.0, 86400.0),
                  "Time that a frame may take [s], in place of errors.")}};
    for (const auto& kind : error_kinds)
      made.keys.push_back(optional(kind.key, form::number(0.0, 1e6),
                                   std::string(kind.meaning) + " [" + kind.unit + "].",
                                   shortest_text(standard_budget.*kind.value)));
    return made;
  }();
  return section;
}

}  // namespace

Forms effects_forms() { return form::map(effects_section); }

Forms accuracy_forms() {
  return form::choice({"draft", "standard", "reference", "off"}) | form::map(accuracy_section);
}

void read_effects(const YamlValue& value, EffectSet& effects) {
  YamlMap map(value, effects_section());
  for (const EffectFacts* effect : all_effects())
    if (effect->switchable)
      if (const auto level = map.find(effect->name)) read_level(*level, *effect, effects);
  map.refuse(Streak::facts.name,
             "can't be switched; integration: analytic or snapshots chooses how it is drawn");
  if (const auto both = map.find("aberration")) {
    effects.force(AnnualAberration::facts, both->flag());
    effects.force(DiurnalAberration::facts, both->flag());
  }
  const auto integration = map.find("integration");
  const bool analytic = integration && integration->choice() == "analytic";
  if (integration) effects.set_snapshots(analytic ? 0 : usual_snapshots);
  if (analytic) effects.draw_by_opengl(false);
  if (const auto evaluator = map.find("evaluator")) {
    effects.draw_by_opengl(evaluator->choice() == "opengl");
    if (effects.drawn_by_opengl() && analytic) evaluator->fail("needs integration: snapshots");
    if (effects.drawn_by_opengl() && effects.snapshots() == 0)
      effects.set_snapshots(usual_snapshots);
  }
  if (const auto count = map.find("snapshots")) {
    if (effects.snapshots() == 0) count->fail("needs integration: snapshots", false);
    effects.set_snapshots(int(count->integer()));
  }
  map.done();
}

Accuracy read_accuracy(const YamlValue& value) {
  if (value.is_scalar())
    return value.chosen({draft_accuracy(), standard_accuracy(), reference_accuracy(), Accuracy{}});
  YamlMap map(value, accuracy_section());
  if (const auto seconds = map.find("seconds_per_frame")) {
    const double limit_s = seconds->number();
    map.done();
    return {.name = "seconds", .budget = {}, .seconds_per_frame = limit_s};
  }
  Accuracy accuracy{.name = "budget", .budget = standard_budget};
  bool any = false;
  for (const auto& kind : error_kinds)
    if (const auto number = map.find(kind.key)) {
      accuracy.budget.*kind.value = number->number();
      any = true;
    }
  map.done();
  if (!any)
    value.fail(
        "needs one of photometry_mag, position_px, background_sigma, noise or "
        "seconds_per_frame",
        false);
  return accuracy;
}

}  // namespace dmise
