#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace dmise {

/// Every stage that touches light or pixels, in the order in which a frame runs through it. Each
/// can be switched in a scenario (`effects: {aberration: off}`) and its time is measured per frame.
/// To add one: list it here and in effects.cpp, use it where it acts, test it.
enum class Effect {
  proper_motion,
  parallax,
  light_deflection,
  annual_aberration,
  diurnal_aberration,
  light_time,
  refraction,
  extinction,
  clouds,
  scintillation,
  shadow,
  earthshine,
  earth_occultation,
  stars,
  objects,
  sky,
  airglow,
  zodiacal_light,
  faint_starlight,
  scattered_moonlight,
  twilight,
  light_pollution,
  psf,
  prnu,
  photon_noise,
  dark_current,
  hot_pixels,
  cosmic_rays,
  reference_pixels,
  persistence,
  full_well,
  blooming,
  interpixel_coupling,
  nonlinearity,
  column_noise,
  read_noise,
  quantisation,
  count
};

inline constexpr std::size_t effect_count = static_cast<std::size_t>(Effect::count);

struct EffectFacts {
  std::string_view name;          // as in YAML
  std::string_view what;          // one line: what it does
  std::string_view error_if_off;  // the size of what is left out
};

const EffectFacts& facts(Effect effect);
std::optional<Effect> effect_named(std::string_view name);

/// Which effects run. All do unless switched off, but for earthshine, which is switched on.
class EffectSet {
 public:
  EffectSet() {
    on_.fill(true);
    set(Effect::earthshine, false);
  }
  bool has(Effect e) const { return on_[static_cast<std::size_t>(e)]; }
  void set(Effect e, bool on) { on_[static_cast<std::size_t>(e)] = on; }
  /// Snapshots along an exposure in which light is integrated; 0: along the path, exactly.
  int snapshots() const { return snapshots_; }
  void set_snapshots(int count) { snapshots_ = count; }
  /// Whether OpenGL draws the snapshots, and the sky, instead of the analytic deposit.
  bool drawn_by_opengl() const { return opengl_; }
  void draw_by_opengl(bool on) { opengl_ = on; }
  bool operator==(const EffectSet&) const = default;

 private:
  std::array<bool, effect_count> on_;
  int snapshots_ = 0;
  bool opengl_ = false;
};

/// Seconds spent in each effect over one frame. Never part of a product whose bytes must repeat.
struct EffectTimes {
  std::array<double, effect_count> seconds{};
  double& operator[](Effect e) { return seconds[static_cast<std::size_t>(e)]; }
  double operator[](Effect e) const { return seconds[static_cast<std::size_t>(e)]; }
};

}  // namespace dmise
