#pragma once
#include <cstddef>
#include <map>
#include <set>
#include <string_view>

namespace dmise {

/// The description of an effect, for scenarios, `dmise check`, run.json and documents.
struct EffectFacts {
  std::string_view name;          // as in YAML
  std::string_view what;          // one line: what it does
  std::string_view error_if_off;  // the size of what is left out
  std::string_view source;        // of the model
  bool usual = true;              // runs unless switched off; else only when switched on
  bool switchable = true;         // else it has other choices than on and off
};

/// The facts by which effects of place and light apply to a sensor's frames or not.
struct SceneFacts {
  bool on_ground = true;
  bool clouds = false;     // over a ground sensor
  bool stars = true;       // there is a catalogue
  bool shapes = true;      // there are objects with a shape
  bool vignettes = false;  // the optics lose light off the axis
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

/// Which effects run: the usual ones but for those that a scenario switches.
class EffectSet {
 public:
  bool has(const EffectFacts& effect) const {
    return effect.usual != switched_.contains(effect.name);
  }
  void set(const EffectFacts& effect, bool on) {
    if (on == effect.usual)
      switched_.erase(effect.name);
    else
      switched_.insert(effect.name);
  }
  /// Snapshots along an exposure in which light is integrated; 0: along the path, exactly.
  int snapshots() const { return snapshots_; }
  void set_snapshots(int count) { snapshots_ = count; }
  /// Whether OpenGL draws the snapshots, and the sky, instead of the analytic deposit.
  bool drawn_by_opengl() const { return opengl_; }
  void draw_by_opengl(bool on) { opengl_ = on; }
  bool operator==(const EffectSet&) const = default;

 private:
  std::set<std::string_view> switched_;  // not as usual
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
