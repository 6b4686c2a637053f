#pragma once
#include <concepts>
#include <optional>
#include <tuple>

#include "core/effects/effects.h"

namespace dmise {

/// The effects of a list that act in one exposure: those that are switched on and apply to it, each
/// made from the facts of the exposure.
template <class List>
class ActingEffects;

template <class... Effects>
class ActingEffects<EffectList<Effects...>> {
 public:
  /// An effect without a constructor that takes `exposure` is made by its default constructor.
  template <class... Facts>
  ActingEffects(const EffectSet& switched, const SceneFacts& scene, const Facts&... exposure) {
    const auto make = [&]<class Effect>(std::optional<Effect>& effect) {
      if (!acts<Effect>(switched, scene)) return;
      if constexpr (std::constructible_from<Effect, const Facts&...>)
        effect.emplace(exposure...);
      else
        effect.emplace();
    };
    (make(std::get<std::optional<Effects>>(effects_)), ...);
  }

  /// Calls `visit(effect)` for each, in the order of the list.
  template <class Visit>
  void for_each(Visit&& visit) const {
    const auto visit_one = [&](const auto& effect) {
      if (effect) visit(*effect);
    };
    (visit_one(std::get<std::optional<Effects>>(effects_)), ...);
  }

  /// Null if the effect does not act.
  template <class Effect>
  const Effect* find() const {
    const auto& effect = std::get<std::optional<Effect>>(effects_);
    return effect ? &*effect : nullptr;
  }

 private:
  std::tuple<std::optional<Effects>...> effects_;
};

}  // namespace dmise
