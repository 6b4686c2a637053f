#pragma once
#include <array>
#include <chrono>
#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>

#include "core/detector/detector.h"

namespace dmise {

enum class Reach { drawing, piece, neighbours, image };

/// Which part of the image an effect needs; `drawing`: it acts before there is one.
template <class Effect>
constexpr Reach reach_of() {
  using X = const ExposureFacts&;
  if (requires(const Effect& e, X x, const WholeImage& i) { e.apply(x, i); }) return Reach::image;
  if (requires(const Effect& e, X x, const ElectronImage& i, Piece& p) { e.apply(x, i, p); })
    return Reach::neighbours;
  constexpr bool has_pixels = requires { &Effect::apply; };
  return has_pixels ? Reach::piece : Reach::drawing;
}

/// Result of an effect's `prepare`.
template <class Effect>
auto prepared(const Effect& effect, const ExposureFacts& exposed) {
  if constexpr (requires { effect.prepare(exposed); })
    return effect.prepare(exposed);
  else
    return std::monostate();
}

/// An effect in one exposure.
template <class Effect>
class ActingEffect {
 public:
  static constexpr Reach reach = reach_of<Effect>();
  ActingEffect(const Effect& effect, const ExposureFacts& exposed)
      : effect_(effect), exposed_(exposed), prepared_(prepared(effect, exposed)) {}

  template <class... Pixels>
  void apply(Pixels&... pixels) const {
    if constexpr (std::is_same_v<Prepared, std::monostate>)
      effect_.apply(exposed_, pixels...);
    else
      effect_.apply(exposed_, prepared_, pixels...);
  }

 private:
  using Prepared =
      decltype(prepared(std::declval<const Effect&>(), std::declval<const ExposureFacts&>()));

  const Effect& effect_;
  ExposureFacts exposed_;
  Prepared prepared_;
};

/// The effects of a family that apply to one exposure, with their random keys and timing.
/// Dispatches once per piece, never per pixel.
template <class List>
class Chain;

template <class... Effects>
class Chain<EffectList<Effects...>> {
 public:
  static constexpr std::size_t size = sizeof...(Effects);
  using Seconds = std::array<double, size>;

  /// `exposed` without its keys. Objects it refers to must outlive the chain.
  Chain(ExposureFacts exposed, Seconds& seconds) {
    Laps laps;
    each_slot([&]<class Effect>(std::size_t i, std::optional<ActingEffect<Effect>>& slot) {
      const Effect& effect = exposed.detector;
      if (reach_of<Effect>() == Reach::drawing) return;
      if (!effect.applies(exposed.detector)) return;
      const Exposure& named = exposed.exposure;
      exposed.key = rng_key(named.seed, named.sensor, named.frame, Effect::facts.name);
      // Frame 0 does not exist otherwise.
      exposed.fixed_key = rng_key(named.seed, named.sensor, 0, Effect::facts.name);
      slot.emplace(effect, exposed);
      laps.charge(seconds[i]);
    });
  }

  /// Index of the first effect from `from` on that needs pixels outside its piece; `size` if there
  /// is none.
  std::size_t next_beyond_pieces(std::size_t from) const {
    std::size_t found = size;
    each([&](std::size_t i, const auto& effect) {
      if (i >= from && found == size && effect.reach > Reach::piece) found = i;
    });
    return found;
  }
  Reach reach(std::size_t index) const {
    Reach reach = Reach::piece;
    each([&](std::size_t i, const auto& effect) {
      if (i == index) reach = effect.reach;
    });
    return reach;
  }

  /// Runs the effects [begin, end) on a piece. The first may need neighbouring pixels, which it
  /// takes from `image`.
  void run(std::size_t begin, std::size_t end, const ElectronImage* image, Piece& piece,
           Seconds& seconds) const {
    Laps laps;
    each([&](std::size_t i, const auto& effect) {
      if (i < begin || i >= end) return;
      constexpr Reach reach = std::remove_cvref_t<decltype(effect)>::reach;
      if constexpr (reach == Reach::piece) effect.apply(piece);
      if constexpr (reach == Reach::neighbours) effect.apply(*image, piece);
      laps.charge(seconds[i]);
    });
  }

  /// Runs one effect on the whole image.
  void run(std::size_t index, const WholeImage& image, Seconds& seconds) const {
    Laps laps;
    each([&](std::size_t i, const auto& effect) {
      if (i != index) return;
      if constexpr (std::remove_cvref_t<decltype(effect)>::reach == Reach::image)
        effect.apply(image);
      laps.charge(seconds[i]);
    });
  }

  /// Adds the run times of the effects to `times`.
  void record(const Seconds& seconds, EffectTimes& times) const {
    each([&]<class Effect>(std::size_t i, const ActingEffect<Effect>&) {
      times[Effect::facts] += seconds[i];
    });
  }

 private:
  class Laps {
   public:
    void charge(double& seconds) {
      const auto now = Clock::now();
      seconds += std::chrono::duration<double>(now - lap_).count();
      lap_ = now;
    }

   private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point lap_ = Clock::now();
  };

  template <class Visit>
  void each_slot(Visit&& visit) {
    std::apply(
        [&](auto&... slot) {
          std::size_t i = 0;
          (visit(i++, slot), ...);
        },
        slots_);
  }
  /// Calls visit(index, effect) for those that apply.
  template <class Visit>
  void each(Visit&& visit) const {
    std::apply(
        [&](const auto&... slot) {
          std::size_t i = 0;
          ((slot ? visit(i, *slot) : void(), ++i), ...);
        },
        slots_);
  }

  std::tuple<std::optional<ActingEffect<Effects>>...> slots_;
};

}  // namespace dmise
