#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>

#include "core/effects/effects.h"
#include "core/effects/sky_part.h"
#include "core/frames/sky_frames.h"
#include "core/frames/vec.h"
#include "core/sky/air/air_gases.h"
#include "core/sky/air/clouds.h"
#include "core/sky/airglow.h"
#include "core/sky/daylight.h"
#include "core/sky/faint_starlight.h"
#include "core/sky/light_pollution.h"
#include "core/sky/scattered_moonlight.h"
#include "core/sky/thermal_sky.h"
#include "core/sky/twilight.h"
#include "core/sky/zodiacal_light.h"

namespace dmise {

/// One brightness everywhere, of the Sun's colour: a sky given by one figure.
struct UniformSky {
  double v_mag_per_arcsec2 = 21.0;
};

/// The parts of the sky; a part is on if it is given. To add one: write its file pair, list it here
/// and in sky_model.cpp, test it in tests/sky.
struct SkyParts {
  std::optional<UniformSky> uniform;
  std::optional<Airglow> airglow;
  std::optional<ZodiacalLight> zodiacal_light;
  std::optional<FaintStarlight> faint_starlight;
  std::optional<ScatteredMoonlight> scattered_moonlight;
  std::optional<Twilight> twilight;
  std::optional<LightPollution> light_pollution;
  std::optional<ThermalSky> thermal_sky;
  std::optional<Daylight> daylight;
};

/// Those that can be switched.
using SkyPartEffects = EffectList<Airglow, ZodiacalLight, FaintStarlight, ScatteredMoonlight,
                                  Twilight, Daylight, LightPollution, ThermalSky>;

/// The member of `SkyParts` for such a part; null for other types.
template <class Part>
inline constexpr std::nullptr_t sky_part = nullptr;
template <>
inline constexpr auto sky_part<Airglow> = &SkyParts::airglow;
template <>
inline constexpr auto sky_part<ZodiacalLight> = &SkyParts::zodiacal_light;
template <>
inline constexpr auto sky_part<FaintStarlight> = &SkyParts::faint_starlight;
template <>
inline constexpr auto sky_part<ScatteredMoonlight> = &SkyParts::scattered_moonlight;
template <>
inline constexpr auto sky_part<Twilight> = &SkyParts::twilight;
template <>
inline constexpr auto sky_part<Daylight> = &SkyParts::daylight;
template <>
inline constexpr auto sky_part<LightPollution> = &SkyParts::light_pollution;
template <>
inline constexpr auto sky_part<ThermalSky> = &SkyParts::thermal_sky;

/// The parts that act: without those that are switched off or do not apply to the scene.
SkyParts acting_sky(const SkyParts& parts, const EffectSet& switched, const SceneFacts& scene);

/// The parts that make the sky of a preset: "dark" (all natural ones), "suburban" and "urban"
/// (these, and lamps that bring the zenith to 20 and 18 mag/arcsec2), "space" (light from above the
/// air alone).
std::optional<SkyParts> sky_parts_named(std::string_view preset);

inline constexpr double mean_moon_distance_m = 384.4e6;

/// What the sky depends on at one site and time. Directions are unit: the Sun's without refraction,
/// as twilight goes by its true depression, the Moon's apparent.
struct SkyScene {
  Vec<Enu> sun{0, 0, -1};
  Vec<Enu> moon{0, 0, -1};
  double moon_phase_rad = 3.14159265358979323846;  // Sun-Moon-observer, 0 at full Moon
  double moon_distance_m = mean_moon_distance_m;
  Rotation<Gcrs, Enu> gcrs_from_enu;
  bool in_air = true;  // false: a camera in space, no extinction
  /// Gases that absorb light from above the air, by the path towards the zenith.
  std::optional<AirGases> gases;
  AirGases warm_air{.pwv_mm = usual_pwv_mm(0.0)};  // by which the thermal sky glows
  /// The air that scatters daylight, and the Sun as it is seen; none: as `sun`.
  DayAir day_air;
  std::optional<Vec<Enu>> apparent_sun;
  /// Clouds dim light from above them; null: none. `LightPollution`, `ThermalSky`,
  /// `UniformSky` and `Daylight` are not changed.
  std::shared_ptr<const CloudMap> clouds;
  double time_s = 0.0;  // for the clouds' drift
};

/// The sky of one scene in one band.
class SkyModel {
 public:
  /// `extinction` [mag/airmass] as in extinction.h. Throws `Error` when a part has no spectrum in
  /// the band.
  SkyModel(const SkyParts& parts, const SkyScene& scene, const Band& band, const Curve& extinction);

  /// Photons/s/m2/sr from a direction (unit) at the camera; below the horizon that of the horizon.
  double photons_per_s_m2_sr(const Vec<Enu>& direction) const;

  /// Photons of each part, in the order of `SkyPart`.
  std::array<double, sky_part_count> photons_of_parts(const Vec<Enu>& direction) const;

  /// V brightness of one part [S10]; 0 where it is off, and of the thermal sky, which has no light
  /// in V. Extinction is that of the band. Daylight: sunlight of as much light in the band.
  double part_s10(SkyPart part, const Vec<Enu>& direction) const;
  /// Brightness of each part [S10], in the order of `SkyPart`.
  std::array<double, sky_part_count> parts_s10(const Vec<Enu>& direction) const;

 private:
  double above_air_s10(SkyPart part, const Vec<Enu>& direction) const;
  double above_clouds_s10(SkyPart part, const Vec<Enu>& direction) const;
  double daylight_s10(const Vec<Enu>& direction) const;
  double cloud_transmission(const Vec<Enu>& direction) const;

  SkyParts parts_;
  SkyScene scene_;
  Rotation<Ecliptic, Enu> ecliptic_from_enu_;
  Rotation<Galactic, Enu> galactic_from_enu_;
  Vec<Enu> galactic_pole_;
  double sun_longitude_rad_ = 0.0;
  double twilight_zenith_s10_ = 0.0;
  std::optional<TwilightPattern> twilight_pattern_;  // none: no twilight
  double zodiacal_redness_ = 0.0;
  double moon_v_mag_ = 0.0;
  double k_v_ = 0.0;          // extinction of stars in V [mag/airmass], 0 in space
  double diffuse_mag_ = 0.0;  // that of extended light in the band [mag/airmass]
  MoonlitAir moonlit_air_;
  std::optional<AirRadiance> air_radiance_;  // none: no heat in the band
  std::shared_ptr<const DaySky> day_sky_;    // null: no daylight
  double daylight_share_ = 0.0;              // the rest of sunlight is twilight
  Vec<Enu> day_sun_{0, 0, -1};
  std::array<double, sky_part_count> photons_of_s10_{};
};

}  // namespace dmise
