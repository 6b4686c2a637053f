#include "core/sky/sky_model.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/planck.h"
#include "core/sky/air/airmass.h"
#include "core/sky/air/extinction.h"
#include "core/sky/surface_brightness.h"

namespace dmise {
namespace {

/// In light from all around, half of what is scattered out of the line of sight is replaced by what
/// is scattered into it. Noll et al. 2012, A&A 543, A92 find 0.3 to 0.7 for zodiacal light.
constexpr double diffuse_share_of_extinction = 0.5;
// Airglow, given as it is seen in the zenith, falls by the whole for each airmass beyond the first:
// Krisciunas & Schaefer 1991, PASP 103, 1033, equation 2, and to 5 % Noll et al.

}  // namespace

std::optional<SkyParts> sky_parts_named(std::string_view preset) {
  const std::optional<double> zenith = zenith_brightness_named(preset);
  if (!zenith) return std::nullopt;
  SkyParts parts;
  parts.zodiacal_light = ZodiacalLight{};
  parts.faint_starlight = FaintStarlight{};
  if (preset == "space") return parts;
  parts.airglow = Airglow{};
  parts.scattered_moonlight = ScatteredMoonlight{};
  parts.twilight = Twilight{};
  parts.thermal_sky = ThermalSky{};
  parts.daylight = Daylight{};
  if (preset != "dark") {
    const double natural_s10 = s10_of_mag_per_arcsec2(*zenith_brightness_named("dark"));
    parts.light_pollution = LightPollution{};
    parts.light_pollution->zenith_v_mag_per_arcsec2 =
        mag_per_arcsec2_of_s10(s10_of_mag_per_arcsec2(*zenith) - natural_s10);
  }
  return parts;
}

SkyParts acting_sky(const SkyParts& parts, const EffectSet& switched, const SceneFacts& scene) {
  SkyParts acting = parts;
  SkyPartEffects::for_each([&]<class Part>() {
    if (!acts<Part>(switched, scene)) (acting.*sky_part<Part>).reset();
  });
  return acting;
}

SkyModel::SkyModel(const SkyParts& parts, const SkyScene& scene, const Band& band,
                   const Curve& extinction)
    : parts_(parts), scene_(scene) {
  const Rotation<Ecliptic, Gcrs> ecliptic = ecliptic_from_gcrs();
  ecliptic_from_enu_ = ecliptic * scene.gcrs_from_enu;
  galactic_from_enu_ = galactic_from_gcrs() * scene.gcrs_from_enu;
  galactic_pole_ = galactic_from_enu_.inverse() * Vec<Galactic>{0, 0, 1};
  sun_longitude_rad_ = to_spherical(ecliptic_from_enu_ * scene.sun)[0];
  const double sun_altitude_rad = std::asin(std::clamp(scene.sun.z, -1.0, 1.0));
  moon_v_mag_ = moon_v_mag(scene.moon_phase_rad) + opposition_surge_mag(scene.moon_phase_rad) +
                5.0 * std::log10(scene.moon_distance_m / mean_moon_distance_m);
  if (scene.in_air) {
    k_v_ = zenith_extinction_mag(johnson_v(), extinction);
    const double k = zenith_extinction_mag(band, extinction);
    diffuse_mag_ = diffuse_share_of_extinction * k;
    if (parts_.scattered_moonlight) moonlit_air_ = moonlit_air(band, k_v_, k);
  } else {
    parts_ = acting_sky(parts, {}, {.on_ground = false});
  }
  if (parts_.daylight) daylight_share_ = daylight_share(sun_altitude_rad);
  if (daylight_share_ > 0.0) {
    day_sun_ = scene.apparent_sun.value_or(scene.sun);
    day_sky_ = kept_day_sky(band, scene.day_air, day_sun_.z);
  }
  if (parts_.twilight && daylight_share_ < 1.0) {
    twilight_zenith_s10_ =
        (1.0 - daylight_share_) * parts_.twilight->factor * twilight_zenith_s10(sun_altitude_rad);
    if (twilight_zenith_s10_ > 0.0) twilight_pattern_.emplace(scene.sun);
  }
  const double sunlit = photons_per_s_m2_sr_of_s10(band);
  photons_of_s10_.fill(sunlit);
  const auto photons_of = [&](SkyPart part, const Spectrum& spectrum, const Band& of) {
    photons_of_s10_[std::size_t(part)] = photons_per_s_m2_sr_of_s10(of, spectrum);
  };
  const bool absorbs = scene.in_air && scene.gases;
  const Band above = absorbs ? through(band, gas_transmission(*scene.gases, 1.0)) : band;
  if (absorbs)
    for (const SkyPart part : {SkyPart::zodiacal_light, SkyPart::faint_starlight})
      photons_of(part, sunlight_spectrum(), above);
  if (parts_.zodiacal_light) zodiacal_redness_ = zodiacal_redness(above);
  if (parts_.airglow)
    photons_of(SkyPart::airglow,
               airglow_spectrum(airglow_by_solar_flux(parts_.airglow->solar_flux_sfu)), band);
  if (parts_.scattered_moonlight)
    photons_of(SkyPart::scattered_moonlight, moonlight_spectrum(), above);
  if (parts_.twilight) photons_of(SkyPart::twilight, twilight_spectrum(sun_altitude_rad), above);
  if (parts_.light_pollution)
    photons_of(SkyPart::light_pollution, lamp_spectrum(parts_.light_pollution->lamps), band);
  if (parts_.thermal_sky && is_thermal(band)) air_radiance_.emplace(band, scene.warm_air);
}

double SkyModel::above_air_s10(SkyPart part, const Vec<Enu>& direction) const {
  if (part == SkyPart::faint_starlight && parts_.faint_starlight->by_counts)
    return faint_starlight_s10(*parts_.faint_starlight, galactic_from_enu_ * direction);
  if (part == SkyPart::faint_starlight)
    return faint_starlight_s10(*parts_.faint_starlight, dot(galactic_pole_, direction));
  const Vec<Ecliptic> e = ecliptic_from_enu_ * direction;
  return parts_.zodiacal_light->factor *
         zodiacal_light_s10(std::atan2(e.y, e.x) - sun_longitude_rad_,
                            std::asin(std::clamp(e.z, -1.0, 1.0)));
}

double SkyModel::above_clouds_s10(SkyPart part, const Vec<Enu>& direction) const {
  switch (part) {
    case SkyPart::airglow:
      return parts_.airglow ? airglow_s10(*parts_.airglow, direction.z,
                                          diffuse_mag_ / diffuse_share_of_extinction)
                            : 0.0;
    case SkyPart::zodiacal_light:
      if (!parts_.zodiacal_light) return 0.0;
      break;
    case SkyPart::faint_starlight:
      if (!parts_.faint_starlight) return 0.0;
      break;
    case SkyPart::scattered_moonlight:
      if (!parts_.scattered_moonlight) return 0.0;
      return parts_.scattered_moonlight->factor *
             scattered_moonlight_s10(angle_rad(direction, scene_.moon), direction.z, scene_.moon.z,
                                     moon_v_mag_, moonlit_air_);
    case SkyPart::twilight:
      return twilight_pattern_ ? twilight_zenith_s10_ * twilight_pattern_->over_zenith(direction)
                               : 0.0;
    default:
      return 0.0;
  }
  const double arrives =
      scene_.in_air ? light_of_magnitude(diffuse_mag_ * scattering_airmass(direction.z)) : 1.0;
  return arrives * above_air_s10(part, direction);
}

double SkyModel::daylight_s10(const Vec<Enu>& direction) const {
  if (!day_sky_) return 0.0;
  const double photons = day_sky_->photons_per_s_m2_sr(
      {.sin_altitude = direction.z,
       .azimuth_from_sun_rad = std::atan2(direction.x * day_sun_.y - direction.y * day_sun_.x,
                                          direction.x * day_sun_.x + direction.y * day_sun_.y),
       .cos_angle_from_sun = dot(direction, day_sun_)});
  return daylight_share_ * parts_.daylight->factor * photons /
         photons_of_s10_[std::size_t(SkyPart::daylight)];
}

double SkyModel::part_s10(SkyPart part, const Vec<Enu>& direction) const {
  if (part == SkyPart::daylight) return daylight_s10(direction);
  if (part == SkyPart::uniform)
    return parts_.uniform ? s10_of_mag_per_arcsec2(parts_.uniform->v_mag_per_arcsec2) : 0.0;
  if (part == SkyPart::light_pollution)
    return parts_.light_pollution ? light_pollution_s10(*parts_.light_pollution, direction, k_v_)
                                  : 0.0;
  return above_clouds_s10(part, direction) * cloud_transmission(direction);
}

double SkyModel::cloud_transmission(const Vec<Enu>& direction) const {
  return scene_.clouds ? scene_.clouds->transmission(direction, scene_.time_s) : 1.0;
}

std::array<double, sky_part_count> SkyModel::parts_s10(const Vec<Enu>& direction) const {
  std::array<double, sky_part_count> s10;
  const double clouds = cloud_transmission(direction);
  for (std::size_t i = 0; i < sky_part_count; ++i) {
    const auto part = static_cast<SkyPart>(i);
    const bool before_clouds =
        part == SkyPart::uniform || part == SkyPart::light_pollution || part == SkyPart::daylight;
    s10[i] = before_clouds ? part_s10(part, direction) : clouds * above_clouds_s10(part, direction);
  }
  return s10;
}

std::array<double, sky_part_count> SkyModel::photons_of_parts(const Vec<Enu>& direction) const {
  auto parts = parts_s10(direction);
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i] *= photons_of_s10_[i];
  double& zodiacal = parts[std::size_t(SkyPart::zodiacal_light)];
  if (zodiacal > 0.0)
    zodiacal *= 1.0 + zodiacal_slope(angle_rad(direction, scene_.sun)) * zodiacal_redness_;
  if (air_radiance_)
    parts[std::size_t(SkyPart::thermal_sky)] = air_radiance_->photons_per_s_m2_sr(direction.z);
  return parts;
}

double SkyModel::photons_per_s_m2_sr(const Vec<Enu>& direction) const {
  double sum = 0.0;
  for (const double part : photons_of_parts(direction)) sum += part;
  return sum;
}

}  // namespace dmise
