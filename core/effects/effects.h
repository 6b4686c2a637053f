#pragma once
#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <string_view>

namespace dmise {

struct ErrorBound;  // core/effects/accuracy.h
struct PlanFacts;   // core/effects/plan_facts.h

inline constexpr std::array<std::string_view, 2> off_and_on{"off", "on"};

/// The description of an effect, for scenarios, `dmise check`, run.json and documents.
struct EffectFacts {
  std::string_view name;          // as in YAML
  std::string_view what;          // one line: what it does
  std::string_view error_if_off;  // the size of what is left out
  std::string_view source;        // where the model comes from
  bool usual = true;              // runs unless switched off; else only when switched on
  bool switchable = true;         // else it has other choices than on and off
  std::span<const std::string_view> levels = off_and_on;  // by rising accuracy, to the reference
  int usual_level = -1;                                   // without a plan; -1: the reference

  /// Whether the first level is to leave it out.
  bool can_be_off() const { return levels.front() == "off"; }
  int reference() const { return int(levels.size()) - 1; }
  /// Returns the level of a frame that nobody planned.
  int unplanned() const { return !usual ? 0 : usual_level < 0 ? reference() : usual_level; }
};

/// The facts that decide which effects of place and light apply to a sensor's frames.
struct SceneFacts {
  bool on_ground = true;
  bool clouds = false;           // over a sensor on the ground
  bool gases = false;            // known amounts of gases over it, with water vapour
  bool stars = true;             // there is a catalogue
  bool shapes = true;            // there are objects with a shape
  bool glints = false;           // with small parts that glint
  bool vignettes = false;        // the optics lose light off the axis
  bool blur_of_file = false;     // the blur of the optics is that of images
  bool diffracts = false;        // the blur of the optics depends on the wavelength
  bool turbulent = false;        // the air blurs, too
  bool synthetic_stars = false;  // the scenario asks for some
  bool blurs = false;            // the optics blur at all
  bool blur_varies = false;      // over the field, by a table
  bool focus_drifts = false;
  bool stray_light = false;  // the optics scatter light from beside the field
  bool thermal = false;      // the band reaches into the heat of air and optics
  bool warm_optics = false;  // and the heat of the optics is known
  // A body's disc is in the field or next to it during the exposure.
  bool sun_in_field = false, moon_in_field = false, earth_in_field = false;
  bool planets_in_field = false;  // or next to it
  bool shutter_closed = false;    // during the exposure: no light comes in
  bool daylight = false;  // the Sun is up over a sensor on the ground, or little below its horizon
  bool limb_in_field = false;  // from space: light may come through the air over the Earth's limb
};

/// A closed family of effects, in the order in which they run.
template <class... Effects>
struct EffectList {
  static constexpr std::size_t size = sizeof...(Effects);
  /// Parameters of all effects in one struct.
  struct Parameters : Effects... {
    bool operator==(const Parameters&) const = default;
  };
  /// Calls `visit.template operator()<Effect>()` for each.
  template <class Visit>
  static void for_each(Visit&& visit) {
    (visit.template operator()<Effects>(), ...);
  }
};

/// The level at which each effect runs: the usual one unless a scenario or a plan sets another.
class EffectSet {
 public:
  int level(const EffectFacts& effect) const {
    const auto found = level_.find(effect.name);
    return found == level_.end() ? effect.unplanned() : found->second;
  }
  /// Whether it runs at all.
  bool has(const EffectFacts& effect) const { return level(effect) > 0 || !effect.can_be_off(); }
  void set_level(const EffectFacts& effect, int level) {
    if (level == effect.unplanned())
      level_.erase(effect.name);
    else
      level_[effect.name] = level;
  }
  void set(const EffectFacts& effect, bool on) {
    set_level(effect, !on ? 0 : effect.usual ? effect.unplanned() : effect.reference());
  }
  /// Sets the level that the user asks for: no plan changes the level.
  void force_level(const EffectFacts& effect, int level) {
    set_level(effect, level);
    forced_.insert(effect.name);
  }
  void force(const EffectFacts& effect, bool on) {
    set(effect, on);
    forced_.insert(effect.name);
  }
  bool is_forced(const EffectFacts& effect) const { return forced_.contains(effect.name); }
  /// Snapshots along an exposure in which light is integrated; 0: along the path, exactly.
  int snapshots() const { return snapshots_; }
  void set_snapshots(int count) { snapshots_ = count; }
  /// Whether OpenGL draws snapshots and sky, instead of the analytic deposit.
  bool drawn_by_opengl() const { return opengl_; }
  void draw_by_opengl(bool on) { opengl_ = on; }
  bool operator==(const EffectSet&) const = default;

 private:
  std::map<std::string_view, int> level_;  // only effects whose level is not the usual one
  std::set<std::string_view> forced_;
  int snapshots_ = 0;
  bool opengl_ = false;
};

/// Whether an effect of place or light acts in a scene.
template <class Effect>
bool acts(const EffectSet& switched, const SceneFacts& scene) {
  if (!switched.has(Effect::facts)) return false;
  if constexpr (requires { Effect::applies(scene); }) return Effect::applies(scene);
  return true;
}

/// Seconds spent in each effect over one frame. Never part of a product whose bytes must repeat.
struct EffectTimes {
  std::map<std::string_view, double> seconds;  // by name
  double& operator[](const EffectFacts& effect) { return seconds[effect.name]; }
  double sum_s() const {
    double sum = 0.0;
    for (const auto& [name, s] : seconds) sum += s;
    return sum;
  }
  double operator[](const EffectFacts& effect) const {
    const auto found = seconds.find(effect.name);
    return found == seconds.end() ? 0.0 : found->second;
  }
};

}  // namespace dmise
